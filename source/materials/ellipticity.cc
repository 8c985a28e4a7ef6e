// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/ellipticity.h>

#include <deal.II/base/numbers.h>

#include <algorithm>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    /** Symmetric part of a_ijkl p_j q_l. */
    SymmetricTensor<2, 3>
    contraction(const MaterialResponse &response,
                const Tensor<1, 3>     &p,
                const Tensor<1, 3>     &q)
    {
      Tensor<2, 3>       M;
      const Tensor<1, 3> stress_q = response.stress * q;
      for (unsigned int k = 0; k < 3; ++k)
        {
          SymmetricTensor<2, 3> T;
          for (unsigned int l = 0; l < 3; ++l)
            T += q[l] * response.tangent[k][l];
          const Tensor<1, 3> column = T * p;
          for (unsigned int i = 0; i < 3; ++i)
            M[i][k] = column[i] - stress_q[i] * p[k];
        }
      return symmetrize(M);
    }

    double
    least_eigenvalue(const SymmetricTensor<2, 3> &Q, const unsigned int dim)
    {
      if (dim == 3)
        return spectral(Q).values[2];
      return 0.5 * (Q[0][0] + Q[1][1]) -
             std::hypot(0.5 * (Q[0][0] - Q[1][1]), Q[0][1]);
    }

    /** Least eigenvalue over n = cos(phi) v + sin(phi) w. */
    double
    least_in_plane(const MaterialResponse &response,
                   const Tensor<1, 3>     &v,
                   const Tensor<1, 3>     &w,
                   const unsigned int      dim)
    {
      const auto vv    = contraction(response, v, v);
      const auto ww    = contraction(response, w, w);
      const auto vw    = contraction(response, v, w);
      const auto wv    = contraction(response, w, v);
      const auto value = [&](const double phi) {
        const double c = std::cos(phi), s = std::sin(phi);
        return least_eigenvalue(c * c * vv + s * s * ww + c * s * (vw + wv),
                                dim);
      };
      // Coarse scan of the half circle, then golden sections about the best
      constexpr unsigned int n     = 24;
      const double           width = dealii::numbers::PI / n;
      unsigned int           best  = 0;
      double                 least = value(0.);
      for (unsigned int i = 1; i < n; ++i)
        {
          const double at = value(i * width);
          if (at < least)
            {
              least = at;
              best  = i;
            }
        }
      constexpr double golden = 0.61803398874989484820;
      double           a = (best - 1.) * width, b = (best + 1.) * width;
      double           x = b - golden * (b - a), y = a + golden * (b - a);
      double           at_x = value(x), at_y = value(y);
      for (unsigned int i = 0; i < 30; ++i)
        if (at_x < at_y)
          {
            b    = y;
            y    = x;
            at_y = at_x;
            x    = b - golden * (b - a);
            at_x = value(x);
          }
        else
          {
            a    = x;
            x    = y;
            at_x = at_y;
            y    = a + golden * (b - a);
            at_y = value(y);
          }
      return std::min({least, at_x, at_y});
    }
  } // namespace



  double
  least_acoustic_eigenvalue(const MaterialResponse &response,
                            const Spectral         &axes,
                            const unsigned int      dim)
  {
    if (dim == 2)
      return least_in_plane(response,
                            Tensor<1, 3>({1., 0., 0.}),
                            Tensor<1, 3>({0., 1., 0.}),
                            dim);
    const auto &v = axes.vectors;
    return std::min({least_in_plane(response, v[0], v[1], dim),
                     least_in_plane(response, v[0], v[2], dim),
                     least_in_plane(response, v[1], v[2], dim)});
  }
} // namespace alveolus
