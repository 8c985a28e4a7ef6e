// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_face_overlap_h
#define alveolus_transfer_face_overlap_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/face_history.h>
#include <alveolus/transfer/boundary_curves.h>
#include <alveolus/transfer/boundary_surface.h>
#include <alveolus/transfer/face_transfer.h>

#include <memory>
#include <vector>

namespace alveolus
{
  /**
   * History of a boundary from an old mesh to an unrelated new one.
   *
   * In the plane the ends of the new sub-segments are projected onto the old
   * curves; the new value is the mean of the old piecewise constant values over
   * the piece of old arc length between them. First order, exact for constants,
   * no new extrema; sum (piece of old arc length) x (value) is conserved where
   * old and new curves coincide. New sub-segments beyond the end of an open
   * curve take its last value.
   *
   * In space each new sub-quadrilateral takes the mean of the old ones over
   * what they have in common, seen along its normal: of the same order, exact
   * for constants, without new extrema; conserved where both surfaces are the
   * same plane. Beyond the rim it takes the value of the nearest one.
   *
   * The constructor takes a picture of the old boundary (small, kept by every
   * process), which may be gone when transfer() is called. The result is the
   * same for any number of processes. Boundaries may not branch, and their
   * parts must be farther from each other than the new one is from the old one.
   */
  template <int dim>
  class FaceOverlap
  {
  public:
    /**
     * Takes the picture (collective).
     * @throws RunError if the boundary branches
     */
    FaceOverlap(const Configuration<dim> &old_configuration,
                const FaceHistory<dim>   &old_history);

    /**
     * Fill the old records of @p new_history (collective); trial records are
     * not touched.
     * @throws RunError if the new boundary is farther from the old ones than
     * half an edge (in space: a sub-quadrilateral), changes from one curve to
     * another, or folds back along it, or the histories have not the same
     * components
     */
    FaceTransferReport
    transfer(const Configuration<dim> &new_configuration,
             FaceHistory<dim>         &new_history) const;

  private:
    const unsigned int         n_points;
    const unsigned int         n_components;
    std::vector<double>        breaks;
    std::unique_ptr<EdgeMap>   map;
    std::vector<BoundaryEdge>  edges;
    std::vector<BoundaryCurve> curves;
    std::vector<ArcLengths>    lengths; ///< by curve
    // In space:
    std::vector<BoundaryFace>        faces;
    std::unique_ptr<BoundarySurface> surface;
  };

  // In files of their own
  /** Of curves. */
  template <>
  FaceOverlap<2>::FaceOverlap(const Configuration<2> &, const FaceHistory<2> &);
  /** Of surfaces. */
  template <>
  FaceOverlap<3>::FaceOverlap(const Configuration<3> &, const FaceHistory<3> &);
  /** Between curves. */
  template <>
  FaceTransferReport
  FaceOverlap<2>::transfer(const Configuration<2> &, FaceHistory<2> &) const;
  /** Between surfaces. */
  template <>
  FaceTransferReport
  FaceOverlap<3>::transfer(const Configuration<3> &, FaceHistory<3> &) const;
} // namespace alveolus

#endif
