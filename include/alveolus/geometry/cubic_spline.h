// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_cubic_spline_h
#define alveolus_geometry_cubic_spline_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <vector>

namespace alveolus
{
  /**
   * Parametric interpolating cubic spline: a twice continuously differentiable
   * curve r(t) in dim dimensions through the points r(t_i) = p_i, cubic on
   * each interval. Its second derivatives at the knots ("moments") solve a
   * diagonally dominant tridiagonal system (C. de Boor, A Practical Guide to
   * Splines, chapter IV), a cyclic one for a closed curve.
   *
   * A curve that is a cubic in its parameter is reproduced exactly if the knots
   * are its parameters and the ends are not-a-knot; otherwise the distance from
   * a smooth curve is O(h^4). Lengths are in the unit of the points (mm).
   */
  template <int dim>
  class CubicSpline
  {
  public:
    /** What closes the system at the ends. */
    enum class Ends
    {
      /** Open; the outermost two intervals at each end are one cubic. With
       * three points a parabola, with two a straight line. */
      not_a_knot,
      /** Open; no second derivative at the ends. Only O(h^2) near them. */
      natural,
      /** Closed and periodic; the first point is not repeated. */
      closed
    };

    /** How knots are chosen from the points. */
    enum class Knots
    {
      chord_length, ///< steps |p_i - p_{i-1}|; t is close to the arc length
      centripetal,  ///< steps |p_i - p_{i-1}|^(1/2) (Lee 1989)
      uniform       ///< steps 1
    };

    /**
     * Spline through @p points with knots chosen from them.
     * @throws RunError if successive points coincide, or if there are fewer
     * than two of them (three for a closed curve)
     */
    explicit CubicSpline(const std::vector<dealii::Point<dim>> &points,
                         const Ends  ends  = Ends::not_a_knot,
                         const Knots knots = Knots::chord_length);

    /**
     * Spline with given knots, ascending; a closed curve has one more knot
     * than points, where it has come back to the first one.
     */
    CubicSpline(const std::vector<dealii::Point<dim>> &points,
                const std::vector<double>             &knots,
                const Ends                             ends);

    /** The knots t_i, including the closing one. */
    const std::vector<double> &
    knots() const
    {
      return t;
    }

    /** Arc length from the start to each knot. */
    const std::vector<double> &
    arc_lengths() const
    {
      return s;
    }

    /** Arc length of the whole curve. */
    double
    length() const
    {
      return s.back();
    }

    /** r(t). Beyond the ends the outermost cubics go on. */
    dealii::Point<dim>
    value(const double parameter) const;

    /** dr/dt. */
    dealii::Tensor<1, dim>
    derivative(const double parameter) const;

    /** Arc length from the start to @p parameter (Gauss quadrature). */
    double
    arc_length(const double parameter) const;

    /**
     * The parameter at which the arc length is @p length, by Newton's method
     * kept inside a bracket, to 1e-14 of the whole length. A closed curve takes
     * the length modulo its whole length.
     * @throws RunError if an open curve is shorter than that
     */
    double
    parameter_at(const double length) const;

    /** Point at arc length @p length from the start. */
    dealii::Point<dim>
    at_arc_length(const double length) const
    {
      return value(parameter_at(length));
    }

  private:
    void
    solve_for_moments(const Ends ends);

    unsigned int
    interval(const double parameter) const;

    /** Arc length within interval @p i from its start to @p parameter. */
    double
    partial_length(const unsigned int i, const double parameter) const;

    bool                                closed;
    std::vector<double>                 t, s;
    std::vector<dealii::Point<dim>>     p;       ///< closed: first one repeated
    std::vector<dealii::Tensor<1, dim>> moments; ///< second derivatives
  };
} // namespace alveolus

#endif
