// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/helmholtz_filter.h>

#include <deal.II/dofs/dof_tools.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  HelmholtzFilter<dim>::HelmholtzFilter(const Configuration<dim> &configuration,
                                        const std::vector<unsigned int> &cells,
                                        const double                     length)
    : cells(cells)
    , length(length)
    , fe(configuration.degree)
    , dof_handler(*configuration.mesh.triangulation)
  {
    dof_handler.distribute_dofs(fe);
    DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);

    // Which cells belong to the domain must be known for ghosts too, hence the
    // marks travel as a nodal vector.
    NodalVector mark(dof_handler.locally_owned_dofs(),
                     relevant,
                     configuration.communicator());
    std::map<unsigned int, std::vector<types::global_dof_index>> dofs_of;
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(dofs);
          dofs_of[cell->active_cell_index()] = dofs;
        }
    for (const unsigned int cell : cells)
      {
        cell_dofs.push_back(dofs_of.at(cell));
        for (const auto dof : cell_dofs.back())
          mark(dof) += 1.;
      }
    mark.compress(VectorOperation::add);
    mark.update_ghost_values();
    outside.reinit(relevant);
    for (const auto dof : relevant)
      if (mark(dof) == 0.)
        outside.add_line(dof);
    outside.close();
    system = make_linear_system(dof_handler, outside, "automatic", 1e-12);
  }



  template <int dim>
  void
  HelmholtzFilter<dim>::apply(const StepGeometry<dim> &geometry,
                              std::vector<double>     &values)
  {
    const unsigned int n = fe.n_dofs_per_cell();
    FullMatrix<double> matrix(n, n);
    NodalVector        right_hand_side(dof_handler.locally_owned_dofs(),
                                relevant,
                                dof_handler.get_communicator());
    NodalVector        solution(right_hand_side);
    system->clear();
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        const double *weights = geometry.weights(cells[c]);
        matrix                = 0.;
        for (unsigned int q = 0; q < geometry.n_points; ++q)
          {
            const Tensor<1, dim> *G = geometry.gradients(cells[c], q);
            for (unsigned int i = 0; i < n; ++i)
              {
                const double N_i =
                  fe.shape_value(i, geometry.quadrature.point(q));
                right_hand_side(cell_dofs[c][i]) +=
                  N_i * values[c * geometry.n_points + q] * weights[q];
                for (unsigned int j = 0; j < n; ++j)
                  matrix(i, j) +=
                    (N_i * fe.shape_value(j, geometry.quadrature.point(q)) +
                     length * length * (G[i] * G[j])) *
                    weights[q];
              }
          }
        system->add(matrix, cell_dofs[c]);
      }
    right_hand_side.compress(VectorOperation::add);
    system->compress();
    system->solve(solution, right_hand_side);
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int q = 0; q < geometry.n_points; ++q)
        {
          double value = 0.;
          for (unsigned int i = 0; i < n; ++i)
            value += solution(cell_dofs[c][i]) *
                     fe.shape_value(i, geometry.quadrature.point(q));
          values[c * geometry.n_points + q] = value;
        }
  }

  template class HelmholtzFilter<2>;
  template class HelmholtzFilter<3>;
} // namespace alveolus
