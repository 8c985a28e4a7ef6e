// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/tensors.h>

#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    using Matrix3 = std::array<std::array<double, 3>, 3>;

    /** All entries, since SymmetricTensor's indices are costly in a product. */
    inline Matrix3
    matrix(const SymmetricTensor<2, 3> &A)
    {
      const auto x = [&A](const unsigned int i) {
        return A.access_raw_entry(i);
      };
      return {
        {{{x(0), x(3), x(4)}}, {{x(3), x(1), x(5)}}, {{x(4), x(5), x(2)}}}};
    }
  } // namespace



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
    const Matrix3 a = matrix(A), b = matrix(B), c = matrix(C);
    Matrix3       ab, abc;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        ab[i][j] = a[i][0] * b[0][j] + a[i][1] * b[1][j] + a[i][2] * b[2][j];
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        abc[i][j] =
          ab[i][0] * c[0][j] + ab[i][1] * c[1][j] + ab[i][2] * c[2][j];
    SymmetricTensor<2, 3> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        result.access_raw_entry(i) = abc[i][i];
        for (unsigned int j = i + 1; j < 3; ++j)
          result.access_raw_entry(i + j + 2) = 0.5 * (abc[i][j] + abc[j][i]);
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
    if (B[0][2] == 0. && B[1][2] == 0.)
      {
        const double x = B[0][0], y = B[1][1], z = B[2][2], o = B[0][1];
        A[0][0] = x * x;
        A[1][1] = y * y;
        A[2][2] = z * z;
        A[0][1] = A[1][0] = o * o;
        A[0][3] = A[3][0] = root2 * x * o;
        A[1][3] = A[3][1] = root2 * y * o;
        A[3][3]           = x * y + o * o;
        A[4][4]           = x * z;
        A[5][5]           = y * z;
        A[4][5] = A[5][4] = o * z;
        return A;
      }
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
