// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_remesher_h
#define alveolus_remeshing_remesher_h

#include <alveolus/base/registry.h>
#include <alveolus/mesh/configuration.h>

#include <deal.II/base/parameter_handler.h>

#include <functional>
#include <string>
#include <vector>

namespace alveolus
{
  /** A new mesh of a deformed body. */
  template <int dim>
  struct RemeshCandidate
  {
    Mesh<dim>   mesh;         ///< the mesh, with all names
    double      quality = 0.; ///< smallest scaled Jacobian of all corners
    std::string description;  ///< how it was made, for the log
    /** Current positions of the new nodes; empty: the initial ones. */
    std::function<NodalVector(const Configuration<dim> &)> positions;

    /** Keep how it was made, also with the mesh. */
    void
    describe(const std::string &how)
    {
      description      = how;
      mesh.description = how;
    }
  };

  /**
   * Makes new meshes of the deformed body. Implementations are registered; the
   * parameter `Remeshing / Type` chooses one. Physics is none of their
   * business: history follows by the transfer floor.
   */
  template <int dim>
  class Remesher
  {
  public:
    virtual ~Remesher() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /**
     * Check that the names in the parameters are those of the mesh.
     * @param where path of the parameters' subsection, for messages
     * @throws InputError
     */
    virtual void
    initialize(const NamedSets<dim> & /*names*/, const std::string & /*where*/)
    {}

    /** Largest degree of the elements that the remesher knows. */
    virtual unsigned int
    largest_degree() const
    {
      return 2;
    }

    /** False if no region of the new meshes is a lattice, whatever is asked. */
    virtual bool
    can_keep_lattices() const
    {
      return true;
    }

    /**
     * What it decides by, "strain energy" or "density"; empty: nothing. Then
     * tell() comes before candidates().
     */
    virtual std::string
    indicator() const
    {
      return "";
    }

    /** Cell means of the indicator by active cell index, also of ghosts. */
    virtual void
    tell(const std::vector<double> & /*cell_values*/)
    {}

    /**
     * New meshes of the body at the current positions of @p old, the best first
     * (collective, the same for any number of processes). Each has the names,
     * boundary, manifold and material ids of the old mesh; its named points are
     * where the old ones are now. The initial positions of a new mesh are the
     * current ones of the old mesh, unless the candidate tells its positions.
     * @param output_directory existing folder for files made on the way
     * @param name  of the remesh, for these files
     * @throws RunError if there is none
     */
    virtual std::vector<RemeshCandidate<dim>>
    candidates(const Configuration<dim> &old,
               const std::string        &output_directory,
               const std::string        &name) const = 0;
  };
} // namespace alveolus

#endif
