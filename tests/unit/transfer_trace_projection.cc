// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Projection of the strain's trace: content, deviator and polynomials stay.
#include "swept_problem.h"

#include <alveolus/transfer/trace_projection.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

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
