// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_shape_metric_h
#define alveolus_rezoning_shape_metric_h

#include <deal.II/base/tensor.h>

namespace alveolus
{
  /**
   * How far a cell is, at a point, from what it should be there: with the
   * Jacobian T of the map from the wanted to the present cell, tau = det T and
   * |T|^2 = T : T,
   *
   *   mu(T) = (1 - g) mu_shape + g mu_size,
   *   mu_shape = |T|^d / (d^(d/2) tau) - 1,
   *   mu_size  = (tau + 1/tau)/2 - 1,
   *
   * g in [0, 1) the weight of the size. mu is not negative; mu_shape vanishes
   * for rotations times a scale only, mu_size for tau = 1. Both are polyconvex
   * and grow to infinity as tau goes to zero: the barrier. They are the metrics
   * 2 and 56 in two, 304 and 316 in three dimensions in the numbering of P.
   * Knupp (Dobrev, Knupp, Kolev, Mittal, Tomov, SIAM J. Sci. Comput. 41 (2019)
   * B50-B68). No units.
   */
  template <int dim>
  class ShapeMetric
  {
  public:
    /** @param size_weight weight of sizes beside shapes [-] */
    explicit ShapeMetric(const double size_weight = 0.)
      : size_weight(size_weight)
    {}

    /** mu(T); infinity where tau is not positive or mu overflows. */
    double
    value(const dealii::Tensor<2, dim> &T) const;

    /** d mu / d T; tau must be positive. */
    dealii::Tensor<2, dim>
    gradient(const dealii::Tensor<2, dim> &T) const;

    /** d^2 mu / d T d T, indices [i][j][k][l]; tau must be positive. */
    dealii::Tensor<4, dim>
    hessian(const dealii::Tensor<2, dim> &T) const;

  private:
    /** Derivatives of mu by I = |T|^2 and tau. */
    struct Derivatives
    {
      double I, tau, II, I_tau, tau_tau;
    };

    Derivatives
    derivatives(const dealii::Tensor<2, dim> &T) const;

    double size_weight;
  };
} // namespace alveolus

#endif
