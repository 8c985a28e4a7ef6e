// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_step_geometry_h
#define alveolus_assembly_step_geometry_h

#include <alveolus/mesh/configuration.h>

#include <deal.II/base/quadrature.h>

#include <vector>

namespace alveolus
{
  /**
   * Shape gradients and weights of the mesh x_n at all quadrature points of the
   * owned cells. The mesh stands still during the equilibrium iterations of a
   * step, so they are computed once a step and kept in flat arrays.
   */
  template <int dim>
  class StepGeometry
  {
  public:
    /** Take the configuration's mesh. @throws RunError if it is inverted */
    explicit StepGeometry(const Configuration<dim> &configuration);

    /**
     * Take the configuration's mesh as it is now, if it has changed.
     * @throws RunError if inverted
     */
    void
    update();

    /** Gradients of the scalar shape functions at a point, n_nodes long [1/mm].
     */
    const dealii::Tensor<1, dim> *
    gradients(const unsigned int cell, const unsigned int point) const
    {
      return all_gradients.data() +
             (static_cast<std::size_t>(slot[cell]) * n_points + point) *
               n_nodes;
    }

    /** Quadrature weights times Jacobian of a cell, n_points long [mm^dim]. */
    const double *
    weights(const unsigned int cell) const
    {
      return all_weights.data() +
             static_cast<std::size_t>(slot[cell]) * n_points;
    }

    /** Bytes of the arrays. */
    std::size_t
    memory_consumption() const;

    const dealii::Quadrature<dim> quadrature; ///< Gauss points of the unit cell
    const unsigned int            n_points;   ///< quadrature points of a cell
    const unsigned int            n_nodes; ///< scalar shape functions of a cell
    /**
     * Values of FE_DGP(degree - 1), [function][point]: what theta and p of mean
     * dilatation are made of. Here because the element is costly to make, and a
     * kernel is made for each assembly.
     */
    const std::vector<std::vector<double>> pressure_shapes;

  private:
    const Configuration<dim>           &configuration;
    std::vector<unsigned int>           slot; ///< of each active cell, if owned
    std::vector<dealii::Tensor<1, dim>> all_gradients;
    std::vector<double>                 all_weights;
    std::vector<double>                 known; ///< mesh displacement of these
  };
} // namespace alveolus

#endif
