// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_tetrahedra_h
#define alveolus_remeshing_tetrahedra_h

#include <alveolus/mesh/gmsh.h>

#include <deal.II/base/point.h>

#include <array>
#include <string>
#include <vector>

namespace alveolus
{
  /** How tetrahedra are made. */
  struct TetrahedraSettings
  {
    GmshSettings gmsh; ///< how gmsh is run
    /** Of gmsh: 1 Delaunay, 4 frontal, 10 HXT. */
    unsigned int algorithm = 1;
    /** On the edge lengths inside. */
    double size_factor = 1.;
  };

  /** A mesh of tetrahedra of positive orientation. */
  struct Tetrahedra
  {
    std::vector<dealii::Point<3>>            vertices; ///< [mm]
    std::vector<std::array<unsigned int, 4>> cells;    ///< vertices by number
  };

  /**
   * Fill a closed surface of triangles, which stay as they are, with
   * tetrahedra (collective). Made by gmsh (Geuzaine and Remacle 2009); edges
   * inside grow from those of the surface.
   * @param vertices of the surface, all of them used; the first ones of the
   *        result, to the last bit
   * @param triangles all oriented alike, seen from outside counterclockwise
   * @throws InputError if gmsh cannot be started; RunError if it makes no mesh,
   *         e.g. since the surface cuts itself, or changes the surface
   */
  Tetrahedra
  fill_with_tetrahedra(
    const std::vector<dealii::Point<3>>            &vertices,
    const std::vector<std::array<unsigned int, 3>> &triangles,
    const TetrahedraSettings                       &settings,
    const MeshingJob                               &job);
} // namespace alveolus

#endif
