// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// New hexahedra in 3D: names and ids, volumes and areas of bodies with plane
// faces, orders on curved ones, conservation, processes.
#include <alveolus/base/errors.h>
#include <alveolus/mesh/block_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/mesh/quality.h>
#include <alveolus/remeshing/flat_tetrahedra.h>
#include <alveolus/remeshing/remesher.h>
#include <alveolus/transfer/overlap_transfer.h>

#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <memory>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Place    = BlockMesh::Place;
  using Settings = std::map<std::string, std::string>;
  using Map      = std::function<Place(const Place &)>;

  const Map unmoved = [](const Place &x) { return x; };

  Map
  box(const double x0, const double x1, const double y, const double z)
  {
    return [=](const Place &u) {
      return Place(x0 + (x1 - x0) * u[0], y * u[1], z * u[2]);
    };
  }

  /** Boundaries where a coordinate has a value, e.g. {"base", {1, 0.}}. */
  void
  name_planes(
    BlockMesh                                                    &mesh,
    const std::map<std::string, std::pair<unsigned int, double>> &planes)
  {
    for (const auto &plane : planes)
      mesh.name_boundary(plane.first, [plane](const Place &x) {
        return std::abs(x[plane.second.first] - plane.second.second) < 1e-9;
      });
  }

  /** 4 x 2 x 2 mm: soft (1.5 wide), beside it hard. */
  MeshDescription<3>
  two_materials()
  {
    BlockMesh mesh("two materials", 4.);
    mesh.add("soft", {{3, 3, 3}}, box(0., 1.5, 2., 2.));
    mesh.add("hard", {{4, 3, 3}}, box(1.5, 4., 2., 2.));
    name_planes(
      mesh, {{"left end", {0, 0.}}, {"right end", {0, 4.}}, {"base", {1, 0.}}});
    mesh.name_segment("front edge", {0., 0., 0.}, {4., 0., 0.});
    mesh.name_segment("seam", {1.5, 2., 0.}, {1.5, 2., 2.});
    mesh.name_point("corner", {4., 2., 2.});
    mesh.name_point("on the seam", {1.5, 2., 2. / 3.});
    mesh.name_point("in the base", {2.125, 0., 2. / 3.});
    return mesh.description("test");
  }

  /** 4.2 x 2 x 2 mm: a layer of 0.2 mm in two sheets between two bodies. */
  MeshDescription<3>
  layered()
  {
    BlockMesh mesh("layered", 4.2);
    mesh.add("tooth", {{3, 3, 3}}, box(0., 2., 2., 2.));
    mesh.add("ligament", {{2, 3, 3}}, box(2., 2.2, 2., 2.));
    mesh.add("bone", {{3, 3, 3}}, box(2.2, 4.2, 2., 2.));
    name_planes(mesh,
                {{"left end", {0, 0.}},
                 {"right end", {0, 4.2}},
                 {"base", {1, 0.}}});
    mesh.name_segment("front edge", {0., 0., 0.}, {4.2, 0., 0.});
    mesh.name_segment("rim", {2.2, 2., 0.}, {2.2, 2., 2.});
    mesh.name_point("inside", {2., 0., 2. / 3.});
    mesh.name_point("outside", {2.2, 2., 2.});
    return mesh.description("test");
  }

  /** The part above z = 0 of a cylinder around the y axis, of radius 1 mm, 90
   * degrees wide and 1 mm long. */
  MeshDescription<3>
  vault(const unsigned int n)
  {
    BlockMesh mesh("vault", 1.);
    mesh.add("vault", {{2 * n, n, n}}, [](const Place &u) {
      const double phi = 0.25 * numbers::PI * (2. * u[0] - 1.);
      return Place(std::sin(phi), u[1], u[2] * std::cos(phi));
    });
    mesh.name_boundary("roof", [](const Place &x) {
      return std::abs(std::hypot(x[0], x[2]) - 1.) < 1e-9;
    });
    return mesh.description("test");
  }

  struct Body
  {
    explicit Body(Mesh<3> &&given, const Map &map = unmoved)
      : mesh(std::move(given))
      , configuration(mesh, 1)
    {
      const Nodes<3> nodes(configuration);
      NodalVector    x = configuration.make_vector();
      x.zero_out_ghost_values();
      for (const NodeId node : nodes.relevant())
        if (nodes.is_owned(node))
          nodes.set(x,
                    node,
                    map(nodes.get(configuration.initial_positions(), node)));
      x.update_ghost_values();
      configuration.set_positions(x);
    }

    Body(const MeshDescription<3> &description,
         const Map                &map          = unmoved,
         const MPI_Comm            communicator = MPI_COMM_WORLD)
      : Body(build_mesh(description, communicator), map)
    {}

    Mesh<3>          mesh;
    Configuration<3> configuration;
  };

  std::vector<RemeshCandidate<3>>
  remesh(const Body &body, const Settings &settings, const std::string &name)
  {
    const auto maker =
      Registry<Remesher<3>>::create("volume", "Remeshing / Type");
    ParameterHandler prm;
    maker->declare_parameters(prm);
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    maker->initialize(body.mesh.names, "Remeshing / volume");
    return maker->candidates(body.configuration, ".", "volume-" + name);
  }

  // All cells are coarse ones, known to every process.
  std::map<unsigned int, double>
  volumes(const Mesh<3> &mesh)
  {
    std::map<unsigned int, double> result;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      result[cell->material_id()] += cell->measure();
    return result;
  }

  std::map<unsigned int, double>
  areas(const Mesh<3> &mesh)
  {
    std::map<unsigned int, double> result;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary())
          result[face->boundary_id()] +=
            0.5 * cross_product_3d(face->vertex(3) - face->vertex(0),
                                   face->vertex(2) - face->vertex(1))
                    .norm();
    return result;
  }

  /** Lengths of the lines by manifold id. */
  std::map<unsigned int, double>
  lengths(const Mesh<3> &mesh)
  {
    std::map<unsigned int, double> result;
    std::set<unsigned int>         done;
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      for (unsigned int l = 0; l < cell->n_lines(); ++l)
        if (cell->line(l)->manifold_id() != numbers::flat_manifold_id &&
            done.insert(cell->line(l)->index()).second)
          result[cell->line(l)->manifold_id()] += cell->line(l)->diameter();
    return result;
  }

  void
  expect_near(const std::map<unsigned int, double> &found,
              const std::map<unsigned int, double> &expected,
              const double                          tolerance,
              const std::string                    &what)
  {
    ASSERT_EQ(found.size(), expected.size()) << what;
    for (const auto &entry : expected)
      {
        ASSERT_EQ(found.count(entry.first), 1u) << what << ' ' << entry.first;
        EXPECT_NEAR(found.at(entry.first), entry.second, tolerance)
          << what << ' ' << entry.first;
      }
  }

  /** All that has to be the same of a body with plane faces. */
  void
  expect_same_body(const Mesh<3> &fresh, const Mesh<3> &old)
  {
    expect_near(volumes(fresh), volumes(old), 1e-12, "volume");
    expect_near(areas(fresh), areas(old), 1e-12, "area");
    expect_near(lengths(fresh), lengths(old), 1e-12, "length");
    EXPECT_EQ(fresh.names.curves, old.names.curves);
    EXPECT_EQ(fresh.names.boundaries, old.names.boundaries);
    EXPECT_EQ(fresh.names.regions, old.names.regions);
    ASSERT_EQ(fresh.names.points.size(), old.names.points.size());
    for (const auto &point : old.names.points)
      EXPECT_EQ(fresh.names.points.at(point.first), point.second);
  }

  HistoryLayout
  layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.;
    density.upper = 10.;
    HistoryField strain;
    strain.name  = "strain";
    strain.shape = HistoryField::Shape::symmetric_tensor;
    return HistoryLayout({density, strain}, 3);
  }

  std::unique_ptr<HistoryStore<3>>
  make_store(const Mesh<3> &mesh)
  {
    std::map<types::material_id, unsigned int> regions;
    for (const auto &entry : volumes(mesh))
      regions.emplace(entry.first, regions.size());
    return std::make_unique<HistoryStore<3>>(
      *mesh.triangulation,
      regions,
      std::vector<HistoryLayout>(regions.size(), layout()),
      8);
  }

  /** Sum of volume times density over all sub-cells. */
  void
  for_sub_cells(
    const Configuration<3> &configuration,
    const HistoryStore<3>  &store,
    const std::function<
      void(unsigned int, unsigned int, const Point<3> &, double)> &f)
  {
    const SubCells<3>     cells(configuration, [&](const unsigned int c) {
      return store.region(c);
    });
    std::vector<Point<3>> centroids;
    std::vector<double>   volumes;
    cells.centroids(configuration.positions(), centroids, volumes);
    for (const unsigned int c : cells.owned_cells())
      for (unsigned int q = 0; q < 8; ++q)
        f(c, q, centroids[c * 8 + q], volumes[c * 8 + q]);
  }
} // namespace



// Plane faces are exact, so that volumes, areas and lengths are those of the
// box, also after several remeshes.
TEST(VolumeRemesher, NamesAndVolumesOfABox)
{
  auto body = std::make_unique<Body>(two_materials());
  for (unsigned int k = 0; k < 2; ++k)
    {
      auto candidates = remesh(*body, {}, "box-" + std::to_string(k));
      ASSERT_FALSE(candidates.empty());
      EXPECT_GT(candidates[0].quality, 0.3);
      EXPECT_NEAR(
        candidates[0].quality,
        mesh_quality(Configuration<3>(candidates[0].mesh, 1),
                     Configuration<3>(candidates[0].mesh, 1).positions())
          .smallest_scaled_jacobian,
        1e-12);
      expect_same_body(candidates[0].mesh, body->mesh);
      body = std::make_unique<Body>(std::move(candidates[0].mesh));
    }
  const auto parts = volumes(body->mesh);
  double     all   = 0.;
  for (const auto &part : parts)
    all += part.second;
  EXPECT_NEAR(all, 16., 1e-12);
}



// The layer keeps its thickness, its two sheets, and what is named at its ends.
TEST(VolumeRemesher, LayersKeepTheirColumns)
{
  auto body = std::make_unique<Body>(layered());
  for (unsigned int k = 0; k < 2; ++k)
    {
      auto candidates =
        remesh(*body, {{"Layers", "ligament"}}, "layer-" + std::to_string(k));
      ASSERT_FALSE(candidates.empty());
      EXPECT_GT(candidates[0].quality, 0.3);
      expect_same_body(candidates[0].mesh, body->mesh);
      const auto id = *body->mesh.names.regions.at("ligament").begin();
      EXPECT_NEAR(volumes(candidates[0].mesh).at(id), 0.8, 1e-12);
      for (const auto &cell :
           candidates[0].mesh.triangulation->cell_iterators_on_level(0))
        if (cell->material_id() == id)
          {
            // Its nodes are at both walls and halfway between
            for (const unsigned int v : cell->vertex_indices())
              {
                const double x = cell->vertex(v)[0];
                EXPECT_LT(std::min({std::abs(x - 2.),
                                    std::abs(x - 2.1),
                                    std::abs(x - 2.2)}),
                          1e-12);
              }
          }
      body = std::make_unique<Body>(std::move(candidates[0].mesh));
    }
}



// A cylinder: nodes on the smooth surface through the old ones are off by a
// power of the size above 2, volumes as inscribed bodies are, order 2.
TEST(VolumeRemesher, OrdersOnACylinder)
{
  double distance[2] = {0., 0.}, volume[2], area[2] = {0., 0.};
  for (unsigned int k = 0; k < 2; ++k)
    {
      const Body body(vault(k == 0 ? 3 : 6));
      const auto candidates =
        remesh(body, {{"Attempts", "1"}}, "vault-" + std::to_string(k));
      const Mesh<3> &mesh = candidates[0].mesh;
      volume[k] = volumes(mesh).begin()->second - (0.25 * numbers::PI + 0.5);
      const auto &roof = mesh.names.boundaries.at("roof");
      for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && roof.count(face->boundary_id()) != 0)
            for (const unsigned int v : face->vertex_indices())
              distance[k] = std::max(distance[k],
                                     std::abs(std::hypot(face->vertex(v)[0],
                                                         face->vertex(v)[2]) -
                                              1.));
      area[k] = areas(mesh).at(*roof.begin()) - 0.5 * numbers::PI;
    }
  EXPECT_LT(distance[1], 0.2 * distance[0]);
  EXPECT_LT(std::abs(volume[1]), 0.35 * std::abs(volume[0]));
  EXPECT_LT(std::abs(area[1]), 0.35 * std::abs(area[0]));
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "distance " << distance[0] << ' ' << distance[1] << ", volume "
              << volume[0] << ' ' << volume[1] << ", area " << area[0] << ' '
              << area[1] << std::endl;
}



// Chords of an arc of the angle a leave a cylinder of radius r by
// r (1 - cos(a/2)); edges wanted at 10 degrees become 4/3 times as long.
TEST(VolumeRemesher, EdgeAngleBoundsTheChordsOfACylinder)
{
  const Body     body(vault(6));
  const Settings coarse{{"Attempts", "1"}, {"Edge length factor", "5"}};
  double         turn[2] = {0., 0.}, sagitta[2] = {0., 0.};
  for (unsigned int k = 0; k < 2; ++k)
    {
      Settings settings = coarse;
      if (k == 1)
        settings["Edge angle"] = "10";
      const auto candidates =
        remesh(body, settings, "edge-angle-" + std::to_string(k));
      const Mesh<3> &mesh = candidates[0].mesh;
      const auto    &roof = mesh.names.boundaries.at("roof");
      for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && roof.count(face->boundary_id()) != 0)
            for (unsigned int l = 0; l < face->n_lines(); ++l)
              {
                const auto &line  = face->line(l);
                const auto  angle = [](const Point<3> &x) {
                  return std::atan2(x[0], x[2]);
                };
                const Point<3> middle = line->center();
                turn[k]               = std::max(turn[k],
                                   std::abs(angle(line->vertex(1)) -
                                            angle(line->vertex(0))));
                sagitta[k] =
                  std::max(sagitta[k], 1. - std::hypot(middle[0], middle[2]));
              }
    }
  const double largest = 4. / 3. * 10. * numbers::PI / 180.;
  EXPECT_LT(turn[1], 1.02 * largest);
  EXPECT_LT(sagitta[1], 1.02 * 1.02 * (1. - std::cos(0.5 * largest)));
  EXPECT_GT(turn[0], 1.5 * largest) << "the bound had nothing to do";
}



// By the mean ratio s of a corner, its shortest edge over the longest one has
// (2 r/(1 + r^2))^(2/3) >= s: good angles between edges of no length are not
// good.
TEST(VolumeRemesher, NoEdgeShrinksToNothing)
{
  const Body bodies[] = {Body(two_materials()), Body(vault(3)), Body(vault(6))};
  for (unsigned int k = 0; k < 3; ++k)
    {
      const auto candidates =
        remesh(bodies[k], {{"Attempts", "1"}}, "edges-" + std::to_string(k));
      double shape = 1., ratio = 1.;
      for (const auto &cell :
           candidates[0].mesh.triangulation->cell_iterators_on_level(0))
        for (const unsigned int v : cell->vertex_indices())
          {
            std::array<Tensor<1, 3>, 3> edge;
            double                      squares = 0.;
            for (unsigned int d = 0; d < 3; ++d)
              {
                edge[d] = cell->vertex(v ^ (1u << d)) - cell->vertex(v);
                squares += edge[d].norm_square();
              }
            const double volume =
              std::abs(cross_product_3d(edge[0], edge[1]) * edge[2]);
            const double s = 3. * std::cbrt(volume * volume) / squares;
            const auto [least, most] =
              std::minmax({edge[0].norm(), edge[1].norm(), edge[2].norm()});
            const double r = least / most;
            EXPECT_LE(s, std::pow(2. * r / (1. + r * r), 2. / 3.) + 1e-12);
            shape = std::min(shape, s);
            ratio = std::min(ratio, r);
          }
      EXPECT_GT(shape, 0.3);
      EXPECT_GT(ratio, 0.08); // what 0.3 leaves
      if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << "shape " << shape << ", ratio of edges " << ratio
                  << std::endl;
    }
}



// A uniform state stays to the last bit, contents of any other one to
// round-off, with both schemes.
TEST(VolumeRemesher, TransferConserves)
{
  // Twisted inside, so that old faces are curved
  const Body body(two_materials(), [](const Place &x) {
    const double a =
      x[0] * (4. - x[0]) * x[1] * (2. - x[1]) * x[2] * (2. - x[2]);
    return Place(x[0], x[1] + 0.05 * a, x[2] - 0.03 * a);
  });
  auto       candidates = remesh(body, {{"Attempts", "1"}}, "transfer");
  const Configuration<3> fresh(candidates[0].mesh, 1);
  for (const std::string scheme : {"Godunov", "limited linear"})
    for (const bool uniform : {true, false})
      {
        const auto old_store = make_store(body.mesh);
        for_sub_cells(body.configuration,
                      *old_store,
                      [&](const unsigned int c,
                          const unsigned int q,
                          const Point<3>    &x,
                          const double) {
                        double *record = old_store->old_record(c, q);
                        for (unsigned int v = 0; v < 7; ++v)
                          record[v] =
                            uniform ? 0.1 * (v + 1) : 1. + x[v % 3] + 0.1 * v;
                      });
        old_store->update_ghosts();
        const OverlapTransfer<3> transfer(body.configuration,
                                          *old_store,
                                          scheme);
        const auto               new_store = make_store(candidates[0].mesh);
        const OverlapReport      report = transfer.transfer(fresh, *new_store);
        EXPECT_EQ(report.n_uncovered, 0u);
        if (uniform)
          {
            for_sub_cells(fresh,
                          *new_store,
                          [&](const unsigned int c,
                              const unsigned int q,
                              const Point<3> &,
                              const double) {
                            for (unsigned int v = 0; v < 7; ++v)
                              EXPECT_EQ(new_store->old_record(c, q)[v],
                                        0.1 * (v + 1));
                          });
            continue;
          }
        for (const auto &region : report.regions)
          {
            EXPECT_NEAR(region.volume_after, region.volume_before, 1e-12);
            EXPECT_NEAR(region.content_after, region.content_before, 1e-11);
          }
      }
}



// The same mesh, whatever the number of processes.
TEST(VolumeRemesher, ProcessesMakeTheSameMesh)
{
  const Body alone(layered(), unmoved, MPI_COMM_SELF);
  const Body together(layered());
  const auto a =
    remesh(alone,
           {{"Layers", "ligament"}, {"Attempts", "1"}},
           "alone-" +
             std::to_string(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD)));
  const auto b =
    remesh(together, {{"Layers", "ligament"}, {"Attempts", "1"}}, "together");
  const auto &x = a[0].mesh.triangulation->get_vertices();
  ASSERT_EQ(x, b[0].mesh.triangulation->get_vertices());
  auto cell = b[0].mesh.triangulation->begin(0);
  for (const auto &mine : a[0].mesh.triangulation->cell_iterators_on_level(0))
    {
      ASSERT_EQ(mine->material_id(), cell->material_id());
      for (const unsigned int v : mine->vertex_indices())
        ASSERT_EQ(mine->vertex_index(v), cell->vertex_index(v));
      ++cell;
    }
}



// A roof over others: its ridge, inside of one patch, has one tetrahedron only,
// and two afterwards; the four around the edge below are cut in two each.
TEST(VolumeRemesher, FlatTetrahedraAreDivided)
{
  Tetrahedra mesh;
  mesh.vertices = {{-1., 0., 0.1},
                   {1., 0., 0.1},
                   {0., -1., 0.},
                   {0., 1., 0.},
                   {-1., 0., -1.},
                   {1., 0., -1.}};
  mesh.cells = {{{0, 1, 3, 2}}, {{0, 2, 3, 4}}, {{1, 3, 2, 5}}, {{2, 3, 4, 5}}};
  const auto volume = [&mesh]() {
    double sum = 0.;
    for (auto &cell : mesh.cells)
      {
        const auto  &x = mesh.vertices;
        const double six =
          cross_product_3d(x[cell[1]] - x[cell[0]], x[cell[2]] - x[cell[0]]) *
          (x[cell[3]] - x[cell[0]]);
        EXPECT_GT(six, 0.);
        sum += six / 6.;
      }
    return sum;
  };
  for (auto &cell : mesh.cells)
    {
      const auto &x = mesh.vertices;
      if (cross_product_3d(x[cell[1]] - x[cell[0]], x[cell[2]] - x[cell[0]]) *
            (x[cell[3]] - x[cell[0]]) <
          0.)
        std::swap(cell[2], cell[3]);
    }
  const double before = volume();
  const auto   report =
    divide_flat_tetrahedra(mesh, {{{0, 1, 3}}, {{0, 2, 1}}}, {0, 0});
  EXPECT_EQ(report.n_divided, 1u);
  EXPECT_EQ(report.n_left, 0u);
  EXPECT_EQ(mesh.cells.size(), 8u);
  EXPECT_NEAR(volume(), before, 1e-14);
  unsigned int n_at_ridge = 0;
  for (const auto &cell : mesh.cells)
    n_at_ridge += std::count(cell.begin(), cell.end(), 0u) == 1 &&
                  std::count(cell.begin(), cell.end(), 1u) == 1;
  EXPECT_EQ(n_at_ridge, 2u);
}



TEST(VolumeRemesher, SaysWhatIsWrong)
{
  const auto message = [](const Settings &settings) -> std::string {
    const Body body(layered());
    try
      {
        remesh(body, settings, "wrong");
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    catch (const RunError &error)
      {
        return error.what();
      }
    return "no error";
  };
  EXPECT_NE(message({{"Layers", "gum"}}).find("'gum'"), std::string::npos);
  EXPECT_NE(message({{"Layers", "bone"}})
              .find("a column of cells of a layer ends at the boundary"),
            std::string::npos);
  EXPECT_NE(message(
              {{"Smallest edge length", "2"}, {"Largest edge length", "1"}})
              .find("Smallest edge length"),
            std::string::npos);
}
