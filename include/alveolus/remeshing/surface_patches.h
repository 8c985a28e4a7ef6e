// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_surface_patches_h
#define alveolus_remeshing_surface_patches_h

#include <alveolus/remeshing/body_surface.h>

namespace alveolus
{
  /**
   * Divide the faces of a surface into smooth patches, and the edges between
   * these into curves from corner to corner. A patch ends where the surface
   * turns, at names, at layers and where more than two faces meet; corners are
   * where curves meet or turn, those that the surface has already included.
   * @param body  with faces, places, components and named corners; gets
   *        patches, curves and further corners
   * @param edges all edges of the faces
   * @param corner_angle edges where the surface turns by more than this, and
   *        corners of curves that do, are kept [rad]
   */
  void
  divide_into_patches(BodySurface                                    &body,
                      const std::map<SurfaceEdge, BodySurface::Edge> &edges,
                      const double corner_angle);
} // namespace alveolus

#endif
