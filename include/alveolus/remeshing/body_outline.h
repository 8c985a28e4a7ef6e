// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_body_outline_h
#define alveolus_remeshing_body_outline_h

#include <alveolus/mesh/planar_geometry.h>
#include <alveolus/remeshing/gathered_mesh.h>

namespace alveolus
{
  /** A piece of an outline or interface between two ends. */
  struct OutlinePiece
  {
    /** Nodes in order, both ends included; a closed piece repeats its first. */
    std::vector<unsigned int> nodes;
    LineIds                   ids;            ///< of all its lines
    bool                      is_cut = false; ///< a line cut through an area
  };

  /** A connected part of the body of one material, between its outlines. */
  struct OutlineArea
  {
    dealii::types::material_id material = 0; ///< of all its cells
    std::vector<unsigned int>  cells;        ///< indices in the gathered mesh
    /** Pieces around it, area on the left; the outer loop first. */
    std::vector<std::vector<LoopPart>> loops;
  };

  /** Outlines and interfaces of a body, taken apart. */
  struct BodyOutline
  {
    std::vector<OutlinePiece> pieces; ///< each between two ends
    std::vector<OutlineArea>  areas;  ///< bounded by pieces

    /** Nodes of a loop in order, the first not repeated. */
    std::vector<unsigned int>
    loop_nodes(const std::vector<LoopPart> &loop) const;
  };

  /**
   * Take the outlines of a mesh: all lines at the boundary, between materials,
   * of named curves, and those of @p cuts. They are divided into pieces where
   * lines branch or end, at named points, where ids or the materials on the
   * sides change, and at corners, where the current outline turns by more than
   * @p corner_angle [rad]. Pieces, areas and their order depend on nothing
   * but the mesh.
   * @throws RunError if a named curve does not part two areas
   */
  BodyOutline
  extract_outline(const GatheredMesh       &mesh,
                  const NamedSets<2>       &names,
                  const std::set<MeshLine> &cuts,
                  const double              corner_angle);

  /**
   * The geometry with nodes of the mesh as they are now, each area with the
   * material id as tag and its cells as finished mesh. Curve i is piece i, with
   * tag i + 1; build_named_mesh() gives it its ids with line_ids().
   */
  PlanarGeometry
  kept_geometry(const GatheredMesh &mesh, const BodyOutline &outline);

  /** The ids of the curves of kept_geometry() by their tags. */
  std::map<unsigned int, LineIds>
  line_ids(const BodyOutline &outline);
} // namespace alveolus

#endif
