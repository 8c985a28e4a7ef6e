// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_area_mesher_h
#define alveolus_mesh_area_mesher_h

#include <alveolus/mesh/gmsh.h>
#include <alveolus/mesh/planar_geometry.h>
#include <alveolus/mesh/quad_optimiser.h>

namespace alveolus
{
  /** A combination of the mesher's options to try on an unstructured area. */
  struct PlanarMesherOptions
  {
    unsigned int algorithm   = 6; ///< of gmsh; 6: frontal Delaunay, 5: Delaunay
    unsigned int smoothing   = 10; ///< steps of gmsh before the subdivision
    double       size_factor = 1.; ///< on the edge lengths inside
  };

  /** The mesher and how good its meshes have to be. */
  struct PlanarMesher
  {
    GmshSettings gmsh; ///< how gmsh is run
    /** No further attempt is made at this smallest scaled Jacobian. */
    double good_quality = 0.6;
    /** Options in the order in which they are tried. */
    std::vector<PlanarMesherOptions> attempts = {{6, 10, 1.},
                                                 {6, 10, 0.95},
                                                 {6, 10, 1.05},
                                                 {5, 10, 1.},
                                                 {6, 10, 0.9},
                                                 {6, 10, 1.1},
                                                 {5, 10, 0.95},
                                                 {6, 0, 1.}};
  };

  /**
   * A mesh of one area. Its first vertices are the nodes of the boundary, one
   * loop after the other, in their order.
   */
  struct AreaMesh
  {
    std::vector<dealii::Point<2>> vertices;      ///< [mm]
    std::vector<Quad>             quads;         ///< vertices by number
    double                        quality = -1.; ///< smallest scaled Jacobian
    std::string                   remark;        ///< how it was made
    unsigned int                  n_mesher_runs = 0; ///< attempts it took
  };

  /**
   * Fill a curvilinear quadrilateral by transfinite interpolation of its sides
   * (Gordon and Hall 1973).
   * @param sides nodes of the four sides in the direction of the loop, each
   *        from corner to corner, both included; opposite ones of equal number
   */
  AreaMesh
  mesh_structured_area(
    const std::array<std::vector<dealii::Point<2>>, 4> &sides);

  /**
   * The same with caps at ends, see Strip.
   * @param sides nodes of the four sides in the direction of the loop, each
   *        from corner to corner, both included
   * @param caps  layers of the caps at the fourth and the second side
   * @throws RunError if the numbers of nodes do not fit together
   */
  AreaMesh
  mesh_capped_area(const std::array<std::vector<dealii::Point<2>>, 4> &sides,
                   const std::array<unsigned int, 2>                  &caps,
                   const std::string                                  &name);

  /**
   * Fill an area with quads (collective). Gmsh (Geuzaine and Remacle 2009)
   * makes triangles from every second boundary node, recombines them by Blossom
   * (Remacle et al. 2012) and halves all edges, so that no triangle is left.
   * The nodes in the middle of boundary edges then move to the given ones,
   * cells at flat boundary vertices are divided (divide_flat_corners()), and
   * inner vertices moved to raise the smallest scaled Jacobian
   * (optimise_quads()).
   * @param area its sizes and its name
   * @param loops nodes of the boundary, each loop an even number, the outer one
   *        first
   * @throws InputError if gmsh cannot be started, RunError if no attempt gives
   *         a valid mesh
   */
  AreaMesh
  mesh_unstructured_area(
    const PlanarArea                                 &area,
    const std::vector<std::vector<dealii::Point<2>>> &loops,
    const PlanarMesher                               &mesher,
    const MeshingJob                                 &job);
} // namespace alveolus

#endif
