// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Transfer between unrelated meshes: intersections of convex bodies, and what
// constants, conservation, bounds and coincident nodes dictate.
#include "noise.h"

#include <alveolus/base/errors.h>
#include <alveolus/geometry/convex_overlap.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/subcells.h>

#include <deal.II/base/timer.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  using Shape = HistoryField::Shape;

  /** A scalar with bounds and a tensor. */
  template <int dim>
  HistoryLayout
  layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.3;
    density.upper = 1.9;
    HistoryField elastic;
    elastic.name  = "elastic strain";
    elastic.shape = Shape::symmetric_tensor;
    return HistoryLayout({density, elastic}, dim);
  }

  /** Mesh, configuration and history. */
  template <int dim>
  struct Problem
  {
    using Grid     = parallel::distributed::Triangulation<dim>;
    using Function = std::function<Tensor<1, dim>(const Point<dim> &)>;

    Problem(const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const MPI_Comm                     communicator = MPI_COMM_WORLD)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      store         = std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}, {1, 1}},
        std::vector<HistoryLayout>{layout<dim>(), layout<dim>()},
        Utilities::pow(degree + 1, dim));
      cells = std::make_unique<SubCells<dim>>(*configuration,
                                              [this](const unsigned int c) {
                                                return store->region(c);
                                              });
    }

    /** Nodal vector of f(x) at the current positions. */
    NodalVector
    interpolate(const Function &f) const
    {
      NodalVector          result = configuration->make_vector();
      const NodalVector    x      = configuration->positions();
      const CellNodes<dim> nodes(*configuration);
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors position;
      for (const unsigned int c : cells->owned_cells())
        {
          nodes.gather(x, c, position);
          for (unsigned int i = 0; i < nodes.n_nodes; ++i)
            {
              const Tensor<1, dim> value = f(Point<dim>(position[i]));
              for (unsigned int d = 0; d < dim; ++d)
                if (nodes.local_entries(c, i)[d] < result.locally_owned_size())
                  result.local_element(nodes.local_entries(c, i)[d]) = value[d];
            }
        }
      result.update_ghost_values();
      return result;
    }

    /** Move the nodes to f(x). */
    Problem &
    map(const Function &f)
    {
      configuration->set_positions(interpolate(f));
      return *this;
    }

    /** Interior nodes of [0,1]^dim by noise, boundary nodes along it. */
    Problem &
    shake(const double size, const unsigned int seed)
    {
      return map([=](const Point<dim> &p) {
        Tensor<1, dim> x = p;
        for (unsigned int d = 0; d < dim; ++d)
          if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
            x[d] += size * noise(p, 3 * seed + d);
        return x;
      });
    }

    /** Fill records from a function of the sub-cell's centroid. */
    Problem &
    fill(const std::function<void(const Point<dim> &, double *)> &f)
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      cells->centroids(configuration->positions(), centroid, volume);
      for (const unsigned int c : cells->owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q], store->old_record(c, q));
      return *this;
    }

    Problem &
    fill_noise()
    {
      return fill([this](const Point<dim> &p, double *r) {
        for (unsigned int k = 0; k < store->layout(0).size; ++k)
          r[k] = noise(p, k);
        r[0] = 1.1 + 0.8 * r[0];
      });
    }

    void
    for_each(
      const std::function<void(const Point<dim> &, const double *)> &f) const
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      cells->centroids(configuration->positions(), centroid, volume);
      for (const unsigned int c : cells->owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q], store->old_record(c, q));
    }

    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
    std::unique_ptr<HistoryStore<dim>>  store;
    std::unique_ptr<SubCells<dim>>      cells;
  };

  template <int dim>
  std::function<void(parallel::distributed::Triangulation<dim> &)>
  cube(const unsigned int n)
  {
    return [n](parallel::distributed::Triangulation<dim> &t) {
      std::vector<unsigned int> repetitions(dim, n);
      repetitions[0] += dim == 2 ? 2 : 0;
      Point<dim> end;
      for (unsigned int d = 0; d < dim; ++d)
        end[d] = 1.;
      GridGenerator::subdivided_hyper_rectangle(t,
                                                repetitions,
                                                Point<dim>(),
                                                end);
    };
  }

  template <int dim>
  std::function<void(parallel::distributed::Triangulation<dim> &)>
  ball(const unsigned int refinements)
  {
    return [=](parallel::distributed::Triangulation<dim> &t) {
      GridGenerator::hyper_ball_balanced(t);
      t.refine_global(refinements);
    };
  }

  double
  largest_difference(const NodalVector &a, const NodalVector &b)
  {
    double result = 0.;
    for (unsigned int i = 0; i < a.locally_owned_size(); ++i)
      result =
        std::max(result, std::abs(a.local_element(i) - b.local_element(i)));
    return Utilities::MPI::max(result, MPI_COMM_WORLD);
  }

  template <int dim>
  Tensor<1, dim>
  linear(const Point<dim> &p)
  {
    Tensor<1, dim> u;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < dim; ++e)
        u[d] += (1. + d + 3. * e) * p[e] - 0.3 * d;
    return u;
  }

  template <int dim>
  constexpr unsigned int n_old = dim == 2 ? 8 : 3;
  template <int dim>
  constexpr unsigned int n_new = dim == 2 ? 11 : 4;
} // namespace

TEST(ConvexOverlap, Squares)
{
  const auto square = [](const double x, const double y) {
    return ConvexPiece<2>{
      {{{x, y}, {x + 1., y}, {x + 1., y + 1.}, {x, y + 1.}}}, 4};
  };
  Moments<2> m = overlap(square(0., 0.), square(0.25, 0.5));
  EXPECT_NEAR(m.volume, 0.375, 1e-16);
  EXPECT_NEAR(m.first[0] / m.volume, 0.625, 1e-15);
  EXPECT_NEAR(m.first[1] / m.volume, 0.75, 1e-15);
  EXPECT_EQ(overlap(square(0., 0.), square(1., 0.)).volume, 0.);
  EXPECT_EQ(overlap(square(0., 0.), square(3., 0.5)).volume, 0.);
  EXPECT_EQ(overlap(square(0.3, 0.7), square(0.3, 0.7)).volume,
            moments(square(0.3, 0.7)).volume);

  // An octagon: the unit square and the same turned by 45 degrees.
  const double         a = std::sqrt(0.5);
  const ConvexPiece<2> turned{
    {{{0.5 - a, 0.5}, {0.5, 0.5 - a}, {0.5 + a, 0.5}, {0.5, 0.5 + a}}}, 4};
  m = overlap(square(0., 0.), turned);
  EXPECT_NEAR(m.volume, 2. * (std::sqrt(2.) - 1.), 1e-15);
  EXPECT_NEAR(m.first[0] / m.volume, 0.5, 1e-15);
  m = overlap(turned, square(0., 0.));
  EXPECT_NEAR(m.volume, 2. * (std::sqrt(2.) - 1.), 1e-15);
}

TEST(ConvexOverlap, Tetrahedra)
{
  const ConvexPiece<3> unit{
    {{{0., 0., 0.}, {1., 0., 0.}, {0., 1., 0.}, {0., 0., 1.}}}, 4};
  EXPECT_NEAR(moments(unit).volume, 1. / 6., 1e-16);
  for (const double s : {0.1, 0.25, 0.6})
    {
      // Shifted by s along x: a tetrahedron scaled by 1-s remains.
      ConvexPiece<3> shifted = unit;
      for (auto &corner : shifted.corners)
        corner[0] += s;
      const Moments<3> m = overlap(unit, shifted);
      EXPECT_NEAR(m.volume, std::pow(1. - s, 3) / 6., 1e-16);
      EXPECT_NEAR(m.first[0] / m.volume, s + (1. - s) / 4., 1e-14);
      EXPECT_NEAR(m.first[1] / m.volume, (1. - s) / 4., 1e-14);
    }
  // Mirrored at x = 1/4: each is cut in the middle, x < 1/2 of both remains.
  ConvexPiece<3> mirrored = unit;
  for (auto &corner : mirrored.corners)
    corner[0] = 0.5 - corner[0];
  std::swap(mirrored.corners[1], mirrored.corners[2]);
  const double whole = 1. / 6., top = std::pow(0.75, 3) / 6.;
  const double beyond = std::pow(0.5, 3) / 6.;
  const auto   m      = overlap(unit, mirrored);
  EXPECT_NEAR(m.first[0] / m.volume, 0.25, 1e-14);
  // x in (1/4,1/2) belongs to unit only: twice the slice of unit there.
  EXPECT_NEAR(m.volume, 2. * (top - beyond), 1e-15);
  EXPECT_GT(whole, m.volume);
}

template <int dim>
void
constants(const unsigned int degree)
{
  Problem<dim> a(degree, cube<dim>(n_old<dim>)), b(degree, ball<dim>(1));
  a.shake(0.2 / n_old<dim> / degree, 1);
  // Inside the cube, whose boundary is elsewhere.
  b.map([](const Point<dim> &p) {
    Tensor<1, dim> x = 0.4 * Tensor<1, dim>(p);
    for (unsigned int d = 0; d < dim; ++d)
      x[d] += 0.5;
    return x;
  });
  a.fill([](const Point<dim> &, double *r) {
    for (unsigned int k = 0; k < layout<dim>().size; ++k)
      r[k] = 0.4 + 0.0317 * k;
  });
  const OverlapTransfer<dim> transfer(*a.configuration, *a.store, "Godunov");
  const OverlapReport report = transfer.transfer(*b.configuration, *b.store);
  b.for_each([](const Point<dim> &, const double *r) {
    for (unsigned int k = 0; k < layout<dim>().size; ++k)
      EXPECT_EQ(r[k], 0.4 + 0.0317 * k);
  });
  EXPECT_EQ(report.n_uncovered, 0u);
  EXPECT_EQ(report.n_limited, 0u);
  EXPECT_EQ(report.n_folded, 0u);
  EXPECT_NEAR(report.regions[0].least_covered, 1., 1e-12);
  EXPECT_NEAR(report.regions[0].volume_before, 1., 1e-13);
  EXPECT_NEAR(report.content_before(), 0.4, 1e-13);
  EXPECT_NEAR(report.content_after(),
              0.4 * report.regions[0].volume_after,
              1e-13);
}

TEST(OverlapTransfer, ConstantsToTheLastBit)
{
  constants<2>(1);
  constants<2>(2);
  constants<3>(1);
}

template <int dim>
void
conservation(const unsigned int degree)
{
  Problem<dim> a(degree, cube<dim>(n_old<dim>)),
    b(degree, cube<dim>(n_new<dim>));
  a.shake(0.2 / n_old<dim> / degree, 1).fill_noise();
  b.shake(0.2 / n_new<dim> / degree, 2);
  const OverlapTransfer<dim> transfer(*a.configuration, *a.store, "Godunov");
  const OverlapReport report = transfer.transfer(*b.configuration, *b.store);
  EXPECT_NEAR(report.content_after() / report.content_before(), 1., 1e-13);
  EXPECT_NEAR(report.regions[0].least_covered, 1., 1e-12);
  EXPECT_EQ(report.n_uncovered, 0u);

  const unsigned int  size = layout<dim>().size;
  std::vector<double> low(size, 1e9), high(size, -1e9);
  a.for_each([&](const Point<dim> &, const double *r) {
    for (unsigned int k = 0; k < size; ++k)
      {
        low[k]  = std::min(low[k], r[k]);
        high[k] = std::max(high[k], r[k]);
      }
  });
  Utilities::MPI::min(low, MPI_COMM_WORLD, low);
  Utilities::MPI::max(high, MPI_COMM_WORLD, high);
  b.for_each([&](const Point<dim> &, const double *r) {
    for (unsigned int k = 0; k < size; ++k)
      {
        EXPECT_GE(r[k], low[k] - 1e-14);
        EXPECT_LE(r[k], high[k] + 1e-14);
      }
  });
}

TEST(OverlapTransfer, ConservationAndBounds)
{
  conservation<2>(1);
  conservation<2>(2);
  conservation<3>(1);
}

// The mean of a step over sub-cells of another width.
TEST(OverlapTransfer, MeansAreExact)
{
  Problem<2> a(1, [](parallel::distributed::Triangulation<2> &t) {
    GridGenerator::subdivided_hyper_rectangle(t,
                                              {2, 3},
                                              Point<2>(),
                                              Point<2>(1., 1.));
  });
  Problem<2> b(1, [](parallel::distributed::Triangulation<2> &t) {
    GridGenerator::subdivided_hyper_rectangle(t,
                                              {3, 2},
                                              Point<2>(),
                                              Point<2>(1., 1.));
  });
  a.fill([](const Point<2> &p, double *r) { r[0] = p[0] < 0.25 ? 1.8 : 0.6; });
  const OverlapTransfer<2> transfer(*a.configuration, *a.store, "Godunov");
  transfer.transfer(*b.configuration, *b.store);
  // 1/4 is in the middle of the second of six columns.
  b.for_each([](const Point<2> &p, const double *r) {
    EXPECT_NEAR(r[0],
                p[0] < 1. / 6. ? 1.8 : (p[0] < 2. / 6. ? 1.2 : 0.6),
                1e-14);
  });
}

template <int dim>
void
same_mesh(const unsigned int degree)
{
  Problem<dim> a(degree, ball<dim>(1)), b(degree, ball<dim>(1));
  const auto   move = [=](const Point<dim> &p) {
    Tensor<1, dim> x = p;
    for (unsigned int d = 0; d < dim; ++d)
      x[d] += 0.03 / degree * noise(p, d);
    return x;
  };
  a.map(move).fill_noise();
  b.map(move);
  const NodalVector          u = a.interpolate([](const Point<dim> &p) {
    Tensor<1, dim> f;
    for (unsigned int d = 0; d < dim; ++d)
      f[d] = noise(p, d);
    return f;
  });
  const OverlapTransfer<dim> transfer(*a.configuration, *a.store, "Godunov");
  OverlapReport report = transfer.transfer(*b.configuration, *b.store);
  if (degree == 1 && dim == 2)
    {
      const unsigned int n_points = a.store->n_points;
      for (const unsigned int c : a.cells->owned_cells())
        for (unsigned int q = 0; q < n_points; ++q)
          for (unsigned int k = 0; k < layout<dim>().size; ++k)
            EXPECT_EQ(a.store->old_record(c, q)[k],
                      b.store->old_record(c, q)[k]);
    }
  EXPECT_NEAR(report.regions[0].least_covered, 1., 1e-12);
  EXPECT_NEAR(report.content_after() / report.content_before(), 1., 1e-14);
  EXPECT_EQ(largest_difference(
              transfer.nodal(u, *b.configuration, *b.store, report), u),
            0.);
  EXPECT_EQ(report.n_nodes_outside, 0u);
}

TEST(OverlapTransfer, SameMeshSameBits)
{
  same_mesh<2>(1);
  same_mesh<2>(2);
  same_mesh<3>(1);
}

template <int dim>
void
two_regions()
{
  const auto grid = [](const unsigned int n) {
    return [n](parallel::distributed::Triangulation<dim> &t) {
      cube<dim>(n)(t);
      for (const auto &cell : t.active_cell_iterators())
        cell->set_material_id(cell->center()[0] < 0.5 ? 0 : 1);
    };
  };
  Problem<dim> a(1, grid(dim == 2 ? 6 : 2)), b(1, grid(dim == 2 ? 10 : 4));
  for (const unsigned int c : a.cells->owned_cells())
    for (unsigned int q = 0; q < a.store->n_points; ++q)
      a.store->old_record(c, q)[0] = a.store->region(c) == 0 ? 1.7 : 0.4;
  // The interface is elsewhere: a strip of 0.02 of region 1 is outside the old
  // one.
  b.map([](const Point<dim> &p) {
    Tensor<1, dim> x = p;
    if (std::abs(p[0] - 0.5) < 1e-10)
      x[0] -= 0.02;
    return x;
  });
  typename OverlapTransfer<dim>::Limits limits;
  limits.uncovered = 0.05;
  const OverlapTransfer<dim> transfer(
    *a.configuration, *a.store, "Godunov", "density", limits);
  const OverlapReport report = transfer.transfer(*b.configuration, *b.store);
  for (const unsigned int c : b.cells->owned_cells())
    for (unsigned int q = 0; q < b.store->n_points; ++q)
      EXPECT_EQ(b.store->old_record(c, q)[0],
                b.store->region(c) == 0 ? 1.7 : 0.4);
  EXPECT_NEAR(report.regions[0].uncovered, 0., 1e-14);
  EXPECT_NEAR(report.regions[1].uncovered, 0.02, 1e-14);
  EXPECT_LT(report.regions[1].least_covered, 0.9);
  EXPECT_NEAR(report.content_before(), 1.05, 1e-13);
  EXPECT_NEAR(report.content_after(), 1.7 * 0.48 + 0.4 * 0.52, 1e-13);

  limits.uncovered = 0.03;
  const OverlapTransfer<dim> strict(
    *a.configuration, *a.store, "Godunov", "density", limits);
  EXPECT_THROW(strict.transfer(*b.configuration, *b.store), RunError);
}

TEST(OverlapTransfer, RegionsNeverMix)
{
  two_regions<2>();
  two_regions<3>();
}

// Sub-cells that are not convex or even folded still cover the plane.
TEST(OverlapTransfer, BadCells)
{
  for (const double in : {0.3, 0.62})
    {
      Problem<2> a(1, [](parallel::distributed::Triangulation<2> &t) {
        GridGenerator::subdivided_hyper_cube(t, 2);
      });
      // The middle node moves towards a corner: for 0.3 the opposite sub-cell
      // is not convex any more.
      a.map([in](const Point<2> &p) {
        return p.distance(Point<2>(0.5, 0.5)) < 1e-10
                 ? Tensor<1, 2>({0.5 - in * 0.75, 0.5 - in * 0.75})
                 : Tensor<1, 2>(p);
      });
      a.fill_noise();
      Problem<2>               b(1, cube<2>(9));
      const OverlapTransfer<2> transfer(*a.configuration, *a.store, "Godunov");
      const OverlapReport      report =
        transfer.transfer(*b.configuration, *b.store);
      EXPECT_EQ(report.n_folded > 0, in > 0.5);
      EXPECT_EQ(report.n_uncovered, 0u);
      if (in < 0.5)
        {
          EXPECT_NEAR(report.regions[0].least_covered, 1., 1e-12);
          EXPECT_NEAR(report.content_after(), report.content_before(), 1e-13);
        }
    }
}

// A domain that grows a little: its rim takes the nearest values.
TEST(OverlapTransfer, UncoveredSubCells)
{
  Problem<2> a(1, cube<2>(4));
  Problem<2> b(1, [](parallel::distributed::Triangulation<2> &t) {
    GridGenerator::subdivided_hyper_rectangle(t,
                                              {101, 5},
                                              Point<2>(),
                                              Point<2>(1.01, 1.));
  });
  a.fill([](const Point<2> &p, double *r) { r[0] = p[1] < 0.5 ? 0.5 : 1.5; });
  const OverlapTransfer<2> transfer(*a.configuration, *a.store, "Godunov");
  const OverlapReport report = transfer.transfer(*b.configuration, *b.store);
  EXPECT_EQ(report.n_uncovered, 20u);
  EXPECT_NEAR(report.regions[0].least_covered, 0., 1e-10);
  EXPECT_NEAR(report.regions[0].uncovered, 0.01, 1e-14);
  EXPECT_NEAR(report.regions[0].content_after, 1.01, 1e-13);
  b.for_each([](const Point<2> &p, const double *r) {
    if (std::abs(p[1] - 0.5) > 0.06)
      {
        EXPECT_EQ(r[0], p[1] < 0.5 ? 0.5 : 1.5);
      }
  });
}

template <int dim>
void
linear_nodal(const unsigned int degree)
{
  Problem<dim> a(degree, cube<dim>(n_old<dim>)),
    b(degree, cube<dim>(n_new<dim>));
  a.shake(0.2 / n_old<dim> / degree, 1);
  b.shake(0.2 / n_new<dim> / degree, 2);
  const OverlapTransfer<dim> transfer(*a.configuration, *a.store, "Godunov");
  OverlapReport              report;
  EXPECT_LT(largest_difference(transfer.nodal(a.interpolate(&linear<dim>),
                                              *b.configuration,
                                              *b.store,
                                              report),
                               b.interpolate(&linear<dim>)),
            1e-12);
  EXPECT_EQ(report.n_nodes_outside, 0u);

  const auto constant = [](const Point<dim> &) {
    Tensor<1, dim> c;
    for (unsigned int d = 0; d < dim; ++d)
      c[d] = 0.1 + d / 3.;
    return c;
  };
  EXPECT_EQ(largest_difference(transfer.nodal(a.interpolate(constant),
                                              *b.configuration,
                                              *b.store,
                                              report),
                               b.interpolate(constant)),
            0.);
}

TEST(OverlapTransfer, LinearNodalField)
{
  linear_nodal<2>(1);
  linear_nodal<2>(2);
  linear_nodal<3>(1);
  linear_nodal<3>(2);
}

// A disc with sides at other angles: boundary nodes leave the polygon by no
// more than the sagitta of its sides.
TEST(OverlapTransfer, NodesOutside)
{
  Problem<2>               a(1, ball<2>(2)), b(1, ball<2>(3));
  const unsigned int       n_sides = 32;
  OverlapReport            report;
  const OverlapTransfer<2> transfer(*a.configuration, *a.store, "Godunov");
  const NodalVector        u = transfer.nodal(a.interpolate(&linear<2>),
                                       *b.configuration,
                                       *b.store,
                                       report);
  EXPECT_LT(largest_difference(u, b.interpolate(&linear<2>)), 1e-12);
  EXPECT_EQ(report.n_nodes_outside, n_sides);
  EXPECT_NEAR(report.largest_distance,
              1. - std::cos(numbers::PI / n_sides),
              1e-12);
  // Old nodes are new nodes too: the same bits.
  const auto field = [](const Point<2> &p) {
    return Tensor<1, 2>({noise(p, 1), noise(p, 2)});
  };
  const NodalVector v =
    transfer.nodal(a.interpolate(field), *b.configuration, *b.store, report);
  const NodalVector exact = b.interpolate(field);
  unsigned int      equal = 0;
  for (unsigned int i = 0; i < v.locally_owned_size(); ++i)
    equal += v.local_element(i) == exact.local_element(i) ? 1 : 0;
  const auto &dofs = a.configuration->dof_handler;
  EXPECT_GE(Utilities::MPI::sum(equal, MPI_COMM_WORLD), dofs.n_dofs());

  Problem<2> far(1, ball<2>(2));
  far.map([](const Point<2> &p) -> Tensor<1, 2> { return 1.5 * p; });
  EXPECT_THROW(transfer.nodal(
                 a.interpolate(field), *far.configuration, *far.store, report),
               RunError);
}

// Same bits on one process and on all of them.
template <int dim>
void
same_on_any_number_of_processes(const unsigned int degree)
{
  std::map<std::string, std::vector<double>> reference;
  std::vector<OverlapReport>                 reports;
  for (const MPI_Comm communicator : {MPI_COMM_SELF, MPI_COMM_WORLD})
    {
      Problem<dim> a(degree, ball<dim>(1), communicator);
      Problem<dim> b(degree, ball<dim>(dim == 2 ? 2 : 1), communicator);
      a.fill_noise();
      b.map([](const Point<dim> &p) {
        Tensor<1, dim> x = p;
        for (unsigned int d = 0; d < dim; ++d)
          x[d] += 0.01 * noise(p, d);
        return x;
      });
      const OverlapTransfer<dim> transfer(*a.configuration,
                                          *a.store,
                                          "Godunov");
      reports.push_back(transfer.transfer(*b.configuration, *b.store));
      const NodalVector u =
        transfer.nodal(a.interpolate([](const Point<dim> &p) {
          Tensor<1, dim> f;
          for (unsigned int d = 0; d < dim; ++d)
            f[d] = noise(p, d);
          return f;
        }),
                       *b.configuration,
                       *b.store,
                       reports.back());
      const CellNodes<dim>                 nodes(*b.configuration);
      typename CellNodes<dim>::NodeTensors f;
      for (const auto &cell : b.mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int  c     = cell->active_cell_index();
            const double       *begin = b.store->old_record(c, 0);
            std::vector<double> values(begin,
                                       begin + b.store->n_points *
                                                 b.store->layout(0).size);
            nodes.gather(u, c, f);
            for (unsigned int i = 0; i < nodes.n_nodes; ++i)
              for (unsigned int d = 0; d < dim; ++d)
                values.push_back(f[i][d]);
            if (communicator == MPI_COMM_SELF)
              reference[cell->id().to_string()] = values;
            else
              EXPECT_EQ(values, reference.at(cell->id().to_string()));
          }
    }
  EXPECT_EQ(reports[0].content_before(), reports[1].content_before());
  EXPECT_EQ(reports[0].content_after(), reports[1].content_after());
  EXPECT_EQ(reports[0].regions[0].uncovered, reports[1].regions[0].uncovered);
  EXPECT_EQ(reports[0].n_uncovered, reports[1].n_uncovered);
  EXPECT_EQ(reports[0].n_nodes_outside, reports[1].n_nodes_outside);
}

TEST(OverlapTransfer, SameOnAnyNumberOfProcesses)
{
  same_on_any_number_of_processes<2>(1);
  same_on_any_number_of_processes<2>(2);
  same_on_any_number_of_processes<3>(1);
}

TEST(OverlapTransfer, Errors)
{
  Problem<2> a(1, cube<2>(4)), b(2, cube<2>(4));
  EXPECT_THROW(OverlapTransfer<2>(*a.configuration, *a.store, "third order"),
               InputError);
  const OverlapTransfer<2> transfer(*a.configuration, *a.store, "Godunov");
  EXPECT_THROW(transfer.transfer(*b.configuration, *b.store), RunError);
  Problem<2> with_ligament(1, [](parallel::distributed::Triangulation<2> &t) {
    cube<2>(4)(t);
    t.begin_active()->set_material_id(1);
  });
  EXPECT_THROW(transfer.transfer(*with_ligament.configuration,
                                 *with_ligament.store),
               RunError);
}

namespace
{
  template <int dim>
  void
  measure(const unsigned int degree, const unsigned int n)
  {
    Problem<dim> a(degree, cube<dim>(n)), b(degree, cube<dim>(n + 1));
    a.shake(0.15 / n / degree, 1).fill_noise();
    b.shake(0.15 / n / degree, 2);
    Timer                      timer;
    const OverlapTransfer<dim> transfer(*a.configuration, *a.store, "Godunov");
    const double               picture = timer.wall_time();
    timer.restart();
    transfer.transfer(*b.configuration, *b.store);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << dim << "D, " << b.mesh.triangulation->n_active_cells()
                << " cells of degree " << degree << ": picture "
                << 1e3 * picture << " ms, overlap " << 1e3 * timer.wall_time()
                << " ms" << std::endl;
  }
} // namespace

// Not a check but a measurement.
TEST(OverlapTransfer, Cost)
{
  measure<2>(1, 32);
  measure<2>(2, 32);
  measure<3>(1, 5);
}
