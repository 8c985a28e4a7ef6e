// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_hex_optimiser_h
#define alveolus_remeshing_hex_optimiser_h

#include <alveolus/remeshing/hex_mesh.h>

namespace alveolus
{
  /** What came of optimise_hexahedra(). */
  struct HexOptimiserReport
  {
    double       before   = 0.; ///< smallest scaled Jacobian [-]
    double       after    = 0.; ///< smallest scaled Jacobian [-]
    unsigned int n_sweeps = 0;  ///< times that nodes were moved
  };

  /**
   * Move nodes so that bad corners become better: each in turn goes down the
   * slope of
   *
   *   sum over the corners it changes of max(0, good - q)^4,
   *
   * q the scaled Jacobian of the corner (Knupp 2000), nodes inside anywhere,
   * those on patches along these, those in layers with the point on the patch
   * they belong to. Nodes on curves stay. A step that does not lower the sum is
   * halved. Deterministic.
   * @param good corners at least this good are left alone
   */
  HexOptimiserReport
  optimise_hexahedra(HexMesh           &mesh,
                     const SurfaceMesh &surface,
                     const double       good,
                     const unsigned int n_sweeps);
} // namespace alveolus

#endif
