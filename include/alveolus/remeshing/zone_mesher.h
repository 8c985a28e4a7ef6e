// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_zone_mesher_h
#define alveolus_remeshing_zone_mesher_h

#include <alveolus/mesh/area_mesher.h>
#include <alveolus/remeshing/strip.h>

#include <limits>

namespace alveolus
{
  /** How zones at the ends of strips are filled. */
  struct ZoneSettings
  {
    /** Numbers of edges to try on the rim; 0: nodes as they are. */
    std::vector<unsigned int> rim_edges = {0};
    /** Edge length at the ends of a new rim over that in its middle. */
    double rim_end_ratio = 1.;
    /** Largest change of area by new nodes on the rim [mm^2]. */
    double largest_area_change = std::numeric_limits<double>::max();
    /** Corners with a larger angle must have two cells [rad]. */
    double       angle_of_two_cells = 2.0;
    double       growth             = 0.25; ///< see PlanarArea
    PlanarMesher mesher;                    ///< for unstructured zones
  };

  /** A corner of a zone between its rim and a side. */
  struct ZoneCorner
  {
    double       angle   = 0.; ///< inside the strip [rad]
    unsigned int n_cells = 0;  ///< cells of the zone that meet there
  };

  /** A mesh of a zone. */
  struct ZoneMesh
  {
    AreaMesh                      mesh; ///< with the nodes of the border first
    std::vector<dealii::Point<2>> rim;  ///< its nodes, from side a to side b
    bool nodes_kept = true;             ///< whether these are the old ones
    std::array<ZoneCorner, 2> corners;  ///< at side a and side b
    std::string               description; ///< how it was made, for the log
  };

  /** What was tried on a zone. */
  struct ZoneMeshes
  {
    std::vector<ZoneMesh> meshes;        ///< best first
    unsigned int          n_tried   = 0; ///< meshes made in all
    unsigned int          n_invalid = 0; ///< with inverted cells, or not made
    unsigned int          n_flat    = 0; ///< one cell where two are needed
    /** Numbers of edges whose rim would change the area too much. */
    std::vector<unsigned int> too_coarse;
  };

  /**
   * Meshes of a zone with the nodes of sides and cut as they are, best first
   * (collective). Tried are, for every number of edges of the rim, the lattice
   * of transfinite interpolation (if opposite sides fit), the lattice with its
   * obtuse corners, or the whole rim, pillowed by rings of cells of several
   * extents, and, where none is good, a mesh of gmsh; inner vertices are moved
   * to raise the smallest scaled Jacobian (optimise_quads()). Meshes with one
   * cell at a corner that should have two, and invalid ones, are dropped and
   * counted.
   */
  ZoneMeshes
  mesh_zone(const GatheredMesh &mesh,
            const StripZone    &zone,
            const ZoneSettings &settings,
            const MeshingJob   &job);
} // namespace alveolus

#endif
