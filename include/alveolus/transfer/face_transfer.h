// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_face_transfer_h
#define alveolus_transfer_face_transfer_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/face_history.h>
#include <alveolus/transfer/cell_nodes.h>

#include <vector>

namespace alveolus
{
  /** What a transfer along a boundary did. */
  struct FaceTransferReport
  {
    /** Length [mm] or area [mm^2] of the boundary. */
    double length_before = 0.;
    double length_after  = 0.; ///< the same afterwards [mm]
    /** Integrals over old and new boundary by component [unit mm^(dim-1)]. */
    std::vector<double> integral_before;
    std::vector<double> integral_after; ///< the same afterwards
    /** Of new points from the old curve; of the motion of points normal to the
     * old surface [mm]. */
    double largest_distance = 0.;
    /** New sub-quadrilaterals beyond the rim of the old surface, which took the
     * nearest value (FaceOverlap in space). */
    unsigned int n_beyond = 0;
    /** False: the boundary stayed, nothing was done. */
    bool moved = false;
  };

  /**
   * History of a boundary moved along it with its nodes, on the same
   * connectivity.
   *
   * On a curve (dim = 2) the ends of the new sub-segments are projected
   * onto the old curve, walking along it from where they were; the new value is
   * the mean of the old piecewise constant values over the piece of old arc
   * length between them. First order, exact for constants, no new extrema;
   * sum (piece of old arc length) x (value) is conserved where the ends of the
   * curve stay. Beyond the end of an open curve its last value goes on.
   *
   * On a surface (dim = 3) the edges of the sub-quadrilaterals sweep areas, by
   * which values pass, see BoundarySurface: first order, exact for constants,
   * no new extrema; conserved are the sums of (area) x (value), up to the part
   * of the area that the curvature of the surface changes. At the rim of an
   * open surface its values go on.
   *
   * The boundary may consist of several parts, which may not branch. The
   * (small) data of the whole boundary are gathered on every
   * process, so that the result is the same for any number of processes.
   */
  template <int dim>
  class FaceTransfer
  {
  public:
    /** @param configuration of the mesh whose boundary it is */
    explicit FaceTransfer(const Configuration<dim> &configuration);

    /**
     * Move the old records of @p history from positions @p x_old to @p x_new
     * (collective).
     * @throws RunError if the boundary branches, or the new nodes are out of
     *         order along the old one
     */
    FaceTransferReport
    transfer(FaceHistory<dim>  &history,
             const NodalVector &x_old,
             const NodalVector &x_new) const;

  private:
    const Configuration<dim> &configuration;
    const CellNodes<dim>      cells;
  };

  // Curves and surfaces have little in common.
  /** Along a curve. */
  template <>
  FaceTransferReport
  FaceTransfer<2>::transfer(FaceHistory<2> &,
                            const NodalVector &,
                            const NodalVector &) const;
  /** Along a surface. */
  template <>
  FaceTransferReport
  FaceTransfer<3>::transfer(FaceHistory<3> &,
                            const NodalVector &,
                            const NodalVector &) const;
} // namespace alveolus

#endif
