// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Transfer of history on the same connectivity: what conservation, uniform
// fields, moving boundaries and bounds dictate.
#include "swept_problem.h"

#include <alveolus/base/errors.h>

#include <deal.II/base/timer.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

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
