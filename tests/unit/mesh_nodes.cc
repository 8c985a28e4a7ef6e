// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Nodes of named sets, their order, and the quality of cells whose Jacobians
// are known.
#include <alveolus/base/errors.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/mesh/quality.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace dealii;
using namespace alveolus;

namespace
{
  constexpr unsigned int n = 4;

  /** Unit square or cube of n^dim cells with names. */
  template <int dim>
  Mesh<dim>
  unit_mesh()
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    Point<dim> corner;
    for (unsigned int c = 0; c < dim; ++c)
      corner[c] = 1.;
    GridGenerator::subdivided_hyper_rectangle(*mesh.triangulation,
                                              std::vector<unsigned int>(dim, n),
                                              Point<dim>(),
                                              corner,
                                              true);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      {
        if (cell->center()[1] < 0.5)
          cell->set_material_id(1);
        for (unsigned int l = 0; l < GeometryInfo<dim>::lines_per_cell; ++l)
          {
            // The line x = 1/2 (in 3D with z = 1/2 as well)
            const auto c = cell->line(l)->center();
            if (std::abs(c[0] - 0.5) < 1e-12 &&
                (dim == 2 || std::abs(c[dim - 1] - 0.5) < 1e-12))
              cell->line(l)->set_manifold_id(7);
          }
      }
    auto &names                  = mesh.names;
    names.points["A"]            = Point<dim>::unit_vector(0) * 0.25;
    names.points["nowhere"]      = Point<dim>::unit_vector(0) * 0.3;
    names.curves["middle"]       = {7};
    names.boundaries["left"]     = {0};
    names.boundaries["right"]    = {1};
    names.boundaries["sides"]    = {0, 1};
    names.boundaries["around"]   = {0, 1, 2, 3};
    names.curves["branched"]     = {7};
    names.boundaries["branched"] = {2};
    names.regions["lower"]       = {1};
    return mesh;
  }

  template <int dim>
  unsigned int
  n_owned(const Nodes<dim> &nodes, const std::vector<NodeId> &list)
  {
    unsigned int count = 0;
    for (const NodeId node : list)
      count += nodes.is_owned(node);
    return Utilities::MPI::sum(count, MPI_COMM_WORLD);
  }
} // namespace

template <int dim>
void
sets(const unsigned int degree)
{
  const Mesh<dim>          mesh = unit_mesh<dim>();
  const Configuration<dim> configuration(mesh, degree);
  const Nodes<dim>         nodes(configuration);
  const NodalVector       &x = configuration.initial_positions();
  const unsigned int       m = n * degree;

  const auto count = [&](const unsigned int planes) {
    return planes * Utilities::fixed_power<dim - 1>(m + 1);
  };
  EXPECT_EQ(n_owned(nodes, nodes.relevant()), count(m + 1));
  EXPECT_EQ(n_owned(nodes, nodes.boundary("sides", "")), count(2));
  EXPECT_EQ(n_owned(nodes, nodes.region("lower", "")), count(m / 2 + 1));
  EXPECT_EQ(n_owned(nodes, nodes.on_curve("middle", "")), m + 1);
  // Sets are complete on ghosts, too.
  for (const NodeId node : nodes.boundary("left", ""))
    EXPECT_NEAR(nodes.get(x, node)[0], 0., 1e-14);
  const auto   left  = nodes.boundary("left", "");
  unsigned int found = 0;
  for (const NodeId node : nodes.relevant())
    found += nodes.get(x, node)[0] < 1e-12;
  EXPECT_EQ(found, left.size());

  const NodeId a = nodes.point("A", "");
  EXPECT_LT(nodes.gather(x, {a})[0].distance(Point<dim>::unit_vector(0) * 0.25),
            1e-14);
  EXPECT_THROW(nodes.point("nowhere", ""), InputError);
  EXPECT_THROW(nodes.point("B", ""), InputError);

  const NodeCurve middle = nodes.curve("middle", "");
  EXPECT_FALSE(middle.closed);
  ASSERT_EQ(middle.nodes.size(), m + 1);
  const auto at = nodes.gather(x, middle.nodes);
  for (unsigned int i = 0; i <= m; ++i)
    {
      Point<dim> expected;
      for (unsigned int c = 0; c < dim; ++c)
        expected[c] = c == 1 ? double(i) / m : 0.5;
      EXPECT_LT(at[i].distance(expected), 1e-14);
    }

  // Values set by their owners come back everywhere, ghosts after an update.
  NodalVector field = configuration.make_vector();
  for (const NodeId node : nodes.relevant())
    if (nodes.is_owned(node))
      nodes.set(field, node, Point<dim>(2. * nodes.get(x, node)));
  field.update_ghost_values();
  for (const NodeId node : nodes.relevant())
    EXPECT_LT(
      nodes.get(field, node).distance(Point<dim>(2. * nodes.get(x, node))),
      1e-14);
}

TEST(Nodes, NamedSets)
{
  for (const unsigned int degree : {1, 2})
    {
      sets<2>(degree);
      sets<3>(degree);
    }
}

TEST(Nodes, CurvesOfBoundaries)
{
  const Mesh<2> mesh = unit_mesh<2>();
  for (const unsigned int degree : {1, 2})
    {
      const Configuration<2> configuration(mesh, degree);
      const Nodes<2>         nodes(configuration);
      const NodeCurve        around = nodes.curve("around", "");
      EXPECT_TRUE(around.closed);
      ASSERT_EQ(around.nodes.size(), 4 * n * degree);
      const auto x =
        nodes.gather(configuration.initial_positions(), around.nodes);
      const double h = 1. / (n * degree);
      EXPECT_LT(x[0].distance(Point<2>(0., 0.)), 1e-14);
      EXPECT_LT(x[1].distance(Point<2>(0., h)), 1e-14);
      EXPECT_LT(x.back().distance(Point<2>(h, 0.)), 1e-14);
      for (unsigned int i = 0; i < x.size(); ++i)
        EXPECT_NEAR(x[i].distance(x[(i + 1) % x.size()]), h, 1e-14);

      EXPECT_EQ(nodes.curve("right", "").nodes.size(), n * degree + 1);
      EXPECT_THROW(nodes.curve("sides", ""), InputError);
      EXPECT_THROW(nodes.curve("branched", ""), InputError);
      EXPECT_THROW(nodes.curve("unknown", ""), InputError);
    }
}

TEST(Nodes, RefusesHigherDegrees)
{
  const Mesh<2>          mesh = unit_mesh<2>();
  const Configuration<2> configuration(mesh, 3);
  EXPECT_THROW(Nodes<2> nodes(configuration), InputError);
}

namespace
{
  /** Positions f(X) of all nodes. */
  template <int dim, typename Map>
  NodalVector
  moved(const Nodes<dim> &nodes, const Map &f)
  {
    NodalVector x = nodes.configuration.positions();
    for (const NodeId node : nodes.relevant())
      if (nodes.is_owned(node))
        nodes.set(x,
                  node,
                  f(nodes.get(nodes.configuration.initial_positions(), node)));
    x.update_ghost_values();
    return x;
  }

  template <int dim>
  Mesh<dim>
  one_cell()
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    GridGenerator::hyper_cube(*mesh.triangulation);
    return mesh;
  }
} // namespace

TEST(Quality, KnownCells)
{
  const Mesh<2> square = one_cell<2>();
  const Mesh<3> cube   = one_cell<3>();
  for (const unsigned int degree : {1, 2})
    {
      const Configuration<2> configuration(square, degree);
      const Nodes<2>         nodes(configuration);

      // Any rectangle is perfect, any size and angle of view.
      auto q = mesh_quality(configuration, moved(nodes, [](const Point<2> &X) {
                              return Point<2>(3e-3 * X[0] - 4. * X[1],
                                              4e-3 * X[0] + 3. * X[1]);
                            }));
      // Sides 1000:1 cost three digits.
      EXPECT_NEAR(q.smallest_scaled_jacobian, 1., 1e-12);
      EXPECT_NEAR(q.smallest_point_jacobian, 1., 1e-12);
      EXPECT_EQ(q.n_inverted_corners, 0u);
      EXPECT_LT(q.where.distance(Point<2>(-1.9985, 1.502)), 1e-13);

      // Parallelogram of 45 degrees
      q = mesh_quality(configuration, moved(nodes, [](const Point<2> &X) {
                         return Point<2>(X[0] + X[1], X[1]);
                       }));
      EXPECT_NEAR(q.smallest_scaled_jacobian, std::sqrt(0.5), 1e-14);
      EXPECT_NEAR(q.smallest_point_jacobian, 1., 1e-13);

      // The square with its last corner at (a, a): det = 1 + (a-1)(xi + eta),
      // mean a; scaled Jacobian there (2a-1)/(a^2 + (1-a)^2)
      const double gauss =
        0.5 + 0.5 * (degree == 1 ? std::sqrt(1. / 3.) : std::sqrt(0.6));
      for (const double a : {0.6, 0.4})
        {
          q = mesh_quality(configuration, moved(nodes, [a](const Point<2> &X) {
                             const double t = (a - 1.) * X[0] * X[1];
                             return Point<2>(X[0] + t, X[1] + t);
                           }));
          EXPECT_NEAR(q.smallest_scaled_jacobian,
                      (2. * a - 1.) / (a * a + (1. - a) * (1. - a)),
                      1e-14);
          EXPECT_EQ(q.n_inverted_corners, a < 0.5 ? 1u : 0u);
          const double least = 1. + (a - 1.) * 2. * gauss;
          if (least > 0.)
            {
              EXPECT_NEAR(q.smallest_point_jacobian, least / a, 1e-13);
            }
          else
            {
              EXPECT_LT(q.smallest_point_jacobian, 0.);
            }
        }

      // Mirror images are inverted everywhere, and nonsense is not valid.
      q = mesh_quality(configuration, moved(nodes, [](const Point<2> &X) {
                         return Point<2>(-X[0], X[1]);
                       }));
      EXPECT_NEAR(q.smallest_scaled_jacobian, -1., 1e-14);
      EXPECT_NEAR(q.smallest_point_jacobian, -1., 1e-13);
      EXPECT_EQ(q.n_inverted_corners, 4u);
      q =
        mesh_quality(configuration, moved(nodes, [](const Point<2> &) {
                       return Point<2>(std::numeric_limits<double>::quiet_NaN(),
                                       0.);
                     }));
      EXPECT_LT(q.smallest_scaled_jacobian, 0.);
      EXPECT_LT(q.smallest_point_jacobian, 0.);

      // In 3D a shear by s
      const Configuration<3> configuration_3(cube, degree);
      const Nodes<3>         nodes_3(configuration_3);
      const double           s = 0.75;
      const auto             q3 =
        mesh_quality(configuration_3, moved(nodes_3, [s](const Point<3> &X) {
                       return Point<3>(X[0] + s * X[2], 2. * X[1], X[2]);
                     }));
      EXPECT_NEAR(q3.smallest_scaled_jacobian, 0.8, 1e-14);
      EXPECT_NEAR(q3.smallest_point_jacobian, 1., 1e-13);
    }
}

TEST(Quality, QuadraticEdgesAreSeenAtTheQuadraturePoints)
{
  // The middle of the lower edge raised by b: y = eta + 4 b xi (1-xi) (2 eta^2
  // - 3 eta + 1), so that det = 1 + 4 b xi (1-xi) (4 eta - 3) with the mean
  // 1 - 2b/3; the vertices know nothing of it.
  const Mesh<2>          mesh = one_cell<2>();
  const Configuration<2> configuration(mesh, 2);
  const Nodes<2>         nodes(configuration);
  const double           b = 0.2, g = 0.5 - 0.5 * std::sqrt(0.6);
  const auto             q =
    mesh_quality(configuration, moved(nodes, [b](const Point<2> &X) {
                   const bool middle =
                     std::abs(X[0] - 0.5) < 1e-12 && X[1] < 1e-12;
                   return Point<2>(X[0], middle ? b : X[1]);
                 }));
  EXPECT_NEAR(q.smallest_scaled_jacobian, 1., 1e-14);
  EXPECT_NEAR(q.smallest_point_jacobian,
              (1. + b * (4. * g - 3.)) / (1. - 2. * b / 3.),
              1e-13);
}

TEST(Quality, RegionsAndCells)
{
  // The upper half is sheared, the lower one is not.
  const Mesh<2>          mesh = unit_mesh<2>();
  const Configuration<2> configuration(mesh, 1);
  const Nodes<2>         nodes(configuration);
  const auto             x = moved(nodes, [](const Point<2> &X) {
    return Point<2>(X[0] + 0.75 * std::max(X[1] - 0.5, 0.), X[1]);
  });
  Vector<float>          per_cell;
  EXPECT_NEAR(
    mesh_quality(configuration, x, {}, &per_cell).smallest_scaled_jacobian,
    0.8,
    1e-14);
  EXPECT_NEAR(mesh_quality(configuration, x, {1}).smallest_scaled_jacobian,
              1.,
              1e-14);
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned())
      {
        EXPECT_NEAR(per_cell[cell->active_cell_index()],
                    cell->material_id() == 1 ? 1. : 0.8,
                    1e-6);
      }
}
