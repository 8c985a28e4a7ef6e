// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// History of a boundary in space that slides along it: constants, integrals,
// bounds, order of convergence, any number of processes.
#include <alveolus/base/errors.h>
#include <alveolus/transfer/boundary_curves.h>
#include <alveolus/transfer/boundary_surface.h>
#include <alveolus/transfer/face_overlap.h>
#include <alveolus/transfer/face_transfer.h>

#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Grid   = parallel::distributed::Triangulation<3>;
  using Motion = std::function<Tensor<1, 3>(const Point<3> &)>;
  using Field  = std::function<double(const Point<3> &)>;

  /** A body whose boundary 0 has a history of three components. */
  struct Body
  {
    Body(const unsigned int                 degree,
         const std::function<void(Grid &)> &make_grid,
         const MPI_Comm                     communicator = MPI_COMM_WORLD)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<3>>(mesh, degree);
      history =
        std::make_unique<FaceHistory<3>>(*mesh.triangulation,
                                         std::set<types::boundary_id>{0},
                                         (degree + 1) * (degree + 1),
                                         3);
    }

    /** Call action(record, centre) for all sub-quadrilaterals at @p x. */
    void
    for_all(const NodalVector                                     &x,
            const std::function<void(double *, const Point<3> &)> &action)
    {
      std::vector<double> lines =
        segment_breaks(std::lround(std::sqrt(history->n_points)));
      std::vector<Point<2>> centres;
      for (unsigned int j = 0; j + 1 < lines.size(); ++j)
        for (unsigned int i = 0; i + 1 < lines.size(); ++i)
          centres.emplace_back(0.5 * (lines[i] + lines[i + 1]),
                               0.5 * (lines[j] + lines[j + 1]));
      const auto                          &fe = configuration->fe;
      FEFaceValues<3>                      values(fe,
                             Quadrature<2>(centres,
                                           std::vector<double>(centres.size())),
                             update_values);
      std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
      for (unsigned int f = 0; f < history->faces().size(); ++f)
        {
          const auto &face = history->faces()[f];
          const typename DoFHandler<3>::active_cell_iterator cell(
            mesh.triangulation.get(),
            face.cell->level(),
            face.cell->index(),
            &configuration->dof_handler);
          values.reinit(cell, face.face_no);
          cell->get_dof_indices(dofs);
          for (unsigned int q = 0; q < centres.size(); ++q)
            {
              Point<3> centre;
              for (unsigned int i = 0; i < dofs.size(); ++i)
                centre[fe.system_to_component_index(i).first] +=
                  values.shape_value(i, q) * x(dofs[i]);
              action(history->old_record(f, q), centre);
            }
        }
    }

    /** Positions of the nodes moved by @p motion. */
    NodalVector
    moved(const Motion &motion) const
    {
      NodalVector                          x = configuration->positions();
      NodalVector                          result(x);
      std::vector<types::global_dof_index> dofs(
        configuration->fe.n_dofs_per_cell());
      const unsigned int n =
        configuration->fe.base_element(0).n_dofs_per_cell();
      for (const auto &cell :
           configuration->dof_handler.active_cell_iterators())
        if (!cell->is_artificial())
          {
            cell->get_dof_indices(dofs);
            for (unsigned int k = 0; k < n; ++k)
              {
                Point<3> p;
                for (unsigned int c = 0; c < 3; ++c)
                  p[c] =
                    x(dofs[configuration->fe.component_to_system_index(c, k)]);
                const Tensor<1, 3> m = motion(p);
                for (unsigned int c = 0; c < 3; ++c)
                  {
                    const auto dof =
                      dofs[configuration->fe.component_to_system_index(c, k)];
                    if (configuration->locally_owned.is_element(dof))
                      result(dof) = p[c] + m[c];
                  }
              }
          }
      result.update_ghost_values();
      return result;
    }

    FaceTransferReport
    transfer(const NodalVector &x)
    {
      return FaceTransfer<3>(*configuration)
        .transfer(*history, configuration->positions(), x);
    }

    /** Mean of |first component - f| over all sub-quadrilaterals. */
    double
    error(const NodalVector &x, const Field &f)
    {
      double sum = 0., n = 0.;
      for_all(x, [&](const double *record, const Point<3> &p) {
        sum += std::abs(record[0] - f(p));
        n += 1.;
      });
      return Utilities::MPI::sum(sum, MPI_COMM_WORLD) /
             Utilities::MPI::sum(n, MPI_COMM_WORLD);
    }

    Mesh<3>                           mesh;
    std::unique_ptr<Configuration<3>> configuration;
    std::unique_ptr<FaceHistory<3>>   history;
  };

  /** The unit cube of @p n^3 cells; boundary 0 is the side x = 0. */
  std::function<void(Grid &)>
  cube(const unsigned int n)
  {
    return [n](Grid &t) {
      GridGenerator::subdivided_hyper_cube(t, n, 0., 1., true);
    };
  }

  /** Slides on x = 0, keeps the rim. */
  Tensor<1, 3>
  slide(const Point<3> &p)
  {
    const double s =
      16. * p[1] * (1. - p[1]) * p[2] * (1. - p[2]) * (1. - p[0]);
    return Point<3>(0., 0.1 * s, -0.06 * s);
  }
} // namespace



TEST(SurfaceTransfer, PlaneSide)
{
  for (const unsigned int degree : {1, 2})
    {
      Body              s(degree, cube(6));
      const NodalVector x_0 = s.configuration->positions();
      const NodalVector x_1 = s.moved(&slide);
      s.for_all(x_0, [](double *record, const Point<3> &p) {
        record[0] = 1.1;
        record[1] = std::sin(5. * p[1]) * p[2];
        record[2] = p[1] > 0.5 ? 1. : 0.;
      });
      const FaceTransferReport report = s.transfer(x_1);
      EXPECT_TRUE(report.moved);
      EXPECT_NEAR(report.length_before, 1., 1e-14);
      EXPECT_NEAR(report.length_after, 1., 1e-14);
      EXPECT_LT(report.largest_distance, 1e-15);
      for (unsigned int c = 0; c < 3; ++c)
        EXPECT_NEAR(report.integral_after[c], report.integral_before[c], 1e-14);
      s.for_all(x_1, [](const double *record, const Point<3> &) {
        EXPECT_EQ(record[0], 1.1);
        EXPECT_GE(record[2], 0.);
        EXPECT_LE(record[2], 1.);
      });
    }
}



// Also where the edges that slide are the rim, and where nothing moves
TEST(SurfaceTransfer, ConstantsAndRest)
{
  Body s(1, cube(4));
  s.for_all(s.configuration->positions(),
            [](double *record, const Point<3> &p) {
              record[0] = 0.7;
              record[1] = p[1];
            });
  const auto values = s.history->old_values;
  EXPECT_FALSE(s.transfer(s.configuration->positions()).moved);
  EXPECT_EQ(s.history->old_values, values);

  const NodalVector x = s.moved(
    [](const Point<3> &p) { return Point<3>(0., 0.05 + 0.02 * p[2], 0.); });
  EXPECT_TRUE(s.transfer(x).moved);
  s.for_all(x, [](const double *record, const Point<3> &) {
    EXPECT_EQ(record[0], 0.7);
    EXPECT_GE(record[1], 0.);
    EXPECT_LE(record[1], 1.);
  });
}



// A way of more than a cell, in parts, of first order
TEST(SurfaceTransfer, ConvergesInFirstOrder)
{
  const Field field = [](const Point<3> &p) {
    return std::sin(3. * p[1]) * std::cos(2. * p[2]);
  };
  std::vector<double> errors;
  for (const unsigned int n : {8, 16, 32})
    {
      // Few cells across: only the side matters
      Body s(1, [n](Grid &t) {
        GridGenerator::subdivided_hyper_rectangle(
          t, {1, n, n}, Point<3>(), Point<3>(0.2, 1., 1.), true);
      });
      s.for_all(s.configuration->positions(),
                [&](double *record, const Point<3> &p) {
                  record[0] = field(p);
                });
      const NodalVector x = s.moved(&slide);
      s.transfer(x);
      errors.push_back(s.error(x, field));
    }
  EXPECT_LT(errors.back(), 0.03);
  EXPECT_GT(errors[0] / errors[1], 1.7);
  EXPECT_GT(errors[1] / errors[2], 1.8);
}



// A ball turns: closed and curved, faces of any orientation
TEST(SurfaceTransfer, TurningBall)
{
  const double angle = 0.1;
  const Motion turn  = [=](const Point<3> &p) -> Tensor<1, 3> {
    return Point<3>(std::cos(angle) * p[0] - std::sin(angle) * p[1] - p[0],
                    std::sin(angle) * p[0] + std::cos(angle) * p[1] - p[1],
                    0.);
  };
  const Field field = [](const Point<3> &p) {
    return (p[0] + 0.5 * p[2]) / p.norm();
  };
  std::vector<double> errors, lost;
  for (const unsigned int refinements : {2, 3, 4})
    {
      Body s(1, [=](Grid &t) {
        GridGenerator::hyper_ball(t);
        t.refine_global(refinements);
      });
      s.for_all(s.configuration->positions(),
                [&](double *record, const Point<3> &p) {
                  record[0] = field(p);
                  record[1] = 1.1;
                  record[2] = 1. + p[0] * p[0];
                });
      const NodalVector        x      = s.moved(turn);
      const FaceTransferReport report = s.transfer(x);
      EXPECT_NEAR(report.length_after / report.length_before, 1., 1e-13);
      s.for_all(x, [](const double *record, const Point<3> &) {
        EXPECT_EQ(record[1], 1.1);
      });
      errors.push_back(s.error(x, field));
      lost.push_back(
        std::abs(report.integral_after[2] / report.integral_before[2] - 1.));
    }
  EXPECT_GT(errors[0] / errors[1], 1.7);
  EXPECT_GT(errors[1] / errors[2], 1.8);
  // What the curvature makes of areas: of second order at least
  EXPECT_GT(lost[0] / lost[2], 16.);
  EXPECT_LT(lost[2], 1e-6);
}



TEST(SurfaceTransfer, SameOnAnyNumberOfProcesses)
{
  const auto grid = [](Grid &t) {
    GridGenerator::hyper_ball(t);
    t.refine_global(1);
  };
  std::map<std::pair<std::string, unsigned int>, std::vector<double>> reference;
  Body one(1, grid, MPI_COMM_SELF), all(1, grid);
  for (Body *s : {&one, &all})
    {
      s->for_all(s->configuration->positions(),
                 [](double *record, const Point<3> &p) {
                   for (unsigned int c = 0; c < 3; ++c)
                     record[c] = std::sin(7. * p[c]) + p[0] * p[1];
                 });
      s->transfer(s->moved([](const Point<3> &p) -> Tensor<1, 3> {
        return 0.05 * cross_product_3d(p, Point<3>(p[2], 1., p[0]));
      }));
      for (unsigned int i = 0; i < s->history->faces().size(); ++i)
        {
          const auto &face = s->history->faces()[i];
          const auto  key =
            std::make_pair(face.cell->id().to_string(), face.face_no);
          const std::vector<double> values(s->history->old_record(i, 0),
                                           s->history->old_record(i, 0) + 12);
          if (s == &one)
            reference[key] = values;
          else
            EXPECT_EQ(values, reference.at(key));
        }
    }
  EXPECT_EQ(reference.size(), 24u);
}



// Unrelated meshes of the same plane: exact means, contents kept
TEST(SurfaceOverlap, PlaneSide)
{
  const auto side = [](const unsigned int n, const unsigned int m) {
    return [=](Grid &t) {
      GridGenerator::subdivided_hyper_rectangle(
        t, {1, n, m}, Point<3>(), Point<3>(0.2, 1., 1.), true);
    };
  };
  Body a(1, side(4, 6)), b(1, side(7, 5));
  a.for_all(a.configuration->positions(),
            [](double *record, const Point<3> &p) {
              record[0] = p[1] < 0.5 ? 2. : -1.;
              record[1] = 0.7;
              record[2] = std::sin(4. * p[1]) * p[2];
            });
  const FaceTransferReport report = FaceOverlap<3>(*a.configuration, *a.history)
                                      .transfer(*b.configuration, *b.history);
  EXPECT_NEAR(report.length_before, 1., 1e-14);
  EXPECT_NEAR(report.length_after, 1., 1e-14);
  EXPECT_LT(report.largest_distance, 1e-15);
  EXPECT_EQ(report.n_beyond, 0u);
  for (unsigned int c = 0; c < 3; ++c)
    EXPECT_NEAR(report.integral_after[c], report.integral_before[c], 1e-14);
  // y = 1/2 is in the middle of the fourth of seven cells, between its two
  // sub-quadrilaterals.
  b.for_all(b.configuration->positions(),
            [](const double *record, const Point<3> &p) {
              EXPECT_NEAR(record[0], p[1] < 0.5 ? 2. : -1., 1e-14);
              EXPECT_EQ(record[1], 0.7);
            });
}



TEST(SurfaceOverlap, BallOnAnyNumberOfProcesses)
{
  const auto ball = [](const unsigned int refinements) {
    return [=](Grid &t) {
      GridGenerator::hyper_ball(t);
      t.refine_global(refinements);
    };
  };
  const Field field = [](const Point<3> &p) {
    return (p[0] + 0.5 * p[2]) / p.norm();
  };
  const double angle = 0.2;
  const Motion turn  = [=](const Point<3> &p) -> Tensor<1, 3> {
    return Point<3>(std::cos(angle) * p[0] - std::sin(angle) * p[1] - p[0],
                    std::sin(angle) * p[0] + std::cos(angle) * p[1] - p[1],
                    0.);
  };
  std::map<std::pair<std::string, unsigned int>, std::vector<double>> reference;
  std::vector<double>                                                 errors;
  for (const unsigned int refinements : {2, 3})
    for (const MPI_Comm communicator : {MPI_COMM_SELF, MPI_COMM_WORLD})
      {
        Body a(1, ball(refinements), communicator);
        Body b(1, ball(refinements), communicator);
        b.configuration->set_positions(b.moved(turn));
        a.for_all(a.configuration->positions(),
                  [&](double *record, const Point<3> &p) {
                    record[0] = field(p);
                    record[1] = 1.1;
                    record[2] = p[2] > 0. ? 1. : 0.;
                  });
        const FaceTransferReport report =
          FaceOverlap<3>(*a.configuration, *a.history)
            .transfer(*b.configuration, *b.history);
        EXPECT_NEAR(report.integral_after[1] / report.integral_before[1],
                    1.,
                    1e-12);
        EXPECT_NEAR(report.integral_after[2] / report.integral_before[2],
                    1.,
                    0.01);
        b.for_all(b.configuration->positions(),
                  [](const double *record, const Point<3> &) {
                    EXPECT_EQ(record[1], 1.1);
                    EXPECT_GE(record[2], 0.);
                    EXPECT_LE(record[2], 1.);
                  });
        for (unsigned int i = 0; i < b.history->faces().size(); ++i)
          {
            const auto &face = b.history->faces()[i];
            const auto  key =
              std::make_pair(face.cell->id().to_string(), face.face_no);
            const std::vector<double> values(b.history->old_record(i, 0),
                                             b.history->old_record(i, 0) + 12);
            if (communicator == MPI_COMM_SELF)
              reference[key] = values;
            else
              EXPECT_EQ(values, reference.at(key));
          }
        if (communicator == MPI_COMM_WORLD)
          errors.push_back(b.error(b.configuration->positions(), field));
      }
  EXPECT_GT(errors[0] / errors[1], 1.8);
  EXPECT_LT(errors[1], 0.01);
}



// A row of new cells beyond the rim takes the last values and is counted.
TEST(SurfaceOverlap, BeyondTheRim)
{
  Body a(1, cube(4)), b(1, cube(4));
  a.for_all(a.configuration->positions(),
            [](double *record, const Point<3> &p) { record[0] = p[1]; });
  b.configuration->set_positions(
    b.moved([](const Point<3> &) { return Point<3>(0., 0.125, 0.); }));
  const FaceTransferReport report = FaceOverlap<3>(*a.configuration, *a.history)
                                      .transfer(*b.configuration, *b.history);
  // By one row of sub-quadrilaterals: the others fit
  EXPECT_EQ(report.n_beyond, 8u);
  b.for_all(b.configuration->positions(),
            [](const double *record, const Point<3> &p) {
              EXPECT_NEAR(record[0], std::min(p[1], 0.9375), 1e-14);
            });
}



TEST(SurfaceOverlap, OtherSurfacesAreRefused)
{
  Body                 a(1, cube(4)), b(1, cube(4));
  const FaceOverlap<3> overlap(*a.configuration, *a.history);
  b.configuration->set_positions(
    b.moved([](const Point<3> &) { return Point<3>(0.4, 0., 0.); }));
  EXPECT_THROW(overlap.transfer(*b.configuration, *b.history), RunError);
}
