// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_describe_mesh_h
#define alveolus_mesh_describe_mesh_h

#include <alveolus/mesh/mesh_description.h>
#include <alveolus/mesh/nodes.h>

namespace alveolus
{
  /**
   * The mesh at @p positions (nodal vector, ghosted [mm]) as a description from
   * which build_mesh() makes it again: vertices, active cells with their
   * material ids, named lines (and quads in 3D) with their tags, all names.
   * Straight edges: of degree 2 only the vertices are taken. The same on every
   * process and for any number of processes (collective; cells in the order of
   * their CellIds, vertices in the order of their first cell).
   * @throws InputError naming @p where if a boundary piece has another number
   *         than its curve, as in meshes of the grid generator with curved
   *         manifolds, or the mesh has hanging nodes
   */
  template <int dim>
  MeshDescription<dim>
  describe_mesh(const Nodes<dim>  &nodes,
                const NodalVector &positions,
                const std::string &where);
} // namespace alveolus

#endif
