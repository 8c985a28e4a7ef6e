// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_configuration_h
#define alveolus_mesh_configuration_h

#include <alveolus/algebra/types.h>
#include <alveolus/mesh/mesh.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/mapping_q_eulerian.h>

namespace alveolus
{
  /**
   * The current mesh x = X_mesh + d: owns the nodal mesh displacement d [mm] on
   * FE_Q(degree)^dim and the MappingQEulerian built on it. The material
   * displacement u lives on the same DoFHandler. Only the commit of a
   * Lagrangian step, rezoning and remeshing write d.
   */
  template <int dim>
  class Configuration
  {
  public:
    /** Keeps a reference to @p mesh, which must outlive this object. */
    Configuration(const Mesh<dim> &mesh, const unsigned int degree);

    /** A zero vector of nodal values, with ghost entries, in ghosted state. */
    NodalVector
    make_vector() const;

    /**
     * Positions X_mesh of all relevant nodes, as a nodal vector [mm]: those of
     * cells with straight edges. On curved manifolds with degree 2, d takes the
     * nodes to the manifold from the start.
     */
    const NodalVector &
    initial_positions() const
    {
      return positions_of_mesh;
    }

    /** Current positions x = X_mesh + d [mm], ghosted. */
    NodalVector
    positions() const;

    /** Move the mesh to @p positions [mm] (ghosted nodal vector). */
    void
    set_positions(const NodalVector &positions);

    /** Add a nodal displacement [mm] to d. */
    void
    move(const NodalVector &displacement_increment);

    /** From the unit cell to the current positions. */
    const dealii::Mapping<dim> &
    mapping() const
    {
      return *eulerian_mapping;
    }

    /** Of the processes that share the mesh. */
    MPI_Comm
    communicator() const
    {
      return mesh.triangulation->get_communicator();
    }

    const Mesh<dim> &mesh; ///< initial mesh and its names
    /** Of shape functions and of the mapping: 1 or 2. */
    const unsigned int    degree;
    dealii::FESystem<dim> fe; ///< dim components of FE_Q
    /** Numbers of the components of positions. */
    dealii::DoFHandler<dim> dof_handler;
    dealii::IndexSet        locally_owned; ///< dofs of this process
    /** These and the ones of ghost cells. */
    dealii::IndexSet locally_relevant;

    /** d [mm]; ghosted. Change it through set_positions() or move(). */
    const NodalVector &
    mesh_displacement() const
    {
      return d;
    }

    /** Replace d as a whole, e.g. by that of a snapshot. */
    void
    set_mesh_displacement(const NodalVector &displacement);

  private:
    NodalVector d;
    NodalVector positions_of_mesh;
    std::unique_ptr<dealii::MappingQEulerian<dim, NodalVector>>
      eulerian_mapping;
  };
} // namespace alveolus

#endif
