// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/cell_nodes.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_tools.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  CellNodes<dim>::CellNodes(const Configuration<dim> &configuration)
    : degree(configuration.degree)
    , n_nodes(Utilities::pow(configuration.degree + 1, dim))
  {
    if (degree > max_degree)
      throw RunError("Degree",
                     "transfer of history is written for degrees up to " +
                       std::to_string(max_degree),
                     "choose degree 1 or 2");

    const QGaussLobatto<1> points(degree + 1);
    for (unsigned int i = 0; i <= degree; ++i)
      nodes_1d[i] = points.point(i)[0];

    const FiniteElement<dim>       &fe = configuration.fe;
    const std::vector<unsigned int> to_hierarchic =
      FETools::lexicographic_to_hierarchic_numbering<dim>(degree);
    const auto &partitioner =
      *configuration.mesh_displacement().get_partitioner();
    n_local_entries =
      partitioner.locally_owned_size() + partitioner.n_ghost_indices();

    entries.assign(configuration.mesh.triangulation->n_active_cells() *
                     n_nodes * dim,
                   numbers::invalid_unsigned_int);
    unit_positions.resize(n_nodes);
    for (unsigned int i = 0; i < n_nodes; ++i)
      unit_positions[i] =
        fe.base_element(0).unit_support_point(to_hierarchic[i]);

    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(dofs);
          unsigned int *entry =
            entries.data() + cell->active_cell_index() * n_nodes * dim;
          for (unsigned int i = 0; i < n_nodes; ++i)
            for (unsigned int d = 0; d < dim; ++d)
              *(entry++) = partitioner.global_to_local(
                dofs[fe.component_to_system_index(d, to_hierarchic[i])]);
        }
  }

  template <int dim>
  void
  CellNodes<dim>::check(const NodalVector &x) const
  {
    const auto &partitioner = *x.get_partitioner();
    if (!x.has_ghost_elements() ||
        partitioner.locally_owned_size() + partitioner.n_ghost_indices() !=
          n_local_entries)
      throw RunError("Transfer",
                     "a nodal vector has no ghost values or belongs to "
                     "another mesh",
                     "make it with Configuration::make_vector() and update "
                     "its ghost values");
  }

  template <int dim>
  void
  CellNodes<dim>::shape_1d(
    const double                        s,
    std::array<double, max_degree + 1> &values,
    std::array<double, max_degree + 1> &derivatives) const
  {
    if (degree == 1)
      {
        values[0]      = 1. - s;
        values[1]      = s;
        derivatives[0] = -1.;
        derivatives[1] = 1.;
        return;
      }
    for (unsigned int i = 0; i <= degree; ++i)
      {
        double value = 1., derivative = 0.;
        for (unsigned int j = 0; j <= degree; ++j)
          if (j != i)
            {
              const double scale = 1. / (nodes_1d[i] - nodes_1d[j]);
              derivative = (derivative * (s - nodes_1d[j]) + value) * scale;
              value *= (s - nodes_1d[j]) * scale;
            }
        values[i]      = value;
        derivatives[i] = derivative;
      }
  }

  template <int dim>
  void
  CellNodes<dim>::shape_gradients(const Point<dim> &xi,
                                  NodeNumbers      &values,
                                  NodeTensors      &gradients) const
  {
    std::array<std::array<double, max_degree + 1>, dim> v, dv;
    for (unsigned int d = 0; d < dim; ++d)
      shape_1d(xi[d], v[d], dv[d]);

    const unsigned int n    = degree + 1;
    unsigned int       node = 0;
    for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i, ++node)
          {
            const double vk    = dim == 3 ? v[dim - 1][k] : 1.;
            values[node]       = v[0][i] * v[1][j] * vk;
            gradients[node][0] = dv[0][i] * v[1][j] * vk;
            gradients[node][1] = v[0][i] * dv[1][j] * vk;
            if constexpr (dim == 3)
              gradients[node][2] = v[0][i] * v[1][j] * dv[2][k];
          }
  }

  template <int dim>
  void
  CellNodes<dim>::shape_values(const Point<dim> &xi, NodeNumbers &values) const
  {
    NodeTensors gradients;
    shape_gradients(xi, values, gradients);
  }

  template <int dim>
  bool
  CellNodes<dim>::invert(const NodeTensors &nodes,
                         const Point<dim>  &x,
                         Point<dim>        &xi) const
  {
    NodeNumbers values;
    NodeTensors gradients;
    for (unsigned int iteration = 0; iteration < 30; ++iteration)
      {
        shape_gradients(xi, values, gradients);
        Tensor<1, dim> residual = x;
        Tensor<2, dim> jacobian;
        for (unsigned int i = 0; i < n_nodes; ++i)
          {
            residual -= values[i] * nodes[i];
            jacobian += outer_product(nodes[i], gradients[i]);
          }
        const double det = determinant(jacobian);
        if (!(std::abs(det) > 1e-14 * std::pow(jacobian.norm(), dim)))
          return false;
        Tensor<1, dim> step = dealii::invert(jacobian) * residual;
        // Far from the cell the map may fold: never leap by more than a cell.
        const double length = step.norm();
        if (length > 1.)
          step /= length;
        xi += step;
        if (!(xi.norm() < 20.))
          return false;
        if (length < 1e-8) // quadratic: the error is now at round-off
          return true;
      }
    return false;
  }

  template class CellNodes<2>;
  template class CellNodes<3>;
} // namespace alveolus
