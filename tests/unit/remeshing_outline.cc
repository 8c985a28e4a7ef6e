// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// New meshes of deformed bodies: nothing of the old outlines, names and areas
// gets lost, and corners get the cells they need.
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/mesh/quality.h>
#include <alveolus/remeshing/body_outline.h>
#include <alveolus/remeshing/remesher.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Points   = std::vector<Point<2>>;
  using Settings = std::map<std::string, std::string>;
  using Map      = std::function<Point<2>(const Point<2> &)>;

  std::string
  folder()
  {
    const std::string name =
      "remeshing_outline." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::filesystem::create_directories(name);
    MPI_Barrier(MPI_COMM_WORLD);
    return name;
  }

  Points
  straight(const Point<2> &a, const Point<2> &b, const unsigned int n)
  {
    Points nodes;
    for (unsigned int i = 0; i <= n; ++i)
      nodes.push_back(a + (b - a) * (double(i) / n));
    nodes.front() = a;
    nodes.back()  = b;
    return nodes;
  }

  // Columns of the sandwich: x from, to, cells
  constexpr double       places[4]   = {0., 1., 1.4, 2.6};
  constexpr unsigned int numbers_[3] = {5, 4, 6};
  constexpr unsigned int n_rows      = 40;

  /**
   * A sandwich 4 high of tooth, ligament and bone, lattices all, with the
   * curves root and socket between them, rim top and rim bottom at the ends of
   * the ligament, base and crown at the outer sides, and the points tip, margin
   * and deep (in the middle of the root).
   */
  Mesh<2>
  sandwich(const MPI_Comm &communicator)
  {
    PlanarGeometry geometry;
    for (const double y : {0., 4.})
      for (const double x : places)
        geometry.points.emplace_back(x, y);
    const auto &p   = geometry.points;
    const auto  add = [&](const unsigned int a,
                         const unsigned int b,
                         const unsigned int n,
                         const std::string &name) {
      PlanarCurve curve;
      curve.begin = a;
      curve.end   = b;
      curve.nodes = straight(p[a], p[b], n);
      curve.tag   = 10 + geometry.curves.size();
      geometry.curve_names[name].insert(curve.tag);
      geometry.curves.push_back(curve);
    };
    const char *vertical[] = {"crown", "root", "socket", "base"};
    for (unsigned int k = 0; k < 4; ++k)
      add(k, 4 + k, n_rows, vertical[k]);
    const char *bottom[] = {"tooth bottom", "rim bottom", "bone bottom"};
    const char *top[]    = {"tooth top", "rim top", "bone top"};
    for (unsigned int k = 0; k < 3; ++k)
      {
        add(k, k + 1, numbers_[k], bottom[k]);
        add(4 + k, 5 + k, numbers_[k], top[k]);
      }
    geometry.curve_names["interfaces"] = {11, 12};
    const char *names[]                = {"tooth", "ligament", "bone"};
    for (unsigned int k = 0; k < 3; ++k)
      {
        PlanarArea area;
        area.name       = names[k];
        area.tag        = 5 + k;
        area.structured = true;
        area.loops      = {
               {{4 + 2 * k, false}, {k + 1, false}, {5 + 2 * k, true}, {k, true}}};
        geometry.areas.push_back(area);
        geometry.region_names[names[k]] = {area.tag};
      }
    geometry.region_names["hard"]  = {5, 7};
    geometry.point_names["tip"]    = p[4];
    geometry.point_names["margin"] = p[5];
    geometry.point_names["deep"]   = geometry.curves[1].nodes[n_rows / 2];
    PlanarMeshReport report;
    return build_mesh(
      mesh_planar_geometry(geometry,
                           PlanarMesher(),
                           {"sandwich", folder(), "test", communicator},
                           report),
      communicator);
  }

  /** A configuration with its mesh, moved by a map. */
  struct Body
  {
    Body(Mesh<2> &&given, const Map &map = Map())
      : mesh(std::move(given))
      , configuration(std::make_unique<Configuration<2>>(mesh, 1))
    {
      if (!map)
        return;
      const Nodes<2> nodes(*configuration);
      NodalVector    positions = configuration->make_vector();
      NodalVector    owned(configuration->locally_owned,
                        configuration->communicator());
      for (const NodeId node : nodes.relevant())
        if (nodes.is_owned(node))
          nodes.set(owned,
                    node,
                    map(nodes.get(configuration->initial_positions(), node)));
      owned.compress(VectorOperation::insert);
      positions = owned;
      configuration->set_positions(positions);
    }

    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
  };

  std::unique_ptr<Remesher<2>>
  remesher(const Settings &settings)
  {
    auto result = Registry<Remesher<2>>::create("outline", "Remeshing / Type");
    ParameterHandler prm;
    result->declare_parameters(prm);
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    return result;
  }

  std::vector<RemeshCandidate<2>>
  remesh(const Body &body, const Settings &settings)
  {
    const auto maker = remesher(settings);
    maker->initialize(body.mesh.names, "Remeshing / outline");
    return maker->candidates(*body.configuration, folder(), "remesh");
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

  /** Area of each material at the current positions. */
  std::map<unsigned int, double>
  areas(const GatheredMesh &mesh)
  {
    std::map<unsigned int, double> result;
    for (std::size_t c = 0; c < mesh.cells.size(); ++c)
      {
        const auto at = [&](const unsigned int v) {
          return mesh.positions[mesh.cells[c][v]];
        };
        const Tensor<1, 2> a = at(3) - at(0), b = at(2) - at(1);
        result[mesh.materials[c]] += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
    return result;
  }

  /** The same of a mesh at rest, all of whose cells are coarse ones. */
  std::map<unsigned int, double>
  areas(const Mesh<2> &mesh)
  {
    std::map<unsigned int, double> result;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      result[cell->material_id()] += cell->measure();
    return result;
  }

  void
  expect_same_sets(const NamedSets<2> &a, const NamedSets<2> &b)
  {
    EXPECT_EQ(a.curves, b.curves);
    EXPECT_EQ(a.boundaries, b.boundaries);
    EXPECT_EQ(a.regions, b.regions);
    ASSERT_EQ(a.points.size(), b.points.size());
  }

  /** Lengths of the lines by their ids. */
  std::map<LineIds, double>
  lengths(const GatheredMesh &mesh)
  {
    std::map<LineIds, double> result;
    for (const auto &line : mesh.lines)
      if (!(line.second == LineIds()))
        result[line.second] += mesh.positions[line.first.first].distance(
          mesh.positions[line.first.second]);
    return result;
  }

  /**
   * The tooth is pressed down into the bone: the upper rim bulges upwards, and
   * its corners open; the lower one becomes hollow and its corners close.
   */
  Point<2>
  bulged(const Point<2> &p, const double height)
  {
    const double from = places[1], to = places[2];
    if (p[0] <= from || p[0] >= to)
      return p;
    const double x = (p[0] - from) / (to - from);
    const double y = 4. * x * (1. - x);
    return {p[0],
            p[1] + height * y *
                     (std::exp(-(4. - p[1]) / 0.3) + std::exp(-p[1] / 0.3))};
  }

  const Settings strip = {{"Kept regions", "tooth, bone"},
                          {"Strips", "ligament"},
                          {"Strip ends", "rim top, rim bottom"},
                          {"Zone lengths", "0.6, 0.4"}};
} // namespace



TEST(BodyOutline, ThreeMaterials)
{
  const Body         body(sandwich(MPI_COMM_WORLD));
  const GatheredMesh mesh = gather_mesh(*body.configuration);
  EXPECT_EQ(mesh.cells.size(), 15u * n_rows);
  EXPECT_EQ(mesh.positions.size(), 16u * (n_rows + 1));

  const BodyOutline outline = extract_outline(mesh, body.mesh.names, {}, 0.7);
  // Of the four vertical lines the root is divided by the point deep.
  EXPECT_EQ(outline.pieces.size(), 4u + 1u + 6u);
  ASSERT_EQ(outline.areas.size(), 3u);
  for (unsigned int a = 0; a < 3; ++a)
    {
      const OutlineArea &area = outline.areas[a];
      EXPECT_EQ(area.material, 5 + a);
      EXPECT_EQ(area.cells.size(), numbers_[a] * n_rows);
      ASSERT_EQ(area.loops.size(), 1u);
      const auto nodes = outline.loop_nodes(area.loops[0]);
      EXPECT_EQ(nodes.size(), 2 * (numbers_[a] + n_rows));
      double sum = 0.;
      for (std::size_t i = 0; i < nodes.size(); ++i)
        {
          const Point<2> &p = mesh.positions[nodes[i]];
          const Point<2> &q = mesh.positions[nodes[(i + 1) % nodes.size()]];
          sum += 0.5 * (p[0] * q[1] - p[1] * q[0]);
        }
      EXPECT_NEAR(sum, 4. * (places[a + 1] - places[a]), 1e-12);
    }
  for (const OutlinePiece &piece : outline.pieces)
    for (std::size_t i = 0; i + 1 < piece.nodes.size(); ++i)
      EXPECT_EQ(mesh.lines.at(
                  GatheredMesh::line(piece.nodes[i], piece.nodes[i + 1])),
                piece.ids);
}



// A square in a square: the outer one has a hole, whose outline has no
// junction.
TEST(BodyOutline, HoleAndCorners)
{
  Mesh<2> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
  GridGenerator::subdivided_hyper_cube(*mesh.triangulation, 4, 0., 4.);
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    cell->set_material_id(cell->center().distance(Point<2>(2., 2.)) < 1. ? 1
                                                                         : 0);
  mesh.names.regions = {{"outer", {0}}, {"inner", {1}}};
  const Body         body(std::move(mesh));
  const GatheredMesh gathered = gather_mesh(*body.configuration);
  const BodyOutline sharp = extract_outline(gathered, body.mesh.names, {}, 0.7);
  EXPECT_EQ(sharp.areas.size(), 2u);
  EXPECT_EQ(sharp.areas[0].loops.size(), 2u);
  EXPECT_EQ(sharp.areas[1].loops.size(), 1u);
  EXPECT_EQ(sharp.pieces.size(), 8u);
  EXPECT_EQ(sharp.loop_nodes(sharp.areas[0].loops[0]).size(), 16u);
  EXPECT_EQ(sharp.loop_nodes(sharp.areas[0].loops[1]).size(), 8u);

  // With no corners at all, each closed line is one piece.
  const BodyOutline smooth = extract_outline(gathered, body.mesh.names, {}, 4.);
  ASSERT_EQ(smooth.pieces.size(), 2u);
  EXPECT_EQ(smooth.pieces[0].nodes.front(), smooth.pieces[0].nodes.back());
  EXPECT_EQ(smooth.pieces[0].nodes.size() + smooth.pieces[1].nodes.size(),
            16u + 8u + 2u);
}



TEST(OutlineRemesher, TwentyRemeshesAtRest)
{
  Settings settings            = strip;
  settings["Kept regions"]     = "tooth";
  settings["Smoothed regions"] = "bone";
  const Body         first(sandwich(MPI_COMM_WORLD));
  const GatheredMesh start      = gather_mesh(*first.configuration);
  const auto         old_areas  = areas(start);
  const auto         old_length = lengths(start);
  Mesh<2>            mesh       = sandwich(MPI_COMM_WORLD);
  for (unsigned int i = 0; i < 20; ++i)
    {
      const Body body(std::move(mesh));
      auto       candidates = remesh(body, settings);
      ASSERT_FALSE(candidates.empty());
      expect_same_sets(candidates[0].mesh.names, first.mesh.names);
      for (const auto &point : first.mesh.names.points)
        EXPECT_EQ(candidates[0].mesh.names.points.at(point.first),
                  point.second);
      EXPECT_NEAR(candidates[0].quality, 1., 1e-12);
      mesh = std::move(candidates[0].mesh);
    }
  const Body         last(std::move(mesh));
  const GatheredMesh end = gather_mesh(*last.configuration);
  for (const auto &area : areas(end))
    EXPECT_NEAR(area.second / old_areas.at(area.first), 1., 1e-12);
  const auto new_length = lengths(end);
  ASSERT_EQ(new_length.size(), old_length.size());
  for (const auto &entry : old_length)
    EXPECT_NEAR(new_length.at(entry.first), entry.second, 1e-12);
}



// The same with all regions meshed anew by gmsh: outlines and names stay.
TEST(OutlineRemesher, UnstructuredTwice)
{
  const Body first(sandwich(MPI_COMM_WORLD));
  const auto old_areas  = areas(gather_mesh(*first.configuration));
  const auto old_length = lengths(gather_mesh(*first.configuration));
  Mesh<2>    mesh       = sandwich(MPI_COMM_WORLD);
  for (unsigned int i = 0; i < 2; ++i)
    {
      const Body body(std::move(mesh));
      auto       candidates = remesh(body, {});
      ASSERT_EQ(candidates.size(), 1u);
      EXPECT_GT(candidates[0].quality, 0.3);
      expect_same_sets(candidates[0].mesh.names, first.mesh.names);
      mesh = std::move(candidates[0].mesh);
    }
  const Body         last(std::move(mesh));
  const GatheredMesh end = gather_mesh(*last.configuration);
  for (const auto &area : areas(end))
    EXPECT_NEAR(area.second / old_areas.at(area.first), 1., 1e-12);
  for (const auto &entry : lengths(end))
    EXPECT_NEAR(old_length.at(entry.first), entry.second, 1e-12);
}



TEST(OutlineRemesher, FlatCornersGetTwoCells)
{
  // At the corners the bulge rises by 4 h/w dx: 168 degrees for h = 0.48.
  for (const double height : {0.1, 0.25, 0.48})
    {
      const Body   body(sandwich(MPI_COMM_WORLD),
                      [&](const Point<2> &p) { return bulged(p, height); });
      const double old_quality =
        mesh_quality(*body.configuration, body.configuration->positions())
          .smallest_scaled_jacobian;
      const auto old_areas           = areas(gather_mesh(*body.configuration));
      Settings   settings            = strip;
      settings["Angle of two cells"] = "140";
      auto candidates                = remesh(body, settings);
      ASSERT_FALSE(candidates.empty());
      for (std::size_t i = 1; i < candidates.size(); ++i)
        EXPECT_GE(candidates[i - 1].quality + 1e-3, candidates[i].quality);
      expect_same_sets(candidates[0].mesh.names, body.mesh.names);
      EXPECT_GE(candidates[0].quality, old_quality - 1e-9);
      if (height > 0.2)
        {
          // beyond 140 degrees at the margin
          const auto  &next    = candidates[0].mesh;
          unsigned int n_cells = 0;
          for (const auto &cell :
               next.triangulation->cell_iterators_on_level(0))
            for (const unsigned int v : cell->vertex_indices())
              n_cells += cell->material_id() == 6 &&
                         cell->vertex(v) == next.names.points.at("margin");
          EXPECT_GE(n_cells, 2u);
        }
      for (const auto &area : areas(candidates[0].mesh))
        EXPECT_NEAR(area.second / old_areas.at(area.first), 1., 1e-12);
    }
}



// Bulges that rise step by step, with a remesh after each: no name and no area
// gets lost, and the last mesh is as good as the first.
TEST(OutlineRemesher, RepeatedlyDeformed)
{
  Mesh<2>    mesh = sandwich(MPI_COMM_WORLD);
  const Body first(sandwich(MPI_COMM_WORLD));
  for (unsigned int i = 1; i <= 6; ++i)
    {
      const Body body(std::move(mesh),
                      [&](const Point<2> &p) { return bulged(p, 0.05); });
      const auto old_areas  = areas(gather_mesh(*body.configuration));
      auto       candidates = remesh(body, strip);
      ASSERT_FALSE(candidates.empty());
      expect_same_sets(candidates[0].mesh.names, first.mesh.names);
      // What the lower corners allow: the bulge rises by 4 (0.05 i)/0.4 there,
      // its chord by three quarters of it.
      EXPECT_GE(candidates[0].quality,
                std::min(0.5, 0.99 * std::cos(std::atan(0.375 * i))));
      for (const auto &area : areas(candidates[0].mesh))
        EXPECT_NEAR(area.second / old_areas.at(area.first), 1., 1e-12);
      mesh = std::move(candidates[0].mesh);
    }
}



// A rim of two edges cuts more off a bulge than is allowed.
TEST(OutlineRemesher, AreaChangeIsBounded)
{
  const Body body(sandwich(MPI_COMM_WORLD),
                  [](const Point<2> &p) { return bulged(p, 0.3); });
  Settings   settings         = strip;
  settings["Strip end edges"] = "2";
  EXPECT_NE(message<RunError>([&] {
              remesh(body, settings);
            }).find("2 edges would change the area too much"),
            std::string::npos);
  // Four quarters of a parabola leave 1/16 of it out, two halves 1/4.
  const double part = 2. / 3. * 0.3 * 0.4 * (1. / 4. - 1. / 16.) / 1.6;
  settings["Largest area change"] = std::to_string(1.2 * part);
  auto candidates                 = remesh(body, settings);
  ASSERT_FALSE(candidates.empty());
  EXPECT_NE(candidates[0].description.find("halved lattice"),
            std::string::npos);
  expect_same_sets(candidates[0].mesh.names, body.mesh.names);
  const double old_area = areas(gather_mesh(*body.configuration)).at(6);
  const double new_area = areas(candidates[0].mesh).at(6);
  EXPECT_NEAR(new_area / old_area, 1., 1e-3);
}



// New nodes at the ends of strips, here bulges of height h over a width w: a
// parabola has the area 2/3 h w. What n equal chords leave out of the area
// under the spline falls with 1/n^2; the spline through five points is not far
// from the parabola.
TEST(OutlineRemesher, NewNodesAtTheEnds)
{
  const double        h = 0.1, w = 0.4;
  std::vector<double> area;
  for (const unsigned int n : {8u, 16u, 32u})
    {
      const Body body(sandwich(MPI_COMM_WORLD),
                      [=](const Point<2> &p) { return bulged(p, h); });
      Settings   settings             = strip;
      settings["Strip end edges"]     = std::to_string(n);
      settings["Largest area change"] = "0.01";
      auto candidates                 = remesh(body, settings);
      ASSERT_FALSE(candidates.empty());
      expect_same_sets(candidates[0].mesh.names, body.mesh.names);
      const Body         next(std::move(candidates[0].mesh));
      const GatheredMesh mesh = gather_mesh(*next.configuration);
      const BodyOutline  outline =
        extract_outline(mesh, next.mesh.names, {}, 1.);
      unsigned int n_edges = 0;
      area.push_back(0.);
      for (const OutlinePiece &piece : outline.pieces)
        if (next.mesh.names.curves.at("rim top").count(piece.ids.manifold) != 0)
          {
            n_edges += piece.nodes.size() - 1;
            for (std::size_t i = 0; i + 1 < piece.nodes.size(); ++i)
              {
                const Point<2> &a = mesh.positions[piece.nodes[i]];
                const Point<2> &b = mesh.positions[piece.nodes[i + 1]];
                area.back() += 0.5 * (a[1] + b[1] - 8.) * std::abs(b[0] - a[0]);
              }
          }
      EXPECT_EQ(n_edges, n);
    }
  EXPECT_NEAR(area[2] / (2. / 3. * h * w), 1., 0.01);
  EXPECT_NEAR((area[1] - area[0]) / (area[2] - area[1]), 4., 0.2);
}



// Straight edges between corners: equal parts, the corners where they were.
TEST(OutlineRemesher, SplinesEndAtCorners)
{
  Mesh<2> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
  GridGenerator::subdivided_hyper_rectangle(
    *mesh.triangulation, {6, 4}, Point<2>(0., 0.), Point<2>(3., 2.), true);
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    cell->set_material_id(0); // it colours them, too
  mesh.names.regions    = {{"body", {0}}};
  mesh.names.boundaries = {{"left", {0}},
                           {"right", {1}},
                           {"bottom", {2}},
                           {"top", {3}}};
  for (const auto &boundary : mesh.names.boundaries)
    mesh.names.curves[boundary.first];
  mesh.names.points["corner"] = Point<2>(3., 2.);
  const Body body(std::move(mesh));
  auto candidates = remesh(body, {{"Edge lengths", "top: 0.3, left: 0.2"}});
  ASSERT_EQ(candidates.size(), 1u);
  expect_same_sets(candidates[0].mesh.names, body.mesh.names);
  EXPECT_GT(candidates[0].quality, 0.5);
  const Body         next(std::move(candidates[0].mesh));
  const GatheredMesh gathered = gather_mesh(*next.configuration);
  EXPECT_NEAR(areas(gathered).at(0), 6., 1e-12);
  EXPECT_EQ(gathered.positions[gathered.points.at("corner")], Point<2>(3., 2.));
  std::map<types::boundary_id, std::vector<double>> edges;
  for (const auto &line : gathered.lines)
    if (line.second.boundary != numbers::internal_face_boundary_id)
      edges[line.second.boundary].push_back(
        gathered.positions[line.first.first].distance(
          gathered.positions[line.first.second]));
  const std::map<types::boundary_id, unsigned int> expected = {{0, 10},
                                                               {1, 4},
                                                               {2, 6},
                                                               {3, 10}};
  ASSERT_EQ(edges.size(), 4u);
  for (const auto &entry : edges)
    {
      const double length = entry.first < 2 ? 2. : 3.;
      ASSERT_EQ(entry.second.size(), expected.at(entry.first));
      for (const double edge : entry.second)
        EXPECT_NEAR(edge, length / entry.second.size(), 1e-12);
    }
}



TEST(OutlineRemesher, SameOnAnyNumberOfProcesses)
{
  const Map  map = [](const Point<2> &p) { return bulged(p, 0.3); };
  const Body alone(sandwich(MPI_COMM_SELF), map);
  const Body together(sandwich(MPI_COMM_WORLD), map);
  const auto maker = remesher(strip);
  // Processes must not write the mesher's files at once.
  const std::string own =
    folder() + "/" +
    std::to_string(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD));
  std::filesystem::create_directories(own);
  const auto a = maker->candidates(*alone.configuration, own, "alone");
  const auto b =
    maker->candidates(*together.configuration, folder(), "together");
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i)
    {
      EXPECT_EQ(a[i].quality, b[i].quality);
      EXPECT_EQ(a[i].mesh.triangulation->get_vertices(),
                b[i].mesh.triangulation->get_vertices());
    }
}



TEST(OutlineRemesher, BadInput)
{
  const Body body(sandwich(MPI_COMM_WORLD));
  const auto input = [&](const Settings &settings) {
    return message<InputError>([&] { remesh(body, settings); });
  };
  EXPECT_NE(input({{"Kept regions", "jaw"}}).find("no region 'jaw'"),
            std::string::npos);
  EXPECT_NE(input({{"Strips", "ligament"}}).find("strips without ends"),
            std::string::npos);
  EXPECT_NE(input({{"Kept regions", "hard"}, {"Smoothed regions", "hard"}})
              .find("is already in 'Kept regions'"),
            std::string::npos);
  Settings settings        = strip;
  settings["Edge lengths"] = "crown: 0.3";
  EXPECT_NE(message<RunError>([&] {
              remesh(body, settings);
            }).find("borders cells that are to stay"),
            std::string::npos);
  settings               = strip;
  settings["Strip ends"] = "base";
  EXPECT_NE(message<RunError>([&] {
              remesh(body, settings);
            }).find("the end 'base' is not at the strip"),
            std::string::npos);

  Mesh<2>                mesh = sandwich(MPI_COMM_WORLD);
  const Configuration<2> quadratic(mesh, 2);
  EXPECT_NE(message<RunError>([&] {
              remesher(strip)->candidates(quadratic, folder(), "remesh");
            }).find("degree 2"),
            std::string::npos);
}
