// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_bone_tissue_h
#define alveolus_materials_bone_tissue_h

namespace alveolus
{
  /** Empirical relations of bone tissue. Densities in g/cc. */
  namespace bone_tissue
  {
    /**
     * Young's modulus L [MPa] of bone of apparent density @p density: the
     * larger of 2014 rho^2.5 and 1763 rho^3.2, which cross at 1.2094 g/cc
     * (Beaupre, Orr and Carter, J. Orthop. Res. 8 (1990) 651; Jacobs 1994).
     */
    double
    young_modulus(const double density);

    /** beta = d ln L/d ln rho: 2.5 for low, 3.2 for high density. */
    double
    stiffness_exponent(const double density);

    /**
     * Specific surface S_v [1/mm] of bone of porosity @p n: 32.3 n - 93.9 n^2 +
     * 134 n^3 - 101 n^4 + 28.8 n^5 (Martin, Crit. Rev. Biomed. Eng. 10 (1984)
     * 179).
     */
    double
    specific_surface(const double porosity);
  } // namespace bone_tissue
} // namespace alveolus

#endif
