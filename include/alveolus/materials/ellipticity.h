// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_ellipticity_h
#define alveolus_materials_ellipticity_h

#include <alveolus/base/tensors.h>
#include <alveolus/materials/material.h>

namespace alveolus
{
  /**
   * Least eigenvalue [MPa] of the symmetric part of the acoustic tensor over
   * directions n,
   *
   *   Q_ik(n) = a_ijkl n_j n_l,   a_ijkl l_kl = (dtau - tau l^T)_ij,
   *
   * a the spatial first elasticity tensor per undeformed volume (J times the
   * one of Cauchy stress) of the response at a state, l a velocity gradient. It
   * is positive for all n where the law is strongly elliptic; where it is not,
   * the deformation may localise and results depend on the mesh (Ogden,
   * Non-linear Elastic Deformations (1984), section 6.2.7).
   *
   * dim = 2: over all n in the plane, with polarisation in the plane (plane
   * strain has no other modes). dim = 3: over all n in the three planes spanned
   * by two of @p axes, with any polarisation; an upper bound of the minimum
   * over all n.
   * @param response stress and tangent for a vanishing increment
   * @param axes     principal axes of the strain; not used for dim = 2
   */
  double
  least_acoustic_eigenvalue(const MaterialResponse &response,
                            const Spectral         &axes,
                            const unsigned int      dim);
} // namespace alveolus

#endif
