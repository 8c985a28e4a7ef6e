// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_mesh_energy_h
#define alveolus_rezoning_mesh_energy_h

#include <alveolus/algebra/linear_system.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/rezoning/shape_metric.h>

#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Distortion of a mesh against wanted cells, as a function of the positions
   * of its nodes (target-matrix optimisation: P. Knupp, Eng. Comput. 28 (2012)
   * 419-429):
   *
   *   E(x) = sum_s w_s mu(T_s) / sum_s w_s,   T_s = c A_s(x) W_s^-1,
   *
   * over samples s in all cells that have a node to be moved: A = dx/dxi the
   * Jacobian of the cell, W that of the wanted cell, w the quadrature weight
   * times det W, mu the ShapeMetric. The number c makes the wanted cells of a
   * region fill it: only the relative size counts.
   *
   * Samples are the Gauss points of the mechanics and Gauss-Lobatto points,
   * which contain the vertices; for degree 2 also the Lobatto points of the
   * cell with straight edges. These are all the places where mesh_quality()
   * looks, so that a finite energy means a valid mesh. Each of these
   * quadratures integrates the cofactors of the Jacobian exactly; so if the
   * wanted cells are those of some mesh, the gradient vanishes at this mesh and
   * at all its affine images (Piola's identity).
   *
   * All functions are collective. No units; positions in mm.
   */
  template <int dim>
  class MeshEnergy
  {
  public:
    /**
     * @param positions mesh whose cells are the wanted ones if @p keep_shapes;
     *        otherwise they are equal squares (cubes)
     * @param regions material ids of the regions that are moved inside
     * @param is_free 1 at the components of nodes to be moved, otherwise 0;
     *        ghosted
     * @param where for messages
     * @throws InputError if a wanted cell has no positive Jacobian
     */
    MeshEnergy(const Nodes<dim>  &nodes,
               const NodalVector &positions,
               const std::vector<std::set<dealii::types::material_id>> &regions,
               const NodalVector                                       &is_free,
               const bool              keep_shapes,
               const ShapeMetric<dim> &metric,
               const std::string      &where);

    /**
     * Choose c of each region so that the wanted cells fill the volume at
     * @p positions; it hangs on nodes that are not moved only. To be called
     * before what follows.
     */
    void
    fit_sizes(const NodalVector &positions);

    /** E; infinity if the Jacobian of any sample is not positive. */
    double
    value(const NodalVector &positions) const;

    /** dE/dx of all nodes of the cells (also those that do not move). */
    void
    gradient(const NodalVector &positions, NodalVector &result) const;

    /**
     * Assemble d^2E/dx^2 into @p system, whose constraints hold the nodes that
     * do not move; rows of other cells get unit diagonals.
     * @param positive replace each cell matrix by the one with the absolute
     *        values of its eigenvalues
     */
    void
    hessian(const NodalVector &positions,
            LinearSystem      &system,
            const bool         positive) const;

    /** d^2E/dx^2 times @p direction, the exact one; for all nodes. */
    void
    hessian_times(const NodalVector &positions,
                  const NodalVector &direction,
                  NodalVector       &result) const;

    /** Largest |grad d| over the samples, d a motion @p step from here. */
    double
    largest_strain(const NodalVector &positions, const NodalVector &step) const;

  private:
    struct Cell
    {
      unsigned int region;
      /** Degrees of freedom, node by node: global and local indices. */
      std::vector<dealii::types::global_dof_index> dofs;
      std::vector<unsigned int>                    local;
    };

    /** Jacobian of sample @p s for the nodal values @p field at @p cell. */
    dealii::Tensor<2, dim>
    jacobian(const NodalVector &field,
             const Cell        &cell,
             const unsigned int s) const;

    /**
     * Add up the forces of all nodes, sum_s of stress : grad N, where
     * @p stress(c, s) is dE/dT or its change at sample s of cell c.
     */
    template <typename Stress>
    void
    integrate(const Stress &stress, NodalVector &result) const;

    /** grad N of all nodes at a sample with respect to the wanted cell. */
    void
    gradients(const unsigned int                   c,
              const unsigned int                   s,
              std::vector<dealii::Tensor<1, dim>> &result) const;

    dealii::Tensor<2, dim>
    target_to_present(const NodalVector &positions,
                      const unsigned int c,
                      const unsigned int s) const
    {
      return scale[cells[c].region] * jacobian(positions, cells[c], s) *
             inverse_targets[c * n_samples + s];
    }

    const MPI_Comm         communicator;
    const ShapeMetric<dim> metric;

    unsigned int                        n_nodes = 0, n_samples = 0;
    std::vector<dealii::Tensor<1, dim>> shape_gradients; ///< [sample][node]
    std::vector<double>                 sample_weights;

    std::vector<Cell>                   cells;
    std::vector<dealii::Tensor<2, dim>> inverse_targets; ///< [cell][sample]
    std::vector<double>                 weights;         ///< [cell][sample]
    std::vector<double>                 region_weight, scale;
    double                              total_weight = 0.;
    /** Degrees of freedom of the owned cells that take no part. */
    std::vector<std::vector<dealii::types::global_dof_index>> other_cells;
  };
} // namespace alveolus

#endif
