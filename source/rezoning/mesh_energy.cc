// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/mesh_energy.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * Gradients of the shape functions of degree @p degree at the points of a
     * quadrature, appended to @p gradients with zeros up to @p n_nodes a point:
     * the nodes of a lower degree are the first ones of a higher degree.
     */
    template <int dim>
    void
    add_samples(const unsigned int           degree,
                const Quadrature<dim>       &quadrature,
                const double                 part,
                const unsigned int           n_nodes,
                std::vector<Tensor<1, dim>> &gradients,
                std::vector<double>         &weights)
    {
      const FE_Q<dim> fe(degree);
      for (unsigned int q = 0; q < quadrature.size(); ++q)
        {
          for (unsigned int k = 0; k < n_nodes; ++k)
            gradients.push_back(k < fe.n_dofs_per_cell()
                                  ? fe.shape_grad(k, quadrature.point(q))
                                  : Tensor<1, dim>());
          weights.push_back(part * quadrature.weight(q));
        }
    }

    /**
     * Points of the Gauss-Lobatto formula that integrates the cofactors of the
     * Jacobian times gradients of shape functions: of degree dim * degree - 1
     * in each direction, at most.
     */
    template <int dim>
    QGaussLobatto<dim>
    lobatto(const unsigned int degree)
    {
      return QGaussLobatto<dim>((degree * dim + 3) / 2);
    }
  } // namespace

  template <int dim>
  MeshEnergy<dim>::MeshEnergy(
    const Nodes<dim>                                &nodes,
    const NodalVector                               &positions,
    const std::vector<std::set<types::material_id>> &regions,
    const NodalVector                               &is_free,
    const bool                                       keep_shapes,
    const ShapeMetric<dim>                          &metric,
    const std::string                               &where)
    : communicator(nodes.configuration.communicator())
    , metric(metric)
    , region_weight(regions.size(), 0.)
    , scale(regions.size(), 1.)
  {
    const auto        &configuration = nodes.configuration;
    const unsigned int degree        = configuration.degree;
    n_nodes           = configuration.fe.base_element(0).n_dofs_per_cell();
    const double part = degree == 1 ? 1. / 2. : 1. / 3.;
    add_samples<dim>(degree,
                     QGauss<dim>(degree + 1),
                     part,
                     n_nodes,
                     shape_gradients,
                     sample_weights);
    add_samples<dim>(degree,
                     lobatto<dim>(degree),
                     part,
                     n_nodes,
                     shape_gradients,
                     sample_weights);
    if (degree > 1)
      add_samples<dim>(
        1, lobatto<dim>(1), part, n_nodes, shape_gradients, sample_weights);
    n_samples = sample_weights.size();

    std::vector<NodeId> cell_nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Cell entry;
          entry.region =
            std::find_if(regions.begin(),
                         regions.end(),
                         [&](const auto &ids) {
                           return ids.count(cell->material_id()) > 0;
                         }) -
            regions.begin();
          bool moves = false;
          nodes.cell_nodes(cell, cell_nodes);
          for (const NodeId node : cell_nodes)
            for (const auto dof : nodes.dofs(node))
              {
                entry.dofs.push_back(dof);
                entry.local.push_back(
                  positions.get_partitioner()->global_to_local(dof));
                moves = moves || is_free(dof) != 0.;
              }
          if (moves)
            cells.push_back(entry);
          else
            other_cells.push_back(entry.dofs);
        }

    Tensor<2, dim> unit;
    for (unsigned int c = 0; c < dim; ++c)
      unit[c][c] = 1.;
    inverse_targets.assign(cells.size() * n_samples, unit);
    weights.reserve(cells.size() * n_samples);
    bool valid = true;
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int s = 0; s < n_samples; ++s)
        {
          double volume = 1.;
          if (keep_shapes)
            {
              const Tensor<2, dim> W = jacobian(positions, cells[c], s);
              volume                 = determinant(W);
              valid                  = valid && volume > 0.;
              if (volume > 0.)
                inverse_targets[c * n_samples + s] = invert(W);
            }
          weights.push_back(sample_weights[s] * volume);
          region_weight[cells[c].region] += weights.back();
        }
    if (Utilities::MPI::min(valid ? 1 : 0, communicator) == 0)
      throw InputError(where + "/Shapes",
                       "a cell to be moved is turned inside out at the start",
                       "repair the mesh, or take `Shapes = equal`");
    Utilities::MPI::sum(region_weight, communicator, region_weight);
    for (const double weight : region_weight)
      total_weight += weight;
  }

  template <int dim>
  Tensor<2, dim>
  MeshEnergy<dim>::jacobian(const NodalVector &field,
                            const Cell        &cell,
                            const unsigned int s) const
  {
    Tensor<2, dim>        A;
    const Tensor<1, dim> *gradient = &shape_gradients[s * n_nodes];
    const unsigned int   *dof      = cell.local.data();
    for (unsigned int k = 0; k < n_nodes; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        A[c] += field.local_element(*dof++) * gradient[k];
    return A;
  }

  template <int dim>
  void
  MeshEnergy<dim>::gradients(const unsigned int           c,
                             const unsigned int           s,
                             std::vector<Tensor<1, dim>> &result) const
  {
    const Tensor<2, dim> to_target =
      scale[cells[c].region] * inverse_targets[c * n_samples + s];
    for (unsigned int k = 0; k < n_nodes; ++k)
      result[k] = shape_gradients[s * n_nodes + k] * to_target;
  }

  template <int dim>
  void
  MeshEnergy<dim>::fit_sizes(const NodalVector &positions)
  {
    std::vector<double> volume(scale.size(), 0.);
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int s = 0; s < n_samples; ++s)
        volume[cells[c].region] +=
          sample_weights[s] * determinant(jacobian(positions, cells[c], s));
    Utilities::MPI::sum(volume, communicator, volume);
    for (unsigned int r = 0; r < scale.size(); ++r)
      // What is not positive cannot be filled; no sample will be valid there.
      scale[r] =
        volume[r] > 0. ? std::pow(region_weight[r] / volume[r], 1. / dim) : 1.;
  }

  template <int dim>
  double
  MeshEnergy<dim>::value(const NodalVector &positions) const
  {
    double sum = 0.;
    for (unsigned int c = 0; c < cells.size() && std::isfinite(sum); ++c)
      for (unsigned int s = 0; s < n_samples && std::isfinite(sum); ++s)
        sum += weights[c * n_samples + s] *
               metric.value(target_to_present(positions, c, s));
    return Utilities::MPI::sum(sum, communicator) / total_weight;
  }

  template <int dim>
  template <typename Stress>
  void
  MeshEnergy<dim>::integrate(const Stress &stress, NodalVector &result) const
  {
    result.zero_out_ghost_values();
    result = 0.;
    std::vector<Tensor<1, dim>> grad(n_nodes);
    for (unsigned int c = 0; c < cells.size(); ++c)
      for (unsigned int s = 0; s < n_samples; ++s)
        {
          gradients(c, s, grad);
          const Tensor<2, dim> P =
            (weights[c * n_samples + s] / total_weight) * stress(c, s);
          const unsigned int *dof = cells[c].local.data();
          for (unsigned int k = 0; k < n_nodes; ++k)
            for (unsigned int i = 0; i < dim; ++i)
              result.local_element(*dof++) += P[i] * grad[k];
        }
    result.compress(VectorOperation::add);
  }

  template <int dim>
  void
  MeshEnergy<dim>::gradient(const NodalVector &positions,
                            NodalVector       &result) const
  {
    integrate(
      [&](const unsigned int c, const unsigned int s) {
        return metric.gradient(target_to_present(positions, c, s));
      },
      result);
  }

  template <int dim>
  void
  MeshEnergy<dim>::hessian_times(const NodalVector &positions,
                                 const NodalVector &direction,
                                 NodalVector       &result) const
  {
    integrate(
      [&](const unsigned int c, const unsigned int s) {
        return double_contract<2, 0, 3, 1>(
          metric.hessian(target_to_present(positions, c, s)),
          target_to_present(direction, c, s));
      },
      result);
  }

  template <int dim>
  void
  MeshEnergy<dim>::hessian(const NodalVector &positions,
                           LinearSystem      &system,
                           const bool         positive) const
  {
    const unsigned int          n = n_nodes * dim;
    FullMatrix<double>          matrix(n, n);
    std::vector<Tensor<1, dim>> grad(n_nodes);
    LAPACKFullMatrix<double>    lapack(n, n);
    FullMatrix<double>          vectors(n, n);
    Vector<double>              values(n);

    system.clear();
    for (unsigned int c = 0; c < cells.size(); ++c)
      {
        matrix = 0.;
        for (unsigned int s = 0; s < n_samples; ++s)
          {
            gradients(c, s, grad);
            const Tensor<4, dim> H =
              (weights[c * n_samples + s] / total_weight) *
              metric.hessian(target_to_present(positions, c, s));
            for (unsigned int l = 0; l < n_nodes; ++l)
              for (unsigned int j = 0; j < dim; ++j)
                {
                  // Change of the stress by component j of node l
                  Tensor<2, dim> dP;
                  for (unsigned int i = 0; i < dim; ++i)
                    for (unsigned int k = 0; k < dim; ++k)
                      dP[i][k] = H[i][k][j] * grad[l];
                  for (unsigned int k = 0; k <= l; ++k)
                    for (unsigned int i = 0; i < dim; ++i)
                      matrix(k * dim + i, l * dim + j) += dP[i] * grad[k];
                }
          }
        for (unsigned int a = 0; a < n; ++a)
          for (unsigned int b = 0; b < a; ++b)
            matrix(a, b) = matrix(b, a);
        if (positive)
          {
            lapack = matrix;
            lapack.compute_eigenvalues_symmetric(
              -std::numeric_limits<double>::max(),
              std::numeric_limits<double>::max(),
              0.,
              values,
              vectors);
            matrix = 0.;
            for (unsigned int e = 0; e < n; ++e)
              for (unsigned int a = 0; a < n; ++a)
                for (unsigned int b = 0; b < n; ++b)
                  matrix(a, b) +=
                    std::abs(values[e]) * vectors(a, e) * vectors(b, e);
          }
        system.add(matrix, cells[c].dofs);
      }
    for (const auto &dofs : other_cells)
      system.add(IdentityMatrix(dofs.size()), dofs);
    system.compress();
  }

  template <int dim>
  double
  MeshEnergy<dim>::largest_strain(const NodalVector &positions,
                                  const NodalVector &step) const
  {
    double largest = 0.;
    for (const Cell &cell : cells)
      for (unsigned int s = 0; s < n_samples; ++s)
        {
          const double strain =
            (jacobian(step, cell, s) * invert(jacobian(positions, cell, s)))
              .norm();
          // A number that is none is large.
          if (!(strain <= largest))
            largest =
              std::isnan(strain) ? std::numeric_limits<double>::max() : strain;
        }
    return Utilities::MPI::max(largest, communicator);
  }

  template class MeshEnergy<2>;
  template class MeshEnergy<3>;
} // namespace alveolus
