// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_hex_optimiser_h
#define alveolus_remeshing_hex_optimiser_h

#include <alveolus/remeshing/hex_mesh.h>

namespace alveolus
{
  /** What corners of hexahedra are worth, 1 for a cube. */
  struct HexQuality
  {
    /** Scaled Jacobian (Knupp 2000): sees angles only. */
    double jacobian = 1.;
    /**
     * Mean ratio 3 det^(2/3)/(|a|^2 + |b|^2 + |c|^2) of the edges a, b, c
     * with the sign of the determinant: small also where one of the edges is
     * much shorter than the others. A value s bounds the ratio r of the
     * shortest to the longest edge of the corner: s <= (2 r/(1 + r^2))^(2/3).
     * Of cells in layers, which are thin, it is 1.
     */
    double shape = 1.;
  };

  /** What came of optimise_hexahedra(). */
  struct HexOptimiserReport
  {
    HexQuality   before;       ///< the smallest ones of all corners
    HexQuality   after;        ///< the smallest ones of all corners
    unsigned int n_sweeps = 0; ///< times that nodes were moved
  };

  /**
   * Move nodes so that bad corners become better: each in turn goes down the
   * slope of
   *
   *   sum max(0, good - q)^4 + max(0, good - s)^4
   *
   * over the corners it changes,
   * q and s the scaled Jacobian and the shape of a corner, nodes inside
   * anywhere, those on patches along these, those in layers with the point on
   * the patch they belong to. Nodes on curves stay. A step that does not lower
   * the sum is halved. By q alone edges may shrink to nothing between good
   * angles, and the least strain then turns corners inside out. Deterministic.
   * @param good corners at least this good are left alone
   */
  HexOptimiserReport
  optimise_hexahedra(HexMesh           &mesh,
                     const SurfaceMesh &surface,
                     const double       good,
                     const unsigned int n_sweeps);
} // namespace alveolus

#endif
