// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_linear_system_h
#define alveolus_algebra_linear_system_h

#include <alveolus/algebra/types.h>

#include <deal.II/dofs/dof_handler.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/full_matrix.h>

#include <memory>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Matrix and solver of one sparse linear system. The only place that knows
   * which library does the algebra: UMFPACK on one process, Trilinos with MUMPS
   * or ML on several.
   */
  class LinearSystem
  {
  public:
    virtual ~LinearSystem() = default;

    /** Set the matrix to zero. */
    virtual void
    clear() = 0;

    /** Add a cell matrix; constrained rows and columns are condensed. */
    virtual void
    add(const dealii::FullMatrix<double>                   &cell_matrix,
        const std::vector<dealii::types::global_dof_index> &dofs) = 0;

    /**
     * The same for a matrix that comes in every assembly: @p slot, counted from
     * zero, stands for @p dofs, so that where its entries belong may be kept.
     */
    virtual void
    add_cell(const unsigned int /*slot*/,
             const dealii::FullMatrix<double>                   &cell_matrix,
             const std::vector<dealii::types::global_dof_index> &dofs)
    {
      add(cell_matrix, dofs);
    }

    /**
     * Add only @p rows (numbers in @p dofs) of a matrix whose dofs may lie
     * anywhere; whether they are constrained must be known here. On one process
     * these are all of its rows.
     */
    virtual void
    add_rows(const dealii::FullMatrix<double>                   &cell_matrix,
             const std::vector<dealii::types::global_dof_index> &dofs,
             const std::vector<unsigned int> & /*rows*/)
    {
      add(cell_matrix, dofs);
    }

    /** End of assembly: exchange between processes. */
    virtual void
    compress() = 0;

    /**
     * Solve A x = b for the unconstrained entries; constrained entries of x are
     * set from the (homogeneous) constraints.
     * @throws RunError for a singular matrix or an iteration that stagnates
     */
    virtual void
    solve(NodalVector &x, const NodalVector &b) = 0;

    /** Where the nodes are [mm]; multigrid takes their rigid motions as near
     * null space. Without it rotations are unknown to it. */
    virtual void
    set_positions(const NodalVector & /*positions*/)
    {}

    /** Whether solutions are found by iteration. */
    virtual bool
    is_iterative() const
    {
      return false;
    }

    /** Residual of the last solve relative to the right hand side; 0 for a
     * direct solver. */
    virtual double
    residual() const
    {
      return 0.;
    }

    /** Solves so far in which the iteration failed and MUMPS took over. */
    virtual unsigned int
    n_replaced() const
    {
      return 0;
    }

    /** Iterations of the last solve; 1 for a direct solver. */
    virtual unsigned int
    n_iterations() const
    {
      return 1;
    }

    /**
     * Smallest over largest pivot of the last solve as an estimate of the
     * reciprocal condition number; 1 for solvers that do not tell.
     */
    virtual double
    pivot_ratio() const
    {
      return 1.;
    }

    /** Stored entries of the matrix, on this process. */
    virtual std::size_t
    n_nonzeros() const
    {
      return 0;
    }

    /** Bytes of the matrix and what belongs to it, without its factors. */
    virtual std::size_t
    memory_consumption() const
    {
      return 0;
    }

    /**
     * Bytes that the factors of a direct solver are expected to take, from an
     * analysis of the pattern alone; 0 where there is no such analysis.
     */
    virtual std::size_t
    expected_factor_bytes()
    {
      return 0;
    }

    /** Name for the log. */
    virtual std::string
    name() const = 0;
  };

  /** Groups of degrees of freedom; within a group all are coupled. */
  using DofGroups = std::vector<std::vector<dealii::types::global_dof_index>>;

  /**
   * Make the system for a DoFHandler and its homogeneous constraints.
   * @param type `automatic` (UMFPACK on one process, MUMPS on several),
   *        `UMFPACK`, `MUMPS`, `multigrid` (CG with Trilinos ML) or `multigrid
   *        GMRES`
   * @param tolerance relative residual of iterative solvers
   * @param couplings entries of the matrix beyond those of the cells, the same
   *        on every process; constraints must know these dofs everywhere
   * @throws InputError for UMFPACK on several processes
   */
  template <int dim>
  std::unique_ptr<LinearSystem>
  make_linear_system(const dealii::DoFHandler<dim>           &dof_handler,
                     const dealii::AffineConstraints<double> &constraints,
                     const std::string                       &type,
                     const double                             tolerance,
                     const DofGroups                         &couplings = {});
} // namespace alveolus

#endif
