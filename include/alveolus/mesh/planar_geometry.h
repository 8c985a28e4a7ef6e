// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_planar_geometry_h
#define alveolus_mesh_planar_geometry_h

#include <deal.II/base/point.h>

#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  struct AreaMesh;

  /** A curve of a plane geometry, given by the mesh nodes it will have. */
  struct PlanarCurve
  {
    /** Index of its first point in PlanarGeometry::points; a closed curve
     * begins and ends at the same one. */
    unsigned int begin = 0;
    unsigned int end   = 0; ///< index of its last point
    /** All nodes of the final mesh on the curve [mm], both ends included and
     * equal to the end points; each segment becomes an edge of the cells on its
     * sides. */
    std::vector<dealii::Point<2>> nodes;
    /** Id of the piece, 0 for a curve without a name. */
    unsigned int tag = 0;

    /** Number of edges. */
    unsigned int
    n_segments() const
    {
      return nodes.size() - 1;
    }
  };

  /** A curve (its index) as part of a loop, perhaps from its end to its begin.
   */
  struct LoopPart
  {
    unsigned int curve    = 0;     ///< index among the curves
    bool         reversed = false; ///< run through from end to begin
  };

  /** A plane area to be filled with quads. */
  struct PlanarArea
  {
    std::string  name;    ///< for files and messages
    unsigned int tag = 1; ///< material id
    /** Closed loops of curves, the outer one first, then holes. */
    std::vector<std::vector<LoopPart>> loops;
    /** Edges inside grow from those of the boundary up to this length [mm]. */
    double largest_size = std::numeric_limits<double>::max();
    /** Growth of the edge length with the distance from the boundary [-]. */
    double growth = 0.25;
    /**
     * If true: four sides with the same number of segments on opposite ones,
     * meshed by transfinite interpolation. corners[k] is the position in
     * loops[0] of the curve with which side k begins; corners[0] = 0.
     */
    bool structured = false;
    /** Where the four sides begin in the loop. */
    std::array<unsigned int, 4> corners{{0, 1, 2, 3}};
    /** Layers of the caps at sides 3 and 1, see Strip; 0 is none. */
    std::array<unsigned int, 2> caps{{0, 0}};
    /** A finished mesh of the area, taken as it is. Among its vertices are the
     * nodes of the loops, with exactly the same coordinates. */
    std::shared_ptr<const AreaMesh> prepared;
  };

  /**
   * A plane body as input of a mesher: points, curves between them and areas
   * bounded by curves. Neighbouring areas share curves and therefore nodes.
   */
  struct PlanarGeometry
  {
    std::vector<dealii::Point<2>> points; ///< [mm]
    std::vector<PlanarCurve>      curves; ///< each once, also between areas
    std::vector<PlanarArea>       areas;  ///< each filled by itself

    std::map<std::string, dealii::Point<2>>       point_names;  ///< at nodes
    std::map<std::string, std::set<unsigned int>> curve_names;  ///< to tags
    std::map<std::string, std::set<unsigned int>> region_names; ///< to tags
  };
} // namespace alveolus

#endif
