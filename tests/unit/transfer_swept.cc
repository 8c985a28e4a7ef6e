// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Transfer of history on the same connectivity: what conservation, uniform
// fields, exact shifts, numerical diffusion and bounds dictate.
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/godunov.h>
#include <alveolus/transfer/swept_transfer.h>
#include <alveolus/transfer/trace_projection.h>

#include <deal.II/base/timer.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Shape = HistoryField::Shape;

  /** A number in [-1,1] without pattern, the same on every process. */
  template <int dim>
  double
  noise(const Point<dim> &x, const unsigned int seed)
  {
    double sum = 0.7 * seed;
    for (unsigned int d = 0; d < dim; ++d)
      sum += (12.9898 + 31.4 * d + seed) * std::round(x[d] * 1e6) * 1e-6;
    const double y = std::sin(sum) * 437.5453;
    return 2. * (y - std::floor(y)) - 1.;
  }

  /** Layout like that of bone: 10 values in 2D, 14 in 3D. */
  template <int dim>
  HistoryLayout
  bone_layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.3;
    density.upper = 1.9;
    HistoryField plastic;
    plastic.name  = "plastic strain";
    plastic.lower = 0.;
    HistoryField elastic;
    elastic.name  = "elastic strain";
    elastic.shape = Shape::symmetric_tensor;
    HistoryField fabric;
    fabric.name      = "log fabric";
    fabric.shape     = Shape::symmetric_tensor;
    fabric.traceless = true;
    return HistoryLayout({density, plastic, elastic, fabric}, dim);
  }

  /** Mesh, configuration, history and transfer of one test. */
  template <int dim>
  struct Problem
  {
    using Grid = parallel::distributed::Triangulation<dim>;

    Problem(const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const double                       donor_fraction = 0.5,
            const MPI_Comm                     communicator   = MPI_COMM_WORLD)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      store         = std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}, {1, 1}},
        std::vector<HistoryLayout>{bone_layout<dim>(), bone_layout<dim>()},
        Utilities::pow(degree + 1, dim));
      transfer =
        std::make_unique<SweptTransfer<dim>>(*configuration,
                                             *store,
                                             std::make_unique<Godunov<dim>>(),
                                             "density",
                                             donor_fraction);
    }

    /** x + motion(x) for every node. */
    NodalVector
    moved(const std::function<Tensor<1, dim>(const Point<dim> &)> &motion) const
    {
      NodalVector                          x = configuration->positions();
      std::vector<types::global_dof_index> dofs(
        configuration->fe.n_dofs_per_cell());
      const NodalVector start = x;
      const auto       &part  = *start.get_partitioner();
      x.zero_out_ghost_values();
      for (const auto &cell :
           configuration->dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(dofs);
            for (unsigned int i = 0; i < dofs.size(); i += 1)
              if (configuration->fe.system_to_component_index(i).first == 0)
                {
                  const unsigned int base =
                    configuration->fe.system_to_component_index(i).second;
                  Point<dim> p;
                  for (unsigned int d = 0; d < dim; ++d)
                    p[d] = start.local_element(part.global_to_local(
                      dofs[configuration->fe.component_to_system_index(d,
                                                                       base)]));
                  const Tensor<1, dim> m = motion(p);
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const auto dof =
                        dofs[configuration->fe.component_to_system_index(d,
                                                                         base)];
                      if (configuration->locally_owned.is_element(dof))
                        x[dof] = p[d] + m[d];
                    }
                }
          }
      x.update_ghost_values();
      return x;
    }

    /** Interior nodes of [0,1]^dim by noise of size @p size. */
    NodalVector
    shaken(const double size, const unsigned int seed = 1) const
    {
      return moved([&](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          if (p[d] < 1e-10 || p[d] > 1. - 1e-10)
            return Tensor<1, dim>();
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = size * noise(p, 3 * seed + d);
        return m;
      });
    }

    /** Fill records from a function of the sub-cell's centroid. */
    void
    fill(const std::function<void(const Point<dim> &, double *)> &f)
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      transfer->subcells().centroids(configuration->positions(),
                                     centroid,
                                     volume);
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q], store->old_record(c, q));
    }

    /** Random, admissible records. */
    void
    fill_noise()
    {
      const unsigned int size = store->layout(0).size;
      fill([size](const Point<dim> &p, double *r) {
        for (unsigned int k = 0; k < size; ++k)
          r[k] = noise(p, k);
        r[0] = 1.1 + 0.8 * r[0];
        r[1] = 0.5 + 0.5 * r[1];
      });
    }

    void
    for_each(const std::function<void(const double *)> &f) const
    {
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(store->old_record(c, q));
    }

    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
    std::unique_ptr<HistoryStore<dim>>  store;
    std::unique_ptr<SweptTransfer<dim>> transfer;
  };

  template <int dim>
  void
  cube(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::subdivided_hyper_cube(t, dim == 2 ? 8 : 4);
  }

  /** Cells of all orientations, curved boundary. */
  template <int dim>
  void
  ball(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::hyper_ball_balanced(t);
    t.refine_global(dim == 2 ? 2 : 1);
  }
} // namespace

template <int dim>
void
uniform_state_stays(const unsigned int degree)
{
  for (const auto &grid : {&cube<dim>, &ball<dim>})
    {
      Problem<dim> s(degree, grid);
      s.fill([](const Point<dim> &, double *r) {
        for (unsigned int k = 0; k < bone_layout<dim>().size; ++k)
          r[k] = 0.4 + 0.0317 * k;
      });
      // Every node, boundary nodes too.
      const NodalVector    x_new = s.moved([](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = 0.02 * noise(p, d) + 0.3 * p[d];
        return m;
      });
      const TransferReport report =
        s.transfer->transfer(*s.store, s.configuration->positions(), x_new);
      s.for_each([](const double *r) {
        for (unsigned int k = 0; k < bone_layout<dim>().size; ++k)
          EXPECT_EQ(r[k], 0.4 + 0.0317 * k);
      });
      EXPECT_LT(report.geometric_conservation_error, 1e-14);
      EXPECT_GE(report.n_subcycles, 1u);
      EXPECT_EQ(report.n_limited, 0u);
      // All that is new came through the boundary with the own value.
      EXPECT_GT(report.through_boundary, 0.1);
      EXPECT_NEAR(report.error(), 0., 1e-14 * report.content_after);
    }
}

TEST(SweptTransfer, UniformStateStaysToTheLastBit)
{
  uniform_state_stays<2>(1);
  uniform_state_stays<2>(2);
  uniform_state_stays<3>(1);
  uniform_state_stays<3>(2);
}

// Neighbours that see their common face turned or mirrored: a wrong pair of
// sub-cells there would break the conservation law, which throws.
template <int dim>
void
any_orientation(
  const std::function<void(parallel::distributed::Triangulation<dim> &)> &grid)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<dim> s(degree, grid);
      s.fill_noise();
      const NodalVector    x = s.moved([](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = 0.03 * noise(p, d);
        return m;
      });
      const TransferReport report =
        s.transfer->transfer(*s.store, s.configuration->positions(), x);
      EXPECT_LT(report.geometric_conservation_error, 1e-14);
      EXPECT_NEAR(report.error(), 0., 1e-14 * report.content_before);
    }
}

TEST(SubCells, AnyOrientation)
{
  for (unsigned int turn = 0; turn < 4; ++turn)
    any_orientation<2>([=](parallel::distributed::Triangulation<2> &t) {
      GridGenerator::non_standard_orientation_mesh(t, turn);
    });
  for (unsigned int i = 0; i < 16; ++i)
    any_orientation<3>([=](parallel::distributed::Triangulation<3> &t) {
      GridGenerator::non_standard_orientation_mesh(
        t, i & 1, i & 2, i & 4, i & 8);
    });
}

// Volumes and centroids against deal.II's own mapping and the divergence
// theorem; first moments obey the same conservation law as volumes.
template <int dim>
void
geometry(const unsigned int degree)
{
  Problem<dim>         s(degree, &ball<dim>);
  const SubCells<dim> &cells = s.transfer->subcells();
  const NodalVector    x_0   = s.configuration->positions();
  const NodalVector    x_1   = s.moved([degree](const Point<dim> &p) {
    Tensor<1, dim> m;
    for (unsigned int d = 0; d < dim; ++d)
      m[d] = 0.03 / (degree * degree) * noise(p, d) + 0.1;
    return m;
  });

  std::vector<double> volume, volume_0, swept;
  cells.volumes(x_1, volume);
  s.configuration->set_positions(x_1);
  FEValues<dim> fe_values(s.configuration->mapping(),
                          s.configuration->fe,
                          QGauss<dim>(2 * degree + 1),
                          update_JxW_values);
  for (const auto &cell : s.configuration->dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        fe_values.reinit(cell);
        double exact = 0., sum = 0.;
        for (const double JxW : fe_values.get_JxW_values())
          exact += JxW;
        for (unsigned int q = 0; q < cells.n_points; ++q)
          sum += volume[cell->active_cell_index() * cells.n_points + q];
        EXPECT_NEAR(sum / exact, 1., 1e-13);
      }

  std::vector<Point<dim>>     centroid_0, centroid_1;
  std::vector<Tensor<1, dim>> moment;
  cells.centroids(x_0, centroid_0, volume_0);
  cells.centroids(x_1, centroid_1, volume);
  cells.swept_volumes(x_0, x_1, swept);
  cells.swept_moments(x_0, x_1, moment);
  for (const unsigned int c : cells.owned_cells())
    for (unsigned int i = c * cells.n_points; i < (c + 1) * cells.n_points; ++i)
      {
        double         gain = 0.;
        Tensor<1, dim> moment_gain;
        for (unsigned int f = 0; f < cells.faces_per_sub_cell; ++f)
          {
            const auto &incidence = cells.incidences(i)[f];
            if (incidence.face == SubCells<dim>::none)
              continue;
            const double sign = incidence.side == 0 ? 1. : -1.;
            EXPECT_EQ(cells.faces()[incidence.face].sub_cell[incidence.side],
                      i);
            gain += sign * swept[incidence.face];
            moment_gain += sign * moment[incidence.face];
          }
        EXPECT_NEAR((volume_0[i] + gain) / volume[i], 1., 1e-14);
        for (unsigned int d = 0; d < dim; ++d)
          EXPECT_NEAR(volume_0[i] * centroid_0[i][d] + moment_gain[d],
                      volume[i] * centroid_1[i][d],
                      1e-14 * volume[i]);
      }
}

TEST(SubCells, Geometry)
{
  geometry<2>(1);
  geometry<2>(2);
  geometry<3>(1);
  geometry<3>(2);
}

template <int dim>
void
content_stays(const unsigned int degree)
{
  Problem<dim> s(degree, &cube<dim>), sub_cycled(degree, &cube<dim>, 0.04);
  s.fill_noise();
  const std::vector<double> start = s.store->old_values;
  const NodalVector         x_0   = s.configuration->positions();
  const NodalVector         x_1   = s.shaken(0.2 / (dim == 2 ? 8 : 4) / degree);
  const TransferReport      report = s.transfer->transfer(*s.store, x_0, x_1);
  EXPECT_EQ(report.through_boundary, 0.);
  EXPECT_NEAR(report.content_after / report.content_before, 1., 2e-15);
  EXPECT_LT(report.geometric_conservation_error, 1e-14);
  EXPECT_NE(start, s.store->old_values);

  // The same in several sub-cycles: conservative too, but another result.
  sub_cycled.fill_noise();
  const TransferReport fine =
    sub_cycled.transfer->transfer(*sub_cycled.store, x_0, x_1);
  EXPECT_GT(fine.n_subcycles, 4 * report.n_subcycles);
  EXPECT_NEAR(fine.content_after / fine.content_before, 1., 4e-15);
  EXPECT_EQ(fine.content_before, report.content_before);
  EXPECT_NE(sub_cycled.store->old_values, s.store->old_values);

  // No new extrema of any component, through many motions.
  const unsigned int  size = s.store->layout(0).size;
  std::vector<double> low(size, 1e9), high(size, -1e9);
  s.fill_noise();
  s.for_each([&](const double *r) {
    for (unsigned int k = 0; k < size; ++k)
      {
        low[k]  = std::min(low[k], r[k]);
        high[k] = std::max(high[k], r[k]);
      }
  });
  for (unsigned int k = 0; k < size; ++k)
    {
      low[k]  = Utilities::MPI::min(low[k], MPI_COMM_WORLD);
      high[k] = Utilities::MPI::max(high[k], MPI_COMM_WORLD);
    }
  NodalVector from = x_0, to;
  from.update_ghost_values();
  for (unsigned int step = 0; step < 10; ++step)
    {
      to = s.shaken(0.2 / (dim == 2 ? 8 : 4) / degree, step);
      s.transfer->transfer(*s.store, from, to);
      from = to;
      from.update_ghost_values();
    }
  s.for_each([&](const double *r) {
    for (unsigned int k = 0; k < size; ++k)
      {
        EXPECT_GE(r[k], low[k] - 1e-14);
        EXPECT_LE(r[k], high[k] + 1e-14);
      }
  });
}

TEST(SweptTransfer, ContentAndBounds)
{
  content_stays<2>(1);
  content_stays<2>(2);
  content_stays<3>(1);
  content_stays<3>(2);
}

// All components are moved by the same linear operator.
TEST(SweptTransfer, ComponentsMoveTogether)
{
  Problem<2> s(1, &cube<2>);
  s.fill([](const Point<2> &p, double *r) {
    r[0] = 1.1 + 0.5 * noise(p, 1);
    for (unsigned int k = 1; k < bone_layout<2>().size; ++k)
      r[k] = (1. + k) * r[0] - 0.2 * (k - 1.);
  });
  s.transfer->transfer(*s.store, s.configuration->positions(), s.shaken(0.02));
  s.for_each([](const double *r) {
    for (unsigned int k = 1; k < bone_layout<2>().size; ++k)
      EXPECT_NEAR(r[k], (1. + k) * r[0] - 0.2 * (k - 1.), 1e-13);
  });
}

// The right side of a square moves out by 1/100: exactly density x area enters.
TEST(SweptTransfer, MovingBoundaryIsBooked)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2> s(degree, &cube<2>);
      s.fill(
        [](const Point<2> &p, double *r) { r[0] = p[1] < 0.5 ? 0.5 : 1.5; });
      const NodalVector x_1 = s.moved([](const Point<2> &p) {
        Tensor<1, 2> m;
        m[0] = p[0] > 1. - 1e-10 ? 0.01 : 0.;
        return m;
      });
      TransferReport    report =
        s.transfer->transfer(*s.store, s.configuration->positions(), x_1);
      EXPECT_NEAR(report.content_before, 1., 1e-14);
      EXPECT_NEAR(report.through_boundary, 0.01, 1e-15);
      EXPECT_NEAR(report.content_after, 1.01, 1e-14);
      report =
        s.transfer->transfer(*s.store, x_1, s.configuration->positions());
      EXPECT_NEAR(report.through_boundary, -0.01, 1e-15);
    }
}

// The interface between two regions moves: each keeps its own density, and the
// balance books what was gained and lost.
template <int dim>
void
two_regions()
{
  Problem<dim> s(1, [](parallel::distributed::Triangulation<dim> &t) {
    cube<dim>(t);
    for (const auto &cell : t.active_cell_iterators())
      cell->set_material_id(cell->center()[0] < 0.5 ? 0 : 1);
  });
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    for (unsigned int q = 0; q < s.store->n_points; ++q)
      s.store->old_record(c, q)[0] = s.store->region(c) == 0 ? 1.7 : 0.4;
  const NodalVector    x_1 = s.moved([](const Point<dim> &p) {
    Tensor<1, dim> m;
    m[0] = std::abs(p[0] - 0.5) < 1e-10 ? 0.02 : 0.;
    return m;
  });
  const TransferReport report =
    s.transfer->transfer(*s.store, s.configuration->positions(), x_1);
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    for (unsigned int q = 0; q < s.store->n_points; ++q)
      EXPECT_EQ(s.store->old_record(c, q)[0],
                s.store->region(c) == 0 ? 1.7 : 0.4);
  EXPECT_NEAR(report.through_boundary, 0.02 * (1.7 - 0.4), 1e-15);
  EXPECT_NEAR(report.content_after, 1.7 * 0.52 + 0.4 * 0.48, 1e-14);
  EXPECT_NEAR(report.error(), 0., 1e-15);
}

TEST(SweptTransfer, RegionsNeverMix)
{
  two_regions<2>();
  two_regions<3>();
}

/**
 * Strip of cells of width 1 along @p direction; its interior nodes shift by
 * c x (sub-cell width 1/2), with a bump far from the ends.
 */
template <int dim>
Problem<dim>
strip(const unsigned int direction)
{
  return Problem<dim>(
    1,
    [=](parallel::distributed::Triangulation<dim> &t) {
      std::vector<unsigned int> n(dim, 1);
      Point<dim>                end;
      for (unsigned int d = 0; d < dim; ++d)
        end[d] = 1.;
      n[direction]   = 24;
      end[direction] = 24.;
      GridGenerator::subdivided_hyper_rectangle(t, n, Point<dim>(), end);
    },
    1.);
}

template <int dim>
NodalVector
shifted(const Problem<dim> &s, const unsigned int direction, const double shift)
{
  return s.moved([=](const Point<dim> &p) {
    Tensor<1, dim> m;
    if (p[direction] > 1e-10 && p[direction] < 24. - 1e-10)
      m[direction] = shift;
    return m;
  });
}

template <int dim>
double
bump(const Point<dim> &p, const unsigned int direction)
{
  const double x = p[direction] - 12.;
  return std::abs(x) < 2. ? 1. + 0.2 * x + 0.3 * std::sin(3. * x) : 0.;
}

template <int dim>
void
numerical_diffusion(const unsigned int direction)
{
  Problem<dim> s = strip<dim>(direction);
  s.fill([=](const Point<dim> &p, double *r) {
    r[1] = bump(p, direction); // a field with the bound 0
  });
  // Content, mean place and variance of the bump on the mesh at x.
  const auto moments = [&](const NodalVector &x) {
    std::vector<Point<dim>> centroid;
    std::vector<double>     volume;
    s.transfer->subcells().centroids(x, centroid, volume);
    std::array<std::vector<double>, 3> m;
    for (const unsigned int c : s.transfer->subcells().owned_cells())
      for (unsigned int q = 0; q < s.store->n_points; ++q)
        {
          const unsigned int i       = c * s.store->n_points + q;
          const double       content = volume[i] * s.store->old_record(c, q)[1];
          const double       place   = centroid[i][direction] - 12.;
          m[0].push_back(content);
          m[1].push_back(content * place);
          m[2].push_back(content * place * place);
        }
    const double m0 = reproducible_sum(m[0], MPI_COMM_WORLD);
    const double m1 = reproducible_sum(m[1], MPI_COMM_WORLD) / m0;
    const double m2 = reproducible_sum(m[2], MPI_COMM_WORLD) / m0;
    return std::array<double, 3>{{m0, m1, m2 - m1 * m1}};
  };

  const double      c = 0.3, h = 0.5;
  const NodalVector x_0   = s.configuration->positions();
  const NodalVector x_1   = shifted(s, direction, c * h);
  const auto        start = moments(x_0);
  for (unsigned int step = 1; step <= 6; ++step)
    {
      const bool           there = step % 2 == 1;
      const TransferReport report =
        s.transfer->transfer(*s.store, there ? x_0 : x_1, there ? x_1 : x_0);
      ASSERT_EQ(report.n_subcycles, 1u);
      const auto now = moments(there ? x_1 : x_0);
      // Upwinding keeps content and mean place and adds c(1-c)h^2 to the
      // variance, i.e. a diffusivity of c(1-c)h^2/2 per step.
      EXPECT_NEAR(now[0], start[0], 1e-14);
      EXPECT_NEAR(now[1], start[1], 1e-14);
      EXPECT_NEAR(now[2] - start[2], step * c * (1. - c) * h * h, 1e-13);
    }
}

TEST(Godunov, NumericalDiffusion)
{
  numerical_diffusion<2>(0);
  numerical_diffusion<2>(1);
  numerical_diffusion<3>(0);
  numerical_diffusion<3>(1);
  numerical_diffusion<3>(2);
}

template <int dim>
void
exact_shift(const unsigned int direction)
{
  // The mesh moves by one sub-cell: at the same place the same value.
  Problem<dim> s = strip<dim>(direction);
  s.fill([=](const Point<dim> &p, double *r) { r[1] = bump(p, direction); });
  // The last interior sub-cell would close: Courant number 1 inside only.
  const NodalVector    x_1 = s.moved([=](const Point<dim> &p) {
    Tensor<1, dim> m;
    const double   x = p[direction];
    m[direction] = x < 4. ? 0.125 * x : (x > 20. ? 0.125 * (24. - x) : 0.5);
    return m;
  });
  const TransferReport report =
    s.transfer->transfer(*s.store, s.configuration->positions(), x_1);
  EXPECT_EQ(report.n_subcycles, 1u);
  std::vector<Point<dim>> centroid;
  std::vector<double>     volume;
  s.transfer->subcells().centroids(x_1, centroid, volume);
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    for (unsigned int q = 0; q < s.store->n_points; ++q)
      EXPECT_NEAR(s.store->old_record(c, q)[1],
                  bump(centroid[c * s.store->n_points + q], direction),
                  1e-14);
}

TEST(Godunov, ExactShift)
{
  exact_shift<2>(0);
  exact_shift<2>(1);
  exact_shift<3>(0);
  exact_shift<3>(2);
}

// A smooth field under a vortex motion of the mesh: the error against the field
// itself is of first order in the cell size when the steps shrink with it.
TEST(Godunov, ObservedOrder)
{
  const auto field = [](const Point<2> &p) {
    return 1. + 0.5 * std::sin(3. * p[0] + 1.) * std::cos(2. * p[1]);
  };
  std::vector<double> errors;
  for (const unsigned int n : {16, 32, 64})
    {
      Problem<2> s(1, [n](parallel::distributed::Triangulation<2> &t) {
        GridGenerator::subdivided_hyper_cube(t, n);
      });
      const auto at = [&](const double t) {
        return s.moved([t](const Point<2> &p) {
          const double bubble =
            std::sin(numbers::PI * p[0]) * std::sin(numbers::PI * p[1]);
          return 0.25 * std::sin(2. * numbers::PI * t) * bubble *
                 Tensor<1, 2>({0.5 - p[1], p[0] - 0.5});
        });
      };
      s.fill([&](const Point<2> &p, double *r) { r[0] = field(p); });
      NodalVector from = at(0.), to;
      for (unsigned int step = 1; step <= n; ++step)
        {
          to = at(step * 0.6 / n);
          s.transfer->transfer(*s.store, from, to);
          from = to;
          from.update_ghost_values();
        }
      std::vector<Point<2>> centroid;
      std::vector<double>   volume, error;
      s.transfer->subcells().centroids(from, centroid, volume);
      for (const unsigned int c : s.transfer->subcells().owned_cells())
        for (unsigned int i = c * 4; i < c * 4 + 4; ++i)
          error.push_back(
            volume[i] *
            std::abs(s.store->old_record(c, i % 4)[0] - field(centroid[i])));
      errors.push_back(reproducible_sum(error, MPI_COMM_WORLD));
    }
  EXPECT_GT(std::log2(errors[0] / errors[1]), 0.85);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 0.9);
}

// Same bits on one process and on all of them.
template <int dim>
void
same_on_any_number_of_processes(const unsigned int degree)
{
  Problem<dim> all(degree, &cube<dim>);
  Problem<dim> one(degree, &cube<dim>, 0.5, MPI_COMM_SELF);
  std::map<std::string, std::vector<double>> reference;
  std::vector<TransferReport>                reports;
  for (Problem<dim> *s : {&one, &all})
    {
      s->fill_noise();
      const NodalVector x = s->moved([](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = (dim == 2 ? 0.02 : 0.04) * noise(p, d);
        return m;
      });
      reports.push_back(
        s->transfer->transfer(*s->store, s->configuration->positions(), x));
      for (const auto &cell : s->mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const double *begin =
              s->store->old_record(cell->active_cell_index(), 0);
            const std::vector<double> values(
              begin, begin + s->store->n_points * s->store->layout(0).size);
            if (s == &one)
              reference[cell->id().to_string()] = values;
            else
              EXPECT_EQ(values, reference.at(cell->id().to_string()));
          }
    }
  EXPECT_EQ(reports[0].n_subcycles, reports[1].n_subcycles);
  EXPECT_EQ(reports[0].content_before, reports[1].content_before);
  EXPECT_EQ(reports[0].content_after, reports[1].content_after);
  EXPECT_EQ(reports[0].through_boundary, reports[1].through_boundary);
}

TEST(SweptTransfer, SameOnAnyNumberOfProcesses)
{
  same_on_any_number_of_processes<2>(1);
  same_on_any_number_of_processes<2>(2);
  same_on_any_number_of_processes<3>(1);
}

TEST(SweptTransfer, LimitedValuesAreCounted)
{
  Problem<2> s(1, &cube<2>);
  s.fill([](const Point<2> &p, double *r) {
    r[0] = p[0] < 0.25 ? 2. : (p[0] > 0.75 ? 1.9 * (1. + 1e-15) : 1.);
  });
  const TransferReport report =
    s.transfer->transfer(*s.store, s.configuration->positions(), s.shaken(0.));
  EXPECT_EQ(report.n_subcycles, 0u);
  EXPECT_EQ(report.n_limited, 2u * 8u * 4u); // not the excess of 1e-15
  s.for_each([](const double *r) { EXPECT_LE(r[0], 1.9); });
}

TEST(SweptTransfer, Errors)
{
  const auto refined = [](parallel::distributed::Triangulation<2> &t) {
    cube<2>(t);
    for (const auto &cell : t.active_cell_iterators())
      if (cell->is_locally_owned() && cell->center().norm() < 0.2)
        cell->set_refine_flag();
    t.execute_coarsening_and_refinement();
  };
  EXPECT_THROW(Problem<2>(2, refined), InputError);
  const auto unknown = [](parallel::distributed::Triangulation<2> &t) {
    cube<2>(t);
    for (const auto &cell : t.active_cell_iterators())
      if (cell->center().norm() < 0.2)
        cell->set_material_id(7);
  };
  EXPECT_THROW(Problem<2>(1, unknown), InputError);
  EXPECT_THROW(Problem<2>(1, &cube<2>, 1.5), InputError);
  EXPECT_THROW(Registry<TransferScheme<2>>::create("Lagrange", "Scheme"),
               InputError);
  EXPECT_FALSE(
    Registry<TransferScheme<3>>::create("Godunov", "Scheme")->has_correction());
  // A mesh turned inside out on the way.
  Problem<2> s(1, &cube<2>);
  EXPECT_THROW(s.transfer->transfer(*s.store,
                                    s.configuration->positions(),
                                    s.shaken(0.5)),
               RunError);
}

// Ghost records are those of the owners.
TEST(HistoryStore, Ghosts)
{
  Problem<3> s(1, &cube<3>);
  for (const auto &cell : s.mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned())
      for (unsigned int q = 0; q < 8; ++q)
        s.store->old_record(cell->active_cell_index(), q)[3] =
          cell->center()[0] + 10. * cell->center()[1] +
          100. * cell->center()[2] + 1000. * q;
  s.store->update_ghosts();
  unsigned int n_ghosts = 0;
  for (const auto &cell : s.mesh.triangulation->active_cell_iterators())
    if (cell->is_ghost())
      {
        ++n_ghosts;
        for (unsigned int q = 0; q < 8; ++q)
          EXPECT_EQ(s.store->old_record(cell->active_cell_index(), q)[3],
                    cell->center()[0] + 10. * cell->center()[1] +
                      100. * cell->center()[2] + 1000. * q);
      }
  EXPECT_EQ(n_ghosts > 0, Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1);
  s.store->trial_values.assign(s.store->trial_values.size(), 3.);
  s.store->commit();
  EXPECT_EQ(s.store->old_record(s.transfer->subcells().owned_cells()[0], 1)[2],
            3.);
}

TEST(ReproducibleSum, OrderDoesNotMatter)
{
  const unsigned int  rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int  n    = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::vector<double> forward, backward;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      const double v = noise(Point<2>(i, 0.), 3) * std::pow(10., i % 12);
      if (i % n == rank)
        forward.push_back(v);
      if (i % n == n - 1 - rank)
        backward.insert(backward.begin(), v);
    }
  const double sum = reproducible_sum(forward, MPI_COMM_WORLD);
  EXPECT_EQ(sum, reproducible_sum(backward, MPI_COMM_WORLD));
  // Cancellation to the last bit: 1e20 + 1 - 1e20 = 1.
  std::vector<double> cancelling;
  if (rank == 0)
    cancelling = {1e20, 1.};
  if (rank == n - 1)
    cancelling.push_back(-1e20);
  EXPECT_EQ(reproducible_sum(cancelling, MPI_COMM_WORLD), 1.);
  EXPECT_EQ(reproducible_sum({}, MPI_COMM_WORLD), 0.);
  EXPECT_TRUE(std::isnan(reproducible_sum({1., std::nan("")}, MPI_COMM_WORLD)));
}

template <int dim>
void
trace_projection(const unsigned int degree)
{
  Problem<dim> s(degree, &cube<dim>);
  s.fill_noise();
  const NodalVector  x      = s.shaken(0.03 / degree);
  const unsigned int n      = s.store->n_points;
  const unsigned int offset = s.store->layout(0).offset("elastic strain");
  const std::vector<double>  start = s.store->old_values;
  const TraceProjection<dim> projection(s.transfer->subcells());
  projection.apply(*s.store, x, {0, 1});

  std::vector<double> volume;
  s.transfer->subcells().volumes(x, volume);
  const QGauss<dim> gauss(degree + 1);
  const auto        trace = [](const double *h) { return h[0] + h[1] + h[2]; };
  const std::size_t size  = s.store->layout(0).size;
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    {
      const double *before = start.data() + s.store->offsets()[c] + offset;
      double        content_before = 0., content_after = 0., total = 0.;
      std::array<double, dim> residual{};
      for (unsigned int q = 0; q < n; ++q)
        {
          const double *h_0 = before + q * size;
          const double *h   = s.store->old_record(c, q) + offset;
          const double  v   = volume[c * n + q];
          total += v;
          content_before += v * trace(h_0);
          content_after += v * trace(h);
          // What was taken away is orthogonal to the polynomials.
          for (unsigned int d = 0; d < dim; ++d)
            residual[d] += v * gauss.point(q)[d] * (trace(h) - trace(h_0));
          // The deviator stays.
          for (unsigned int k = 0; k < size - offset; ++k)
            {
              const bool diagonal = k < 3;
              EXPECT_NEAR(h[k] - (diagonal ? trace(h) / 3. : 0.),
                          h_0[k] - (diagonal ? trace(h_0) / 3. : 0.),
                          1e-14);
            }
          if (degree == 1)
            {
              EXPECT_NEAR(trace(h),
                          trace(s.store->old_record(c, 0) + offset),
                          1e-14);
            }
        }
      EXPECT_NEAR(content_after, content_before, 1e-14 * total);
      for (unsigned int d = 0; d < (degree == 2 ? dim : 0); ++d)
        EXPECT_NEAR(residual[d], 0., 1e-14 * total);
    }
  // A polynomial in the unit coordinates stays as it is.
  const auto field = [&](const unsigned int q) {
    double value = 0.2;
    if (degree == 2)
      for (unsigned int d = 0; d < dim; ++d)
        value += (0.1 + d) * gauss.point(q)[d];
    return value;
  };
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    for (unsigned int q = 0; q < n; ++q)
      {
        double *h = s.store->old_record(c, q) + offset;
        h[0]      = field(q);
        h[1]      = 0.5;
        h[2]      = -0.5;
      }
  projection.apply(*s.store, x, {0});
  for (const unsigned int c : s.transfer->subcells().owned_cells())
    for (unsigned int q = 0; q < n; ++q)
      EXPECT_NEAR(trace(s.store->old_record(c, q) + offset), field(q), 1e-13);
}

TEST(TraceProjection, KeepsContentAndDeviator)
{
  trace_projection<2>(1);
  trace_projection<2>(2);
  trace_projection<3>(1);
  trace_projection<3>(2);
}

// Not a check but a measurement: one transfer of about 1000 cells.
TEST(SweptTransfer, Cost)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2> s(degree, [](parallel::distributed::Triangulation<2> &t) {
        GridGenerator::subdivided_hyper_cube(t, 32);
      });
      s.fill_noise();
      const NodalVector x_0  = s.configuration->positions();
      const NodalVector x_1  = s.shaken(0.001);
      double            best = 1e9;
      for (unsigned int i = 0; i < 20; ++i)
        {
          Timer                timer;
          const TransferReport report = s.transfer->transfer(*s.store,
                                                             i % 2 ? x_1 : x_0,
                                                             i % 2 ? x_0 : x_1);
          best                        = std::min(best, timer.wall_time());
          EXPECT_EQ(report.n_subcycles, 1u);
        }
      if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << "one transfer, 1024 cells of degree " << degree << ", "
                  << s.store->layout(0).size << " values: " << 1e3 * best
                  << " ms" << std::endl;
    }
}
