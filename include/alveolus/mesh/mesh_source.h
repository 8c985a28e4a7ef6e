// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_source_h
#define alveolus_mesh_mesh_source_h

#include <alveolus/base/errors.h>
#include <alveolus/base/registry.h>
#include <alveolus/mesh/mesh.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <cmath>
#include <sstream>
#include <string>

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

    /** A mesh of more cells is refused before it is made. */
    void
    set_largest_number_of_cells(const unsigned int n)
    {
      largest_number_of_cells = n;
    }

    /**
     * Whether a script of the user's may be run to make the mesh. By default
     * not: gmsh's language can start programs and write files.
     */
    void
    allow_scripts(const bool yes)
    {
      scripts_allowed = yes;
    }

  protected:
    /** Whether gmsh scripts of the user may run (`--allow-scripts`). */
    bool
    may_run_scripts() const
    {
      return scripts_allowed;
    }

    /**
     * For implementations, to be called before memory is taken.
     * @param n_cells as far as it is known, a product may be huge
     * @param n_refinements how often each will be divided in all directions
     * @param where what asks for them, for the message
     * @throws InputError if they are more than allowed
     */
    void
    check_number_of_cells(const double       n_cells,
                          const unsigned int n_refinements,
                          const std::string &where) const
    {
      const double n = std::ldexp(n_cells, dim * n_refinements);
      if (n > largest_number_of_cells)
        {
          std::ostringstream found;
          found << "asks for " << n << " cells";
          throw InputError(where,
                           found.str(),
                           "lower it, or raise `Mesh / Largest number of "
                           "cells`, which is " +
                             std::to_string(largest_number_of_cells));
        }
    }

  private:
    unsigned int largest_number_of_cells = 10000000;
    bool         scripts_allowed         = false;
  };
} // namespace alveolus

#endif
