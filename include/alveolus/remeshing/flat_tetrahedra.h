// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_flat_tetrahedra_h
#define alveolus_remeshing_flat_tetrahedra_h

#include <alveolus/remeshing/tetrahedra.h>

namespace alveolus
{
  /** What divide_flat_tetrahedra() found. */
  struct FlatTetrahedra
  {
    unsigned int n_divided = 0; ///< flat ones replaced by others
    unsigned int n_left    = 0; ///< where no vertex can be put
  };

  /**
   * Give a second tetrahedron to edges inside of a smooth patch that have one
   * only: two of its faces are on the patch, and on a curved patch the angle
   * between them becomes 180 degrees when the middles of edges and faces go to
   * the surface, so that hexahedra there would have flat corners whatever nodes
   * do. All tetrahedra around its opposite edge are replaced by those between
   * their outer faces and a new vertex in the middle.
   * @param triangles of the surface of the mesh
   * @param patches   of the triangles
   */
  FlatTetrahedra
  divide_flat_tetrahedra(
    Tetrahedra                                     &mesh,
    const std::vector<std::array<unsigned int, 3>> &triangles,
    const std::vector<unsigned int>                &patches);
} // namespace alveolus

#endif
