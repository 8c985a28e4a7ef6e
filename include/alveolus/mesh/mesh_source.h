// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_source_h
#define alveolus_mesh_mesh_source_h

#include <alveolus/base/registry.h>
#include <alveolus/mesh/mesh.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

namespace alveolus
{
  /**
   * Where an initial mesh comes from. Implementations are registered; the
   * scene's parameter `Mesh / Type` chooses one and `Mesh / <Type>` is the
   * subsection of its parameters.
   */
  template <int dim>
  class MeshSource
  {
  public:
    virtual ~MeshSource() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /**
     * Build the mesh, the same on every process of @p communicator (coarse
     * cells are replicated).
     * @param input_directory  folder that relative file names refer to
     * @param output_directory existing folder for files made on the way
     * @throws InputError with file, line or parameter
     */
    virtual Mesh<dim>
    create(const MPI_Comm    &communicator,
           const std::string &input_directory,
           const std::string &output_directory) const = 0;
  };
} // namespace alveolus

#endif
