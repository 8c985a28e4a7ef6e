// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_cell_kernel_h
#define alveolus_assembly_cell_kernel_h

#include <alveolus/assembly/step_geometry.h>
#include <alveolus/materials/material.h>
#include <alveolus/state/history_store.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <string>

namespace alveolus
{
  /** What is modelled in one region: the region's index is that of the history.
   */
  struct Region
  {
    std::string     name;               ///< of the scene, in messages
    const Material *material = nullptr; ///< of all its cells; lives elsewhere
    /** Mean dilatation (theory, section 2) instead of full integration. */
    bool mean_dilatation = true;
  };

  /**
   * Internal forces and tangent of one cell for the displacement increment du
   * on the mesh x_n. With the Kirchhoff stress tau of f = I + d(du)/dx_n and
   * J_n = dv_n/dV of the past,
   *
   *   F_i = int tau_hat : grad_x N_i dv_n / J_n.
   *
   * Full integration: tau_hat = tau(f). Mean dilatation, from the three-field
   * principle int psi(f_bar)/J_n + p (det f - theta) dv_n (Simo, Taylor &
   * Pister 1985, condensed cell-wise, theta and p in FE_DGP(degree - 1)):
   * f_bar = (theta/det f)^{1/3} f, theta = P(det f), p = P(tr tau_bar /
   * (3 theta J_n)), tau_hat = dev tau_bar / J_n + p det f I, where P is the L2
   * projection on the cell of x_n. The tangent is the derivative of F,
   * symmetric where the material has an incremental potential.
   */
  template <int dim>
  class CellKernel
  {
  public:
    /** Why a cell could not be evaluated. */
    enum class Status
    {
      good,
      inverted,  ///< det f or theta not positive
      not_finite ///< stress not a finite number
    };

    /**
     * Both must outlive this object. It has work space inside: each thread
     * needs its own.
     */
    explicit CellKernel(const Configuration<dim> &configuration,
                        const StepGeometry<dim>  &geometry);

    /**
     * @param cell      active cell index of an owned cell
     * @param increment du of the cell's dofs in the order of the FESystem [mm]
     * @param matrix    tangent [N/mm (per mm)], not filled if null
     * @param forces    internal forces of the dofs [N (per mm)]
     * Writes the trial history of the cell. Material errors pass through.
     */
    Status
    evaluate(const unsigned int            cell,
             const Region                 &region,
             HistoryStore<dim>            &history,
             const dealii::Vector<double> &increment,
             dealii::FullMatrix<double>   *matrix,
             dealii::Vector<double>       &forces);

    // Of the cell in the last evaluate() [mJ (per mm)]:
    double energy = 0.; ///< stored
    /**
     * The same with the undeformed volumes that the points have on the moved
     * mesh. Mean dilatation shifts them within a cell, since J changes by theta
     * where the mesh changes by det f.
     */
    double energy_moved = 0.;
    double dissipation  = 0.; ///< plastic work of the increment

    /** Undeformed volume of a point on the moved mesh, dv/J [mm^dim]. */
    double
    moved_weight(const unsigned int point) const
    {
      return points[point].weight * points[point].det / points[point].theta;
    }

  private:
    struct Point
    {
      dealii::Tensor<2, 3>                f;
      double                              det                = 1.;
      double                              theta              = 1.;
      double                              weight             = 0.;
      double                              pressure_integrand = 0.;
      double                              pressure           = 0.;
      MaterialResponse                    response;
      std::vector<dealii::Tensor<1, dim>> gradients; ///< with respect to x
      /** Derivatives that mean dilatation needs, with dv_n / J_n: */
      dealii::Tensor<2, dim> stress_by_theta;      ///< of the deviator
      dealii::Tensor<2, dim> pressure_by_gradient; ///< of tr tau/(3 theta)
      double                 pressure_by_theta = 0.;
    };

    Status
    evaluate_points(const unsigned int            cell,
                    const Region                 &region,
                    HistoryStore<dim>            &history,
                    const dealii::Vector<double> &increment,
                    const bool                    need_tangent);
    void
    fill_tangent(dealii::FullMatrix<double> &matrix);
    /** @tparam n_static number of nodes if known beforehand, otherwise 0. */
    template <unsigned int n_static>
    void
    add_point_tangents();
    void
    add_dilatation_tangent();

    /** Coefficients of the L2 projection of values given at the points. */
    void
    invert_mass(const double *weights);
    template <typename Get>
    void
    project(const Get &integrand, std::vector<double> &coefficients) const;
    double
    projected(const std::vector<double> &coefficients,
              const unsigned int         point) const;

    const Configuration<dim> &configuration;
    const StepGeometry<dim>  &geometry;
    std::vector<unsigned int> dof; ///< of node a, component i at [a * dim + i]
    bool                      mean_dilatation = false;
    const double             *geometry_weight = nullptr; ///< of the cell
    std::vector<Point>        points;
    const std::vector<std::vector<double>> &pressure_shapes; ///< of geometry
    dealii::FullMatrix<double>              mass_inverse;
    std::vector<double>                     coefficients;
    std::vector<double>                     coefficients_pressure;
    /**
     * Work space of the tangent: d force (node a, component i) by d u (node b,
     * component k) at [((b * dim + k) * dim + i) * n_nodes + a].
     */
    std::vector<double> tangent;
    double              moduli[dim][dim][dim][dim]; ///< a_ijkl at [k][i][j][l]
    std::vector<double> gradients_by_component;
    /** Rows of all dofs for each function of FE_DGP, see
     * add_dilatation_tangent.
     */
    std::vector<double> volume_rows, pressure_rows, deviator_rows, theta_rows,
      dp_rows;
  };
} // namespace alveolus

#endif
