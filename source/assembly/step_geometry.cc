// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/step_geometry.h>
#include <alveolus/base/errors.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_dgp.h>
#include <deal.II/fe/fe_q.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    std::vector<std::vector<double>>
    shape_values(const FiniteElement<dim> &fe, const Quadrature<dim> &points)
    {
      std::vector<std::vector<double>> values(
        fe.n_dofs_per_cell(), std::vector<double>(points.size()));
      for (unsigned int m = 0; m < values.size(); ++m)
        for (unsigned int q = 0; q < points.size(); ++q)
          values[m][q] = fe.shape_value(m, points.point(q));
      return values;
    }
  } // namespace



  template <int dim>
  StepGeometry<dim>::StepGeometry(const Configuration<dim> &configuration)
    : quadrature(QGauss<dim>(configuration.degree + 1))
    , n_points(quadrature.size())
    , n_nodes(configuration.fe.n_dofs_per_cell() / dim)
    , pressure_shapes(
        shape_values(FE_DGP<dim>(configuration.degree - 1), quadrature))
    , configuration(configuration)
    , slot(configuration.mesh.triangulation->n_active_cells(),
           numbers::invalid_unsigned_int)
  {
    unsigned int n_owned = 0;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        slot[cell->active_cell_index()] = n_owned++;
    all_gradients.resize(static_cast<std::size_t>(n_owned) * n_points *
                         n_nodes);
    all_weights.resize(static_cast<std::size_t>(n_owned) * n_points);
  }



  template <int dim>
  void
  StepGeometry<dim>::update()
  {
    // A rejected step and the books of energy come back to the same mesh.
    const NodalVector  &d = configuration.mesh_displacement();
    std::vector<double> present;
    present.reserve(configuration.locally_relevant.n_elements());
    for (const auto i : configuration.locally_relevant)
      present.push_back(d(i));
    if (present == known)
      return;
    known.clear();
    // The mesh is isoparametric: Jacobians and gradients come from the
    // positions of the nodes, as FEValues with the Eulerian mapping would get
    // them, but without its tables for each cell.
    const FE_Q<dim>             scalar_fe(configuration.degree);
    std::vector<Tensor<1, dim>> unit(n_points * n_nodes);
    for (unsigned int q = 0; q < n_points; ++q)
      for (unsigned int a = 0; a < n_nodes; ++a)
        unit[q * n_nodes + a] = scalar_fe.shape_grad(a, quadrature.point(q));
    std::vector<unsigned int> dof;
    for (unsigned int a = 0; a < n_nodes; ++a)
      for (unsigned int i = 0; i < dim; ++i)
        dof.push_back(configuration.fe.component_to_system_index(i, a));

    const NodalVector                    positions = configuration.positions();
    std::vector<types::global_dof_index> dofs(n_nodes * dim);
    std::vector<Tensor<1, dim>>          x(n_nodes);
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int a = 0; a < n_nodes; ++a)
            for (unsigned int i = 0; i < dim; ++i)
              x[a][i] = positions(dofs[dof[a * dim + i]]);
          const std::size_t first =
            static_cast<std::size_t>(slot[cell->active_cell_index()]) *
            n_points;
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const Tensor<1, dim> *N = unit.data() + q * n_nodes;
              Tensor<2, dim>        jacobian;
              for (unsigned int a = 0; a < n_nodes; ++a)
                for (unsigned int i = 0; i < dim; ++i)
                  jacobian[i] += x[a][i] * N[a];
              const double J = determinant(jacobian);
              if (!(J > 0.))
                throw RunError("mesh",
                               "an element is inverted at its quadrature point",
                               "start from a valid mesh");
              all_weights[first + q]       = J * quadrature.weight(q);
              const Tensor<2, dim> inverse = invert(jacobian);
              for (unsigned int a = 0; a < n_nodes; ++a)
                all_gradients[(first + q) * n_nodes + a] = N[a] * inverse;
            }
        }
    known = std::move(present);
  }



  template <int dim>
  std::size_t
  StepGeometry<dim>::memory_consumption() const
  {
    return all_gradients.size() * sizeof(Tensor<1, dim>) +
           all_weights.size() * sizeof(double) +
           slot.size() * sizeof(unsigned int);
  }

  template class StepGeometry<2>;
  template class StepGeometry<3>;
} // namespace alveolus
