// SPDX-License-Identifier: LGPL-2.1-or-later
// Cubic splines against curves known in closed form.
#include <alveolus/base/errors.h>
#include <alveolus/geometry/cubic_spline.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Spline = CubicSpline<2>;

  Point<2>
  cubic(const double t)
  {
    return {1. + 2. * t - t * t + 0.5 * t * t * t, -t + 3. * t * t - t * t * t};
  }

  /** Length of the cubic up to t by the composite rule of Simpson. */
  double
  cubic_length(const double t)
  {
    const auto speed = [](const double t) {
      return std::hypot(2. - 2. * t + 1.5 * t * t, -1. + 6. * t - 3. * t * t);
    };
    const unsigned int n   = 1000;
    const double       h   = t / n;
    double             sum = 0.;
    for (unsigned int i = 0; i < n; ++i)
      sum += h / 6. *
             (speed(i * h) + 4. * speed((i + 0.5) * h) + speed((i + 1) * h));
    return sum;
  }

  Point<2>
  circle(const double angle)
  {
    return {3. * std::cos(angle), 3. * std::sin(angle)};
  }
} // namespace

TEST(CubicSpline, ReproducesACubicWithItsParameter)
{
  const std::vector<double> t = {0., 0.3, 0.4, 0.9, 1.3, 2.};
  std::vector<Point<2>>     p;
  for (const double x : t)
    p.push_back(cubic(x));
  const Spline spline(p, t, Spline::Ends::not_a_knot);
  for (double x = 0.; x <= 2.; x += 0.0625)
    {
      EXPECT_LT(spline.value(x).distance(cubic(x)), 1e-14);
      EXPECT_NEAR(spline.derivative(x)[0], 2. - 2. * x + 1.5 * x * x, 1e-13);
      EXPECT_NEAR(spline.arc_length(x), cubic_length(x), 1e-9);
    }

  // Four equidistant points with uniform knots are a cubic, too.
  const Spline uniform({cubic(0.), cubic(0.5), cubic(1.), cubic(1.5)},
                       Spline::Ends::not_a_knot,
                       Spline::Knots::uniform);
  EXPECT_LT(uniform.value(1.1).distance(cubic(0.55)), 1e-14);
}

TEST(CubicSpline, FewPointsAndNaturalEnds)
{
  // Two points: the segment; three: the parabola.
  const Spline segment({Point<2>(0., 0.), Point<2>(3., 4.)});
  EXPECT_NEAR(segment.length(), 5., 1e-14);
  EXPECT_LT(segment.at_arc_length(2.).distance(Point<2>(1.2, 1.6)), 1e-14);
  const Spline parabola({Point<2>(0., 0.), Point<2>(1., 1.), Point<2>(3., 9.)},
                        {0., 1., 3.},
                        Spline::Ends::not_a_knot);
  EXPECT_LT(parabola.value(2.).distance(Point<2>(2., 4.)), 1e-14);

  // Natural spline through the sine-like points 0, 1, 0 with knots 0, 1, 2:
  // the cubic (3t - t^3)/2 on [0, 1] and its mirror image.
  const Spline natural({Point<2>(0., 0.), Point<2>(1., 1.), Point<2>(2., 0.)},
                       {0., 1., 2.},
                       Spline::Ends::natural);
  EXPECT_NEAR(natural.value(0.5)[1], 0.6875, 1e-15);
  EXPECT_NEAR(natural.value(1.5)[1], 0.6875, 1e-15);
}

TEST(CubicSpline, FourthOrderOnACircle)
{
  // Open arc of unevenly spaced points, and the whole circle closed: radius
  // and length converge with order 4.
  double previous_open = 0., previous_closed = 0., previous_length = 0.;
  for (const unsigned int n : {16, 32, 64})
    {
      const auto angle = [&](const unsigned int i) {
        const double x = double(i) / n;
        return 2. * M_PI * (x + 0.05 * std::sin(2. * M_PI * x));
      };
      std::vector<Point<2>> arc, ring;
      for (unsigned int i = 0; i <= n; ++i)
        arc.push_back(circle(0.5 * angle(i)));
      for (unsigned int i = 0; i < n; ++i)
        ring.push_back(circle(angle(i)));
      const Spline open(arc), closed(ring, Spline::Ends::closed);
      double       error_open = 0., error_closed = 0.;
      for (unsigned int k = 0; k < 1000; ++k)
        {
          const double x = (k + 0.5) / 1000.;
          error_open =
            std::max(error_open,
                     std::abs(open.value(x * open.knots().back()).norm() - 3.));
          error_closed =
            std::max(error_closed,
                     std::abs(closed.value(x * closed.knots().back()).norm() -
                              3.));
        }
      const double error_length = std::abs(closed.length() - 6. * M_PI);
      if (previous_open > 0.)
        {
          EXPECT_NEAR(std::log2(previous_open / error_open), 4., 0.5);
          EXPECT_NEAR(std::log2(previous_closed / error_closed), 4., 0.3);
          EXPECT_NEAR(std::log2(previous_length / error_length), 4., 0.3);
        }
      RecordProperty("error closed " + std::to_string(n),
                     std::to_string(error_closed));
      previous_open   = error_open;
      previous_closed = error_closed;
      previous_length = error_length;
      // Periodic also in the derivative
      EXPECT_LT((closed.derivative(0.) -
                 closed.derivative(closed.knots().back()))
                  .norm(),
                1e-12);
    }
}

TEST(CubicSpline, RelocationToArcLengths)
{
  std::vector<double>   t;
  std::vector<Point<2>> p;
  for (unsigned int i = 0; i <= 10; ++i)
    {
      t.push_back(0.2 * i);
      p.push_back(cubic(t.back()));
    }
  const Spline spline(p, t, Spline::Ends::not_a_knot);
  for (double fraction = 0.; fraction <= 1.; fraction += 0.05)
    {
      const double target    = fraction * spline.length();
      const double parameter = spline.parameter_at(target);
      EXPECT_NEAR(spline.arc_length(parameter), target, 1e-13);
      EXPECT_NEAR(cubic_length(parameter), target, 1e-9);
    }
  EXPECT_LT(spline.at_arc_length(0.).distance(p.front()), 1e-14);
  EXPECT_LT(spline.at_arc_length(spline.length()).distance(p.back()), 1e-13);
  EXPECT_THROW(spline.parameter_at(1.01 * spline.length()), RunError);
  EXPECT_THROW(spline.parameter_at(-0.01), RunError);

  // A closed curve goes round.
  std::vector<Point<2>> ring;
  for (unsigned int i = 0; i < 24; ++i)
    ring.push_back(circle(2. * M_PI * i / 24));
  const Spline closed(ring, Spline::Ends::closed);
  EXPECT_LT(closed.at_arc_length(-closed.length() / 4.).distance(ring[18]),
            1e-12);
  EXPECT_LT(closed.at_arc_length(closed.length() * 1.25).distance(ring[6]),
            1e-12);
}

TEST(CubicSpline, SpaceCurve)
{
  // A helix, exact length
  std::vector<Point<3>> p;
  for (unsigned int i = 0; i <= 100; ++i)
    {
      const double a = 0.1 * i;
      p.emplace_back(std::cos(a), std::sin(a), 0.5 * a);
    }
  const CubicSpline<3> spline(p);
  EXPECT_NEAR(spline.length(), 10. * std::sqrt(1.25), 1e-5);
}

TEST(CubicSpline, RefusesCoincidingAndMissingPoints)
{
  const Point<2> a(0., 0.), b(1., 0.);
  EXPECT_THROW(Spline({a, b, b}), RunError);
  EXPECT_THROW(Spline({a}), RunError);
  EXPECT_THROW(Spline({a, b}, Spline::Ends::closed), RunError);
}
