// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/shape_metric.h>

#include <cmath>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** d^(-d/2): makes mu_shape of the identity vanish. */
    template <int dim>
    double
    norming()
    {
      return dim == 2 ? 0.5 : 1. / std::sqrt(27.);
    }

    /** Cofactor: d det T / d T, also for singular T. */
    inline Tensor<2, 2>
    cofactor(const Tensor<2, 2> &T)
    {
      Tensor<2, 2> C;
      C[0][0] = T[1][1];
      C[0][1] = -T[1][0];
      C[1][0] = -T[0][1];
      C[1][1] = T[0][0];
      return C;
    }

    inline Tensor<2, 3>
    cofactor(const Tensor<2, 3> &T)
    {
      Tensor<2, 3> C;
      for (unsigned int i = 0; i < 3; ++i)
        C[i] = cross_product_3d(T[(i + 1) % 3], T[(i + 2) % 3]);
      return C;
    }

    /** H += f d cof T / d T. */
    inline void
    add_cofactor_derivative(const double f,
                            const Tensor<2, 2> &,
                            Tensor<4, 2> &H)
    {
      H[0][0][1][1] += f;
      H[1][1][0][0] += f;
      H[0][1][1][0] -= f;
      H[1][0][0][1] -= f;
    }

    inline void
    add_cofactor_derivative(const double        f,
                            const Tensor<2, 3> &T,
                            Tensor<4, 3>       &H)
    {
      // cof_ij = T_i+1,j+1 T_i+2,j+2 - T_i+1,j+2 T_i+2,j+1, indices modulo 3
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = 0; j < 3; ++j)
          {
            const unsigned int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
            const unsigned int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
            H[i][j][i1][j1] += f * T[i2][j2];
            H[i][j][i2][j2] += f * T[i1][j1];
            H[i][j][i1][j2] -= f * T[i2][j1];
            H[i][j][i2][j1] -= f * T[i1][j2];
          }
    }
  } // namespace

  template <int dim>
  double
  ShapeMetric<dim>::value(const Tensor<2, dim> &T) const
  {
    const double tau = determinant(T);
    // A number that is none is not positive either.
    if (!(tau > 0.))
      return std::numeric_limits<double>::infinity();
    const double I = T.norm_square();
    const double mu =
      (1. - size_weight) *
        (norming<dim>() * (dim == 2 ? I : I * std::sqrt(I)) / tau - 1.) +
      size_weight * (0.5 * (tau + 1. / tau) - 1.);
    return std::isfinite(mu) ? mu : std::numeric_limits<double>::infinity();
  }

  template <int dim>
  typename ShapeMetric<dim>::Derivatives
  ShapeMetric<dim>::derivatives(const Tensor<2, dim> &T) const
  {
    const double p   = 0.5 * dim;
    const double tau = determinant(T);
    const double I   = T.norm_square();
    const double f   = (1. - size_weight) * norming<dim>() *
                     (dim == 2 ? I : I * std::sqrt(I)) / tau;
    Derivatives d;
    d.I       = p * f / I;
    d.tau     = -f / tau + size_weight * 0.5 * (1. - 1. / (tau * tau));
    d.II      = p * (p - 1.) * f / (I * I);
    d.I_tau   = -p * f / (I * tau);
    d.tau_tau = 2. * f / (tau * tau) + size_weight / (tau * tau * tau);
    return d;
  }

  template <int dim>
  Tensor<2, dim>
  ShapeMetric<dim>::gradient(const Tensor<2, dim> &T) const
  {
    const Derivatives d = derivatives(T);
    return 2. * d.I * T + d.tau * cofactor(T);
  }

  template <int dim>
  Tensor<4, dim>
  ShapeMetric<dim>::hessian(const Tensor<2, dim> &T) const
  {
    const Derivatives    d = derivatives(T);
    const Tensor<2, dim> C = cofactor(T);
    Tensor<4, dim>       H;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        {
          H[i][j] = (4. * d.II * T[i][j] + 2. * d.I_tau * C[i][j]) * T +
                    (2. * d.I_tau * T[i][j] + d.tau_tau * C[i][j]) * C;
          H[i][j][i][j] += 2. * d.I;
        }
    add_cofactor_derivative(d.tau, T, H);
    return H;
  }

  template class ShapeMetric<2>;
  template class ShapeMetric<3>;
} // namespace alveolus
