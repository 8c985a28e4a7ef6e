// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_multigrid_h
#define alveolus_algebra_multigrid_h

#include <alveolus/algebra/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Epetra_MultiVector.h>

#include <array>
#include <memory>
#include <vector>

namespace alveolus
{
  /**
   * CG or GMRES with algebraic multigrid: smoothed aggregation (Trilinos ML)
   * over nodes, with the rigid motions of the mesh as near null space.
   *
   * The hierarchy is made in the first solution after set_positions(), that is
   * once a step, and serves the Newton iterations after it as long as they do
   * not need many more iterations than the first one did; so a run that is
   * resumed repeats the iterations of one that was not interrupted.
   */
  template <int dim>
  class Multigrid
  {
  public:
    /** @param symmetric CG instead of GMRES */
    Multigrid(const dealii::DoFHandler<dim> &dof_handler, const bool symmetric);

    /** Where the nodes are [mm]: near null space of the next hierarchy. */
    void
    set_positions(const NodalVector &positions);

    /**
     * Solve A x = b from x = 0 to a residual of @p tolerance times |b|.
     * @return false if the iteration does not get there, even with a new
     *         hierarchy
     */
    bool
    solve(const dealii::TrilinosWrappers::SparseMatrix &matrix,
          dealii::TrilinosWrappers::MPI::Vector        &x,
          const dealii::TrilinosWrappers::MPI::Vector  &b,
          const double                                  tolerance);

    unsigned int iterations = 0;  ///< of the last solution
    double       residual   = 0.; ///< of the last solution, relative to |b|
    unsigned int n_setups   = 0;  ///< hierarchies made so far

  private:
    void
    make_hierarchy(const dealii::TrilinosWrappers::SparseMatrix &matrix);
    /** Translations and (linearised) rotations at the nodes, one a column. */
    void
    rigid_motions(Epetra_MultiVector &modes) const;
    bool
    iterate(const dealii::TrilinosWrappers::SparseMatrix &matrix,
            dealii::TrilinosWrappers::MPI::Vector        &x,
            const dealii::TrilinosWrappers::MPI::Vector  &b,
            const double                                  tolerance);

    static constexpr unsigned int max_iterations = 500;

    const bool       symmetric;
    dealii::IndexSet owned;
    /** Degrees of freedom of the owned nodes, and where these are [mm],
     * counted from the middle of all. */
    std::vector<std::array<dealii::types::global_dof_index, dim>> nodes;
    std::vector<dealii::Tensor<1, dim>>                           places;
    std::unique_ptr<dealii::TrilinosWrappers::PreconditionAMG>    hierarchy;
    bool                                                          renew = true;
    /** Iterations per power of ten of the residual in the first solution with
     * the hierarchy, and how many more the later ones took in all. */
    double per_magnitude = 0.;
    double excess        = 0.;
  };
} // namespace alveolus

#endif
