// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The scheme of first order: numerical diffusion, exact shifts, observed order.
#include "swept_problem.h"

#include <alveolus/state/reproducible_sum.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

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
