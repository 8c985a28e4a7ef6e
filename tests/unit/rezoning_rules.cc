// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Rezoning rules on meshes whose new positions mathematics dictates, for
// degrees 1 and 2, and the rezoner that composes them.
#include "rezoning_bench.h"

#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/mesh/quality.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

template <int dim>
void
follow_fixed_material(const unsigned int degree)
{
  // The step shifts by (0.1, 0.2) and stretches a little.
  const Bench<dim> bench(unit_mesh<dim>(2), degree);
  const Map<dim>   f = [](const Point<dim> &X) {
    Point<dim> x = X;
    x[0] += 0.1 + 0.05 * X[1];
    x[1] += 0.2;
    return x;
  };
  const auto near = [](const double a, const double b) {
    return std::abs(a - b) < 1e-10;
  };
  const auto    lagrangian = bench.map(f);
  Rezoning<dim> run(bench);
  // Y follows X in x, although the material takes it further; the right
  // boundary follows Y, which a rule has moved before, in all components.
  run.add("follow", {{"On", "right"}, {"Leader", "Y"}});
  run.add("follow", {{"On", "Y"}, {"Leader", "X"}, {"Components", "x"}});
  run.add("fixed", {{"On", "M"}, {"Components", "y"}});
  run.add("material", {{"On", "O"}});
  run.add("fixed", {{"On", "left"}});
  const auto x = run(bench.initial, bench.initial, lagrangian);
  EXPECT_EQ(run.report.fraction, 1.);
  const Map<dim> expected = [&](const Point<dim> &X) {
    Point<dim>       x = f(X);
    const Point<dim> Y = Point<dim>::unit_vector(1), O;
    if (X.distance(Y) < 1e-10)
      x[0] = X[0] + 0.1;
    else if (X.distance(O) < 1e-10)
      x = f(X); // the rule of the point wins over that of the boundary
    else if (near(X[0], 0.))
      x = X;
    else if (near(X[0], 1.))
      {
        x = X;
        x[0] += 0.1;
        x[1] += 0.2;
      }
    bool centre = true;
    for (unsigned int c = 0; c < dim; ++c)
      centre = centre && near(X[c], 0.5);
    if (centre)
      x[1] = X[1];
    return x;
  };
  EXPECT_LT(bench.distance(x, expected), 1e-14);
  // The fixed node of the left boundary that is highest; in 2D Y is another's.
  const double height = dim == 2 ? 1. - 0.5 / degree : 1.;
  EXPECT_NEAR(run.report.largest_motion,
              std::hypot(0.1 + 0.05 * height, 0.2),
              1e-14);
}

TEST(Rules, FollowFixedMaterial)
{
  for (const unsigned int degree : {1, 2})
    {
      follow_fixed_material<2>(degree);
      follow_fixed_material<3>(degree);
    }
}

TEST(Rules, StraightKeepsSpacing)
{
  for (const unsigned int degree : {1, 2})
    {
      const Bench<2> bench(unit_mesh<2>(6), degree);
      // Graded towards the left, then a bulge, and the end X moves.
      const auto  graded     = bench.map([](const Point<2> &X) {
        return Point<2>((X[0] + X[0] * X[0]) / 2., X[1]);
      });
      const auto  lagrangian = bench.map([](const Point<2> &X) {
        return Point<2>((X[0] + X[0] * X[0]) / 2. + 0.02 * std::sin(9. * X[0]),
                        X[1] - 0.05 * std::sin(M_PI * X[0]));
      });
      Rezoning<2> run(bench);
      run.add("straight", {{"On", "bottom, top"}});
      const auto   x   = run(graded, graded, lagrangian);
      const double end = 1. + 0.02 * std::sin(9.);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_LT(bench.distance(
                  x,
                  [&](const Point<2> &X) {
                    return Point<2>(end * (X[0] + X[0] * X[0]) / 2., X[1]);
                  },
                  [](const Point<2> &X) {
                    return X[1] < 1e-10 || X[1] > 1. - 1e-10;
                  }),
                1e-14);

      // A point in between that follows divides the line.
      Mesh<2> mesh           = unit_mesh<2>(6);
      mesh.names.points["N"] = Point<2>(0.5, 0.);
      const Bench<2> bench_2(std::move(mesh), degree);
      const auto     bent = bench_2.map([](const Point<2> &X) {
        return Point<2>(X[0] + (is_inside(X) ? 0. : 0.03 * noise(X, 3)),
                        X[1] - 0.1 * X[0] * (1. - X[0]));
      });
      Rezoning<2>    run_2(bench_2);
      run_2.add("straight", {{"On", "bottom"}});
      run_2.add("fixed", {{"On", "N, O, X"}});
      EXPECT_LT(bench_2.distance(
                  run_2(bench_2.initial, bench_2.initial, bent),
                  [](const Point<2> &X) { return X; },
                  [](const Point<2> &X) { return X[1] < 1e-10; }),
                1e-14);
    }
}

TEST(Rules, SplineIsExactOnACubic)
{
  for (const unsigned int degree : {1, 2})
    {
      // The nodes of the bottom are at P(t) of a plane cubic with equidistant
      // t; they have to go to equal arc lengths on it.
      const Bench<2> bench(unit_mesh<2>(8), degree);
      const auto     P = [](const double t) {
        return Point<2>(t + 0.3 * t * t,
                        -0.4 * t + 0.9 * t * t - 0.5 * t * t * t);
      };
      const auto length = [](const double t) {
        const unsigned int n   = 2000;
        double             sum = 0.;
        const auto         v   = [](const double t) {
          return std::hypot(1. + 0.6 * t, -0.4 + 1.8 * t - 1.5 * t * t);
        };
        for (unsigned int i = 0; i < n; ++i)
          sum +=
            (v(i * t / n) + 4. * v((i + 0.5) * t / n) + v((i + 1) * t / n)) *
            t / n / 6.;
        return sum;
      };
      const auto  lagrangian = bench.map([&](const Point<2> &X) {
        return Point<2>((1. - X[1]) * P(X[0]) +
                        X[1] * Point<2>(1.3 * X[0], 1.));
      });
      Rezoning<2> run(bench);
      run.add("spline", {{"On", "bottom"}, {"Knots", "uniform"}});
      const auto x = run(bench.initial, bench.initial, lagrangian);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_GT(run.report.largest_motion, 1e-2);
      EXPECT_LT(bench.distance(
                  x,
                  [&](const Point<2> &X) {
                    double t = X[0];
                    for (unsigned int i = 0; i < 60; ++i)
                      t -=
                        (length(t) - X[0] * length(1.)) /
                        std::hypot(1. + 0.6 * t, -0.4 + 1.8 * t - 1.5 * t * t);
                    return P(t);
                  },
                  [](const Point<2> &X) { return X[1] < 1e-10; }),
                1e-12);
    }
}

TEST(Rules, SplineOnACircle)
{
  // A ring whose nodes have slid along the inner circle goes back to equal
  // arcs; the fixed node is the first one, at (-1, 0). Fourth order.
  for (const unsigned int degree : {1, 2})
    {
      double previous = 0.;
      for (const unsigned int n : {16, 32, 64})
        {
          Mesh<2> mesh = empty_mesh<2>();
          GridGenerator::hyper_shell(
            *mesh.triangulation, Point<2>(), 1., 2., n, true);
          mesh.names.boundaries = {{"inner", {0}}, {"outer", {1}}};
          const Bench<2> bench(std::move(mesh), degree);
          const auto     lagrangian = bench.map([](const Point<2> &X) {
            const double a = std::atan2(X[1], -X[0]);
            const double b = a + (2. - X.norm()) * 0.2 * std::sin(a);
            return Point<2>(-X.norm() * std::cos(b), X.norm() * std::sin(b));
          });
          Rezoning<2>    run(bench);
          run.add("spline", {{"On", "inner"}});
          const auto   x     = run(bench.initial, bench.initial, lagrangian);
          const double error = bench.distance(
            x,
            [](const Point<2> &X) { return X; },
            [](const Point<2> &X) { return X.norm() < 1.01; });
          EXPECT_EQ(run.report.fraction, 1.);
          if (previous > 0.)
            {
              EXPECT_NEAR(std::log2(previous / error), 4., 0.6);
            }
          else
            {
              EXPECT_LT(error, 1e-2 / degree);
            }
          previous = error;

          // An undeformed curve is left where it is.
          EXPECT_LT(
            bench.distance(run(bench.initial, bench.initial, bench.initial),
                           [](const Point<2> &X) { return X; }),
            1e-13);
        }
    }
}

namespace
{
  /** A general multilinear map. */
  template <int dim>
  Point<dim>
  multilinear(const Point<dim> &X)
  {
    Point<dim> x;
    for (unsigned int c = 0; c < dim; ++c)
      {
        x[c] = (1.5 + 0.2 * c) * X[c] + 0.3 * X[(c + 1) % dim] +
               0.2 * X[0] * X[1] * (c == 0 ? 1. : -1.);
        if (dim == 3)
          x[c] += 0.15 * X[0] * X[1] * X[2] + 0.1 * X[1] * X[2];
      }
    return x;
  }
} // namespace

template <int dim>
void
transfinite(const unsigned int degree)
{
  const Bench<dim> bench(unit_mesh<dim>(dim == 2 ? 6 : 4), degree);
  const auto       noisy = [](const Map<dim> &f) -> Map<dim> {
    return [f](const Point<dim> &X) {
      Point<dim> x = f(X);
      if (is_inside(X))
        x[0] += 0.02 * noise(X, 1);
      return x;
    };
  };
  // A graded block of bilinear shape, whatever the material did inside
  Rezoning<dim> run(bench);
  run.add("transfinite", {{"On", "all"}});
  const Map<dim> target = [](const Point<dim> &X) {
    return multilinear(grade(X));
  };
  const auto x =
    run(bench.map(grade<dim>), bench.map(grade<dim>), bench.map(noisy(target)));
  EXPECT_EQ(run.report.fraction, 1.);
  EXPECT_LT(bench.distance(x, target), 1e-14);

  // A block with any mesh inside and any border stays as it is, and follows
  // affine motions.
  const Map<dim> odd = [](const Point<dim> &X) {
    Point<dim> x = grade(X);
    for (unsigned int c = 0; c < dim; ++c)
      x[c] += 0.05 * std::sin(3. * X[0] + 2. * X[1] + 4. * X[dim - 1] + c);
    return x;
  };
  const Map<dim> affine = [&](const Point<dim> &X) {
    const Point<dim> x = odd(X);
    Point<dim>       y;
    y[0]       = 0.6 * x[0] - 0.8 * x[1] + 3.;
    y[1]       = 1.2 * x[0] + 0.9 * x[1];
    y[dim - 1] = y[dim - 1] + (dim == 3 ? x[2] + 0.1 * x[0] : 0.);
    return y;
  };
  const auto    odd_start = bench.map(odd);
  Rezoning<dim> run_odd(bench);
  run_odd.add("transfinite", {{"On", "left block, right block"}});
  EXPECT_LT(bench.distance(run_odd(odd_start, odd_start, odd_start), odd),
            1e-14);
  EXPECT_LT(bench.distance(
              run_odd(odd_start, odd_start, bench.map([&](const Point<dim> &X) {
                Point<dim> x = affine(X);
                if (is_inside(X) && std::abs(X[0] - 0.5) > 1e-10)
                  x[1] += 0.01 * noise(X, 5);
                return x;
              })),
              affine),
            1e-13);
  EXPECT_EQ(run_odd.report.fraction, 1.);
}

TEST(Rules, Transfinite)
{
  for (const unsigned int degree : {1, 2})
    {
      transfinite<2>(degree);
      transfinite<3>(degree);
    }
}

TEST(Rules, TransfiniteRefusesWhatIsNoBlock)
{
  // An L has five corners, a ring none.
  Mesh<2> corner = empty_mesh<2>();
  GridGenerator::hyper_L(*corner.triangulation);
  corner.triangulation->refine_global(1);
  corner.names.regions["all"] = {0};
  Mesh<2> ring                = empty_mesh<2>();
  GridGenerator::hyper_shell(*ring.triangulation, Point<2>(), 1., 2., 8);
  ring.names.regions["all"] = {0};
  const Bench<2> bench(std::move(corner), 1), bench_ring(std::move(ring), 1);
  for (const auto *b : {&bench, &bench_ring})
    {
      Rezoning<2> run(*b);
      run.add("transfinite", {{"On", "all"}});
      EXPECT_THROW(run(b->initial, b->initial, b->initial), InputError);
    }
}

template <int dim>
void
giuliani_regular(const unsigned int degree)
{
  const Bench<dim> bench(unit_mesh<dim>(4), degree);
  for (unsigned int shape = 0; shape < 3; ++shape)
    {
      // Square, rectangle, parallelogram
      const Map<dim> regular = [shape](const Point<dim> &X) {
        Point<dim> x = X;
        if (shape > 0)
          x[0] *= 3.;
        if (shape > 1)
          {
            x[0] += 0.7 * X[1];
            x[dim - 1] += dim == 3 ? 0.4 * X[0] + 0.3 * X[1] : 0.;
          }
        return x;
      };
      Rezoning<dim> run(bench);
      run.add("Giuliani",
              {{"On", "all"},
               {"Tolerance", "1e-13"},
               {"Largest number of sweeps", "5000"}});
      const auto start = bench.map(regular);
      EXPECT_LT(bench.distance(run(start, start, start), regular), 1e-14);
      EXPECT_EQ(run.report.sweeps, 1u);

      // What the material did inside is forgotten.
      const auto x = run(start, start, bench.map([&](const Point<dim> &X) {
        return regular(perturbed<dim>(0.06 / degree, shape)(X));
      }));
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      EXPECT_GT(run.report.largest_motion, 0.02);
      EXPECT_LT(bench.distance(x, regular), 3e-12);
    }
}

TEST(Rules, GiulianiLeavesAndRecoversRegularMeshes)
{
  for (const unsigned int degree : {1, 2})
    {
      giuliani_regular<2>(degree);
      giuliani_regular<3>(degree);
    }
}

TEST(Rules, GiulianiMinimisesShearAndSqueeze)
{
  // One inner node: a sweep without relaxation minimises the sum of the
  // squares of offsets along the bases and of the deviations from the heights
  // that give the triangles the mean area; checked by differences.
  const Bench<2> bench(unit_mesh<2>(2), 1);
  const Map<2>   f = [](const Point<2> &X) {
    return Point<2>(X[0] + 0.2 * X[1] * X[1], X[1] - 0.3 * X[0] * (1. - X[0]));
  };
  const auto  lagrangian = bench.map([&](const Point<2> &X) {
    return is_inside(X) ? Point<2>(0.5, 0.55) : f(X);
  });
  Rezoning<2> run(bench);
  run.add("Giuliani",
          {{"On", "all"},
           {"Shapes", "equal"},
           {"Tolerance", "1e-12"},
           {"Relaxation", "1"}});
  const auto x = run(bench.initial, bench.initial, lagrangian);
  const auto P = bench.nodes.gather(x, {bench.nodes.point("M", "")})[0];

  const std::array<Point<2>, 4> ring = {
    {f({1., 0.5}), f({0.5, 1.}), f({0., 0.5}), f({0.5, 0.})}};
  const auto cross = [](const Tensor<1, 2> &a, const Tensor<1, 2> &b) {
    return a[0] * b[1] - a[1] * b[0];
  };
  double area = 0.; // of the polygon of neighbours
  for (unsigned int i = 0; i < 4; ++i)
    area += 0.5 * cross(ring[i], ring[(i + 1) % 4]);
  const auto functional = [&](const Point<2> &P) {
    double sum = 0.;
    for (unsigned int i = 0; i < 4; ++i)
      {
        const Tensor<1, 2> base   = ring[(i + 1) % 4] - ring[i];
        const Tensor<1, 2> above  = P - (ring[i] + 0.5 * base);
        const double       offset = above * base / base.norm();
        const double       height = cross(base, above) / base.norm();
        const double       goal   = 2. * area / 4. / base.norm();
        sum += offset * offset + (height - goal) * (height - goal);
      }
    return sum;
  };
  const double h = 1e-3; // the functional is quadratic: differences are exact
  for (unsigned int c = 0; c < 2; ++c)
    {
      const Tensor<1, 2> d = h * Point<2>::unit_vector(c);
      EXPECT_NEAR((functional(P + d) - functional(P - d)) / (2. * h),
                  0.,
                  1e-12);
      EXPECT_GT(functional(P + d), functional(P));
    }
}

template <int dim>
void
giuliani_respects(const unsigned int degree)
{
  // Two regions: their interface is the material's. A fixed point inside, too.
  Mesh<dim>  mesh        = unit_mesh<dim>(4);
  Point<dim> quarter     = mesh.names.points["M"];
  quarter[0]             = 0.25;
  mesh.names.points["Q"] = quarter;
  const Bench<dim> bench(std::move(mesh), degree);
  const auto       f          = perturbed<dim>(0.06 / degree, 8);
  const auto       lagrangian = bench.map(f);
  Rezoning<dim>    run(bench);
  run.add("Giuliani", {{"On", "left block, right block"}});
  run.add("fixed", {{"On", "Q"}});
  const auto x = run(bench.initial, bench.initial, lagrangian);
  EXPECT_EQ(run.report.fraction, 1.);
  EXPECT_EQ(run.report.unconverged_rules, 0u);
  EXPECT_LT(bench.distance(x,
                           f,
                           [](const Point<dim> &X) {
                             return std::abs(X[0] - 0.5) < 1e-10;
                           }),
            1e-15);
  EXPECT_LT(bench.distance(
              x,
              [](const Point<dim> &X) { return X; },
              [&](const Point<dim> &X) { return X.distance(quarter) < 1e-10; }),
            1e-15);
  // Others did move.
  EXPECT_GT(run.report.largest_motion, 1e-2);
}

TEST(Rules, GiulianiRespectsInterfacesAndOtherRules)
{
  for (const unsigned int degree : {1, 2})
    {
      giuliani_respects<2>(degree);
      giuliani_respects<3>(degree);
    }
}

template <int dim>
void
giuliani_accelerated(const unsigned int n)
{
  // Sheared: an affine image of the mesh at attach is what both end at.
  const Bench<dim> bench(unit_mesh<dim>(n), 1);
  const Map<dim>   sheared = [](const Point<dim> &X) {
    Point<dim> x = X;
    x[0] += 0.5 * X[1];
    return x;
  };
  const auto                  lagrangian = bench.map([&](const Point<dim> &X) {
    return sheared(perturbed<dim>(0.2 / n, 1)(X));
  });
  std::array<unsigned int, 2> sweeps;
  for (unsigned int k = 0; k < 2; ++k)
    {
      Rezoning<dim> run(bench);
      run.add("Giuliani",
              {{"On", "all"},
               {"Tolerance", "1e-10"},
               {"Iteration", k == 0 ? "Jacobi" : "Chebyshev"},
               {"Largest number of sweeps", "5000"}});
      const auto x = run(bench.initial, bench.initial, lagrangian);
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      EXPECT_LT(bench.distance(x, sheared), 1e-8);
      sweeps[k] = run.report.sweeps;
    }
  EXPECT_LT(3 * sweeps[1], sweeps[0]);
}

TEST(Rules, GiulianiIsAcceleratedByChebyshev)
{
  giuliani_accelerated<2>(20);
  giuliani_accelerated<3>(12);
  const Bench<2> bench(unit_mesh<2>(4), 1);
  Rezoning<2>    run(bench);
  run.add("Giuliani",
          {{"On", "all"}, {"Shapes", "equal"}, {"Iteration", "Chebyshev"}});
  EXPECT_THROW(run(bench.initial, bench.initial, bench.initial), InputError);
}

TEST(Rules, GiulianiCountsWhenItDoesNotConverge)
{
  const Bench<2> bench(unit_mesh<2>(8), 1);
  Rezoning<2>    run(bench);
  run.add("Giuliani",
          {{"On", "all"},
           {"Tolerance", "1e-10"},
           {"Largest number of sweeps", "3"}});
  run(bench.initial, bench.initial, bench.map(perturbed<2>(0.03, 1)));
  EXPECT_EQ(run.report.sweeps, 3u);
  EXPECT_EQ(run.report.unconverged_rules, 1u);
}

TEST(Rezoner, NeverReturnsAnInvertedMesh)
{
  // Strongly disturbed, but valid meshes with moved borders
  unsigned int n_valid = 0;
  for (const unsigned int degree : {1, 2})
    for (unsigned int seed = 0; seed < 60; ++seed)
      {
        const Bench<2> bench(unit_mesh<2>(5), degree);
        const auto     lagrangian = bench.map([&](const Point<2> &X) {
          Point<2> x = X;
          for (unsigned int c = 0; c < 2; ++c)
            x[c] += (is_inside(X) ? 0.09 : 0.06) / degree * noise(X, seed + c);
          return x;
        });
        const auto     before = mesh_quality(bench.configuration, lagrangian);
        if (before.smallest_scaled_jacobian <= 0. ||
            before.smallest_point_jacobian <= 0.)
          continue;
        ++n_valid;
        Rezoning<2> run(bench);
        run.add("Giuliani",
                {{"On", "all"},
                 {"Shapes", seed % 2 == 0 ? "initial" : "equal"}});
        const auto x     = run(bench.initial, bench.initial, lagrangian);
        const auto after = mesh_quality(bench.configuration, x);
        EXPECT_GT(after.smallest_scaled_jacobian, 0.);
        EXPECT_GT(after.smallest_point_jacobian, 0.);
        EXPECT_EQ(run.report.smallest_quality, after.smallest_scaled_jacobian);
      }
  EXPECT_GT(n_valid, 30u);
}

namespace
{
  /** Moves the point M by a given vector, at a given stage. */
  template <int dim>
  class PushRule : public RezoningRule<dim>
  {
  public:
    using Stage = typename RezoningRule<dim>::Stage;

    PushRule(const Tensor<1, dim> &shift)
      : shift(shift)
    {}
    void
    declare_parameters(ParameterHandler &) override
    {}
    Stage
    stage(const NamedSets<dim> &, const std::string &) const override
    {
      return Stage::volumes;
    }
    void
    attach(const Nodes<dim> &nodes,
           const NodalVector &,
           const std::set<NodeId> &taken_now,
           const std::string &) override
    {
      touched = {nodes.point("M", "")};
      taken   = taken_now;
    }
    void
    apply(const Nodes<dim> &nodes,
          const NodalVector &,
          const NodalVector &lagrangian,
          NodalVector       &proposed,
          RezoningReport &) const override
    {
      if (nodes.is_owned(touched[0]))
        nodes.set(proposed,
                  touched[0],
                  nodes.get(lagrangian, touched[0]) + shift);
      proposed.update_ghost_values();
    }
    const std::vector<NodeId> &
    touched_nodes() const override
    {
      return touched;
    }

    Tensor<1, dim>      shift;
    std::vector<NodeId> touched;
    std::set<NodeId>    taken;
  };
} // namespace

TEST(Rezoner, CutsBackWhatWouldInvert)
{
  const Bench<2> bench(unit_mesh<2>(4), 1);
  const auto     push = [&](const double shift, RezoningReport &report) {
    Rezoner<2> rezoner;
    rezoner.add(std::make_unique<PushRule<2>>(Point<2>(shift, 0.)), "push");
    rezoner.attach(bench.nodes, bench.initial);
    const auto x =
      rezoner.propose(bench.nodes, bench.initial, bench.initial, report);
    return bench.nodes.gather(x, {bench.nodes.point("M", "")})[0];
  };
  // The neighbour is 1/4 away. A motion by s of one corner of a square of side
  // h makes it concave at s = h for the corner pushed (h - s > 0).
  RezoningReport report;
  EXPECT_NEAR(push(0.24, report)[0], 0.74, 1e-15);
  EXPECT_EQ(report.fraction, 1.);
  EXPECT_FALSE(report.cut_back);
  EXPECT_NEAR(push(0.26, report)[0], 0.63, 1e-15);
  EXPECT_EQ(report.fraction, 0.5);
  EXPECT_TRUE(report.cut_back);
  EXPECT_NEAR(report.largest_motion, 0.13, 1e-15);
  EXPECT_NEAR(push(1.5, report)[0], 0.5 + 1.5 / 8., 1e-15);
  EXPECT_EQ(report.fraction, 0.125);
  EXPECT_NEAR(push(60., report)[0], 0.5 + 60. / 256., 1e-13);
  EXPECT_EQ(report.fraction, 1. / 256.);
  EXPECT_GT(report.smallest_quality, 0.);
  for (const double bad : {100., std::numeric_limits<double>::quiet_NaN()})
    {
      EXPECT_EQ(push(bad, report)[0], 0.5);
      EXPECT_EQ(report.fraction, 0.);
      EXPECT_TRUE(report.cut_back);
      EXPECT_EQ(report.largest_motion, 0.);
      EXPECT_NEAR(report.smallest_quality, 1., 1e-14);
    }
}

TEST(Rezoner, PrecedenceAndContradictions)
{
  const Bench<2> bench(unit_mesh<2>(4), 1);
  const auto     message = [&](Rezoning<2> &run) -> std::string {
    try
      {
        run(bench.initial, bench.initial, bench.initial);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  };
  const auto contains = [](const std::string &text, const std::string &part) {
    return text.find(part) != std::string::npos;
  };
  {
    // Two rules of one stage
    Rezoning<2> run(bench);
    run.add("straight", {{"On", "left"}}).add("spline", {{"On", "left"}});
    const std::string text = message(run);
    EXPECT_TRUE(contains(text, "Rezoning/straight1")) << text;
    EXPECT_TRUE(contains(text, "Rezoning/spline2")) << text;
  }
  {
    // One rule that names a curve twice
    Rezoning<2> run(bench);
    run.add("straight", {{"On", "left, left"}});
    EXPECT_TRUE(contains(message(run), "its own sets"));
  }
  {
    // Different components of a node are no contradiction; nor are stages.
    Rezoning<2> run(bench);
    run.add("follow", {{"On", "X"}, {"Leader", "O"}, {"Components", "x"}})
      .add("fixed", {{"On", "X"}, {"Components", "y"}})
      .add("fixed", {{"On", "bottom"}})
      .add("straight", {{"On", "right"}})
      .add("Giuliani", {{"On", "all"}});
    EXPECT_EQ(message(run), "");
    run.add("follow", {{"On", "Y, X"}, {"Leader", "O"}, {"Components", "y"}});
    EXPECT_TRUE(contains(message(run), "Rezoning/fixed2"));
  }
  {
    // Nodes of earlier stages are announced to later ones on every process.
    Rezoning<2> run(bench);
    run.add("fixed", {{"On", "bottom"}}).add("fixed", {{"On", "O, M"}});
    auto        push  = std::make_unique<PushRule<2>>(Point<2>());
    const auto &taken = push->taken;
    run.rezoner.add(std::move(push), "push");
    EXPECT_EQ(message(run), "");
    EXPECT_EQ(taken.size(), 6u);
  }
  // Names
  for (const auto &wrong : std::vector<std::pair<std::string, Settings>>{
         {"fixed", {}},
         {"fixed", {{"On", "nothing"}}},
         {"follow", {{"On", "X"}, {"Leader", "W"}}},
         {"follow", {{"On", "X"}, {"Leader", "X"}}},
         {"follow", {{"On", "X"}, {"Leader", "O"}, {"Components", "z"}}},
         {"straight", {{"On", "around"}}},
         {"straight", {{"On", "O"}}},
         {"transfinite", {{"On", "bottom"}}},
         {"Giuliani", {{"On", "bottom"}}}})
    {
      Rezoning<2> run(bench);
      run.add(wrong.first, wrong.second);
      EXPECT_TRUE(contains(message(run), "Rezoning/" + wrong.first + "1"))
        << wrong.first << ": " << message(run);
    }
}

// After the rules hanging nodes are in the middle again; degree 2 is refused.
TEST(Rezoner, HangingNodes)
{
  const auto refined = []() {
    Mesh<2> mesh = unit_mesh<2>(2);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && cell->center()[0] < 0.5 &&
          cell->center()[1] < 0.5)
        cell->set_refine_flag();
    mesh.triangulation->execute_coarsening_and_refinement();
    return mesh;
  };
  const Bench<2> bench(refined(), 1);
  Rezoning<2>    run(bench);
  run.add("Giuliani", {{"On", "all"}, {"Shapes", "equal"}});
  NodalVector x = run(bench.initial, bench.initial, bench.initial);
  x.update_ghost_values();
  NodalVector constrained(x);
  constrained.update_ghost_values();
  HangingNodes<2>(bench.configuration).distribute(constrained);
  for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
    EXPECT_NEAR(x.local_element(i), constrained.local_element(i), 1e-15);

  const Bench<2> quadratic(refined(), 2);
  Rezoning<2>    refused(quadratic);
  refused.add("Giuliani", {{"On", "all"}});
  EXPECT_THROW(refused(quadratic.initial, quadratic.initial, quadratic.initial),
               InputError);
}
