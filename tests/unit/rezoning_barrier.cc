// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The barrier smoother: its metric and energy against differences, what it has
// to keep exactly, and that it never inverts a cell, in 2D and 3D, for degrees
// 1 and 2.
#include "rezoning_bench.h"

#include <alveolus/mesh/quality.h>
#include <alveolus/rezoning/mesh_newton.h>

#include <deal.II/lac/lapack_full_matrix.h>
#include <deal.II/physics/transformations.h>

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <type_traits>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  /** Call f(dim, degree) for both dimensions and degrees. */
  template <typename Function>
  void
  for_all(const Function &f)
  {
    for (const unsigned int degree : {1, 2})
      {
        SCOPED_TRACE(degree);
        f(std::integral_constant<int, 2>(), degree);
        f(std::integral_constant<int, 3>(), degree);
      }
  }

  /** An invertible matrix far from the identity. */
  template <int dim>
  Tensor<2, dim>
  some_matrix()
  {
    Tensor<2, dim> T;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        T[i][j] = (i == j ? 1.1 + 0.3 * i : 0.) + 0.4 * std::sin(3. * i + j);
    return T;
  }

  template <int dim>
  Tensor<2, dim>
  rotation()
  {
    Tensor<2, dim> R;
    R[dim - 1][dim - 1] = 1.;
    R[0][0]             = 0.8;
    R[0][1]             = -0.6;
    R[1][0]             = 0.6;
    R[1][1]             = 0.8;
    if (dim == 3)
      {
        Tensor<2, dim> S;
        S[0][0]             = 1.;
        S[1][1]             = 5. / 13.;
        S[1][dim - 1]       = -12. / 13.;
        S[dim - 1][1]       = 12. / 13.;
        S[dim - 1][dim - 1] = 5. / 13.;
        R                   = S * R;
      }
    return R;
  }

  /** The affine map x -> F x + (3, 3, 3). */
  template <int dim>
  Map<dim>
  affine(const Tensor<2, dim> &F, const Map<dim> &before)
  {
    return [=](const Point<dim> &X) {
      Point<dim> x(F * before(X));
      for (unsigned int c = 0; c < dim; ++c)
        x[c] += 3.;
      return x;
    };
  }

  /** A smoothly distorted, curved unit cell, inside a little irregular. */
  template <int dim>
  Map<dim>
  curved(const double irregular = 0.)
  {
    return [=](const Point<dim> &X) {
      Point<dim> x = perturbed<dim>(irregular, 4)(X);
      Point<dim> y = x;
      for (unsigned int c = 0; c < dim; ++c)
        y[c] += 0.04 * std::sin(4. * x[(c + 1) % dim] + 2. * x[c] + c);
      return y;
    };
  }

  /** Energy of a bench whose inner nodes are free, and its system. */
  template <int dim>
  struct Optimisation
  {
    Optimisation(const Bench<dim>  &bench,
                 const NodalVector &targets,
                 const bool         keep_shapes,
                 const double       size_weight)
      : is_free(bench.configuration.make_vector())
    {
      is_free.zero_out_ghost_values();
      for (const NodeId node : bench.nodes.relevant())
        if (bench.nodes.is_owned(node) &&
            is_inside(bench.nodes.get(bench.initial, node)))
          for (const auto dof : bench.nodes.dofs(node))
            is_free(dof) = 1.;
      is_free.update_ghost_values();
      constraints.reinit(bench.configuration.locally_relevant);
      for (const auto dof : bench.configuration.locally_relevant)
        if (is_free(dof) == 0.)
          constraints.add_line(dof);
      constraints.close();
      energy = std::make_unique<MeshEnergy<dim>>(
        bench.nodes,
        targets,
        std::vector<std::set<types::material_id>>{{0, 1}},
        is_free,
        keep_shapes,
        ShapeMetric<dim>(size_weight),
        "test");
      system = make_linear_system(bench.configuration.dof_handler,
                                  constraints,
                                  "automatic",
                                  1e-12);
    }

    NodalVector                      is_free;
    AffineConstraints<double>        constraints;
    std::unique_ptr<MeshEnergy<dim>> energy;
    std::unique_ptr<LinearSystem>    system;
  };

  /** Keeps the whole matrix on every process, and every cell matrix. */
  class DenseSystem : public LinearSystem
  {
  public:
    DenseSystem(const unsigned int n)
      : matrix(n, n)
    {}
    void
    clear() override
    {
      matrix = 0.;
      cells.clear();
    }
    void
    add(const FullMatrix<double>                   &cell_matrix,
        const std::vector<types::global_dof_index> &dofs) override
    {
      cells.push_back(cell_matrix);
      for (unsigned int a = 0; a < dofs.size(); ++a)
        for (unsigned int b = 0; b < dofs.size(); ++b)
          matrix(dofs[a], dofs[b]) += cell_matrix(a, b);
    }
    void
    compress() override
    {
      const ArrayView<double> all(&matrix(0, 0), matrix.n_elements());
      Utilities::MPI::sum(ArrayView<const double>(all), MPI_COMM_WORLD, all);
    }
    void
    solve(NodalVector &, const NodalVector &) override
    {}
    std::string
    name() const override
    {
      return "dense";
    }

    FullMatrix<double>              matrix;
    std::vector<FullMatrix<double>> cells;
  };
} // namespace

template <int dim>
void
metric()
{
  // Known values
  Tensor<2, dim> stretched = unit_symmetric_tensor<dim>();
  stretched[0][0]          = 2.;
  const double shape       = dim == 2 ? 0.25 : std::sqrt(2.) - 1.;
  EXPECT_NEAR(ShapeMetric<dim>().value(stretched), shape, 1e-15);
  EXPECT_NEAR(ShapeMetric<dim>(0.4).value(stretched),
              0.6 * shape + 0.4 * 0.25,
              1e-15);
  EXPECT_NEAR(ShapeMetric<dim>().value(3. * rotation<dim>()), 0., 1e-14);
  EXPECT_NEAR(ShapeMetric<dim>(0.4).value(rotation<dim>()), 0., 1e-14);
  stretched[0][0] = 0.;
  EXPECT_EQ(ShapeMetric<dim>().value(stretched),
            std::numeric_limits<double>::infinity());
  stretched[0][0] = -1.;
  EXPECT_EQ(ShapeMetric<dim>().value(stretched),
            std::numeric_limits<double>::infinity());
  stretched[0][0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(ShapeMetric<dim>().value(stretched),
            std::numeric_limits<double>::infinity());

  const auto   T = some_matrix<dim>();
  const double h = 1e-5;
  ASSERT_GT(determinant(T), 0.2);
  for (const double weight : {0., 0.3})
    {
      const ShapeMetric<dim> mu(weight);
      const auto             P = mu.gradient(T);
      const auto             H = mu.hessian(T);
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          {
            Tensor<2, dim> dT;
            dT[i][j] = h;
            EXPECT_NEAR((mu.value(T + dT) - mu.value(T - dT)) / (2. * h),
                        P[i][j],
                        1e-9);
            const auto dP =
              (mu.gradient(T + dT) - mu.gradient(T - dT)) / (2. * h);
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int l = 0; l < dim; ++l)
                EXPECT_NEAR(dP[k][l], H[k][l][i][j], 1e-8);
          }
    }
}

TEST(Barrier, MetricAgainstDifferences)
{
  metric<2>();
  metric<3>();
}

template <int dim>
void
derivatives(const unsigned int degree)
{
  const Bench<dim>  bench(unit_mesh<dim>(2), degree);
  const NodalVector x = bench.map(curved<dim>(0.1 / degree));
  NodalVector       v = bench.map([](const Point<dim> &X) {
    Point<dim> v;
    for (unsigned int c = 0; c < dim; ++c)
      v[c] = noise(X, 3 + c);
    return v;
  });
  for (const bool keep_shapes : {true, false})
    for (const double weight : {0., 0.3})
      {
        const Optimisation<dim> problem(bench,
                                        bench.map(grade<dim>),
                                        keep_shapes,
                                        weight);
        problem.energy->fit_sizes(x);
        // x + a h v; differences of fourth order
        const double h     = 1e-4;
        const auto   moved = [&](const double a) {
          NodalVector y = x;
          for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
            y.local_element(i) += a * h * v.local_element(i);
          y.update_ghost_values();
          return y;
        };
        const std::array<std::pair<double, double>, 4> stencil = {
          {{1., 8.}, {-1., -8.}, {2., -1.}, {-2., 1.}}};

        // All nodes of the mesh move here, the fixed ones, too.
        NodalVector g(x), g_moved(x), dg(x);
        dg           = 0.;
        double slope = 0.;
        for (const auto &point : stencil)
          {
            const NodalVector y = moved(point.first);
            slope += point.second * problem.energy->value(y) / (12. * h);
            problem.energy->gradient(y, g_moved);
            dg.add(point.second / (12. * h), g_moved);
          }
        problem.energy->gradient(x, g);
        ASSERT_TRUE(std::isfinite(slope));
        EXPECT_NEAR(slope, g * v, 1e-9 * std::abs(slope));

        problem.energy->hessian_times(x, v, g_moved);
        g_moved -= dg;
        EXPECT_LT(g_moved.linfty_norm(), 1e-9 * dg.linfty_norm());

        DenseSystem system(x.size());
        problem.energy->hessian(x, system, false);
        double largest = 0.;
        for (unsigned int i = 0; i < x.size(); ++i)
          {
            double Hv = 0.;
            for (unsigned int j = 0; j < x.size(); ++j)
              if (x.in_local_range(j))
                Hv += system.matrix(i, j) * v(j);
            Hv = Utilities::MPI::sum(Hv, MPI_COMM_WORLD);
            if (x.in_local_range(i))
              largest = std::max(largest, std::abs(Hv - dg(i)));
          }
        EXPECT_LT(largest, 1e-9 * dg.linfty_norm());

        // Exact cell matrices have negative eigenvalues, the others do not,
        // and the sizes of the eigenvalues are the same.
        const auto exact = system.cells;
        problem.energy->hessian(x, system, true);
        double least = 0.;
        for (unsigned int c = 0; c < exact.size(); ++c)
          {
            std::array<std::vector<double>, 2> sizes;
            for (unsigned int k = 0; k < 2; ++k)
              {
                LAPACKFullMatrix<double> matrix(exact[c].m(), exact[c].n());
                matrix = k == 0 ? exact[c] : system.cells[c];
                FullMatrix<double> vectors(exact[c].m(), exact[c].n());
                Vector<double>     values(exact[c].m());
                matrix.compute_eigenvalues_symmetric(
                  -1e10, 1e10, 0., values, vectors);
                for (const double value : values)
                  {
                    if (k == 0)
                      least = std::min(least, value);
                    else
                      EXPECT_GT(value, -1e-12);
                    sizes[k].push_back(std::abs(value));
                  }
                std::sort(sizes[k].begin(), sizes[k].end());
              }
            for (unsigned int e = 0; e < sizes[0].size(); ++e)
              EXPECT_NEAR(sizes[0][e], sizes[1][e], 1e-11 * sizes[0].back());
          }
        EXPECT_LT(Utilities::MPI::min(least, MPI_COMM_WORLD), -1e-3);
      }
}

TEST(Barrier, EnergyAgainstDifferences)
{
  for_all([](const auto dim, const unsigned int degree) {
    derivatives<dim>(degree);
  });
}

template <int dim>
void
keeps_affine_images(const unsigned int degree)
{
  // Any mesh, with any border, and its image
  const Bench<dim> bench(unit_mesh<dim>(4), degree);
  const Map<dim>   some = [&](const Point<dim> &X) {
    return grade(curved<dim>(0.03 / degree)(X));
  };
  const auto image = affine<dim>(some_matrix<dim>(), some);
  for (const char *weight : {"0", "0.3"})
    {
      Rezoning<dim> run(bench);
      run.add("barrier",
              {{"On", "all"}, {"Size weight", weight}, {"Tolerance", "1e-7"}});
      const auto start = bench.map(some);
      EXPECT_LT(bench.distance(run(start, start, bench.map(image)), image),
                1e-12);
      EXPECT_EQ(run.report.sweeps, 1u);
      EXPECT_EQ(run.report.unconverged_rules, 0u);

      // The image is found again from elsewhere.
      const auto x = run(start, start, bench.map([&](const Point<dim> &X) {
        Point<dim> x = image(X);
        if (is_inside(X))
          for (unsigned int c = 0; c < dim; ++c)
            x[c] += 0.02 / degree / degree * noise(X, 5 + c);
        return x;
      }));
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_GT(run.report.largest_motion, 0.005);
      EXPECT_LT(bench.distance(x, image), 1e-11);
    }
}

TEST(Barrier, KeepsAffineImages)
{
  for_all([](const auto dim, const unsigned int degree) {
    keeps_affine_images<dim>(degree);
  });
}

template <int dim>
void
recovers_uniform(const unsigned int degree)
{
  // Equal squares fill a square, whatever the mesh was at the start.
  const Bench<dim> bench(unit_mesh<dim>(4), degree);
  const Map<dim>   uniform =
    affine<dim>(rotation<dim>(), [](const auto &X) { return X; });
  const Map<dim> rough = [&](const Point<dim> &X) {
    return uniform(perturbed<dim>(0.08 / degree / degree, 2)(X));
  };
  for (const char *weight : {"0", "0.5"})
    {
      Rezoning<dim> run(bench);
      run.add("barrier",
              {{"On", "all"},
               {"Shapes", "equal"},
               {"Size weight", weight},
               {"Tolerance", "1e-7"}});
      const auto lagrangian = bench.map(rough);
      const auto x          = run(lagrangian, lagrangian, lagrangian);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      EXPECT_LE(run.report.sweeps, 12u);
      EXPECT_LT(bench.distance(x, uniform), 1e-12);
    }
}

TEST(Barrier, RecoversUniformMeshes)
{
  for_all([](const auto dim, const unsigned int degree) {
    recovers_uniform<dim>(degree);
  });
}

template <int dim>
void
descends(const unsigned int degree)
{
  // From a barely valid mesh, one iteration after the other
  const unsigned int n = dim == 2 ? 8 : 4;
  const Bench<dim>   bench(unit_mesh<dim>(n), degree);
  for (const bool keep_shapes : {true, false})
    {
      double      amplitude = 0.5 / n;
      NodalVector x(bench.initial);
      const auto  quality = [&] {
        const auto q = mesh_quality(bench.configuration, x);
        return std::min(q.smallest_scaled_jacobian, q.smallest_point_jacobian);
      };
      Optimisation<dim> problem(bench, bench.initial, keep_shapes, 0.);
      const auto        start = [&] {
        x = bench.map(
          [&](const Point<dim> &X) { return curved<dim>(amplitude)(X); });
        problem.energy->fit_sizes(x);
        return problem.energy->value(x);
      };
      double energy;
      while (!std::isfinite(energy = start()))
        amplitude *= 0.95;
      ASSERT_GT(amplitude, 0.05 / n);
      const double at_start = quality();
      EXPECT_LT(at_start, 0.5);

      bool         converged  = false;
      unsigned int iterations = 0;
      while (!converged && iterations < 40)
        {
          const auto report =
            minimise(*problem.energy, *problem.system, 1e-8, 1, x);
          ++iterations;
          converged = report.converged;
          EXPECT_GT(quality(), 0.);
          EXPECT_EQ(report.energy, problem.energy->value(x));
          EXPECT_LE(report.energy, energy + (converged ? 1e-12 : 0.));
          energy = report.energy;
        }
      EXPECT_TRUE(converged);
      EXPECT_LE(iterations, 20u);
      EXPECT_GT(quality(), at_start + 0.2);

      // What is left of the gradient is round-off.
      NodalVector g(x);
      problem.energy->gradient(x, g);
      g.scale(problem.is_free);
      EXPECT_LT(g.linfty_norm(), 1e-11 * n);
    }
}

TEST(Barrier, DescendsOverValidMeshes)
{
  for_all(
    [](const auto dim, const unsigned int degree) { descends<dim>(degree); });
}

template <int dim>
void
invariant(const unsigned int degree)
{
  // The problem, turned, enlarged and shifted
  const Bench<dim>     bench(unit_mesh<dim>(4), degree);
  const Tensor<2, dim> Q      = 7. * rotation<dim>();
  const auto           turned = [&](const Map<dim> &f) {
    return bench.map(affine<dim>(Q, f));
  };
  const Map<dim> identity = [](const Point<dim> &X) { return X; };
  const Map<dim> rough    = curved<dim>(0.05 / degree / degree);
  for (const Settings &settings : std::vector<Settings>{
         {{"On", "all"}, {"Shapes", "initial"}},
         {{"On", "all"}, {"Shapes", "equal"}, {"Size weight", "0.3"}}})
    {
      Rezoning<dim> run(bench), run_turned(bench);
      run.add("barrier", settings);
      run_turned.add("barrier", settings);
      const auto x = run(bench.initial, bench.initial, bench.map(rough));
      const auto y =
        run_turned(turned(identity), turned(identity), turned(rough));
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      EXPECT_EQ(run.report.sweeps, run_turned.report.sweeps);
      EXPECT_GT(run.report.largest_motion, 0.01 / degree);
      EXPECT_LT(bench.distance(y,
                               affine<dim>(Q,
                                           [&](const Point<dim> &X) {
                                             // Nodes are found by X.
                                             for (const NodeId n :
                                                  bench.nodes.relevant())
                                               if (bench.nodes
                                                     .get(bench.initial, n)
                                                     .distance(X) < 1e-10)
                                                 return bench.nodes.get(x, n);
                                             return X;
                                           })),
                7e-12);
    }
}

TEST(Barrier, RigidMotionsAndScales)
{
  for_all(
    [](const auto dim, const unsigned int degree) { invariant<dim>(degree); });
}

template <int dim>
void
respects(const unsigned int degree)
{
  // Two regions: their interface is the material's. A fixed point inside, too.
  Mesh<dim>  mesh        = unit_mesh<dim>(4);
  Point<dim> quarter     = mesh.names.points["M"];
  quarter[0]             = 0.25;
  mesh.names.points["Q"] = quarter;
  const Bench<dim> bench(std::move(mesh), degree);
  const auto       f          = perturbed<dim>(0.06 / degree / degree, 8);
  const auto       lagrangian = bench.map(f);
  for (const char *on : {"left block, right block", "left block"})
    {
      Rezoning<dim> run(bench);
      run.add("barrier", {{"On", on}});
      run.add("fixed", {{"On", "Q"}});
      const auto x = run(bench.initial, bench.initial, lagrangian);
      EXPECT_EQ(run.report.fraction, 1.);
      EXPECT_EQ(run.report.unconverged_rules, 0u);
      const bool right_moves = std::string(on) != "left block";
      EXPECT_EQ(bench.distance(x,
                               f,
                               [&](const Point<dim> &X) {
                                 return std::abs(X[0] - 0.5) < 1e-10 ||
                                        (!right_moves && X[0] > 0.5);
                               }),
                0.);
      const auto away = [&](const double side) {
        return bench.distance(x, f, [&](const Point<dim> &X) {
          return side * (X[0] - 0.5) > 1e-10;
        });
      };
      EXPECT_GT(away(-1.), 0.003);
      if (right_moves)
        {
          EXPECT_GT(away(1.), 0.003);
        }
      EXPECT_EQ(bench.distance(
                  x,
                  [](const Point<dim> &X) { return X; },
                  [&](const Point<dim> &X) {
                    return X.distance(quarter) < 1e-10;
                  }),
                0.);
    }
}

TEST(Barrier, RespectsInterfacesAndOtherRules)
{
  for_all(
    [](const auto dim, const unsigned int degree) { respects<dim>(degree); });
}

template <int dim>
void
same_on_one_process(const unsigned int degree)
{
  // Every process solves the whole problem by itself, and all of them together.
  const unsigned int n     = dim == 2 ? 6 : 4;
  const auto         solve = [&](const MPI_Comm communicator) {
    const Bench<dim> bench(unit_mesh<dim>(n, communicator), degree);
    Rezoning<dim>    run(bench);
    run.add("barrier", {{"On", "all"}});
    const auto x = run(bench.initial,
                       bench.initial,
                       bench.map(curved<dim>(0.05 / degree / degree)));
    EXPECT_EQ(run.report.unconverged_rules, 0u);
    std::vector<std::pair<Point<dim>, Point<dim>>> places;
    for (const NodeId node : bench.nodes.relevant())
      places.emplace_back(bench.nodes.get(bench.initial, node),
                          bench.nodes.get(x, node));
    return std::make_pair(places, run.report.sweeps);
  };
  const auto together = solve(MPI_COMM_WORLD);
  const auto alone    = solve(MPI_COMM_SELF);
  EXPECT_EQ(together.second, alone.second);
  double largest = 0.;
  for (const auto &a : together.first)
    {
      double difference = std::numeric_limits<double>::max();
      for (const auto &b : alone.first)
        if (a.first.distance(b.first) < 1e-10)
          difference = a.second.distance(b.second);
      largest = std::max(largest, difference);
    }
  EXPECT_LT(largest, 1e-11);
}

TEST(Barrier, SameOnOneProcess)
{
  for_all([](const auto dim, const unsigned int degree) {
    same_on_one_process<dim>(degree);
  });
}

template <int dim>
void
where_giuliani_fails(const unsigned int degree)
{
  // The bottom of a square bulges far into it.
  const Map<dim> bulge = [](const Point<dim> &X) {
    double r2 = 0.;
    for (unsigned int c = 0; c + 1 < dim; ++c)
      r2 += (X[c] - 0.5) * (X[c] - 0.5);
    Point<dim> x = X;
    x[dim - 1] += 0.75 * (1. - X[dim - 1]) * std::exp(-r2 / 0.03);
    return x;
  };
  const unsigned int n = dim == 2 ? 12 : 4;
  const Bench<dim>   bench(unit_mesh<dim>(n), degree);
  const auto         lagrangian = bench.map(bulge);
  const auto         before     = mesh_quality(bench.configuration, lagrangian);
  ASSERT_GT(before.smallest_scaled_jacobian, 0.);
  ASSERT_GT(before.smallest_point_jacobian, 0.);
  for (const char *shapes : {"initial", "equal"})
    {
      Rezoning<dim> giuliani(bench), barrier(bench);
      giuliani.add("Giuliani", {{"On", "all"}, {"Shapes", shapes}});
      barrier.add("barrier", {{"On", "all"}, {"Shapes", shapes}});
      giuliani(bench.initial, bench.initial, lagrangian);
      const auto x = barrier(bench.initial, bench.initial, lagrangian);
      EXPECT_LT(giuliani.report.fraction, 1.);
      EXPECT_EQ(barrier.report.fraction, 1.);
      EXPECT_EQ(barrier.report.unconverged_rules, 0u);
      EXPECT_LE(barrier.report.sweeps, 20u);
      EXPECT_GT(barrier.report.largest_motion, 0.01);
      EXPECT_GT(barrier.report.smallest_quality, 0.);
      EXPECT_GT(mesh_quality(bench.configuration, x).smallest_point_jacobian,
                0.);
    }
}

TEST(Barrier, WhereGiulianiFails)
{
  for_all([](const auto dim, const unsigned int degree) {
    where_giuliani_fails<dim>(degree);
  });
}

template <int dim>
void
far_boundary(const unsigned int degree)
{
  // The material is stretched to three times its width, the boundary goes back,
  // across many cells: in stages.
  Mesh<dim> mesh                 = unit_mesh<dim>(dim == 2 ? 6 : 4);
  mesh.names.boundaries["sides"] = {0, 1, 2, 3, 4, 5};
  const Bench<dim> bench(std::move(mesh), degree);
  const Map<dim>   identity  = [](const Point<dim> &X) { return X; };
  const Map<dim>   stretched = [](const Point<dim> &X) {
    Point<dim> x = X;
    x[0] *= 3.;
    return x;
  };
  Rezoning<dim> run(bench);
  run.add("fixed", {{"On", "sides"}}).add("barrier", {{"On", "all"}});
  const auto x = run(bench.initial, bench.initial, bench.map(stretched));
  EXPECT_EQ(run.report.fraction, 1.);
  EXPECT_EQ(run.report.unconverged_rules, 0u);
  EXPECT_LT(bench.distance(x, identity), 1e-12);

  // No way leads to a mirrored boundary: nothing is moved, and it is said.
  const Map<dim> mirrored = [](const Point<dim> &X) {
    Point<dim> x = X;
    x[0] *= -1.;
    return x;
  };
  const auto y = run(bench.initial, bench.map(mirrored), bench.map(stretched));
  EXPECT_LT(run.report.fraction, 1.);
  EXPECT_EQ(run.report.unconverged_rules, 1u);
  EXPECT_EQ(bench.distance(y, stretched, is_inside<dim>), 0.);
}

TEST(Barrier, FarBoundary)
{
  for_all([](const auto dim, const unsigned int degree) {
    far_boundary<dim>(degree);
  });
}

TEST(Barrier, CountsWhatItCannotDo)
{
  const Bench<2> bench(unit_mesh<2>(6), 1);
  {
    // A mesh that is invalid already is left alone.
    const auto  folded = perturbed<2>(0.3, 1);
    Rezoning<2> run(bench);
    run.add("barrier", {{"On", "all"}});
    const auto x = run(bench.initial, bench.initial, bench.map(folded));
    EXPECT_EQ(run.report.unconverged_rules, 1u);
    EXPECT_EQ(run.report.sweeps, 0u);
    EXPECT_EQ(bench.distance(x, folded), 0.);
    // So are wanted cells that are inside out.
    EXPECT_THROW(run(bench.map(folded), bench.initial, bench.initial),
                 InputError);
  }
  {
    Rezoning<2> run(bench);
    run.add("barrier",
            {{"On", "all"},
             {"Tolerance", "1e-10"},
             {"Largest number of iterations", "2"}});
    run(bench.initial, bench.initial, bench.map(curved<2>(0.05)));
    EXPECT_EQ(run.report.sweeps, 2u);
    EXPECT_EQ(run.report.unconverged_rules, 1u);
  }
  {
    // Nothing inside
    const Bench<2> single(unit_mesh<2>(1), 1);
    Rezoning<2>    run(single);
    run.add("barrier", {{"On", "all"}});
    run(single.initial, single.initial, single.initial);
    EXPECT_EQ(run.report.sweeps, 0u);
    EXPECT_EQ(run.report.unconverged_rules, 0u);
  }
  for (const Settings &wrong : std::vector<Settings>{{}, {{"On", "bottom"}}})
    {
      Rezoning<2> run(bench);
      run.add("barrier", wrong);
      EXPECT_THROW(run(bench.initial, bench.initial, bench.initial),
                   InputError);
    }
}
