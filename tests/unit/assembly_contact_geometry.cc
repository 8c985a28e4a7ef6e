// SPDX-License-Identifier: LGPL-2.1-or-later
// Geometry of contact: derivatives of gap, foot, normal and offset against
// differences, gaps at the kinks of an outline and far from the origin.
#include "contact_bodies.h"

#include <alveolus/assembly/contact_gap.h>
#include <alveolus/assembly/contact_pair.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** A crooked outline of three edges as the top of a block. */
  struct Crooked
  {
    explicit Crooked(const unsigned int degree)
    {
      Blocks blocks;
      blocks.add("a", 3, 1, Point<2>(0., -1.), Point<2>(3., 0.));
      mesh          = blocks.build();
      configuration = std::make_unique<Configuration<2>>(mesh, degree);
      nodes         = std::make_unique<Nodes<2>>(*configuration);
      outline       = ContactOutline(*nodes, "a top", "test");
      positions     = outline.get(configuration->initial_positions());
      for (auto &x : positions)
        for (unsigned int d = 0; d < 2; ++d)
          x[d] += 0.07 * random();
    }

    double
    random()
    {
      return std::uniform_real_distribution<double>(-1., 1.)(generator);
    }

    /** Coordinate @p i of a patch with the point @p x. */
    double &
    coordinate(const ContactPatch &patch, const unsigned int i)
    {
      return i < 2 ? x[i] : positions[patch.nodes[i / 2 - 1]][i % 2];
    }

    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
    std::unique_ptr<Nodes<2>>         nodes;
    ContactOutline                    outline;
    std::vector<Point<2>>             positions;
    Point<2>                          x;
    std::mt19937                      generator{4711};
  };
} // namespace



// Gap, foot and normal over smoothed and sharp joints, straight lines and
// parabolas, on both sides: derivatives against differences. The foot is one,
// and the gap is that to the lines themselves.
TEST(ContactGap, DerivativesAreThoseOfDifferences)
{
  for (const unsigned int degree : {1, 2})
    for (const bool smooth : {true, false})
      for (unsigned int trial = 0; trial < 30; ++trial)
        {
          Crooked test(degree);
          test.generator.seed(trial);
          test.x =
            Point<2>(1.5 + 1.3 * test.random(), 0.1 * test.random() - 0.02);
          const std::vector<bool> joints(3, smooth);
          const auto              project = [&]() {
            return ContactSurface(test.outline, test.positions, joints)
              .project(test.x, Point<2>(0., -1.), {0, 1, 2});
          };
          const auto evaluate = [&]() {
            return ContactGap(test.x,
                              ContactSurface(test.outline,
                                             test.positions,
                                             joints),
                              project());
          };
          const ContactProjection projection = project();
          if (!projection.found())
            continue; // beyond the ends
          const ContactGap exact = evaluate();
          EXPECT_NEAR(exact.gap, projection.gap, 1e-15);
          EXPECT_LE((test.x -
                     test.outline.curve(projection.edge, test.positions)
                       .point(projection.xi) -
                     exact.gap * exact.normal)
                      .norm(),
                    1e-14);
          for (unsigned int i = 0; i < exact.patch.size(); ++i)
            {
              const double h       = 1e-6;
              double      &z       = test.coordinate(exact.patch, i);
              const double middle  = z;
              z                    = middle + h;
              const ContactGap p   = evaluate();
              const double     xi  = project().xi;
              z                    = middle - h;
              const ContactGap m   = evaluate();
              const double     dxi = xi - project().xi;
              z                    = middle;
              EXPECT_NEAR(exact.d_gap[i], (p.gap - m.gap) / (2. * h), 1e-8);
              EXPECT_NEAR(exact.d_foot[i], dxi / (2. * h), 1e-8);
              for (unsigned int d = 0; d < 2; ++d)
                EXPECT_NEAR(exact.d_normal[d][i],
                            (p.normal[d] - m.normal[d]) / (2. * h),
                            1e-8);
            }
        }
}



// First and second derivatives of the offset from a place on a line
TEST(ContactOffset, DerivativesAreThoseOfDifferences)
{
  for (const unsigned int degree : {1, 2})
    {
      Crooked test(degree);
      test.x              = Point<2>(1.4, 0.15);
      const auto evaluate = [&]() {
        const ContactSurface surface(test.outline,
                                     test.positions,
                                     std::vector<bool>(3, true));
        return ContactOffset(test.x, surface, 1, 0.3);
      };
      const ContactOffset exact = evaluate();
      for (unsigned int i = 0; i < exact.patch.size(); ++i)
        {
          const double h        = 1e-5;
          double      &z        = test.coordinate(exact.patch, i);
          const double middle   = z;
          z                     = middle + h;
          const ContactOffset p = evaluate();
          z                     = middle - h;
          const ContactOffset m = evaluate();
          z                     = middle;
          for (const auto measure : {&ContactOffset::gap, &ContactOffset::slip})
            {
              EXPECT_NEAR((exact.*measure).gradient[i],
                          ((p.*measure).value - (m.*measure).value) / (2. * h),
                          1e-8);
              for (unsigned int j = 0; j < exact.patch.size(); ++j)
                EXPECT_NEAR((exact.*measure).hessian[j][i],
                            ((p.*measure).gradient[j] -
                             (m.*measure).gradient[j]) /
                              (2. * h),
                            1e-7);
            }
        }
    }
}



namespace
{
  /** An outline of two edges from (-1, -slope) to the origin to (1, -slope). */
  struct Kink
  {
    explicit Kink(const double slope)
    {
      Blocks blocks;
      blocks.add("a", 2, 1, [=](const double s, const double t) {
        const double x = 2. * s - 1.;
        return Point<2>(x, t < 0.5 ? -3. : -slope * std::abs(x));
      });
      mesh          = blocks.build();
      configuration = std::make_unique<Configuration<2>>(mesh, 1);
      nodes         = std::make_unique<Nodes<2>>(*configuration);
      outline       = ContactOutline(*nodes, "a top", "test");
      positions     = outline.get(configuration->initial_positions());
    }

    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
    std::unique_ptr<Nodes<2>>         nodes;
    ContactOutline                    outline;
    std::vector<Point<2>>             positions;
  };
} // namespace



// Walking round a vertex, convex or concave, inside or outside, smoothed or
// sharp, the gap never jumps; at a smoothed one the normal does not either.
// Beyond the ends of the outline there is no gap.
TEST(ContactSurface, GapIsContinuousAtKinks)
{
  for (const bool smooth : {false, true})
    for (const double slope : {-0.8, -0.1, 0.1, 0.8})
      for (const double height : {-0.3, -0.01, 0.01, 0.3})
        {
          const Kink           kink(slope);
          const ContactSurface surface(kink.outline,
                                       kink.positions,
                                       {smooth, smooth});
          double               last = 0.;
          Tensor<1, 2>         last_normal;
          const Tensor<1, 2>   down({0., -1.});
          const double         step = 1e-3;
          for (double x = -0.5; x < 0.5; x += step)
            {
              const Point<2>          point(x, height - slope * std::abs(x));
              const ContactProjection found =
                surface.project(point, down, {0, 1});
              ASSERT_TRUE(found.found());
              const Tensor<1, 2> normal =
                ContactGap(point, surface, found).normal;
              if (x > -0.5)
                {
                  // The point moves by step*sqrt(1 + slope^2).
                  EXPECT_LE(std::abs(found.gap - last), 3. * step)
                    << slope << ' ' << height << ' ' << x;
                  if (smooth)
                    {
                      EXPECT_LE((normal - last_normal).norm(), 4. * step)
                        << slope << ' ' << height << ' ' << x;
                    }
                }
              EXPECT_GT(found.gap * height, 0.);
              last        = found.gap;
              last_normal = normal;
            }
          // Over the end of the right edge, and past it along the edge
          const Tensor<1, 2> along({1., -slope}), across({slope, 1.});
          const Point<2>     end(1., -slope);
          EXPECT_TRUE(
            surface.project(end - 0.01 * along + 0.1 * across, down, {0, 1})
              .found());
          EXPECT_FALSE(
            surface.project(end + 0.01 * along + 0.1 * across, down, {0, 1})
              .found());
        }
}



// Round-off of large coordinates does not keep a point from its foot.
TEST(ContactSurface, FeetAreFoundFarFromTheOrigin)
{
  for (const unsigned int degree : {1, 2})
    {
      Crooked test(degree);
      for (auto &x : test.positions)
        x = Point<2>(1000. + 0.05 * x[0], 2000. + 0.05 * x[1]);
      const ContactSurface surface(test.outline,
                                   test.positions,
                                   std::vector<bool>(3, true));
      for (unsigned int i = 0; i < 1000; ++i)
        {
          const Point<2> x(1000.01 + 1.3e-4 * i, 2000. + 0.001 * test.random());
          EXPECT_TRUE(surface.project(x, Point<2>(0., -1.), {0, 1, 2}).found())
            << x;
        }
    }
}
