// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_helmholtz_filter_h
#define alveolus_solver_helmholtz_filter_h

#include <alveolus/algebra/linear_system.h>
#include <alveolus/assembly/step_geometry.h>

#include <deal.II/fe/fe_q.h>

#include <memory>
#include <vector>

namespace alveolus
{
  /**
   * Smooths a field of quadrature point values over the length l:
   * phi - l^2 lap phi = f with zero normal derivative, in the weak form
   * int N phi + l^2 grad N . grad phi = int N f on the current mesh (Lazarov &
   * Sigmund, Int. J. Numer. Meth. Eng. 86 (2011) 765). Acts on the given cells
   * only; keeps constants and the integral.
   */
  template <int dim>
  class HelmholtzFilter
  {
  public:
    /**
     * @param cells  active cell indices of the owned cells of the domain
     * @param length l [mm]
     */
    HelmholtzFilter(const Configuration<dim>        &configuration,
                    const std::vector<unsigned int> &cells,
                    const double                     length);

    /**
     * Replace @p values (n_points per entry of `cells`, in that order) by their
     * filtered values (collective).
     */
    void
    apply(const StepGeometry<dim> &geometry, std::vector<double> &values);

  private:
    const std::vector<unsigned int>  &cells;
    const double                      length;
    dealii::FE_Q<dim>                 fe;
    dealii::DoFHandler<dim>           dof_handler;
    dealii::AffineConstraints<double> outside; ///< dofs of no filtered cell
    std::unique_ptr<LinearSystem>     system;
    std::vector<std::vector<dealii::types::global_dof_index>> cell_dofs;
    dealii::IndexSet                                          relevant;
  };
} // namespace alveolus

#endif
