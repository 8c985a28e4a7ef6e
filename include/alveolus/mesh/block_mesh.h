// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_block_mesh_h
#define alveolus_mesh_block_mesh_h

#include <alveolus/mesh/mesh_description.h>

#include <functional>

namespace alveolus
{
  /**
   * A mesh of hexahedra put together from structured blocks, each the image of
   * the unit cube, divided into n1 x n2 x n3 cells. Vertices of blocks that lie
   * at the same place become one, so that blocks conform where their faces do.
   * Names are given by place afterwards: to boundary faces, lines and vertices.
   */
  class BlockMesh
  {
  public:
    /** A point, in the unit cube or in the body [mm]. */
    using Place = dealii::Point<3>;
    /** Cells in the three directions. */
    using Divisions = std::array<unsigned int, 3>;
    /** Chooses points of the body [mm]. */
    using Condition = std::function<bool(const Place &)>;

    /**
     * @param source name of the mesh, for messages
     * @param length of the body [mm]; vertices closer than 1e-9 of it are one
     */
    BlockMesh(const std::string &source, const double length);

    /**
     * Add a block: vertex (i, j, k) is at @p map (i/n1, j/n2, k/n3) [mm]. The
     * map must turn right-handed axes into right-handed ones.
     * @param region name of the region its cells belong to; blocks may share it
     */
    void
    add(const std::string                         &region,
        const Divisions                           &n,
        const std::function<Place(const Place &)> &map);

    /** Name @p name for the vertex at @p place. @throws InputError if none */
    void
    name_point(const std::string &name, const Place &place);

    /** Name for the lines of cells both ends of which fulfil @p condition. */
    void
    name_curve(const std::string &name, const Condition &condition);

    /** Name for the lines of cells on the segment from @p a to @p b. */
    void
    name_segment(const std::string &name, const Place &a, const Place &b);

    /** Name for the boundary faces all corners of which fulfil @p condition.
     */
    void
    name_boundary(const std::string &name, const Condition &condition);

    /**
     * The mesh, checked (mesh_checks.h).
     * @throws InputError naming @p where if cells are inverted
     */
    MeshDescription<3>
    description(const std::string &where) const;

  private:
    unsigned int
    vertex(const Place &x);

    MeshDescription<3>                          mesh;
    double                                      tolerance; ///< [mm]
    std::map<std::array<long, 3>, unsigned int> at;
    unsigned int                                n_tags = 0;
  };
} // namespace alveolus

#endif
