// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Accuracy of transfer schemes of first and second order, on the same
// connectivity and by overlap: what linear fields, turned scenes, shifts and a
// smooth field dictate. scripts/verify takes numbers from here.
#include "two_ways_problem.h"

#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/reconstruction.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <iomanip>
#include <sstream>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  /** A number for the report of the test, from which scripts/verify takes it.
   */
  void
  record(const std::string &key, const double value)
  {
    std::ostringstream text;
    text << std::setprecision(16) << value;
    testing::Test::RecordProperty(key, text.str());
  }

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
