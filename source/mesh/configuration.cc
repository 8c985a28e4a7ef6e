// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/mesh/configuration.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/numerics/vector_tools.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  Configuration<dim>::Configuration(const Mesh<dim>   &mesh,
                                    const unsigned int degree)
    : mesh(mesh)
    , degree(degree)
    , fe(FE_Q<dim>(degree), dim)
    , dof_handler(*mesh.triangulation)
  {
    dof_handler.distribute_dofs(fe);
    locally_owned = dof_handler.locally_owned_dofs();
    DoFTools::extract_locally_relevant_dofs(dof_handler, locally_relevant);

    d                 = make_vector();
    positions_of_mesh = make_vector();

    // X_mesh is what MappingQEulerian starts from: cells with straight edges
    // between the vertices. With curved manifolds and degree 2 the nodes begin
    // where MappingQ places them on the manifold, so d starts with the
    // difference.
    const Quadrature<dim> nodes(fe.get_unit_support_points());
    const auto            place_nodes = [&](const unsigned int mapping_degree,
                                 NodalVector       &result) {
      const MappingQ<dim> mapping(mapping_degree);
      FEValues<dim> fe_values(mapping, fe, nodes, update_quadrature_points);
      std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
      result.zero_out_ghost_values();
      for (const auto &cell : dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            fe_values.reinit(cell);
            cell->get_dof_indices(dofs);
            for (unsigned int i = 0; i < dofs.size(); ++i)
              if (locally_owned.is_element(dofs[i]))
                result[dofs[i]] = fe_values.quadrature_point(
                  i)[fe.system_to_component_index(i).first];
          }
    };
    place_nodes(1, positions_of_mesh);
    if (degree > 1)
      {
        place_nodes(degree, d);
        d -= positions_of_mesh;
        d.update_ghost_values();
      }
    positions_of_mesh.update_ghost_values();

    eulerian_mapping =
      std::make_unique<MappingQEulerian<dim, NodalVector>>(degree,
                                                           dof_handler,
                                                           d);
  }

  template <int dim>
  NodalVector
  Configuration<dim>::make_vector() const
  {
    NodalVector v(locally_owned, locally_relevant, communicator());
    v.update_ghost_values();
    return v;
  }

  template <int dim>
  NodalVector
  Configuration<dim>::positions() const
  {
    NodalVector x(positions_of_mesh);
    x.zero_out_ghost_values();
    x += d;
    x.update_ghost_values();
    return x;
  }

  template <int dim>
  void
  Configuration<dim>::set_positions(const NodalVector &positions)
  {
    d.zero_out_ghost_values();
    d = positions;
    d.zero_out_ghost_values();
    d -= positions_of_mesh;
    d.update_ghost_values();
  }

  template <int dim>
  void
  Configuration<dim>::move(const NodalVector &displacement_increment)
  {
    d.zero_out_ghost_values();
    d += displacement_increment;
    d.update_ghost_values();
  }

  template <int dim>
  void
  Configuration<dim>::set_mesh_displacement(const NodalVector &displacement)
  {
    d.zero_out_ghost_values();
    d = displacement;
    d.update_ghost_values();
  }

  template class Configuration<2>;
  template class Configuration<3>;
} // namespace alveolus
