// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/distributed_system.h>
#include <alveolus/base/errors.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_solver.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  DistributedSystem<dim>::DistributedSystem(
    const DoFHandler<dim>           &dof_handler,
    const AffineConstraints<double> &constraints,
    const Method                     method,
    const double                     tolerance,
    const DofGroups                 &couplings)
    : constraints(constraints)
    , method(method)
    , tolerance(tolerance)
    , asked(tolerance)
    , owned(dof_handler.locally_owned_dofs())
  {
    const MPI_Comm communicator = dof_handler.get_communicator();
    IndexSet       relevant;
    DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
    DynamicSparsityPattern pattern =
      make_sparsity(dof_handler, constraints, relevant, owned, couplings);
    SparsityTools::distribute_sparsity_pattern(pattern,
                                               owned,
                                               communicator,
                                               relevant);
    matrix.reinit(owned, owned, pattern, communicator);
    right_hand_side.reinit(owned, communicator);
    solution.reinit(owned, communicator);
    if (method != Method::direct)
      multigrid =
        std::make_unique<Multigrid<dim>>(dof_handler, method == Method::cg);
  }



  template <int dim>
  void
  DistributedSystem<dim>::clear()
  {
    matrix = 0.;
  }



  template <int dim>
  void
  DistributedSystem<dim>::add(const FullMatrix<double> &cell_matrix,
                              const std::vector<types::global_dof_index> &dofs)
  {
    constraints.distribute_local_to_global(cell_matrix, dofs, matrix);
  }



  template <int dim>
  void
  DistributedSystem<dim>::add_rows(
    const FullMatrix<double>                   &cell_matrix,
    const std::vector<types::global_dof_index> &dofs,
    const std::vector<unsigned int>            &rows)
  {
    FullMatrix<double>                   part(rows.size(), dofs.size());
    std::vector<types::global_dof_index> row_dofs;
    for (unsigned int i = 0; i < rows.size(); ++i)
      {
        row_dofs.push_back(dofs[rows[i]]);
        for (unsigned int j = 0; j < dofs.size(); ++j)
          part(i, j) = cell_matrix(rows[i], j);
      }
    constraints.distribute_local_to_global(part, row_dofs, dofs, matrix);
  }



  template <int dim>
  void
  DistributedSystem<dim>::compress()
  {
    matrix.compress(VectorOperation::add);
  }



  template <int dim>
  void
  DistributedSystem<dim>::set_positions(const NodalVector &positions)
  {
    if (multigrid)
      multigrid->set_positions(positions);
  }



  template <int dim>
  void
  DistributedSystem<dim>::ask(const double relative_residual)
  {
    asked = std::max(relative_residual, tolerance);
  }



  template <int dim>
  void
  DistributedSystem<dim>::solve(NodalVector &x, const NodalVector &b)
  {
    for (const auto i : owned)
      {
        right_hand_side(i) = constraints.is_constrained(i) ? 0. : b(i);
        solution(i)        = 0.;
      }
    right_hand_side.compress(VectorOperation::insert);
    solution.compress(VectorOperation::insert);

    const double norm = right_hand_side.l2_norm();
    iterations        = 1;
    rest              = 0.;
    condition         = 1.;
    if (!multigrid || !(norm > 0.))
      factorise(norm);
    else if (multigrid->solve(matrix, solution, right_hand_side, asked))
      {
        iterations = multigrid->iterations;
        rest       = multigrid->residual;
      }
    else
      {
        ++replaced;
        factorise(norm);
      }
    asked = tolerance;

    constraints.distribute(solution);
    x.zero_out_ghost_values();
    for (const auto i : owned)
      x(i) = solution(i);
    x.update_ghost_values();
  }



  template <int dim>
  void
  DistributedSystem<dim>::factorise(const double norm)
  {
    SolverControl                                  control(1, 1e300);
    TrilinosWrappers::SolverDirect::AdditionalData data(false, "Amesos_Mumps");
    TrilinosWrappers::SolverDirect                 solver(control, data);
    try
      {
        solver.initialize(matrix);
        solver.solve(solution, right_hand_side);
        // What was lost by scaling, static pivots and another order of
        // elimination on another number of processes comes back.
        TrilinosWrappers::MPI::Vector left(right_hand_side);
        TrilinosWrappers::MPI::Vector correction(right_hand_side);
        double last = matrix.residual(left, solution, right_hand_side);
        for (unsigned int n = 0; n < 2 && last > 1e-15 * norm; ++n)
          {
            solver.solve(correction, left);
            solution += correction;
            const double now = matrix.residual(left, solution, right_hand_side);
            if (!(now < 0.5 * last))
              {
                if (!(now < last))
                  solution -= correction;
                break;
              }
            last = now;
          }
      }
    catch (const ExceptionBase &failure)
      {
        throw RunError("linear solver " + name(),
                       "MUMPS could not factorise the matrix",
                       "check that the conditions hold every body; if memory "
                       "was too small, use `Linear solver = multigrid`, more "
                       "processes or a coarser mesh");
      }
    // MUMPS divides by pivots of the size of round-off without a word: what a
    // load does then tells. A lower bound of the condition number.
    const double largest = matrix.linfty_norm() * solution.l2_norm();
    condition            = largest > 0. ? std::min(1., norm / largest) : 1.;
  }



  template <int dim>
  double
  DistributedSystem<dim>::pivot_ratio() const
  {
    return condition;
  }



  template <int dim>
  bool
  DistributedSystem<dim>::is_iterative() const
  {
    return method != Method::direct;
  }



  template <int dim>
  unsigned int
  DistributedSystem<dim>::n_iterations() const
  {
    return iterations;
  }



  template <int dim>
  double
  DistributedSystem<dim>::residual() const
  {
    return rest;
  }



  template <int dim>
  unsigned int
  DistributedSystem<dim>::n_replaced() const
  {
    return replaced;
  }



  template <int dim>
  std::size_t
  DistributedSystem<dim>::n_nonzeros() const
  {
    return matrix.trilinos_matrix().NumMyNonzeros();
  }



  template <int dim>
  std::string
  DistributedSystem<dim>::name() const
  {
    return method == Method::direct ? "MUMPS"
           : method == Method::cg   ? "CG with ML"
                                    : "GMRES with ML";
  }

  template class DistributedSystem<2>;
  template class DistributedSystem<3>;
} // namespace alveolus
