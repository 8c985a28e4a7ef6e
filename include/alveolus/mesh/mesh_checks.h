// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_checks_h
#define alveolus_mesh_mesh_checks_h

#include <alveolus/mesh/mesh_description.h>

namespace alveolus
{
  /** What check_description() mended or noticed, for the log. */
  struct MeshRepairs
  {
    unsigned int n_unused_vertices = 0; ///< dropped
    unsigned int n_turned_cells    = 0; ///< of negative orientation, turned
    unsigned int n_parts           = 0; ///< parts that share no vertex
  };

  /** Scaled Jacobians (see smallest_scaled_jacobian()) at a cell's corners. */
  template <int dim>
  std::array<double, (1 << dim)>
  corner_jacobians(const MeshDescription<dim>  &mesh,
                   const DescribedElement<dim> &cell);

  /**
   * Make sure that @p mesh is one a computation can use. Nodes that belong to
   * no cell are dropped, cells with all corners inverted are turned round.
   * @param allow_touching_parts let separate parts of the mesh have nodes at
   *        the same place or on each other's edges, e.g. for contact
   * @throws InputError with file, line and numbers: a corner that is inverted
   *         or flat, coincident nodes, a node on another cell's edge (hanging
   *         node), a face of more than two cells or of two cells on the same
   *         side, named points, lines or quads that belong to no cell
   */
  template <int dim>
  MeshRepairs
  check_description(MeshDescription<dim> &mesh,
                    const bool            allow_touching_parts = false);
} // namespace alveolus

#endif
