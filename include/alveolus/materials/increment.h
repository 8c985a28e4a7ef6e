// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_increment_h
#define alveolus_materials_increment_h

#include <alveolus/base/tensors.h>
#include <alveolus/materials/material.h>

namespace alveolus
{
  /**
   * Kinematics of an increment for laws written in the elastic Hencky strain
   * h = (1/2) ln b: the trial state b = f exp(2 h_n) f^T.
   *
   * The derivative of h for df = l f is, in the eigenbasis of b with
   * eigenvalues B_i, dh_ij = G_ij (l_ij B_j + B_i l_ji),
   * G_ij = (1/2) (ln B_i - ln B_j)/(B_i - B_j) (e.g. Miehe, Comput. Struct. 66
   * (1998) 37), with the limit 1/(2 B_i) for equal eigenvalues.
   */
  struct Increment
  {
    /**
     * @param f              deformation increment
     * @param elastic_strain Hencky strain h_n at the beginning
     * @throws RunError if det f is not positive or anything is not finite
     */
    Increment(const dealii::Tensor<2, 3>          &f,
              const dealii::SymmetricTensor<2, 3> &elastic_strain);

    /** h = (1/2) ln b. */
    dealii::SymmetricTensor<2, 3>
    strain() const
    {
      return compose(principal, b);
    }

    /** Eigenvalues (descending) and eigenvectors of b. */
    Spectral b;
    /** Principal Hencky strains, ln(B_a)/2, in the order of b. */
    std::array<double, 3> principal;
  };

  /** Principal Kirchhoff stress of an isotropic law and its derivatives. */
  struct PrincipalResponse
  {
    /** Principal stresses tau_a [MPa]. */
    std::array<double, 3> stress;
    /** d tau_a / d h_b [MPa]. */
    std::array<std::array<double, 3>, 3> normal;
    /**
     * (tau_a - tau_b)/(h_a - h_b) or its limit [MPa], entry c for the pair
     * other than c: shear[2] for (0, 1), shear[1] for (0, 2), shear[0] for
     * (1, 2).
     */
    std::array<double, 3> shear;
    /** Stored energy [MPa]. */
    double energy = 0.;
  };

  /**
   * Stress and, if asked for, the tangent of an isotropic law: both are
   * coaxial with b.
   */
  void
  isotropic_response(const Increment         &increment,
                     const PrincipalResponse &principal,
                     const bool               need_tangent,
                     MaterialResponse        &response);

  /** Tangent from C = d tau/d h: dtau = C : dh. */
  void
  general_tangent(const Increment  &increment,
                  const Mandel66   &C,
                  MaterialResponse &response);

  /**
   * Tangent of a law tau(h, H) that is jointly isotropic in the trial strain h
   * and a structural tensor H = R H_n R^T turning with the polar rotation R of
   * f: dtau = Omega tau - tau Omega + C : (dh - Omega h + h Omega), Omega the
   * spin of R. response.stress must be set.
   * @param V left stretch of the polar decomposition of f
   */
  void
  structural_tangent(const Increment                     &increment,
                     const dealii::SymmetricTensor<2, 3> &V,
                     const Mandel66                      &C,
                     MaterialResponse                    &response);
} // namespace alveolus

#endif
