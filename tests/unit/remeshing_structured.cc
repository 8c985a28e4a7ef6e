// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Blocks divided anew: counts follow from lengths, and all the rest stays.
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/remeshing/gathered_mesh.h>
#include <alveolus/remeshing/remesher.h>

#include <gtest/gtest.h>

#include <functional>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Points   = std::vector<Point<2>>;
  using Settings = std::map<std::string, std::string>;
  using Map      = std::function<Point<2>(const Point<2> &)>;

  constexpr double       places[4] = {0., 6., 8., 14.};
  constexpr unsigned int counts[3] = {6, 4, 6};

  /**
   * Three blocks 4 high in a row, left, centre and right, of 6, 4 and 6 times
   * 4 cells; edges of the left one grow towards the left by a factor from
   * one to the next. Curves bottom, top, their parts, and the vertical lines;
   * points A (top left) and M (in the middle of the top of left).
   */
  Mesh<2>
  row_of_blocks(const double factor = 1.)
  {
    PlanarGeometry geometry;
    for (const double y : {0., 4.})
      for (const double x : places)
        geometry.points.emplace_back(x, y);
    const auto &p   = geometry.points;
    const auto  add = [&](const unsigned int           a,
                         const unsigned int           b,
                         const unsigned int           n,
                         const double                 q,
                         const std::set<std::string> &names) {
      PlanarCurve curve;
      curve.begin = a;
      curve.end   = b;
      for (unsigned int i = 0; i <= n; ++i)
        curve.nodes.push_back(
          p[a] + (p[b] - p[a]) *
                   (q == 1. ? double(i) / n
                             : (std::pow(q, i) - 1.) / (std::pow(q, n) - 1.)));
      curve.nodes.back() = p[b];
      curve.tag          = 3 + geometry.curves.size();
      for (const std::string &name : names)
        geometry.curve_names[name].insert(curve.tag);
      geometry.curves.push_back(curve);
    };
    const char *vertical[] = {"left end", "line 1", "line 2", "right end"};
    for (unsigned int k = 0; k < 4; ++k)
      add(k, 4 + k, 4, 1., {vertical[k]});
    const char *regions[] = {"left", "centre", "right"};
    for (unsigned int k = 0; k < 3; ++k)
      for (const unsigned int row : {0u, 4u})
        add(row + k,
            row + k + 1,
            counts[k],
            k == 0 ? 1. / factor : 1.,
            {row == 0 ? "bottom" : "top",
             std::string(row == 0 ? "bottom " : "top ") + regions[k]});
    for (unsigned int k = 0; k < 3; ++k)
      {
        PlanarArea area;
        area.name       = regions[k];
        area.tag        = 1 + k;
        area.structured = true;
        area.loops      = {
               {{4 + 2 * k, false}, {k + 1, false}, {5 + 2 * k, true}, {k, true}}};
        geometry.areas.push_back(area);
        geometry.region_names[regions[k]] = {area.tag};
      }
    geometry.point_names["A"] = p[4];
    geometry.point_names["M"] = geometry.curves[5].nodes[3];
    PlanarMeshReport report;
    return build_mesh(mesh_planar_geometry(geometry,
                                           PlanarMesher(),
                                           {"row", ".", "test", MPI_COMM_WORLD},
                                           report),
                      MPI_COMM_WORLD);
  }

  struct Body
  {
    Body(Mesh<2> &&given, const Map &map)
      : mesh(std::move(given))
      , configuration(mesh, 1)
    {
      const Nodes<2> nodes(configuration);
      NodalVector    positions = configuration.make_vector();
      NodalVector    owned(configuration.locally_owned,
                        configuration.communicator());
      for (const NodeId node : nodes.relevant())
        if (nodes.is_owned(node))
          nodes.set(owned,
                    node,
                    map(nodes.get(configuration.initial_positions(), node)));
      owned.compress(VectorOperation::insert);
      positions = owned;
      configuration.set_positions(positions);
    }

    Mesh<2>          mesh;
    Configuration<2> configuration;
  };

  std::vector<RemeshCandidate<2>>
  remesh(const Body &body, const Settings &settings)
  {
    const auto maker =
      Registry<Remesher<2>>::create("structured", "Remeshing / Type");
    ParameterHandler prm;
    maker->declare_parameters(prm);
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    maker->initialize(body.mesh.names, "Remeshing / structured");
    return maker->candidates(body.configuration, ".", "remesh");
  }

  template <class Error>
  std::string
  message(const std::function<void()> &function)
  {
    try
      {
        function();
      }
    catch (const Error &error)
      {
        return error.what();
      }
    return "no error";
  }

  std::map<unsigned int, unsigned int>
  n_cells(const Mesh<2> &mesh)
  {
    std::map<unsigned int, unsigned int> result;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      ++result[cell->material_id()];
    return result;
  }

  std::map<unsigned int, double>
  areas(const Mesh<2> &mesh)
  {
    std::map<unsigned int, double> result;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      result[cell->material_id()] += cell->measure();
    return result;
  }

  /** The centre goes to the right by way; the blocks beside it follow. */
  Map
  shifted(const double way)
  {
    return [way](const Point<2> &p) {
      const double part = p[0] < places[1] ? p[0] / places[1]
                          : p[0] > places[2]
                            ? (places[3] - p[0]) / (places[3] - places[2])
                            : 1.;
      return Point<2>(p[0] + way * part, p[1]);
    };
  }
} // namespace



// From 6 mm to 10 mm and 2 mm; edges of 1 mm across: 10 and 2 columns of
// squares.
TEST(StructuredRemesher, CountsFollowLengths)
{
  const Body body(row_of_blocks(), shifted(4.));
  const auto candidates = remesh(body, {{"Blocks", "left, right"}});
  ASSERT_EQ(candidates.size(), 1u);
  const Mesh<2> &mesh = candidates[0].mesh;
  EXPECT_NEAR(candidates[0].quality, 1., 1e-12);
  EXPECT_EQ(n_cells(mesh),
            (std::map<unsigned int, unsigned int>{{1, 40}, {2, 16}, {3, 8}}));
  const auto new_areas = areas(mesh);
  EXPECT_NEAR(new_areas.at(1), 40., 1e-12);
  EXPECT_NEAR(new_areas.at(2), 8., 1e-12);
  EXPECT_NEAR(new_areas.at(3), 8., 1e-12);
  for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
    if (cell->material_id() != 2)
      {
        EXPECT_NEAR(cell->measure(), 1., 1e-12);
        EXPECT_NEAR(cell->diameter(), std::sqrt(2.), 1e-12);
      }
  EXPECT_EQ(mesh.names.curves, body.mesh.names.curves);
  EXPECT_EQ(mesh.names.boundaries, body.mesh.names.boundaries);
  EXPECT_EQ(mesh.names.regions, body.mesh.names.regions);
  EXPECT_EQ(mesh.names.points.at("A"), Point<2>(0., 4.));
  EXPECT_NEAR(mesh.names.points.at("M").distance(Point<2>(5., 4.)), 0., 1e-12);

  // Every boundary line has the id of the part it is on.
  for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
    for (const auto &line : cell->face_iterators())
      if (line->at_boundary() && line->center()[1] == 4.)
        {
          const double      x    = line->center()[0];
          const std::string part = x < 10.   ? "left"
                                   : x < 12. ? "centre"
                                             : "right";
          EXPECT_EQ(
            mesh.names.boundaries.at("top " + part).count(line->boundary_id()),
            1u);
        }
}



// There and back: the mesh of the start.
TEST(StructuredRemesher, ThereAndBack)
{
  const Body body(row_of_blocks(), shifted(4.));
  auto       there = remesh(body, {{"Blocks", "left, right"}});
  ASSERT_EQ(there.size(), 1u);
  const Body moved(std::move(there[0].mesh), [](const Point<2> &p) {
    const double part = p[0] < 10.   ? p[0] / 10.
                        : p[0] > 12. ? (14. - p[0]) / 2.
                                     : 1.;
    return Point<2>(p[0] - 4. * part, p[1]);
  });
  const auto back = remesh(moved, {{"Blocks", "left, right"}});
  EXPECT_EQ(n_cells(back[0].mesh), n_cells(row_of_blocks()));
  std::set<std::pair<long, long>> places_back, places_start;
  for (const Point<2> &p : back[0].mesh.triangulation->get_vertices())
    places_back.emplace(std::lround(1e9 * p[0]), std::lround(1e9 * p[1]));
  const Mesh<2> start = row_of_blocks();
  for (const Point<2> &p : start.triangulation->get_vertices())
    places_start.emplace(std::lround(1e9 * p[0]), std::lround(1e9 * p[1]));
  EXPECT_EQ(places_back, places_start);
}



TEST(StructuredRemesher, Grading)
{
  const double factor = 1.3;
  const Body   body(row_of_blocks(factor), shifted(0.));
  for (const bool graded : {true, false})
    {
      const auto candidates =
        remesh(body,
               {{"Blocks", "left"},
                {"Edge length", "0.5"},
                {"Grading", graded ? "as before" : "equal"}});
      std::set<double> x;
      for (const auto &cell :
           candidates[0].mesh.triangulation->cell_iterators_on_level(0))
        if (cell->material_id() == 1)
          for (const unsigned int v : cell->vertex_indices())
            if (cell->vertex(v)[1] == 0.)
              x.insert(cell->vertex(v)[0]);
      ASSERT_EQ(x.size(), 13u);
      const std::vector<double> s(x.begin(), x.end());
      if (graded) // every old edge has two halves
        for (unsigned int i = 0; i + 4 <= 12; i += 2)
          EXPECT_NEAR((s[i + 2] - s[i]) / (s[i + 4] - s[i + 2]), factor, 1e-9);
      else
        for (unsigned int i = 0; i < 12; ++i)
          EXPECT_NEAR(s[i + 1] - s[i], 0.5, 1e-12);
    }
}



// All three are blocks: their vertical lines may be divided anew, too.
TEST(StructuredRemesher, SharedSides)
{
  const Body body(row_of_blocks(), shifted(0.));
  const auto candidates =
    remesh(body, {{"Blocks", "left, centre, right"}, {"Edge length", "0.5"}});
  EXPECT_EQ(n_cells(candidates[0].mesh),
            (std::map<unsigned int, unsigned int>{{1, 12 * 8},
                                                  {2, 4 * 8},
                                                  {3, 12 * 8}}));
  EXPECT_NEAR(candidates[0].quality, 1., 1e-12);
}



// The shipped mesh of the academic case, its centre moved by 20 mm: the lateral
// blocks, 39 mm long with 12 x 18 cells, become 59 and 19 mm long. With the
// aspect ratio they had, 18 and 6 columns; the unstructured centre stays.
TEST(StructuredRemesher, AcademicBlocks)
{
  const auto       source = Registry<MeshSource<2>>::create("file", "test");
  ParameterHandler prm;
  source->declare_parameters(prm);
  prm.set("File name",
          std::string(ALVEOLUS_SOURCE_DIR) + "/meshes/academic.msh");
  const auto     mesh   = source->create(MPI_COMM_WORLD, ".", ".");
  const auto     before = n_cells(mesh);
  const Body     body(source->create(MPI_COMM_WORLD, ".", "."),
                  [](const Point<2> &p) {
                    const double x = std::abs(p[0]);
                    return Point<2>(p[0] + 20. * std::min(1., (52.5 - x) / 39.),
                                    p[1]);
                  });
  const double   ratio      = (39. / 12.) / (40. / 18.);
  const auto     candidates = remesh(body,
                                 {{"Blocks", "left, right"},
                                      {"Aspect ratio", std::to_string(ratio)}});
  const Mesh<2> &next       = candidates[0].mesh;
  auto           after      = n_cells(next);
  const auto     id         = [&](const std::string &region) {
    return *next.names.regions.at(region).begin();
  };
  EXPECT_EQ(after[id("left")], 18u * 18u);
  EXPECT_EQ(after[id("right")], 6u * 18u);
  EXPECT_EQ(after[id("centre")], before.at(id("centre")));
  EXPECT_NEAR(areas(next).at(id("left")), 59. * 40., 1e-9);
  EXPECT_NEAR(areas(next).at(id("right")), 19. * 40., 1e-9);
  EXPECT_EQ(next.names.boundaries, mesh.names.boundaries);
  EXPECT_EQ(next.names.curves, mesh.names.curves);
  EXPECT_NEAR(next.names.points.at("B")[0], -13.5 + 20., 1e-12);
  for (const auto &cell : next.triangulation->cell_iterators_on_level(0))
    if (cell->material_id() != id("centre"))
      {
        const auto box = cell->bounding_box();
        EXPECT_NEAR(box.side_length(0) / box.side_length(1),
                    ratio,
                    0.05 * ratio);
      }
}



TEST(StructuredRemesher, BadInput)
{
  const Body body(row_of_blocks(), shifted(0.));
  EXPECT_NE(message<InputError>([&] {
              remesh(body, {{"Blocks", "middle"}});
            }).find("no region 'middle'"),
            std::string::npos);
  // Two blocks as one region of an L: six corners are no lattice.
  Mesh<2> mesh = row_of_blocks();
  for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
    if (cell->material_id() == 2 && cell->center()[1] < 2.)
      cell->set_material_id(1);
  mesh.names.curves.erase("line 1");
  for (auto &curve : mesh.names.curves)
    curve.second.erase(4);
  const Body angle(std::move(mesh), shifted(0.));
  EXPECT_NE(message<RunError>([&] {
              remesh(angle, {{"Blocks", "left"}});
            }).find("is no lattice with four corners"),
            std::string::npos);
}
