// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_builder_h
#define alveolus_mesh_mesh_builder_h

#include <alveolus/mesh/mesh.h>
#include <alveolus/mesh/mesh_description.h>

namespace alveolus
{
  /**
   * Make a triangulation with names of a description that passed
   * check_description() (collective; the description must be the same on every
   * process). Cells get their tag as material id; lines theirs as manifold id
   * (all manifolds flat) and, in 2D at the boundary, as boundary id; in 3D
   * boundary quads theirs as boundary id. Boundary faces without a name get
   * boundary id 0. Named surfaces inside a 3D body leave no trace but their
   * curves.
   */
  template <int dim>
  Mesh<dim>
  build_mesh(const MeshDescription<dim> &description,
             const MPI_Comm             &communicator);

  /**
   * Smallest scaled Jacobian over the corners of all cells: at a corner the
   * determinant of the edge vectors leaving it over the product of their
   * lengths (Knupp 2000); 1 for a square, negative for an inverted corner.
   */
  template <int dim>
  double
  smallest_scaled_jacobian(const MeshDescription<dim> &description);
} // namespace alveolus

#endif
