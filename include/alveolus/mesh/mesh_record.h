// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_record_h
#define alveolus_mesh_mesh_record_h

#include <alveolus/base/block_file.h>
#include <alveolus/mesh/mesh.h>

#include <cstdint>

namespace alveolus
{
  /**
   * A number made of everything about the active cells that results depend on:
   * ids, vertices to the last bit, material, boundary and manifold ids. The
   * same for any number of processes (collective).
   */
  template <int dim>
  std::uint64_t
  fingerprint(const Mesh<dim> &mesh);

  /**
   * Whether load_mesh() can make the mesh anew: all manifolds are flat. Local
   * refinement is stored, too.
   */
  template <int dim>
  bool
  can_be_stored(const Mesh<dim> &mesh);

  /**
   * Put a mesh that can_be_stored() into blocks "mesh/..." (collective):
   * coarse vertices, cells with their ids, ids of lines and faces, number of
   * refinements, names.
   */
  template <int dim>
  void
  save_mesh(const Mesh<dim> &mesh, BlockFile &blocks);

  /**
   * The same mesh again, with cells, vertices and lines in the same order, so
   * that degrees of freedom have the same numbers (collective).
   * @throws InputError if the blocks are inconsistent
   */
  template <int dim>
  Mesh<dim>
  load_mesh(const BlockFile &blocks, const MPI_Comm &communicator);
} // namespace alveolus

#endif
