// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/cubic_spline.h>

#include <deal.II/base/exceptions.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * Solve the tridiagonal system lower_i x_{i-1} + diagonal_i x_i +
     * upper_i x_{i+1} = x_i in place (no pivoting: diagonally dominant).
     */
    template <typename Value>
    void
    solve_tridiagonal(const std::vector<double> &lower,
                      std::vector<double>        diagonal,
                      const std::vector<double> &upper,
                      std::vector<Value>        &x)
    {
      const std::size_t n = x.size();
      for (std::size_t i = 1; i < n; ++i)
        {
          const double factor = lower[i] / diagonal[i - 1];
          diagonal[i] -= factor * upper[i - 1];
          x[i] -= factor * x[i - 1];
        }
      x[n - 1] /= diagonal[n - 1];
      for (std::size_t i = n - 1; i-- > 0;)
        x[i] = (x[i] - upper[i] * x[i + 1]) / diagonal[i];
    }

    template <int dim>
    std::vector<double>
    knots_of(const std::vector<Point<dim>>         &points,
             const bool                             closed,
             const typename CubicSpline<dim>::Knots kind)
    {
      std::vector<double> t(1, 0.);
      const std::size_t   n = points.size();
      for (std::size_t i = 1; i < (closed ? n + 1 : n); ++i)
        {
          const double chord = points[i % n].distance(points[i - 1]);
          t.push_back(t.back() + (kind == CubicSpline<dim>::Knots::chord_length
                                    ? chord
                                  : kind == CubicSpline<dim>::Knots::centripetal
                                    ? std::sqrt(chord)
                                    : 1.));
        }
      return t;
    }
  } // namespace

  template <int dim>
  CubicSpline<dim>::CubicSpline(const std::vector<Point<dim>> &points,
                                const Ends                     ends,
                                const Knots                    knots)
    : CubicSpline(points,
                  knots_of<dim>(points, ends == Ends::closed, knots),
                  ends)
  {}

  template <int dim>
  CubicSpline<dim>::CubicSpline(const std::vector<Point<dim>> &points,
                                const std::vector<double>     &knots,
                                const Ends                     ends)
    : closed(ends == Ends::closed)
    , t(knots)
    , p(points)
  {
    if (points.size() < (closed ? 3 : 2))
      throw RunError("Cubic spline",
                     std::to_string(points.size()) + " points are too few",
                     "an open curve needs two, a closed one three");
    if (closed)
      p.push_back(points[0]);
    AssertThrow(t.size() == p.size(), ExcDimensionMismatch(t.size(), p.size()));
    for (std::size_t i = 1; i < t.size(); ++i)
      if (!(t[i] > t[i - 1]))
        throw RunError("Cubic spline",
                       "points " + std::to_string(i - 1) + " and " +
                         std::to_string(i) + " coincide",
                       "");
    solve_for_moments(ends);

    s.assign(1, 0.);
    for (unsigned int i = 0; i + 1 < t.size(); ++i)
      s.push_back(s.back() + partial_length(i, t[i + 1]));
  }

  template <int dim>
  void
  CubicSpline<dim>::solve_for_moments(const Ends ends)
  {
    const std::size_t n = t.size();
    moments.assign(n, Tensor<1, dim>());
    if (n == 2)
      return;
    const auto h     = [this](const std::size_t i) { return t[i + 1] - t[i]; };
    const auto slope = [this, &h](const std::size_t i) {
      return (p[i + 1] - p[i]) / h(i);
    };
    if (n == 3 && ends == Ends::not_a_knot)
      {
        moments.assign(3, 2. * (slope(1) - slope(0)) / (t[2] - t[0]));
        return;
      }

    // Unknowns: the inner knots, and knot 0 = knot n-1 of a closed curve
    const std::size_t           first = closed ? 0 : 1;
    const std::size_t           m     = n - 1 - first;
    std::vector<double>         lower(m), diagonal(m), upper(m);
    std::vector<Tensor<1, dim>> x(m);
    for (std::size_t j = 0; j < m; ++j)
      {
        const std::size_t i    = j + first;
        const std::size_t back = i == 0 ? n - 2 : i - 1;
        lower[j]               = h(back);
        diagonal[j]            = 2. * (h(back) + h(i));
        upper[j]               = h(i);
        x[j]                   = 6. * (slope(i) - slope(back));
      }

    if (closed)
      {
        // Cyclic corners by the formula of Sherman and Morrison
        const double        corner = h(n - 2), gamma = -diagonal[0];
        std::vector<double> z(m, 0.);
        z[0]     = gamma;
        z[m - 1] = corner;
        diagonal[0] -= gamma;
        diagonal[m - 1] -= corner * corner / gamma;
        solve_tridiagonal(lower, diagonal, upper, x);
        solve_tridiagonal(lower, diagonal, upper, z);
        const double         ratio = corner / gamma;
        const Tensor<1, dim> factor =
          (x[0] + ratio * x[m - 1]) / (1. + z[0] + ratio * z[m - 1]);
        for (std::size_t j = 0; j < m; ++j)
          moments[j] = x[j] - z[j] * factor;
        moments[n - 1] = moments[0];
        return;
      }

    // Not-a-knot: the end moment continues the line through the next two, which
    // eliminates it from the first (last) equation.
    const double q0 = h(0) / h(1), q1 = h(n - 2) / h(n - 3);
    if (ends == Ends::not_a_knot)
      {
        diagonal[0] += lower[0] * (1. + q0);
        upper[0] -= lower[0] * q0;
        diagonal[m - 1] += upper[m - 1] * (1. + q1);
        lower[m - 1] -= upper[m - 1] * q1;
      }
    solve_tridiagonal(lower, diagonal, upper, x);
    std::copy(x.begin(), x.end(), moments.begin() + 1);
    if (ends == Ends::not_a_knot)
      {
        moments[0] = moments[1] + q0 * (moments[1] - moments[2]);
        moments[n - 1] =
          moments[n - 2] + q1 * (moments[n - 2] - moments[n - 3]);
      }
  }

  template <int dim>
  unsigned int
  CubicSpline<dim>::interval(const double parameter) const
  {
    const auto after = std::upper_bound(t.begin() + 1, t.end() - 1, parameter);
    return after - t.begin() - 1;
  }

  template <int dim>
  Point<dim>
  CubicSpline<dim>::value(const double parameter) const
  {
    const unsigned int i = interval(parameter);
    const double       h = t[i + 1] - t[i];
    const double       a = (t[i + 1] - parameter) / h, b = 1. - a;
    return Point<dim>(
      a * p[i] + b * p[i + 1] +
      h * h / 6. *
        ((a * a * a - a) * moments[i] + (b * b * b - b) * moments[i + 1]));
  }

  template <int dim>
  Tensor<1, dim>
  CubicSpline<dim>::derivative(const double parameter) const
  {
    const unsigned int i = interval(parameter);
    const double       h = t[i + 1] - t[i];
    const double       a = (t[i + 1] - parameter) / h, b = 1. - a;
    return (p[i + 1] - p[i]) / h + h / 6. *
                                     ((1. - 3. * a * a) * moments[i] +
                                      (3. * b * b - 1.) * moments[i + 1]);
  }

  template <int dim>
  double
  CubicSpline<dim>::partial_length(const unsigned int i,
                                   const double       parameter) const
  {
    static const QGauss<1> quadrature(10);
    const double           width = parameter - t[i];
    double                 sum   = 0.;
    for (unsigned int q = 0; q < quadrature.size(); ++q)
      sum += quadrature.weight(q) *
             derivative(t[i] + quadrature.point(q)[0] * width).norm();
    return sum * width;
  }

  template <int dim>
  double
  CubicSpline<dim>::arc_length(const double parameter) const
  {
    const unsigned int i = interval(parameter);
    return s[i] + partial_length(i, parameter);
  }

  template <int dim>
  double
  CubicSpline<dim>::parameter_at(const double length) const
  {
    double target = length;
    if (closed)
      target -= std::floor(target / s.back()) * s.back();
    const double epsilon = 1e-14 * s.back();
    if (!(target >= -1e3 * epsilon && target <= s.back() + 1e3 * epsilon))
      throw RunError("Cubic spline",
                     "arc length " + std::to_string(length) +
                       " lies beyond the curve of length " +
                       std::to_string(s.back()),
                     "");
    target = std::min(std::max(target, 0.), s.back());

    const auto   after = std::upper_bound(s.begin() + 1, s.end() - 1, target);
    const auto   i     = static_cast<unsigned int>(after - s.begin() - 1);
    double       low = t[i], high = t[i + 1];
    const double rest = target - s[i];
    double       x    = low + (high - low) * rest / (s[i + 1] - s[i]);
    for (unsigned int iteration = 0; iteration < 100; ++iteration)
      {
        const double error = partial_length(i, x) - rest;
        if (std::abs(error) <= epsilon)
          break;
        (error > 0. ? high : low) = x;
        const double next         = x - error / derivative(x).norm();
        // Where Newton leaves the bracket, or the curve stands still, halve.
        x = next > low && next < high ? next : 0.5 * (low + high);
      }
    return x;
  }

  template class CubicSpline<2>;
  template class CubicSpline<3>;
} // namespace alveolus
