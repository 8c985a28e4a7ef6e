// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Nodal fields and boundary history moved with the mesh on the same
// connectivity.
#include "noise.h"

#include <alveolus/base/errors.h>
#include <alveolus/transfer/face_overlap.h>
#include <alveolus/transfer/face_transfer.h>
#include <alveolus/transfer/nodal_transfer.h>

#include <deal.II/base/timer.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  template <int dim>
  struct Problem
  {
    using Grid     = parallel::distributed::Triangulation<dim>;
    using Function = std::function<Tensor<1, dim>(const Point<dim> &)>;

    Problem(const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const MPI_Comm                     communicator = MPI_COMM_WORLD)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
    }

    /** Nodal vector of f(x) for positions @p x. */
    NodalVector
    interpolate(const NodalVector &x, const Function &f) const
    {
      NodalVector          result = configuration->make_vector();
      const CellNodes<dim> cells(*configuration);
      const unsigned int   n_owned = result.locally_owned_size();
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors position;
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int c = cell->active_cell_index();
            cells.gather(x, c, position);
            for (unsigned int i = 0; i < cells.n_nodes; ++i)
              {
                const Tensor<1, dim> value = f(Point<dim>(position[i]));
                for (unsigned int d = 0; d < dim; ++d)
                  if (cells.local_entries(c, i)[d] < n_owned)
                    result.local_element(cells.local_entries(c, i)[d]) =
                      value[d];
              }
          }
      result.update_ghost_values();
      return result;
    }

    /** x + motion(x) for the nodes of the configuration. */
    NodalVector
    moved(const Function &motion) const
    {
      return interpolate(configuration->positions(),
                         [&](const Point<dim> &p) -> Tensor<1, dim> {
                           return p + motion(p);
                         });
    }

    /** Interior nodes of [0,1]^dim by noise of size @p size. */
    NodalVector
    shaken(const double size, const unsigned int seed) const
    {
      return moved([=](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
            m[d] = size * noise(p, 3 * seed + d);
        return m; // boundary nodes slide along the boundary
      });
    }

    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
  };

  template <int dim>
  void
  cube(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::subdivided_hyper_cube(t, dim == 2 ? 8 : 4, 0., 1., true);
  }

  template <int dim>
  void
  ball(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::hyper_ball(t);
    t.refine_global(dim == 2 ? 3 : 1);
  }

  template <int dim>
  Tensor<1, dim>
  linear(const Point<dim> &p)
  {
    Tensor<1, dim> u;
    for (unsigned int d = 0; d < dim; ++d)
      for (unsigned int e = 0; e < dim; ++e)
        u[d] += (1. + d + 3. * e) * p[e] - 0.3 * d;
    return u;
  }

  double
  largest_difference(const NodalVector &a, const NodalVector &b)
  {
    double result = 0.;
    for (unsigned int i = 0; i < a.locally_owned_size(); ++i)
      result =
        std::max(result, std::abs(a.local_element(i) - b.local_element(i)));
    return Utilities::MPI::max(result, MPI_COMM_WORLD);
  }
} // namespace

template <int dim>
void
linear_field(const unsigned int degree)
{
  Problem<dim>             s(degree, &cube<dim>);
  const NodalTransfer<dim> transfer(*s.configuration);
  const double             size = 0.2 / (dim == 2 ? 8 : 4) / degree;
  const NodalVector        x_0 = s.shaken(size, 1), x_1 = s.shaken(size, 2);
  NodalVector              u      = s.interpolate(x_0, &linear<dim>);
  NodalTransferReport      report = transfer.transfer(u, x_0, x_1);
  EXPECT_LT(largest_difference(u, s.interpolate(x_1, &linear<dim>)), 1e-12);
  EXPECT_TRUE(u.has_ghost_elements());
  EXPECT_EQ(report.n_extrapolated, 0u);
  EXPECT_EQ(report.n_subcycles, 1u);
  EXPECT_GT(report.n_moved, 0u);

  // A constant is kept to the last bit, and so is what does not move.
  const auto constant = [](const Point<dim> &) {
    Tensor<1, dim> c;
    for (unsigned int d = 0; d < dim; ++d)
      c[d] = 0.1 + d / 3.;
    return c;
  };
  u = s.interpolate(x_0, constant);
  transfer.transfer(u, x_0, x_1);
  EXPECT_EQ(largest_difference(u, s.interpolate(x_1, constant)), 0.);
  u                        = s.interpolate(x_0, [](const Point<dim> &p) {
    Tensor<1, dim> c;
    c[0] = noise(p, 4);
    return c;
  });
  const NodalVector before = u;
  report                   = transfer.transfer(u, x_0, x_0);
  EXPECT_EQ(largest_difference(u, before), 0.);
  EXPECT_EQ(report.n_moved, 0u);
}

TEST(NodalTransfer, LinearFieldIsExact)
{
  linear_field<2>(1);
  linear_field<2>(2);
  linear_field<3>(1);
  linear_field<3>(2);
}

// Nodes that travel over several cells.
TEST(NodalTransfer, LongWay)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2>                s(degree, &cube<2>);
      const NodalTransfer<2>    transfer(*s.configuration);
      const NodalVector         x_0    = s.configuration->positions();
      const NodalVector         x_1    = s.moved([](const Point<2> &p) {
        Tensor<1, 2> m;
        m[0] = 1.2 * p[0] * (1. - p[0]) * std::sin(numbers::PI * p[1]);
        m[0] *= 1. - p[0] / 2.;
        return m;
      });
      NodalVector               u      = s.interpolate(x_0, &linear<2>);
      const NodalTransferReport report = transfer.transfer(u, x_0, x_1);
      EXPECT_GT(report.n_subcycles, 1u);
      EXPECT_EQ(report.n_extrapolated, 0u);
      EXPECT_LT(largest_difference(u, s.interpolate(x_1, &linear<2>)), 1e-12);
    }
}

// The mesh of a disc turns by half a cell: boundary nodes leave the polygon by
// no more than the sagitta of its sides.
TEST(NodalTransfer, CurvedBoundary)
{
  const unsigned int n_sides = 32;
  const double       angle   = numbers::PI / n_sides;
  for (const unsigned int degree : {1, 2})
    {
      Problem<2>             s(degree, &ball<2>);
      const NodalTransfer<2> transfer(*s.configuration);
      const NodalVector      x_0 = s.configuration->positions();
      const NodalVector      x_1 = s.interpolate(x_0, [=](const Point<2> &p) {
        return Tensor<1, 2>({std::cos(angle) * p[0] - std::sin(angle) * p[1],
                             std::sin(angle) * p[0] + std::cos(angle) * p[1]});
      });
      NodalVector            u   = s.interpolate(x_0, &linear<2>);
      const NodalTransferReport report = transfer.transfer(u, x_0, x_1);
      EXPECT_LT(largest_difference(u, s.interpolate(x_1, &linear<2>)), 1e-12);
      EXPECT_EQ(report.n_subcycles, 1u);
      if (degree == 1)
        {
          EXPECT_EQ(report.n_extrapolated, n_sides);
          EXPECT_NEAR(report.largest_distance, 1. - std::cos(angle), 1e-4);
        }
      else // for degree 2 the sides bend with the disc
        EXPECT_LT(report.largest_distance, 1e-5);
    }
}

// The error of one interpolation is of order degree + 1.
TEST(NodalTransfer, Order)
{
  for (const unsigned int degree : {1, 2})
    {
      std::vector<double> errors;
      for (const unsigned int n : {8, 16})
        {
          Problem<2> s(degree, [n](parallel::distributed::Triangulation<2> &t) {
            GridGenerator::subdivided_hyper_cube(t, n);
          });
          const NodalTransfer<2> transfer(*s.configuration);
          const auto             field = [](const Point<2> &p) {
            return Tensor<1, 2>(
              {std::sin(2. * p[0] + p[1]), std::cos(p[0] - 3. * p[1])});
          };
          const NodalVector x_0 = s.configuration->positions();
          const NodalVector x_1 = s.moved([n](const Point<2> &p) {
            const double bubble =
              std::sin(numbers::PI * p[0]) * std::sin(numbers::PI * p[1]);
            return 0.4 / n * bubble * Tensor<1, 2>({1., -0.7});
          });
          NodalVector       u   = s.interpolate(x_0, field);
          transfer.transfer(u, x_0, x_1);
          errors.push_back(largest_difference(u, s.interpolate(x_1, field)));
        }
      EXPECT_NEAR(std::log2(errors[0] / errors[1]), degree + 1., 0.25);
    }
}

// Same bits on one process and on all of them.
TEST(NodalTransfer, SameOnAnyNumberOfProcesses)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2> all(degree, &cube<2>);
      Problem<2> one(degree, &cube<2>, MPI_COMM_SELF);
      const auto field = [](const Point<2> &p) {
        return Tensor<1, 2>({noise(p, 8), noise(p, 9)});
      };
      std::map<std::string, std::vector<double>> reference;
      for (Problem<2> *s : {&one, &all})
        {
          const NodalVector x_0 = s->configuration->positions();
          const NodalVector x_1 = s->shaken(0.02, 1);
          NodalVector       u   = s->interpolate(x_0, field);
          NodalTransfer<2>(*s->configuration).transfer(u, x_0, x_1);
          const CellNodes<2>        cells(*s->configuration);
          CellNodes<2>::NodeTensors values;
          for (const auto &cell :
               s->mesh.triangulation->active_cell_iterators())
            if (cell->is_locally_owned())
              {
                cells.gather(u, cell->active_cell_index(), values);
                std::vector<double> list;
                for (unsigned int i = 0; i < cells.n_nodes; ++i)
                  for (unsigned int d = 0; d < 2; ++d)
                    list.push_back(values[i][d]);
                if (s == &one)
                  reference[cell->id().to_string()] = list;
                else
                  EXPECT_EQ(list, reference.at(cell->id().to_string()));
              }
        }
    }
}

TEST(NodalTransfer, LostNodesAreAnError)
{
  // A node that leaves the domain has no value anywhere.
  Problem<2>        s(1, &cube<2>);
  const NodalVector x_0 = s.configuration->positions();
  const NodalVector x_1 = s.moved([](const Point<2> &p) {
    Tensor<1, 2> m;
    if (p.distance(Point<2>(0.5, 0.5)) < 1e-10)
      m[0] = 100.;
    return m;
  });
  NodalVector       u   = s.interpolate(x_0, &linear<2>);
  EXPECT_THROW(NodalTransfer<2>(*s.configuration).transfer(u, x_0, x_1),
               RunError);
}

namespace
{
  /** Integral of component @p c over the face sub-cells from a report. */
  template <int dim>
  void
  fill(FaceHistory<dim>                                              &history,
       const std::function<double(const Point<dim> &, unsigned int)> &f)
  {
    for (unsigned int i = 0; i < history.faces().size(); ++i)
      for (unsigned int q = 0; q < history.n_points; ++q)
        for (unsigned int c = 0; c < history.n_components; ++c)
          {
            const auto      &face = history.faces()[i];
            const QGauss<1>  gauss(history.n_points);
            const Point<dim> a = face.cell->vertex(
              GeometryInfo<dim>::face_to_cell_vertices(face.face_no, 0));
            const Point<dim> b = face.cell->vertex(
              GeometryInfo<dim>::face_to_cell_vertices(face.face_no, 1));
            // Centres of the sub-segments.
            double s = 0.5 * gauss.weight(q);
            for (unsigned int r = 0; r < q; ++r)
              s += gauss.weight(r);
            history.old_record(i, q)[c] = f(a + s * (b - a), c);
          }
  }

  /** The side x = 0 of the unit square; interior nodes by y -> y + m(y). */
  NodalVector
  slide(const Problem<2> &s, const std::function<double(double)> &m)
  {
    return s.moved([&](const Point<2> &p) {
      Tensor<1, 2> result;
      if (p[1] > 1e-10 && p[1] < 1. - 1e-10)
        result[1] = m(p[1]);
      return result;
    });
  }
} // namespace

TEST(FaceTransfer, StraightSide)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2>            s(degree, &cube<2>);
      const FaceTransfer<2> transfer(*s.configuration);
      FaceHistory<2>        history(*s.mesh.triangulation, {0}, degree + 1, 3);
      EXPECT_EQ(Utilities::MPI::sum(history.faces().size(), MPI_COMM_WORLD),
                8u);
      for (unsigned int i = 0; i < history.faces().size(); ++i)
        EXPECT_EQ(history.index(history.faces()[i].cell->active_cell_index(),
                                history.faces()[i].face_no),
                  i);
      fill<2>(history, [](const Point<2> &p, const unsigned int c) {
        return c == 0 ? 0.7 : noise(p, c);
      });
      const NodalVector x_0  = s.configuration->positions();
      NodalVector       from = x_0;
      from.update_ghost_values();
      for (unsigned int step = 0; step < 5; ++step)
        {
          const NodalVector        to = slide(s, [&](const double y) {
            return 0.04 / degree * noise(Point<2>(y, step), 7);
          });
          const FaceTransferReport report =
            transfer.transfer(history, from, to);
          EXPECT_TRUE(report.moved);
          EXPECT_NEAR(report.length_before, 1., 1e-14);
          EXPECT_NEAR(report.length_after, 1., 1e-14);
          EXPECT_LT(report.largest_distance, 1e-15);
          for (unsigned int c = 0; c < 3; ++c)
            EXPECT_NEAR(report.integral_after[c],
                        report.integral_before[c],
                        1e-14);
          from = to;
          from.update_ghost_values();
        }
      for (unsigned int i = 0; i < history.faces().size(); ++i)
        for (unsigned int q = 0; q < history.n_points; ++q)
          {
            EXPECT_EQ(history.old_record(i, q)[0], 0.7);
            EXPECT_LE(std::abs(history.old_record(i, q)[1]), 1.);
          }

      // Nothing moves: nothing changes, to the last bit.
      const std::vector<double> before = history.old_values;
      EXPECT_FALSE(transfer.transfer(history, x_0, x_0).moved);
      EXPECT_EQ(history.old_values, before);

      // A node that overtakes its neighbour.
      EXPECT_THROW(transfer.transfer(history,
                                     x_0,
                                     slide(s,
                                           [](double y) {
                                             return std::abs(y - 0.5) < 1e-10
                                                      ? 0.4
                                                      : 0.;
                                           })),
                   RunError);
    }
}

// Interior nodes move by one sub-segment: values stay at their places.
TEST(FaceTransfer, ExactShift)
{
  Problem<2>     s(1, &cube<2>);
  FaceHistory<2> history(*s.mesh.triangulation, {0}, 2, 1);
  // A step that the shift carries from y = 0.5 of the nodes to y = 0.5 in space
  const auto step = [](const Point<2> &p, const unsigned int) {
    return p[1] < 0.5 ? 1. : 3.;
  };
  fill<2>(history, step);
  const NodalVector x_0 = s.configuration->positions();
  const NodalVector x_1 =
    slide(s, [](const double y) { return y < 0.2 || y > 0.8 ? 0. : 1. / 16.; });
  FaceTransfer<2>(*s.configuration).transfer(history, x_0, x_1);
  s.configuration->set_positions(x_1);
  const CellNodes<2>        cells(*s.configuration);
  CellNodes<2>::NodeTensors position;
  for (unsigned int i = 0; i < history.faces().size(); ++i)
    {
      cells.gather(x_1, history.faces()[i].cell->active_cell_index(), position);
      const double a = position[0][1], b = position[2][1];
      EXPECT_NEAR(history.old_record(i, 0)[0],
                  step(Point<2>(0., 0.75 * a + 0.25 * b), 0),
                  1e-13);
      EXPECT_NEAR(history.old_record(i, 1)[0],
                  step(Point<2>(0., 0.25 * a + 0.75 * b), 0),
                  1e-13);
    }
}

// The rim of a disc turns by exactly one side: a closed curve, whose values
// move on by one side.
TEST(FaceTransfer, ClosedCurve)
{
  for (const unsigned int degree : {1, 2})
    for (const double turn : {1., -1., 0.5})
      {
        Problem<2>     s(degree, &ball<2>);
        FaceHistory<2> history(*s.mesh.triangulation, {0}, degree + 1, 2);
        const auto     field = [](const Point<2> &p, const unsigned int c) {
          return c == 0 ? 1.1 : std::sin(3. * std::atan2(p[1], p[0]));
        };
        fill<2>(history, field);
        const NodalVector x_0   = s.configuration->positions();
        const double      angle = turn * 2. * numbers::PI / 32.;
        const double      c = std::cos(angle), sn = std::sin(angle);
        const auto        rotate = [=](const Point<2> &p) -> Tensor<1, 2> {
          return Point<2>(c * p[0] - sn * p[1], sn * p[0] + c * p[1]);
        };
        const NodalVector        x_1 = s.interpolate(x_0, rotate);
        const FaceTransferReport report =
          FaceTransfer<2>(*s.configuration).transfer(history, x_0, x_1);
        EXPECT_NEAR(report.length_after / report.length_before, 1., 1e-14);
        EXPECT_NEAR(report.integral_after[1], report.integral_before[1], 1e-12);
        const bool           exact = std::abs(turn) == 1.;
        const FaceHistory<2> after = history;
        fill<2>(history, [&](const Point<2> &p, const unsigned int component) {
          return field(Point<2>(rotate(p)), component);
        });
        for (unsigned int i = 0; i < history.faces().size(); ++i)
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              EXPECT_EQ(after.old_record(i, q)[0], 1.1);
              EXPECT_NEAR(after.old_record(i, q)[1],
                          history.old_record(i, q)[1],
                          exact ? 1e-12 : 0.05);
            }
      }
}

// Two curves at once, and the same bits on one process and on all of them.
TEST(FaceTransfer, SameOnAnyNumberOfProcesses)
{
  const auto ring = [](parallel::distributed::Triangulation<2> &t) {
    GridGenerator::hyper_shell(t, Point<2>(), 0.5, 1., 16, true);
  };
  Problem<2> all(1, ring);
  Problem<2> one(1, ring, MPI_COMM_SELF);
  std::map<std::pair<std::string, unsigned int>, std::vector<double>> reference;
  for (Problem<2> *s : {&one, &all})
    {
      FaceHistory<2> history(*s->mesh.triangulation, {0, 1}, 2, 2);
      fill<2>(history, [](const Point<2> &p, const unsigned int c) {
        return noise(p, c);
      });
      const NodalVector x_0 = s->configuration->positions();
      const NodalVector x_1 = s->moved([](const Point<2> &p) -> Tensor<1, 2> {
        return 0.05 * noise(p, 3) * Tensor<1, 2>({-p[1], p[0]});
      });
      FaceTransfer<2>(*s->configuration).transfer(history, x_0, x_1);
      for (unsigned int i = 0; i < history.faces().size(); ++i)
        {
          const std::vector<double> values(history.old_record(i, 0),
                                           history.old_record(i, 0) + 4);
          const auto                key =
            std::make_pair(history.faces()[i].cell->id().to_string(),
                           history.faces()[i].face_no);
          if (s == &one)
            reference[key] = values;
          else
            EXPECT_EQ(values, reference.at(key));
        }
    }
  EXPECT_EQ(reference.size(), 32u);
}

namespace
{
  /** Unit square with @p n cells along y, side x = 0 is boundary 0. */
  std::function<void(parallel::distributed::Triangulation<2> &)>
  rows(const unsigned int n, const bool upside_down = false)
  {
    return [=](parallel::distributed::Triangulation<2> &t) {
      GridGenerator::subdivided_hyper_rectangle(
        t, {3, n}, Point<2>(), Point<2>(1., 1.), true);
      if (upside_down)
        GridTools::rotate(numbers::PI, t);
      if (upside_down)
        GridTools::shift(Point<2>(1., 1.), t);
      for (const auto &face : t.active_face_iterators())
        if (face->at_boundary())
          face->set_boundary_id(face->center()[0] < 1e-10 ? 0 : 1);
    };
  }
} // namespace

// Boundary history between unrelated meshes: means by arc length.
TEST(FaceOverlap, StraightSide)
{
  for (const bool upside_down : {false, true})
    {
      Problem<2>     a(1, rows(2)), b(1, rows(3, upside_down));
      FaceHistory<2> old_history(*a.mesh.triangulation, {0}, 2, 2);
      FaceHistory<2> new_history(*b.mesh.triangulation, {0}, 2, 2);
      fill<2>(old_history, [](const Point<2> &p, const unsigned int c) {
        return c == 0 ? 0.7 : (p[1] < 0.25 ? 2. : -1.);
      });
      const FaceTransferReport report =
        FaceOverlap<2>(*a.configuration, old_history)
          .transfer(*b.configuration, new_history);
      EXPECT_NEAR(report.length_before, 1., 1e-14);
      EXPECT_NEAR(report.length_after, 1., 1e-14);
      EXPECT_LT(report.largest_distance, 1e-15);
      EXPECT_NEAR(report.integral_before[1], -0.25, 1e-14);
      EXPECT_NEAR(report.integral_after[1], -0.25, 1e-14);
      const FaceHistory<2> result = new_history;
      // 1/4 is in the middle of the second of six sub-segments.
      fill<2>(new_history, [](const Point<2> &p, const unsigned int) {
        return p[1] < 1. / 6. ? 2. : (p[1] < 2. / 6. ? 0.5 : -1.);
      });
      for (unsigned int i = 0; i < result.faces().size(); ++i)
        for (unsigned int q = 0; q < 2; ++q)
          {
            EXPECT_EQ(result.old_record(i, q)[0], 0.7);
            EXPECT_NEAR(result.old_record(i, q)[1],
                        new_history.old_record(i, q)[0],
                        1e-14);
          }
    }
}

// A closed curve, turned so that its begin is elsewhere; and the same bits on
// any number of processes.
TEST(FaceOverlap, ClosedCurve)
{
  for (const unsigned int degree : {1, 2})
    {
      std::map<std::pair<std::string, unsigned int>, std::vector<double>>
        reference;
      for (const MPI_Comm communicator : {MPI_COMM_SELF, MPI_COMM_WORLD})
        {
          Problem<2> a(degree, &ball<2>, communicator);
          Problem<2> b(
            degree,
            [](parallel::distributed::Triangulation<2> &t) {
              GridGenerator::hyper_ball(t);
              t.refine_global(4);
            },
            communicator);
          const double angle = 0.3;
          b.configuration->set_positions(
            b.moved([=](const Point<2> &p) -> Tensor<1, 2> {
              const double c = std::cos(angle), sn = std::sin(angle);
              return Point<2>(c * p[0] - sn * p[1], sn * p[0] + c * p[1]) - p;
            }));
          FaceHistory<2> old_history(*a.mesh.triangulation, {0}, degree + 1, 2);
          FaceHistory<2> new_history(*b.mesh.triangulation, {0}, degree + 1, 2);
          const auto     field = [](const Point<2> &p, const unsigned int c) {
            return c == 0 ? 1.1 : std::sin(2. * std::atan2(p[1], p[0]));
          };
          fill<2>(old_history, field);
          const FaceTransferReport report =
            FaceOverlap<2>(*a.configuration, old_history)
              .transfer(*b.configuration, new_history);
          // The sagitta of the old sides.
          EXPECT_LT(report.largest_distance, degree == 1 ? 5e-3 : 1e-5);
          EXPECT_NEAR(report.integral_after[1],
                      report.integral_before[1],
                      1e-3);
          double largest = 0.;
          for (unsigned int i = 0; i < new_history.faces().size(); ++i)
            {
              const auto  &face = new_history.faces()[i];
              const auto   v    = face.cell->face(face.face_no)->center();
              const double phi  = std::atan2(v[1], v[0]) + angle;
              for (unsigned int q = 0; q < new_history.n_points; ++q)
                {
                  EXPECT_EQ(new_history.old_record(i, q)[0], 1.1);
                  largest = std::max(largest,
                                     std::abs(new_history.old_record(i, q)[1] -
                                              std::sin(2. * phi)));
                }
              const std::vector<double> values(new_history.old_record(i, 0),
                                               new_history.old_record(i, 0) +
                                                 2 * new_history.n_points);
              const auto                key =
                std::make_pair(face.cell->id().to_string(), face.face_no);
              if (communicator == MPI_COMM_SELF)
                reference[key] = values;
              else
                EXPECT_EQ(values, reference.at(key));
            }
          // Within half an old sub-segment (pi/64) and half a new edge.
          EXPECT_LT(largest, 2. * numbers::PI * (1. / 64. + 1. / 64.));
        }
    }
}

TEST(FaceOverlap, Errors)
{
  Problem<2>           a(1, rows(8)), b(1, rows(8));
  FaceHistory<2>       old_history(*a.mesh.triangulation, {0}, 2, 2);
  FaceHistory<2>       new_history(*b.mesh.triangulation, {0}, 2, 2);
  FaceHistory<2>       other(*b.mesh.triangulation, {0}, 2, 3);
  const FaceOverlap<2> overlap(*a.configuration, old_history);
  EXPECT_THROW(overlap.transfer(*b.configuration, other), RunError);
  b.configuration->set_positions(b.moved([](const Point<2> &) {
    return Tensor<1, 2>({0.2, 0.});
  }));
  EXPECT_THROW(overlap.transfer(*b.configuration, new_history), RunError);
}

// Not a check but a measurement: about 1000 nodes, all of which move, and a
// boundary of 32 faces.
TEST(NodalTransfer, Cost)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<2> s(degree, [](parallel::distributed::Triangulation<2> &t) {
        GridGenerator::subdivided_hyper_cube(t, 32, 0., 1., true);
      });
      const NodalTransfer<2> transfer(*s.configuration);
      const FaceTransfer<2>  face_transfer(*s.configuration);
      FaceHistory<2>         history(*s.mesh.triangulation, {0}, degree + 1, 2);
      const NodalVector      x_0   = s.configuration->positions();
      const NodalVector      x_1   = s.shaken(0.001, 1);
      NodalVector            u     = s.interpolate(x_0, &linear<2>);
      double                 nodal = 1e9, face = 1e9;
      for (unsigned int i = 0; i < 10; ++i)
        {
          Timer timer;
          transfer.transfer(u, x_0, x_1);
          nodal = std::min(nodal, timer.wall_time());
          timer.restart();
          face_transfer.transfer(history, x_0, x_1);
          face = std::min(face, timer.wall_time());
        }
      if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
        std::cout << "1024 cells of degree " << degree << ": nodal transfer "
                  << 1e3 * nodal << " ms, boundary of 32 faces " << 1e3 * face
                  << " ms" << std::endl;
    }
}
