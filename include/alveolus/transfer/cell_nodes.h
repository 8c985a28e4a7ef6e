// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_cell_nodes_h
#define alveolus_transfer_cell_nodes_h

#include <alveolus/mesh/configuration.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace alveolus
{
  /**
   * The map of a cell x(xi) = sum_i N_i(xi) x_i through its nodal positions,
   * xi in [0,1]^dim, N_i the Lagrange polynomials of FE_Q(degree): where the
   * nodes of each owned and ghost cell are in a nodal vector, values and
   * gradients of N_i at any point, and the inverse map. Nodes are in
   * lexicographic order, x fastest. Built once per mesh.
   */
  template <int dim>
  class CellNodes
  {
  public:
    /** Largest degree of elements. */
    static constexpr unsigned int max_degree = 3;
    /** Nodes of a cell of that degree. */
    static constexpr unsigned int max_nodes = dim == 2 ? 16 : 64;

    /** A vector at each node of a cell. */
    using NodeTensors = std::array<dealii::Tensor<1, dim>, max_nodes>;
    /** A number at each node of a cell. */
    using NodeNumbers = std::array<double, max_nodes>;

    /** @throws RunError if the degree is above max_degree */
    explicit CellNodes(const Configuration<dim> &configuration);

    /**
     * Values of the ghosted nodal vector @p x at the nodes of the active cell
     * @p cell (owned or ghost).
     */
    void
    gather(const NodalVector &x,
           const unsigned int cell,
           NodeTensors       &values) const
    {
      const unsigned int *entry = entries.data() + cell * n_nodes * dim;
      for (unsigned int i = 0; i < n_nodes; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          values[i][d] = x.local_element(*(entry++));
    }

    /**
     * Local entries (owned ones first, then ghosts) of the dim components of
     * node @p node of the active cell @p cell in a nodal vector.
     */
    const unsigned int *
    local_entries(const unsigned int cell, const unsigned int node) const
    {
      return entries.data() + (cell * n_nodes + node) * dim;
    }

    /** @throws RunError unless @p x is a ghosted vector of the configuration */
    void
    check(const NodalVector &x) const;

    /** N_i(xi). */
    void
    shape_values(const dealii::Point<dim> &xi, NodeNumbers &values) const;

    /** N_i(xi) and their derivatives with respect to xi. */
    void
    shape_gradients(const dealii::Point<dim> &xi,
                    NodeNumbers              &values,
                    NodeTensors              &gradients) const;

    /** One-dimensional Lagrange polynomials and derivatives at @p s. */
    void
    shape_1d(const double                        s,
             std::array<double, max_degree + 1> &values,
             std::array<double, max_degree + 1> &derivatives) const;

    /**
     * Find xi with x(xi) = @p x by Newton's method from the start value
     * @p xi; the point may be outside the cell.
     * @return false if Newton does not converge
     */
    bool
    invert(const NodeTensors        &nodes,
           const dealii::Point<dim> &x,
           dealii::Point<dim>       &xi) const;

    /** Unit position of node @p node. */
    const dealii::Point<dim> &
    unit_position(const unsigned int node) const
    {
      return unit_positions[node];
    }

    const unsigned int degree;  ///< of the elements
    const unsigned int n_nodes; ///< per cell

  private:
    std::array<double, max_degree + 1> nodes_1d;
    std::vector<dealii::Point<dim>>    unit_positions;
    std::vector<unsigned int>          entries;
    std::size_t                        n_local_entries = 0;
  };
} // namespace alveolus

#endif
