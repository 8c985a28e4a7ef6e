// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_gathered_mesh_h
#define alveolus_remeshing_gathered_mesh_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/mesh/mesh_description.h>
#include <alveolus/mesh/quad_optimiser.h>

#include <map>
#include <utility>
#include <vector>

namespace alveolus
{
  /** Ids by which a line of a triangulation belongs to names. */
  struct LineIds
  {
    /** Of curves. */
    dealii::types::manifold_id manifold = dealii::numbers::flat_manifold_id;
    /** internal_face_boundary_id if it is not at the boundary. */
    dealii::types::boundary_id boundary =
      dealii::numbers::internal_face_boundary_id;

    /** Whether a line with these ids is part of a named curve. */
    bool
    are_on(const std::string &curve, const NamedSets<2> &names) const;

    /** An order, for use as a key. */
    bool
    operator<(const LineIds &other) const
    {
      return std::make_pair(manifold, boundary) <
             std::make_pair(other.manifold, other.boundary);
    }
    /** Equal ids. */
    bool
    operator==(const LineIds &other) const
    {
      return manifold == other.manifold && boundary == other.boundary;
    }
  };

  /** A line of the mesh: its nodes, the smaller index first. */
  using MeshLine = std::pair<unsigned int, unsigned int>;

  /**
   * A plane mesh at its current positions as plain data, replicated on every
   * process. Nodes are numbered by their initial positions (x, then y), cells
   * by their nodes, so that numbers do not depend on the processes.
   */
  struct GatheredMesh
  {
    std::vector<dealii::Point<2>>           positions; ///< current [mm]
    std::vector<dealii::Point<2>>           initial;   ///< [mm]
    std::vector<Quad>                       cells;     ///< nodes by number
    std::vector<dealii::types::material_id> materials; ///< of the cells
    std::map<MeshLine, LineIds>             lines;     ///< all of them
    std::map<std::string, unsigned int>     points;    ///< nodes of the names

    /** Line between two nodes. */
    static MeshLine
    line(const unsigned int a, const unsigned int b)
    {
      return a < b ? MeshLine(a, b) : MeshLine(b, a);
    }
  };

  /**
   * Gather the mesh of a configuration (collective).
   * @throws RunError for degree 2 or a mesh with hanging nodes, of which no
   * remesh can be made, and if a named point is no vertex
   */
  GatheredMesh
  gather_mesh(const Configuration<2> &configuration);

  /**
   * A mesh with the given cells and the names of an old one (collective).
   * Boundary, manifold and material ids are those asked for, so that the sets
   * of
   * @p names apply unchanged; its points are replaced.
   * @param description cells with material ids as tags; lines with tags, which
   *        need no names; points with names
   * @param ids of the lines by their tags (1, 2, ...)
   */
  Mesh<2>
  build_named_mesh(const MeshDescription<2>              &description,
                   const std::map<unsigned int, LineIds> &ids,
                   const NamedSets<2>                    &names,
                   const MPI_Comm                        &communicator);
} // namespace alveolus

#endif
