// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// What limited transfer must not do, on the same connectivity and by overlap:
// change uniform states, lose content, exceed bounds, mix regions, depend on
// the number of processes.
#include "two_ways_problem.h"

#include <deal.II/base/timer.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  template <int dim>
  void
  ball(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::hyper_ball_balanced(t);
    t.refine_global(dim == 2 ? 2 : 1);
  }
} // namespace

// Every scheme: a uniform state to the last bit.
template <int dim>
void
uniform_state_stays(const unsigned int degree)
{
  for (const Way way : both_ways)
    {
      if (way == Way::overlap && dim == 3 && degree == 2)
        continue; // slow
      Problem<dim> s(way, second, degree, &ball<dim>);
      s.for_each([](const Point<dim> &, double, double *r) {
        for (unsigned int k = 0; k < bone_layout<dim>().size; ++k)
          r[k] = 0.4 + 0.0317 * k;
      });
      for (unsigned int step = 0; step < (dim == 2 && degree == 1 ? 20 : 2);
           ++step)
        s.move(s.positions([=](const Point<dim> &p) {
          Tensor<1, dim> x = p;
          for (unsigned int d = 0; d < dim; ++d)
            x[d] += 0.01 / degree * noise(p, d + step);
          return x;
        }));
      s.for_each([](const Point<dim> &, double, const double *r) {
        for (unsigned int k = 0; k < bone_layout<dim>().size; ++k)
          EXPECT_EQ(r[k], 0.4 + 0.0317 * k);
      });
    }
}

TEST(LimitedLinear, UniformStateStaysToTheLastBit)
{
  uniform_state_stays<2>(1);
  uniform_state_stays<2>(2);
  uniform_state_stays<3>(1);
}

// Content to round-off, and no new extrema of scalars and norms of tensors,
// through many motions of a field without any smoothness.
template <int dim>
void
content_and_bounds(const unsigned int degree)
{
  for (const Way way : both_ways)
    for (const double donor_fraction : {0.5, 0.04})
      {
        if (way == Way::overlap && donor_fraction < 0.5)
          continue;
        Problem<dim>       s(way,
                       second,
                       degree,
                       cube<dim>(n_cells<dim>),
                       MPI_COMM_WORLD,
                       donor_fraction);
        const unsigned int n    = n_values(Shape::symmetric_tensor, dim);
        const auto         norm = [&](const double *t) {
          return unpack(t, dim).norm();
        };
        s.fill_noise();
        double low = 1e9, high = 0., largest_norm[2] = {0., 0.};
        s.for_each([&](const Point<dim> &, double, double *r) {
          low  = std::min(low, r[0]);
          high = std::max(high, r[0]);
          for (unsigned int i = 0; i < 2; ++i)
            largest_norm[i] = std::max(largest_norm[i], norm(r + 1 + i * n));
        });
        low  = Utilities::MPI::min(low, MPI_COMM_WORLD);
        high = Utilities::MPI::max(high, MPI_COMM_WORLD);
        for (double &l : largest_norm)
          l = Utilities::MPI::max(l, MPI_COMM_WORLD);
        for (unsigned int step = 0; step < (dim == 2 ? 10 : 3); ++step)
          {
            const Moved moved = s.move(
              s.positions(shaken<dim>(0.2 / n_cells<dim> / degree, step)));
            EXPECT_NEAR(moved.content_after / moved.content_before, 1., 1e-13);
            EXPECT_EQ(moved.n_limited, 0u);
          }
        s.for_each([&](const Point<dim> &, double, double *r) {
          EXPECT_GE(r[0], low - 1e-14);
          EXPECT_LE(r[0], high + 1e-14);
          for (unsigned int i = 0; i < 2; ++i)
            EXPECT_LE(norm(r + 1 + i * n), largest_norm[i] * (1. + 1e-14));
          for (const double value : spectral(unpack(r + 1 + n, dim)).values)
            EXPECT_LE(std::abs(value), fabric_bound * (1. + 1e-14));
        });
      }
}

TEST(LimitedLinear, ContentAndBounds)
{
  content_and_bounds<2>(1);
  content_and_bounds<2>(2);
  content_and_bounds<3>(1);
}

// A thousand transfers with values at their bounds: nothing has to be brought
// back into bounds.
TEST(LimitedLinear, ThousandTransfers)
{
  Problem<2> s(Way::swept, second, 1, cube<2>(5));
  s.fill_noise();
  s.for_each([](const Point<2> &p, double, double *r) {
    r[0] = noise(p, 1) > 0. ? 1.9 : 0.3;
  });
  double start = 0.;
  for (unsigned int step = 0; step < 1000; ++step)
    {
      const Moved moved = s.move(s.positions(shaken<2>(0.02, step)));
      if (step == 0)
        start = moved.content_before;
      EXPECT_EQ(moved.n_limited, 0u);
      EXPECT_NEAR(moved.content_after / start, 1., 1e-13);
    }
  s.for_each([](const Point<2> &, double, const double *r) {
    EXPECT_GE(r[0], 0.3);
    EXPECT_LE(r[0], 1.9);
    const auto fabric = spectral(unpack(r + 5, 2)).values;
    EXPECT_LE(fabric[0], fabric_bound * (1. + 1e-12));
    EXPECT_GE(fabric[2], -fabric_bound * (1. + 1e-12));
  });
}

// Tensors that are multiples of one tensor are limited like the scalar.
TEST(LimitedLinear, TensorsLikeScalars)
{
  for (const Way way : both_ways)
    {
      Problem<2> s(way, second, 1, cube<2>(8));
      s.for_each([](const Point<2> &p, double, double *r) {
        r[0] = 1.1 + 0.7 * noise(p, 1);
        for (unsigned int k = 1; k < 9; ++k)
          r[k] = (k - 3.3) * r[0];
      });
      for (unsigned int step = 1; step < 6; ++step)
        s.move(s.positions(shaken<2>(0.02, step)));
      s.for_each([](const Point<2> &, double, const double *r) {
        for (unsigned int k = 1; k < 9; ++k)
          EXPECT_NEAR(r[k], (k - 3.3) * r[0], 1e-13);
      });
    }
}

// Regions never mix, and the reconstruction does not look across.
template <int dim>
void
two_regions()
{
  for (const Way way : both_ways)
    {
      Problem<dim> s(way,
                     second,
                     1,
                     [](parallel::distributed::Triangulation<dim> &t) {
                       cube<dim>(n_cells<dim>)(t);
                       for (const auto &cell : t.active_cell_iterators())
                         cell->set_material_id(cell->center()[0] < 0.5 ? 0 : 1);
                     });
      const auto   region = [](const Point<dim> &p) { return p[0] < 0.5; };
      s.for_each([&](const Point<dim> &p, double, double *r) {
        r[0] = region(p) ? 1.7 : 0.4;
      });
      s.move(s.positions([&](const Point<dim> &p) {
        if (std::abs(p[0] - 0.5) < 1e-10)
          return Tensor<1, dim>(p);
        return shaken<dim>(0.2 / n_cells<dim>)(p);
      }));
      s.for_each([&](const Point<dim> &p, double, const double *r) {
        EXPECT_EQ(r[0], region(p) ? 1.7 : 0.4);
      });
    }
}

TEST(LimitedLinear, RegionsNeverMix)
{
  two_regions<2>();
  two_regions<3>();
}

// Same bits on one process and on all of them.
template <int dim>
void
same_on_any_number_of_processes(const unsigned int degree)
{
  for (const Way way : both_ways)
    {
      std::map<std::string, std::vector<double>> reference;
      for (const MPI_Comm communicator : {MPI_COMM_SELF, MPI_COMM_WORLD})
        {
          Problem<dim> s(
            way, second, degree, cube<dim>(n_cells<dim>), communicator);
          s.fill_noise();
          for (unsigned int step = 1; step < 3; ++step)
            s.move(s.positions(shaken<dim>(0.2 / n_cells<dim> / degree, step)));
          for (const auto &cell : s.mesh.triangulation->active_cell_iterators())
            if (cell->is_locally_owned())
              {
                const double *begin =
                  s.store->old_record(cell->active_cell_index(), 0);
                const std::vector<double> values(
                  begin, begin + s.store->n_points * s.store->layout(0).size);
                if (communicator == MPI_COMM_SELF)
                  reference[cell->id().to_string()] = values;
                else
                  EXPECT_EQ(values, reference.at(cell->id().to_string()));
              }
        }
    }
}

TEST(LimitedLinear, SameOnAnyNumberOfProcesses)
{
  same_on_any_number_of_processes<2>(1);
  same_on_any_number_of_processes<2>(2);
  same_on_any_number_of_processes<3>(1);
}

// Not a check but a measurement: one transfer of about 1000 cells.
TEST(LimitedLinear, Cost)
{
  for (const Way way : both_ways)
    for (const std::string &scheme : {first, second})
      for (const unsigned int degree : {1, 2})
        {
          Problem<2> s(way, scheme, degree, cube<2>(32));
          s.fill_noise();
          double best = 1e9;
          for (unsigned int i = 0; i < (way == Way::swept ? 6 : 2); ++i)
            {
              const NodalVector x = s.positions(shaken<2>(0.001, i));
              Timer             timer;
              s.move(x);
              best = std::min(best, timer.wall_time());
            }
          if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
            std::cout << (way == Way::swept ? "swept" : "overlap") << ", "
                      << scheme << ", 1024 cells of degree " << degree << ": "
                      << 1e3 * best << " ms" << std::endl;
        }
}
