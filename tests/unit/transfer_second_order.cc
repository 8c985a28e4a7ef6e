// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Transfer schemes of first and second order, on the same connectivity and by
// overlap: the same tests for both.
#include <alveolus/base/tensors.h>
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/reconstruction.h>
#include <alveolus/transfer/swept_transfer.h>

#include <deal.II/base/timer.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <iomanip>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Shape = HistoryField::Shape;

  const std::string first = "Godunov", second = "limited linear";

  /** A number for the report of the test, from which scripts/verify takes it.
   */
  void
  record(const std::string &key, const double value)
  {
    std::ostringstream text;
    text << std::setprecision(16) << value;
    testing::Test::RecordProperty(key, text.str());
  }

  /** How the history gets to the new positions. */
  enum class Way
  {
    swept,
    overlap
  };

  /** A number in [-1,1] without pattern, the same on every process. */
  template <int dim>
  double
  noise(const Point<dim> &x, const unsigned int seed)
  {
    double sum = 0.7 * seed;
    for (unsigned int d = 0; d < dim; ++d)
      sum += (12.9898 + 31.4 * d + seed) * std::round(x[d] * 1e6) * 1e-6;
    const double y = std::sin(sum) * 437.5453;
    return 2. * (y - std::floor(y)) - 1.;
  }

  constexpr double fabric_bound = 20.;

  template <int dim>
  HistoryLayout
  bone_layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.3;
    density.upper = 1.9;
    HistoryField elastic;
    elastic.name  = "elastic strain";
    elastic.shape = Shape::symmetric_tensor;
    HistoryField fabric;
    fabric.name      = "log fabric";
    fabric.shape     = Shape::symmetric_tensor;
    fabric.traceless = true;
    fabric.lower     = -fabric_bound;
    fabric.upper     = fabric_bound;
    return HistoryLayout({density, elastic, fabric}, dim);
  }

  /** What a move did, by either transfer. */
  struct Moved
  {
    double       content_before, content_after, through_boundary;
    unsigned int n_limited;
  };

  /** Mesh, configuration and history; moves it by either transfer. */
  template <int dim>
  struct Problem
  {
    using Grid     = parallel::distributed::Triangulation<dim>;
    using Function = std::function<Tensor<1, dim>(const Point<dim> &)>;

    Problem(const Way                          way,
            const std::string                 &scheme,
            const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const MPI_Comm                     communicator   = MPI_COMM_WORLD,
            const double                       donor_fraction = 0.5)
      : way(way)
      , scheme(scheme)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      store         = make_store();
      transfer      = std::make_unique<SweptTransfer<dim>>(
        *configuration,
        *store,
        Registry<TransferScheme<dim>>::create(scheme, "Scheme"),
        "density",
        donor_fraction);
    }

    std::unique_ptr<HistoryStore<dim>>
    make_store() const
    {
      return std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}, {1, 1}},
        std::vector<HistoryLayout>{bone_layout<dim>(), bone_layout<dim>()},
        Utilities::pow(configuration->degree + 1, dim));
    }

    /** f at the initial positions of the nodes. */
    NodalVector
    positions(const Function &f) const
    {
      NodalVector          result = configuration->make_vector();
      const CellNodes<dim> nodes(*configuration);
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors position;
      for (const unsigned int c : transfer->subcells().owned_cells())
        {
          nodes.gather(configuration->initial_positions(), c, position);
          for (unsigned int i = 0; i < nodes.n_nodes; ++i)
            {
              const Tensor<1, dim> value = f(Point<dim>(position[i]));
              for (unsigned int d = 0; d < dim; ++d)
                if (nodes.local_entries(c, i)[d] < result.locally_owned_size())
                  result.local_element(nodes.local_entries(c, i)[d]) = value[d];
            }
        }
      result.update_ghost_values();
      return result;
    }

    /** Move mesh and history to @p x. */
    Moved
    move(const NodalVector &x)
    {
      if (way == Way::swept)
        {
          const TransferReport r =
            transfer->transfer(*store, configuration->positions(), x);
          configuration->set_positions(x);
          return {r.content_before,
                  r.content_after,
                  r.through_boundary,
                  r.n_limited};
        }
      const OverlapTransfer<dim> overlap(*configuration, *store, scheme);
      std::unique_ptr<HistoryStore<dim>> next = make_store();
      configuration->set_positions(x);
      const OverlapReport r = overlap.transfer(*configuration, *next);
      store->old_values     = next->old_values;
      return {r.content_before(), r.content_after(), 0., r.n_limited};
    }

    /** Go over owned sub-cells: centroid, volume, record. */
    void
    for_each(
      const std::function<void(const Point<dim> &, double, double *)> &f) const
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      transfer->subcells().centroids(configuration->positions(),
                                     centroid,
                                     volume);
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q],
            volume[c * store->n_points + q],
            store->old_record(c, q));
    }

    /** Random records; the fabric is at its bounds in many places. */
    void
    fill_noise()
    {
      for_each([this](const Point<dim> &p, double, double *r) {
        for (unsigned int k = 0; k < store->layout(0).size; ++k)
          r[k] = noise(p, k);
        r[0]           = 1.1 + 0.8 * r[0];
        double *fabric = r + store->layout(0).offset("log fabric");
        pack(tensor_function(unpack(fabric, dim),
                             [](const double value) {
                               return std::min(fabric_bound,
                                               std::max(-fabric_bound,
                                                        40. * value));
                             }),
             fabric,
             dim);
      });
    }

    Way                                 way;
    std::string                         scheme;
    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
    std::unique_ptr<HistoryStore<dim>>  store;
    std::unique_ptr<SweptTransfer<dim>> transfer;
  };

  template <int dim>
  std::function<void(parallel::distributed::Triangulation<dim> &)>
  cube(const unsigned int n)
  {
    return [n](parallel::distributed::Triangulation<dim> &t) {
      GridGenerator::subdivided_hyper_cube(t, n);
    };
  }

  template <int dim>
  void
  ball(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::hyper_ball_balanced(t);
    t.refine_global(dim == 2 ? 2 : 1);
  }

  /** Interior nodes of [0,1]^dim by noise of size @p size. */
  template <int dim>
  std::function<Tensor<1, dim>(const Point<dim> &)>
  shaken(const double size, const unsigned int seed = 1)
  {
    return [=](const Point<dim> &p) {
      Tensor<1, dim> x = p;
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
          x[d] += size * noise(p, 3 * seed + d);
      return x;
    };
  }

  template <int dim>
  constexpr unsigned int n_cells = dim == 2 ? 8 : 4;

  constexpr Way both_ways[] = {Way::swept, Way::overlap};

  /** Linear in x, another function for each value. */
  template <int dim>
  double
  linear(const Tensor<1, dim> &p, const unsigned int k)
  {
    double result = 0.9 + 0.1 * k;
    for (unsigned int d = 0; d < dim; ++d)
      result += (k == 0 ? 0.2 : 1. - 0.3 * k + 0.4 * k * d) * (p[d] - 0.5);
    return result;
  }
} // namespace

template <int dim>
void
gradient_is_exact()
{
  for (const unsigned int n : {3u, 5u, 9u})
    {
      Point<dim>                  x;
      std::vector<Point<dim>>     around;
      std::vector<Tensor<1, dim>> weights;
      // All of them on one side, as in a corner of the domain; flat.
      for (unsigned int j = 0; j < n; ++j)
        {
          Point<dim> p;
          p[0] = j + 1.;
          for (unsigned int d = 0; d < dim; ++d)
            p[d] = (d == 1 ? 1e-3 : 1.) * (1.1 + noise(p, d));
          around.push_back(p);
        }
      gradient_weights(x, around, weights);
      Tensor<1, dim> gradient;
      for (unsigned int j = 0; j < n; ++j)
        gradient +=
          weights[j] * (linear<dim>(around[j], 3) - linear<dim>(x, 3));
      for (unsigned int d = 0; d < dim; ++d)
        EXPECT_NEAR(gradient[d], 0.1 + 1.2 * d, 1e-9);
    }
  std::vector<Tensor<1, dim>> weights;
  gradient_weights(Point<dim>(), {Point<dim>::unit_vector(0)}, weights);
  EXPECT_EQ(weights[0], (Tensor<1, dim>()));
}

TEST(Reconstruction, GradientOfLinearField)
{
  gradient_is_exact<2>();
  gradient_is_exact<3>();
}

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

// A linear field of means stays that linear field. No old mean may be exceeded,
// so: an affine motion of the whole mesh into itself, in which every centroid
// comes to lie between old ones; and far from the boundary any motion at all.
template <int dim>
void
linear_field_is_exact(const unsigned int degree)
{
  Tensor<2, dim> skew, shrink;
  for (unsigned int d = 0; d < dim; ++d)
    for (unsigned int e = 0; e < dim; ++e)
      {
        skew[d][e]   = (d == e ? 1.2 : 0.) + 0.15 * (1. + d - e);
        shrink[d][e] = (d == e ? 0.93 : 0.) + 0.08 / (dim * dim) * (1. * d - e);
      }
  Tensor<1, dim> middle;
  for (unsigned int d = 0; d < dim; ++d)
    middle[d] = 0.5;

  const auto largest_error = [&](const Problem<dim> &s, const bool inner) {
    double largest = 0.;
    s.for_each([&](const Point<dim> &p, double, const double *r) {
      const Tensor<1, dim> xi   = invert(skew) * (p - middle);
      bool                 near = false; // to the boundary
      for (unsigned int d = 0; d < dim; ++d)
        near = near || std::abs(xi[d]) > 0.5 - 1.3 / n_cells<dim>;
      if (!inner || !near)
        for (unsigned int k = 0; k < s.store->layout(0).size; ++k)
          largest = std::max(largest,
                             std::abs(r[k] - linear<dim>(p, k)) /
                               std::abs(linear<dim>(p, k)));
    });
    return Utilities::MPI::max(largest, MPI_COMM_WORLD);
  };
  for (const Way way : both_ways)
    {
      Problem<dim> s(way, second, degree, cube<dim>(n_cells<dim>));
      const auto   at = [&](const unsigned int step, const bool affine) {
        return s.positions([&](const Point<dim> &p) {
          if (!affine)
            return Tensor<1, dim>(
              middle +
              skew *
                (shaken<dim>(0.1 / n_cells<dim> / degree, step)(p) - middle));
          Tensor<1, dim> x = skew * (p - middle);
          for (unsigned int i = 0; i < step; ++i)
            x = shrink * x;
          return x + middle;
        });
      };
      for (const bool affine : {true, false})
        {
          // The overlap of curved sub-cells is approximate.
          if (!affine && way == Way::overlap && (dim == 3 || degree == 2))
            continue;
          s.configuration->set_positions(at(0, affine));
          s.for_each([&](const Point<dim> &p, double, double *r) {
            for (unsigned int k = 0; k < s.store->layout(0).size; ++k)
              r[k] = linear<dim>(p, k);
          });
          for (unsigned int step = 1; step < (affine ? 5 : 2); ++step)
            EXPECT_EQ(s.move(at(step, affine)).n_limited, 0u);
          const double largest = largest_error(s, !affine);
          EXPECT_LT(largest, 1e-12);
          if (affine)
            record(std::string(way == Way::swept ? "swept " : "overlap ") +
                     std::to_string(dim) + "D degree " + std::to_string(degree),
                   largest);
        }
    }
}

TEST(LimitedLinear, LinearFieldIsExact)
{
  linear_field_is_exact<2>(1);
  linear_field_is_exact<2>(2);
  linear_field_is_exact<3>(1);
}

// A scene turned by 37 degrees has the turned result: scalars to 1e-12, tensors
// after turning them back. The field has jumps, so that limiters act.
template <int dim>
void
turned(const std::string &scheme, const unsigned int degree)
{
  const double   angle = 37. * numbers::PI / 180.;
  Tensor<2, dim> Q;
  Tensor<2, 3>   Q3;
  for (unsigned int d = 0; d < 3; ++d)
    Q3[d][d] = 1.;
  Q3[0][0] = Q3[1][1] = std::cos(angle);
  Q3[1][0]            = std::sin(angle);
  Q3[0][1]            = -Q3[1][0];
  if (dim == 3) // about another axis, too
    {
      Tensor<2, 3> other;
      other[0][0] = 1.;
      other[1][1] = other[2][2] = Q3[0][0];
      other[2][1]               = Q3[1][0];
      other[1][2]               = -Q3[1][0];
      Q3                        = other * Q3;
    }
  for (unsigned int d = 0; d < dim; ++d)
    for (unsigned int e = 0; e < dim; ++e)
      Q[d][e] = Q3[d][e];

  for (const Way way : both_ways)
    {
      std::vector<double>           reference;
      const std::vector<bool>       both{false, true};
      double                        largest = 0.;
      std::unique_ptr<Problem<dim>> s;
      for (const bool turn : both)
        {
          s             = std::make_unique<Problem<dim>>(way,
                                             scheme,
                                             degree,
                                             cube<dim>(n_cells<dim>));
          const auto at = [&](const unsigned int step) {
            return s->positions([=](const Point<dim> &p) {
              const Tensor<1, dim> x =
                shaken<dim>(0.15 / n_cells<dim> / degree, step)(p);
              return turn ? Tensor<1, dim>(Q * x) : x;
            });
          };
          const unsigned int n   = s->store->layout(0).size;
          const auto turn_record = [&](double *r, const Tensor<2, 3> &R) {
            for (const unsigned int offset :
                 {1u, 1u + n_values(Shape::symmetric_tensor, dim)})
              pack(SymmetricTensor<2, 3>(symmetrize(
                     R * Tensor<2, 3>(unpack(r + offset, dim)) * transpose(R))),
                   r + offset,
                   dim);
          };
          s->configuration->set_positions(at(0));
          s->for_each([&](const Point<dim> &p, double, double *r) {
            const Point<dim> x =
              turn ? Point<dim>(transpose(Q) * Tensor<1, dim>(p)) : p;
            const double jump = x[0] + 0.5 * x[1] < 0.6 ? 1. : -0.5;
            for (unsigned int k = 0; k < n; ++k)
              r[k] = 0.9 + 0.4 * jump * std::cos(5. * x[1] - k * x[0]);
            if (turn)
              turn_record(r, Q3);
          });
          for (unsigned int step = 1; step < 4; ++step)
            s->move(at(step));
          unsigned int i = 0;
          s->for_each([&](const Point<dim> &, double, double *r) {
            if (turn)
              turn_record(r, transpose(Q3));
            for (unsigned int k = 0; k < n; ++k, ++i)
              if (turn)
                largest = std::max(largest, std::abs(r[k] - reference[i]));
              else
                reference.push_back(r[k]);
          });
        }
      EXPECT_LT(largest, 1e-12);
      record(std::string(way == Way::swept ? "swept " : "overlap ") +
               (scheme == first ? "1 " : "2 ") + std::to_string(dim) +
               "D degree " + std::to_string(degree),
             largest);
    }
}

TEST(LimitedLinear, TurnedScene)
{
  turned<2>(second, 1);
  turned<2>(second, 2);
  turned<3>(second, 1);
  turned<2>(first, 1);
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

// The mesh moves by one sub-cell: at the same place the same value.
TEST(LimitedLinear, ExactShift)
{
  for (const Way way : both_ways)
    {
      Problem<2> s(
        way,
        second,
        1,
        [](parallel::distributed::Triangulation<2> &t) {
          GridGenerator::subdivided_hyper_rectangle(t,
                                                    {24, 3},
                                                    Point<2>(),
                                                    Point<2>(24., 3.));
        },
        MPI_COMM_WORLD,
        1.);
      const auto bump = [](const Point<2> &p) {
        const double x = p[0] - 12.;
        return std::abs(x) < 2.
                 ? 1. + 0.2 * x + 0.3 * std::sin(3. * x) * (1. + 0.1 * p[1])
                 : 0.5;
      };
      s.for_each([&](const Point<2> &p, double, double *r) { r[0] = bump(p); });
      s.move(s.positions([](const Point<2> &p) {
        const double x = p[0];
        return Tensor<1, 2>(
          {x + (x < 4. ? 0.125 * x : (x > 20. ? 0.125 * (24. - x) : 0.5)),
           p[1]});
      }));
      double largest = 0.;
      s.for_each([&](const Point<2> &p, double, const double *r) {
        EXPECT_NEAR(r[0], bump(p), 1e-14);
        largest = std::max(largest, std::abs(r[0] - bump(p)));
      });
      record(way == Way::swept ? "swept" : "overlap", largest);
    }
}

// A smooth field under a vortex motion of the mesh: orders of the error against
// the field itself, content and extrema. One mesh more, of 64 x 64 cells, with
// ALVEOLUS_FINE_TRANSFER in the environment.
TEST(LimitedLinear, ObservedOrder)
{
  const auto field = [](const Point<2> &p) {
    return 1. + 0.1 * (p[0] + 2. * p[1]) +
           0.3 * std::sin(3. * p[0] + 1.) * std::cos(2. * p[1]);
  };
  for (const Way way : both_ways)
    for (const std::string &scheme : {first, second})
      {
        const std::string key =
          std::string(way == Way::swept ? "swept " : "overlap ") +
          (scheme == first ? "1 " : "2 ");
        std::vector<double> errors;
        double              largest_drift = 0., beyond = 0.;
        for (const unsigned int n : {8, 16, 32, 64})
          {
            if (n == 64 && std::getenv("ALVEOLUS_FINE_TRANSFER") == nullptr)
              continue;
            Problem<2> s(way, scheme, 1, cube<2>(n));
            const auto at = [&](const double t) {
              return s.positions([t](const Point<2> &p) {
                const double bubble =
                  std::sin(numbers::PI * p[0]) * std::sin(numbers::PI * p[1]);
                return p + 0.25 * std::sin(2. * numbers::PI * t) * bubble *
                             Tensor<1, 2>({0.5 - p[1], p[0] - 0.5});
              });
            };
            // Midpoint values are means up to the second order.
            double low = 1e9, high = 0.;
            s.for_each([&](const Point<2> &p, double, double *r) {
              r[0] = field(p);
              low  = std::min(low, r[0]);
              high = std::max(high, r[0]);
            });
            low          = Utilities::MPI::min(low, MPI_COMM_WORLD);
            high         = Utilities::MPI::max(high, MPI_COMM_WORLD);
            double drift = 0.;
            for (unsigned int step = 1; step <= n; ++step)
              {
                const Moved m = s.move(at(step * 0.6 / n));
                drift =
                  std::max(drift,
                           std::abs(m.content_after / m.content_before - 1.));
                EXPECT_EQ(m.n_limited, 0u);
              }
            EXPECT_LT(drift, 1e-13);
            std::vector<double> error;
            s.for_each([&](const Point<2> &p, double volume, const double *r) {
              error.push_back(volume * std::abs(r[0] - field(p)));
              EXPECT_GE(r[0], low - 1e-14);
              EXPECT_LE(r[0], high + 1e-14);
              beyond = std::max({beyond, low - r[0], r[0] - high});
            });
            largest_drift = std::max(largest_drift, drift);
            errors.push_back(reproducible_sum(error, MPI_COMM_WORLD));
            if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
              std::cout << (way == Way::swept ? "swept  " : "overlap") << ' '
                        << scheme << ", 1/h = " << n << ": L1 error "
                        << errors.back() << ", order "
                        << (errors.size() < 2
                              ? 0.
                              : std::log2(errors[errors.size() - 2] /
                                          errors.back()))
                        << ", content drift " << drift << std::endl;
          }
        EXPECT_GT(std::log2(errors[1] / errors[2]),
                  scheme == first ? 0.9 : 1.8);
        for (unsigned int i = 0; i < errors.size(); ++i)
          record(key + std::to_string(8u << i), errors[i]);
        record(key + "drift", largest_drift);
        record(key + "beyond", beyond);
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
