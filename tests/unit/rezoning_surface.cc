// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The rule that smooths nodes on the surface they lie on: planes follow affine
// motions of their rim, nodes stay on a sphere, interfaces of blocks of the
// same material need not.
#include "rezoning_bench.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  bool
  near(const double a, const double b)
  {
    return std::abs(a - b) < 1e-10;
  }

  /** Zero on the edges of the unit square. */
  double
  bubble(const double x, const double z)
  {
    return 16. * x * (1. - x) * z * (1. - z);
  }

  const Map<3> affine = [](const Point<3> &X) {
    return Point<3>(0.2 + 1.1 * X[0] + 0.2 * X[2], 1. * X[1] - 0.1, 0.9 * X[2]);
  };
} // namespace

TEST(SurfaceRule, PlaneFollowsAffineMap)
{
  for (const unsigned int degree : {1, 2})
    {
      const Bench<3> bench(unit_mesh<3>(4), degree);
      const auto     graded     = bench.map(grade<3>);
      const auto     lagrangian = bench.map([](const Point<3> &X) {
        Point<3>   x = grade(X);
        const auto s = 0.03 * bubble(X[0], X[2]);
        if (near(X[1], 1.))
          x += Point<3>(s, 0., -s);
        return affine(x);
      });
      Rezoning<3>    run(bench);
      run.add("surface", {{"On", "top"}});
      const auto x = run(graded, graded, lagrangian);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_GT(run.report.largest_motion, 0.01);
      EXPECT_LT(
        bench.distance(x, [](const Point<3> &X) { return affine(grade(X)); }),
        1e-13);
    }
}

// The nodes of the top, on a sphere, have moved along it by a tenth of a cell;
// their rim has not: they go back to where they were. On the facets they would
// miss the sphere by the second order.
TEST(SurfaceRule, StaysOnSphere)
{
  const auto on_sphere = [](const double x, const double z) {
    return std::sqrt(4. - (x - 0.5) * (x - 0.5) - (z - 0.5) * (z - 0.5)) - 1.;
  };
  std::vector<double> errors;
  for (const unsigned int n : {6, 12})
    {
      const Bench<3> bench(unit_mesh<3>(n), 1);
      const Map<3>   start = [&](const Point<3> &X) {
        return Point<3>(X[0], X[1] * on_sphere(X[0], X[2]), X[2]);
      };
      const auto  lagrangian = bench.map([&](const Point<3> &X) {
        if (!near(X[1], 1.))
          return start(X);
        const double s = 0.1 / n * bubble(X[0], X[2]);
        return Point<3>(X[0] + s, on_sphere(X[0] + s, X[2] - s), X[2] - s);
      });
      Rezoning<3> run(bench);
      run.add("surface", {{"On", "top"}});
      const auto initial = bench.map(start);
      const auto x       = run(initial, initial, lagrangian);
      errors.push_back(bench.distance(x, start));
    }
  EXPECT_LT(errors[0], 2e-5);
  EXPECT_GT(errors[0] / errors[1], 6.);
}

TEST(SurfaceRule, Interface)
{
  const Bench<3> bench(unit_mesh<3>(4), 1);
  const auto     lagrangian = bench.map([](const Point<3> &X) {
    Point<3> x = affine(X);
    if (near(X[0], 0.5))
      x[0] += 0.1 * bubble(X[1], X[2]);
    return x;
  });
  const auto on_interface   = [](const Point<3> &X) { return near(X[0], 0.5); };
  for (const bool stays : {true, false})
    {
      Rezoning<3> run(bench);
      run.add("surface",
              {{"On", "left block|right block"},
               {"Stay on material", stays ? "true" : "false"}});
      const auto x = run(bench.initial, bench.initial, lagrangian);
      if (stays)
        EXPECT_GT(bench.distance(x, affine, on_interface), 0.05);
      else
        EXPECT_LT(bench.distance(x, affine), 1e-13);
    }
  Rezoning<3> unknown(bench);
  unknown.add("surface", {{"On", "left block|nothing"}});
  EXPECT_THROW(unknown(bench.initial, bench.initial, lagrangian), InputError);
}
