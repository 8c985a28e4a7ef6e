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
    double length_before = 0.; ///< of the boundary [mm]
    double length_after  = 0.; ///< the same afterwards [mm]
    /** Integrals over old and new boundary by component [unit mm]. */
    std::vector<double> integral_before;
    std::vector<double> integral_after; ///< the same afterwards
    double largest_distance = 0.; ///< of new points from the old curve [mm]
    /** False: the boundary stayed, nothing was done. */
    bool moved = false;
  };

  /**
   * History of a boundary curve (dim = 2) moved along the curve with its nodes,
   * on the same connectivity. The ends of the new sub-segments are projected
   * onto the old curve, walking along it from where they were; the new value is
   * the mean of the old piecewise constant values over the piece of old arc
   * length between them. First order, exact for constants, no new extrema;
   * sum (piece of old arc length) x (value) is conserved where the ends of the
   * curve stay. Beyond the end of an open curve its last value goes on.
   *
   * The boundary may consist of several open or closed curves, which may not
   * branch. The (small) data of the whole boundary are gathered on every
   * process, so that the result is the same for any number of processes.
   *
   * Not yet written for surfaces (dim = 3).
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
     * @throws RunError if the boundary branches, the new nodes are out of
     *         order along the old curve, or dim = 3
     */
    FaceTransferReport
    transfer(FaceHistory<dim>  &history,
             const NodalVector &x_old,
             const NodalVector &x_new) const;

  private:
    const Configuration<dim> &configuration;
    const CellNodes<dim>      cells;
  };
} // namespace alveolus

#endif
