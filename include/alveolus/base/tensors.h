// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_tensors_h
#define alveolus_base_tensors_h

#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>

namespace alveolus
{
  /** Eigenvalues in descending order, and orthonormal eigenvectors. */
  struct Spectral
  {
    /** Eigenvalues, each with its vector. */
    std::array<double, 3>               values;
    std::array<dealii::Tensor<1, 3>, 3> vectors; ///< orthonormal
    /**
     * Which eigenvector is e_z, if the tensor has no xz and yz components
     * (plane strain); 3 for any other tensor. Turning the vectors does not
     * change it.
     */
    unsigned int normal_axis = 3;
  };

  /**
   * Eigen-decomposition of a symmetric tensor by cyclic Jacobi rotations:
   * reliable for any spacing of the eigenvalues, and a single rotation for a
   * tensor of plane strain.
   */
  Spectral
  spectral(const dealii::SymmetricTensor<2, 3> &tensor);

  /** The tensor with the given eigenvalues and the eigenvectors of @p basis. */
  dealii::SymmetricTensor<2, 3>
  compose(const std::array<double, 3> &values, const Spectral &basis);

  /** f(tensor) for a scalar function f, by its eigenvalues. */
  template <class Function>
  dealii::SymmetricTensor<2, 3>
  tensor_function(const dealii::SymmetricTensor<2, 3> &tensor,
                  const Function                      &function)
  {
    const Spectral s = spectral(tensor);
    return compose(
      {{function(s.values[0]), function(s.values[1]), function(s.values[2])}},
      s);
  }

  /** Exponential of a symmetric tensor. */
  dealii::SymmetricTensor<2, 3>
  exp(const dealii::SymmetricTensor<2, 3> &tensor);

  /** Logarithm of a symmetric positive definite tensor. */
  dealii::SymmetricTensor<2, 3>
  log(const dealii::SymmetricTensor<2, 3> &tensor);

  /**
   * (1/2) (ln x - ln y) / (x - y) for x, y > 0, with its limit 1/(2x) for
   * equal arguments; accurate to round-off for nearly equal ones.
   */
  double
  half_log_quotient(const double x, const double y);

  /** sinh(x)/x, with its limit 1 at zero. */
  double
  sinhc(const double x);

  /** f = V R with V symmetric positive definite and R a rotation. */
  struct Polar
  {
    dealii::SymmetricTensor<2, 3> V; ///< left stretch [-]
    dealii::Tensor<2, 3>          R; ///< rotation
  };

  /** Left polar decomposition of @p f, det f > 0. */
  Polar
  polar(const dealii::Tensor<2, 3> &f);

  /**
   * Spin of the polar rotation: for df = l f, dR = Omega R with
   * V Omega + Omega V = l V - V l^T, that is, for the axial vector w of Omega
   * (Omega a = w x a), w = (tr V I - V)^{-1} axial(l V - V l^T).
   * @return spin[k][l] = w for the velocity gradient e_k (x) e_l
   */
  std::array<std::array<dealii::Tensor<1, 3>, 3>, 3>
  polar_spin(const dealii::SymmetricTensor<2, 3> &V);

  /** R A R^T. */
  dealii::SymmetricTensor<2, 3>
  rotate(const dealii::Tensor<2, 3> &R, const dealii::SymmetricTensor<2, 3> &A);

  /** True if every component is exactly zero. */
  inline bool
  is_zero(const dealii::SymmetricTensor<2, 3> &A)
  {
    for (unsigned int i = 0; i < 6; ++i)
      if (A.access_raw_entry(i) != 0.)
        return false;
    return true;
  }

  /** Omega A - A Omega for the skew tensor Omega of the axial vector w. */
  dealii::SymmetricTensor<2, 3>
  commutator(const dealii::Tensor<1, 3>          &w,
             const dealii::SymmetricTensor<2, 3> &A);

  /** Symmetric part of the product A B C. */
  dealii::SymmetricTensor<2, 3>
  symmetric_product(const dealii::SymmetricTensor<2, 3> &A,
                    const dealii::SymmetricTensor<2, 3> &B,
                    const dealii::SymmetricTensor<2, 3> &C);

  /**
   * Six components xx, yy, zz, xy, xz, yz of a symmetric tensor in the
   * orthonormal (Mandel or Kelvin) basis: shear components carry sqrt(2), so
   * that the double contraction is the scalar product and the inverse of a
   * fourth-order tensor is the inverse of its matrix.
   */
  using Mandel6 = std::array<double, 6>;

  /** Components 11, 22, 33 and sqrt(2) times 12, 13, 23. */
  Mandel6
  to_mandel(const dealii::SymmetricTensor<2, 3> &tensor);

  /** The tensor with these Mandel components. */
  dealii::SymmetricTensor<2, 3>
  from_mandel(const Mandel6 &components);

  /** Scalar product of two tensors in Mandel components. */
  inline double
  dot(const Mandel6 &a, const Mandel6 &b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] +
           a[5] * b[5];
  }

  /** A fourth-order tensor with both minor symmetries in the same basis. */
  struct Mandel66
  {
    std::array<Mandel6, 6> rows{}; ///< one for each component of the result

    /** Row i of the matrix. */
    Mandel6 &
    operator[](const unsigned int i)
    {
      return rows[i];
    }
    /** Row i of the matrix. */
    const Mandel6 &
    operator[](const unsigned int i) const
    {
      return rows[i];
    }
  };

  /** The second-order tensor A : b. */
  Mandel6
  operator*(const Mandel66 &A, const Mandel6 &b);

  /** The fourth-order tensor A : B. */
  Mandel66
  operator*(const Mandel66 &A, const Mandel66 &B);

  /** this += factor a (x) a. */
  void
  add_dyad(Mandel66 &A, const double factor, const Mandel6 &a);

  /** this += factor P with P the projection onto deviators. */
  void
  add_deviatoric_projection(Mandel66 &A, const double factor);

  /** The linear map h -> B h B. */
  Mandel66
  congruence(const dealii::SymmetricTensor<2, 3> &B);

  /**
   * Cholesky factorisation of a symmetric positive definite matrix.
   * valid() is false if it is not positive definite (or not finite).
   */
  class Cholesky6
  {
  public:
    /** Decompose a symmetric matrix, of which the lower triangle is read. */
    explicit Cholesky6(const Mandel66 &matrix);

    /**
     * Whether the matrix is positive definite; the rest is meaningless
     * otherwise.
     */
    bool
    valid() const
    {
      return positive;
    }

    /** Solve for one right-hand side. */
    Mandel6
    solve(const Mandel6 &right_hand_side) const;

    /** Inverse of the matrix. */
    Mandel66
    inverse() const;

  private:
    Mandel66 factor; ///< lower triangle, reciprocal diagonal
    bool     positive = true;
  };
} // namespace alveolus

#endif
