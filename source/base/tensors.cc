// SPDX-License-Identifier: LGPL-2.1-or-later
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
  } // namespace



  Spectral
  spectral(const SymmetricTensor<2, 3> &tensor)
  {
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



  std::array<std::array<Tensor<1, 3>, 3>, 3>
  polar_spin(const SymmetricTensor<2, 3> &V)
  {
    const SymmetricTensor<2, 3> inverse =
      invert(trace(V) * dealii::unit_symmetric_tensor<3>() - V);

    std::array<std::array<Tensor<1, 3>, 3>, 3> spin;
    for (unsigned int k = 0; k < 3; ++k)
      for (unsigned int l = 0; l < 3; ++l)
        {
          // axial vector of e_k (x) V e_l - V e_l (x) e_k is (V e_l) x e_k
          const unsigned int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
          for (unsigned int m = 0; m < 3; ++m)
            spin[k][l][m] =
              inverse[m][k1] * V[l][k2] - inverse[m][k2] * V[l][k1];
        }
    return spin;
  }



  SymmetricTensor<2, 3>
  rotate(const Tensor<2, 3> &R, const SymmetricTensor<2, 3> &A)
  {
    Tensor<2, 3> RA;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        for (unsigned int k = 0; k < 3; ++k)
          RA[i][j] += R[i][k] * A[k][j];
    SymmetricTensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        result[i][j] = RA[i] * R[j];
    return result;
  }



  SymmetricTensor<2, 3>
  commutator(const Tensor<1, 3> &w, const SymmetricTensor<2, 3> &A)
  {
    // S = Omega A has the columns w x (A e_j); the result is S + S^T.
    double S[3][3];
    for (unsigned int j = 0; j < 3; ++j)
      for (unsigned int i = 0; i < 3; ++i)
        {
          const unsigned int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
          S[i][j] = w[i1] * A[i2][j] - w[i2] * A[i1][j];
        }
    SymmetricTensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        result[i][j] = S[i][j] + S[j][i];
    return result;
  }



  SymmetricTensor<2, 3>
  symmetric_product(const SymmetricTensor<2, 3> &A,
                    const SymmetricTensor<2, 3> &B,
                    const SymmetricTensor<2, 3> &C)
  {
    double AB[3][3];
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        AB[i][j] = A[i][0] * B[0][j] + A[i][1] * B[1][j] + A[i][2] * B[2][j];
    const auto entry = [&](const unsigned int i, const unsigned int j) {
      return AB[i][0] * C[0][j] + AB[i][1] * C[1][j] + AB[i][2] * C[2][j];
    };
    SymmetricTensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        result[i][i] = entry(i, i);
        for (unsigned int j = i + 1; j < 3; ++j)
          result[i][j] = 0.5 * (entry(i, j) + entry(j, i));
      }
    return result;
  }



  namespace
  {
    constexpr double       root2     = 1.41421356237309504880;
    constexpr unsigned int row[6]    = {0, 1, 2, 0, 0, 1};
    constexpr unsigned int column[6] = {0, 1, 2, 1, 2, 2};
  } // namespace



  Mandel6
  to_mandel(const SymmetricTensor<2, 3> &t)
  {
    return {{t[0][0],
             t[1][1],
             t[2][2],
             root2 * t[0][1],
             root2 * t[0][2],
             root2 * t[1][2]}};
  }



  SymmetricTensor<2, 3>
  from_mandel(const Mandel6 &c)
  {
    SymmetricTensor<2, 3> t;
    t[0][0] = c[0];
    t[1][1] = c[1];
    t[2][2] = c[2];
    t[0][1] = c[3] / root2;
    t[0][2] = c[4] / root2;
    t[1][2] = c[5] / root2;
    return t;
  }



  Mandel6
  operator*(const Mandel66 &A, const Mandel6 &b)
  {
    Mandel6 result;
    for (unsigned int i = 0; i < 6; ++i)
      result[i] = dot(A[i], b);
    return result;
  }



  Mandel66
  operator*(const Mandel66 &A, const Mandel66 &B)
  {
    Mandel66 result;
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int k = 0; k < 6; ++k)
        for (unsigned int j = 0; j < 6; ++j)
          result[i][j] += A[i][k] * B[k][j];
    return result;
  }



  void
  add_dyad(Mandel66 &A, const double factor, const Mandel6 &a)
  {
    for (unsigned int i = 0; i < 6; ++i)
      for (unsigned int j = 0; j < 6; ++j)
        A[i][j] += factor * a[i] * a[j];
  }



  void
  add_deviatoric_projection(Mandel66 &A, const double factor)
  {
    for (unsigned int i = 0; i < 6; ++i)
      A[i][i] += factor;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        A[i][j] -= factor / 3.;
  }



  Mandel66
  congruence(const SymmetricTensor<2, 3> &B)
  {
    Mandel66 A;
    for (unsigned int I = 0; I < 6; ++I)
      for (unsigned int J = I; J < 6; ++J)
        {
          const unsigned int i = row[I], j = column[I];
          const unsigned int k = row[J], l = column[J];
          // 1/sqrt(2) for each of the two mixed pairs once symmetrised
          const double weight =
            (I < 3 ? 1. : root2) * (J < 3 ? 0.5 : 1. / root2);
          A[I][J] = A[J][I] = weight * (B[i][k] * B[j][l] + B[i][l] * B[j][k]);
        }
    return A;
  }



  Cholesky6::Cholesky6(const Mandel66 &matrix)
  {
    for (unsigned int j = 0; j < 6; ++j)
      {
        double pivot = matrix[j][j];
        for (unsigned int k = 0; k < j; ++k)
          pivot -= factor[j][k] * factor[j][k];
        if (!(pivot > 0.))
          {
            positive = false;
            return;
          }
        factor[j][j] = 1. / std::sqrt(pivot);
        for (unsigned int i = j + 1; i < 6; ++i)
          {
            double sum = matrix[i][j];
            for (unsigned int k = 0; k < j; ++k)
              sum -= factor[i][k] * factor[j][k];
            factor[i][j] = sum * factor[j][j];
          }
      }
  }



  Mandel6
  Cholesky6::solve(const Mandel6 &right_hand_side) const
  {
    Mandel6 x = right_hand_side;
    for (unsigned int i = 0; i < 6; ++i)
      {
        for (unsigned int k = 0; k < i; ++k)
          x[i] -= factor[i][k] * x[k];
        x[i] *= factor[i][i];
      }
    for (unsigned int i = 6; i-- > 0;)
      {
        for (unsigned int k = i + 1; k < 6; ++k)
          x[i] -= factor[k][i] * x[k];
        x[i] *= factor[i][i];
      }
    return x;
  }



  Mandel66
  Cholesky6::inverse() const
  {
    Mandel66 result;
    for (unsigned int j = 0; j < 6; ++j)
      {
        Mandel6 unit{};
        unit[j]   = 1.;
        result[j] = solve(unit);
      }
    return result;
  }
} // namespace alveolus
