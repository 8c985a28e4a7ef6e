// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_distributed_system_h
#define alveolus_algebra_distributed_system_h

#include <alveolus/algebra/adaptive_tolerance.h>
#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/multigrid.h>

#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace alveolus
{
  /**
   * Entries of the matrix of a DoFHandler, for the rows of @p relevant, and of
   * @p couplings, for the rows of @p owned.
   */
  template <int dim>
  dealii::DynamicSparsityPattern
  make_sparsity(const dealii::DoFHandler<dim>           &dof_handler,
                const dealii::AffineConstraints<double> &constraints,
                const dealii::IndexSet                  &relevant,
                const dealii::IndexSet                  &owned,
                const DofGroups                         &couplings);

  /**
   * Trilinos' matrix with MUMPS, or with CG or GMRES and algebraic multigrid.
   * Where the iteration fails, MUMPS is asked instead, which is counted.
   * Solutions of MUMPS are refined by their residual.
   */
  template <int dim>
  class DistributedSystem : public LinearSystem, public AdaptiveTolerance
  {
  public:
    /**
     * How systems are solved: MUMPS, or CG or GMRES with algebraic multigrid.
     */
    enum class Method
    {
      direct,
      cg,
      gmres
    };

    /**
     * @param constraints of the matrix: hanging nodes
     * @param tolerance of iterations, relative to the right-hand side [-]
     * @param couplings dofs of different cells that get entries in common
     */
    DistributedSystem(const dealii::DoFHandler<dim>           &dof_handler,
                      const dealii::AffineConstraints<double> &constraints,
                      const Method                             method,
                      const double                             tolerance,
                      const DofGroups                         &couplings);

    void
    clear() override;
    void
    add(const dealii::FullMatrix<double>                   &cell_matrix,
        const std::vector<dealii::types::global_dof_index> &dofs) override;
    void
    add_rows(const dealii::FullMatrix<double>                   &cell_matrix,
             const std::vector<dealii::types::global_dof_index> &dofs,
             const std::vector<unsigned int>                    &rows) override;
    void
    compress() override;
    void
    set_positions(const NodalVector &positions) override;
    void
    ask(const double relative_residual) override;
    void
    solve(NodalVector &x, const NodalVector &b) override;

    bool
    is_iterative() const override;
    unsigned int
    n_iterations() const override;
    double
    residual() const override;
    unsigned int
    n_replaced() const override;
    std::size_t
    n_nonzeros() const override;
    double
    pivot_ratio() const override;
    std::string
    name() const override;

  private:
    void
    factorise(const double norm);

    const dealii::AffineConstraints<double> &constraints;
    const Method                             method;
    const double                             tolerance;
    double                                   asked; ///< in the next solution
    dealii::IndexSet                         owned;
    dealii::TrilinosWrappers::SparseMatrix   matrix;
    dealii::TrilinosWrappers::MPI::Vector    right_hand_side;
    dealii::TrilinosWrappers::MPI::Vector    solution;
    std::unique_ptr<Multigrid<dim>>          multigrid;
    unsigned int                             iterations = 1;
    unsigned int                             replaced   = 0;
    double                                   rest       = 0.;
    double                                   condition  = 1.; ///< reciprocal
  };
} // namespace alveolus

#endif
