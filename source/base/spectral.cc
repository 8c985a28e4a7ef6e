// SPDX-License-Identifier: LGPL-2.1-or-later
// Functions of symmetric tensors by their eigenvalues, in closed form where the
// tensor is one of plane strain.
#include <alveolus/base/tensors.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    /** A B of tensors that commute. */
    inline SymmetricTensor<2, 3>
    symmetric_product(const SymmetricTensor<2, 3> &A,
                      const SymmetricTensor<2, 3> &B)
    {
      SymmetricTensor<2, 3> result;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          result[i][j] =
            A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
      return result;
    }

    bool
    is_plane(const SymmetricTensor<2, 3> &tensor)
    {
      return tensor[0][2] == 0. && tensor[1][2] == 0.;
    }

    /** The one rotation that a tensor of plane strain needs. */
    Spectral
    spectral_in_plane(const SymmetricTensor<2, 3> &tensor)
    {
      double       x = tensor[0][0], y = tensor[1][1];
      const double z = tensor[2][2], off = tensor[0][1];
      double       cosine = 1., sine = 0.;
      if (std::abs(off) >
          1e-18 * std::max({std::abs(x), std::abs(y), std::abs(z)}))
        {
          // tan of the smaller of the two angles that annihilate the xy entry
          const double theta = 0.5 * (y - x) / off;
          const double t     = (theta >= 0. ? 1. : -1.) /
                           (std::abs(theta) + std::sqrt(theta * theta + 1.));
          cosine = 1. / std::sqrt(t * t + 1.);
          sine   = t * cosine;
          x -= t * off;
          y += t * off;
        }
      const Tensor<1, 3> first({cosine, -sine, 0.}), second({sine, cosine, 0.}),
        normal({0., 0., 1.});
      const bool   turn  = x < y;
      const double large = turn ? y : x, small = turn ? x : y;
      Spectral     s;
      // The order of the general method: e_z after its equals
      s.normal_axis            = small >= z ? 2 : (large >= z ? 1 : 0);
      s.values[s.normal_axis]  = z;
      s.vectors[s.normal_axis] = normal;
      const unsigned int i     = s.normal_axis == 0 ? 1 : 0;
      const unsigned int j     = s.normal_axis == 2 ? 1 : 2;
      s.values[i]              = large;
      s.values[j]              = small;
      s.vectors[i]             = turn ? second : first;
      s.vectors[j]             = turn ? first : second;
      return s;
    }
  } // namespace



  Spectral
  spectral(const SymmetricTensor<2, 3> &tensor)
  {
    if (is_plane(tensor))
      return spectral_in_plane(tensor);

    double a[3][3], q[3][3];
    double scale = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        {
          a[i][j] = tensor[i][j];
          q[i][j] = (i == j) ? 1. : 0.;
          scale   = std::max(scale, std::abs(a[i][j]));
        }

    // Below this an off-diagonal entry changes no digit of tensor or vectors.
    const double negligible = 1e-18 * scale;

    constexpr unsigned int pairs[3][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};
    for (unsigned int sweep = 0; sweep < 30; ++sweep)
      {
        bool rotated = false;
        for (const auto &[p, r, s] : pairs)
          {
            const double off = a[p][r];
            if (!(std::abs(off) > negligible))
              continue;
            rotated = true;
            // tan of the smaller of the two angles that annihilate a[p][r]
            const double theta = 0.5 * (a[r][r] - a[p][p]) / off;
            const double t     = (theta >= 0. ? 1. : -1.) /
                             (std::abs(theta) + std::sqrt(theta * theta + 1.));
            const double cosine = 1. / std::sqrt(t * t + 1.);
            const double sine   = t * cosine;
            a[p][p] -= t * off;
            a[r][r] += t * off;
            a[p][r] = a[r][p] = 0.;
            const double sp = a[s][p], sr = a[s][r];
            a[s][p] = a[p][s] = cosine * sp - sine * sr;
            a[s][r] = a[r][s] = sine * sp + cosine * sr;
            for (auto &row : q)
              {
                const double x = row[p], y = row[r];
                row[p] = cosine * x - sine * y;
                row[r] = sine * x + cosine * y;
              }
          }
        if (!rotated)
          break;
      }

    std::array<unsigned int, 3> order{{0, 1, 2}};
    if (a[order[0]][order[0]] < a[order[1]][order[1]])
      std::swap(order[0], order[1]);
    if (a[order[1]][order[1]] < a[order[2]][order[2]])
      std::swap(order[1], order[2]);
    if (a[order[0]][order[0]] < a[order[1]][order[1]])
      std::swap(order[0], order[1]);

    Spectral result;
    for (unsigned int k = 0; k < 3; ++k)
      {
        result.values[k] = a[order[k]][order[k]];
        for (unsigned int i = 0; i < 3; ++i)
          result.vectors[k][i] = q[i][order[k]];
      }
    return result;
  }



  SymmetricTensor<2, 3>
  compose(const std::array<double, 3> &values, const Spectral &basis)
  {
    SymmetricTensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        {
          double sum = 0.;
          for (unsigned int a = 0; a < 3; ++a)
            sum += values[a] * basis.vectors[a][i] * basis.vectors[a][j];
          result[i][j] = sum;
        }
    return result;
  }



  SymmetricTensor<2, 3>
  exp(const SymmetricTensor<2, 3> &tensor)
  {
    if (is_plane(tensor))
      {
        // exp(m I + D) = e^m (cosh r I + (sinh r)/r D) with trace-free D of the
        // plane and D^2 = r^2 I; the series ends below round-off for r < 0.3
        const double m    = 0.5 * (tensor[0][0] + tensor[1][1]);
        const double half = 0.5 * (tensor[0][0] - tensor[1][1]);
        const double r2   = half * half + tensor[0][1] * tensor[0][1];
        if (r2 < 0.09)
          {
            const double cosh =
              1. +
              r2 / 2. *
                (1. + r2 / 12. *
                        (1. + r2 / 30. *
                                (1. + r2 / 56. *
                                        (1. + r2 / 90. * (1. + r2 / 132.)))));
            const double sinhc =
              1. +
              r2 / 6. *
                (1. + r2 / 20. *
                        (1. + r2 / 42. *
                                (1. + r2 / 72. *
                                        (1. + r2 / 110. * (1. + r2 / 156.)))));
            const double          e = std::exp(m);
            SymmetricTensor<2, 3> result;
            result[0][0] = e * (cosh + sinhc * half);
            result[1][1] = e * (cosh - sinhc * half);
            result[0][1] = e * sinhc * tensor[0][1];
            result[2][2] = std::exp(tensor[2][2]);
            return result;
          }
      }
    // Taylor series after halving: elastic strains are small, so that a few
    // products do what an eigen-decomposition would take far longer for.
    double largest = tensor.norm();
    if (!(largest < 100.)) // or not a number
      return tensor_function(tensor,
                             [](const double x) { return std::exp(x); });
    unsigned int halved = 0;
    for (; largest > 0.25; ++halved)
      largest *= 0.5;
    const SymmetricTensor<2, 3> a    = tensor / std::pow(2., halved);
    SymmetricTensor<2, 3>       term = a;
    SymmetricTensor<2, 3>       rest = a; // of exp(a) - I
    double                      size = largest;
    for (unsigned int n = 2; size > 1e-18; ++n)
      {
        term = symmetric_product(a, term) / n;
        rest += term;
        size *= largest / n;
      }
    // exp(2 a) - I = (exp(a) - I)^2 + 2 (exp(a) - I)
    for (unsigned int n = 0; n < halved; ++n)
      rest = symmetric_product(rest, rest) + 2. * rest;
    return rest + dealii::unit_symmetric_tensor<3>();
  }



  SymmetricTensor<2, 3>
  log(const SymmetricTensor<2, 3> &tensor)
  {
    return tensor_function(tensor, [](const double x) { return std::log(x); });
  }



  double
  half_log_quotient(const double x, const double y)
  {
    const double d = (x - y) / y;
    // log1p is accurate for any d > -1; only the quotient 0/0 has to be avoided
    if (std::abs(d) < 1e-8)
      return 0.5 * (1. - 0.5 * d) / y;
    return 0.5 * std::log1p(d) / (x - y);
  }



  double
  sinhc(const double x)
  {
    return std::abs(x) < 1e-4 ? 1. + x * x / 6. : std::sinh(x) / x;
  }



  Polar
  polar(const Tensor<2, 3> &f)
  {
    if (f[0][2] == 0. && f[1][2] == 0. && f[2][0] == 0. && f[2][1] == 0. &&
        f[2][2] > 0.)
      {
        // In the plane: the angle that makes R^T f symmetric
        const double cosine = f[0][0] + f[1][1], sine = f[1][0] - f[0][1];
        const double length = std::sqrt(cosine * cosine + sine * sine);
        const double c = cosine / length, s = sine / length;
        Polar        result;
        result.R[0][0] = result.R[1][1] = c;
        result.R[1][0]                  = s;
        result.R[0][1]                  = -s;
        result.R[2][2]                  = 1.;
        result.V[0][0]                  = f[0][0] * c - f[0][1] * s;
        result.V[1][1]                  = f[1][0] * s + f[1][1] * c;
        result.V[0][1] =
          0.5 * (f[0][0] * s + f[0][1] * c + f[1][0] * c - f[1][1] * s);
        result.V[2][2] = f[2][2];
        return result;
      }

    SymmetricTensor<2, 3> b;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        b[i][j] = f[i] * f[j];
    const Spectral        s = spectral(b);
    std::array<double, 3> stretch, inverse;
    for (unsigned int a = 0; a < 3; ++a)
      {
        stretch[a] = std::sqrt(s.values[a]);
        inverse[a] = 1. / stretch[a];
      }
    Polar result;
    result.V = compose(stretch, s);
    result.R = Tensor<2, 3>(compose(inverse, s)) * f;
    return result;
  }
} // namespace alveolus
