// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/umfpack.h>
#include <alveolus/base/errors.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    DynamicSparsityPattern
    make_pattern(const DoFHandler<dim>           &dof_handler,
                 const AffineConstraints<double> &constraints,
                 const IndexSet                  &relevant,
                 const DofGroups                 &couplings)
    {
      DynamicSparsityPattern pattern(relevant);
      DoFTools::make_sparsity_pattern(dof_handler,
                                      pattern,
                                      constraints,
                                      /*keep constrained*/ false);
      for (const auto &group : couplings)
        constraints.add_entries_local_to_global(group,
                                                pattern,
                                                /*keep constrained*/ false);
      return pattern;
    }



    /** deal.II's matrix and UMFPACK, one process. */
    class SerialSystem : public LinearSystem
    {
    public:
      template <int dim>
      SerialSystem(const DoFHandler<dim>           &dof_handler,
                   const AffineConstraints<double> &constraints,
                   const DofGroups                 &couplings)
        : constraints(constraints)
      {
        IndexSet all(dof_handler.n_dofs());
        all.add_range(0, dof_handler.n_dofs());
        pattern.copy_from(
          make_pattern(dof_handler, constraints, all, couplings));
        matrix.reinit(pattern);
        right_hand_side.reinit(dof_handler.n_dofs());
        solution.reinit(dof_handler.n_dofs());
      }

      void
      clear() override
      {
        matrix = 0.;
      }

      void
      add(const FullMatrix<double>                   &cell_matrix,
          const std::vector<types::global_dof_index> &dofs) override
      {
        constraints.distribute_local_to_global(cell_matrix, dofs, matrix);
      }

      void
      compress() override
      {}

      void
      solve(NodalVector &x, const NodalVector &b) override
      {
        umfpack.factorize(matrix);
        for (unsigned int i = 0; i < right_hand_side.size(); ++i)
          right_hand_side[i] = constraints.is_constrained(i) ? 0. : b(i);
        umfpack.solve(solution, right_hand_side);
        constraints.distribute(solution);
        x.zero_out_ghost_values();
        for (unsigned int i = 0; i < solution.size(); ++i)
          x.local_element(i) = solution[i];
        x.update_ghost_values();
      }

      double
      pivot_ratio() const override
      {
        return umfpack.pivot_ratio();
      }

      std::string
      name() const override
      {
        return "UMFPACK";
      }

    private:
      const AffineConstraints<double> &constraints;
      SparsityPattern                  pattern;
      SparseMatrix<double>             matrix;
      Umfpack                          umfpack;
      Vector<double>                   right_hand_side;
      Vector<double>                   solution;
    };



    /** Trilinos' matrix with MUMPS or with CG and algebraic multigrid. */
    class DistributedSystem : public LinearSystem
    {
    public:
      template <int dim>
      DistributedSystem(const DoFHandler<dim>           &dof_handler,
                        const AffineConstraints<double> &constraints,
                        const bool                       multigrid,
                        const double                     tolerance,
                        const DofGroups                 &couplings)
        : constraints(constraints)
        , multigrid(multigrid)
        , tolerance(tolerance)
      {
        const MPI_Comm communicator = dof_handler.get_communicator();
        owned                       = dof_handler.locally_owned_dofs();
        IndexSet relevant;
        DoFTools::extract_locally_relevant_dofs(dof_handler, relevant);
        DynamicSparsityPattern pattern =
          make_pattern(dof_handler, constraints, relevant, couplings);
        SparsityTools::distribute_sparsity_pattern(pattern,
                                                   owned,
                                                   communicator,
                                                   relevant);
        matrix.reinit(owned, owned, pattern, communicator);
        right_hand_side.reinit(owned, communicator);
        solution.reinit(owned, communicator);
        if (multigrid)
          DoFTools::extract_constant_modes(dof_handler,
                                           ComponentMask(dim, true),
                                           constant_modes);
      }

      void
      clear() override
      {
        matrix = 0.;
      }

      void
      add(const FullMatrix<double>                   &cell_matrix,
          const std::vector<types::global_dof_index> &dofs) override
      {
        constraints.distribute_local_to_global(cell_matrix, dofs, matrix);
      }

      void
      compress() override
      {
        matrix.compress(VectorOperation::add);
      }

      void
      solve(NodalVector &x, const NodalVector &b) override
      {
        for (const auto i : owned)
          {
            right_hand_side(i) = constraints.is_constrained(i) ? 0. : b(i);
            solution(i)        = 0.;
          }
        right_hand_side.compress(VectorOperation::insert);
        solution.compress(VectorOperation::insert);

        const double  norm = right_hand_side.l2_norm();
        SolverControl control(5000, tolerance * norm + 1e-300);
        try
          {
            if (multigrid && norm > 0.)
              {
                TrilinosWrappers::PreconditionAMG::AdditionalData data;
                data.elliptic              = true;
                data.constant_modes        = constant_modes;
                data.smoother_sweeps       = 2;
                data.aggregation_threshold = 0.02;
                TrilinosWrappers::PreconditionAMG preconditioner;
                preconditioner.initialize(matrix, data);
                TrilinosWrappers::SolverCG solver(control);
                solver.solve(matrix, solution, right_hand_side, preconditioner);
                iterations = control.last_step();
              }
            else
              {
                TrilinosWrappers::SolverDirect::AdditionalData data(
                  false, "Amesos_Mumps");
                TrilinosWrappers::SolverDirect solver(control, data);
                solver.solve(matrix, solution, right_hand_side);
              }
          }
        catch (const SolverControl::NoConvergence &failure)
          {
            throw RunError("linear solver " + name(),
                           "residual " + std::to_string(failure.last_residual) +
                             " after " + std::to_string(failure.last_step) +
                             " iterations from " + std::to_string(norm),
                           "try `Solver / Linear solver = MUMPS`");
          }
        catch (const ExceptionBase &failure)
          {
            throw RunError(
              "linear solver " + name(),
              "the matrix could not be factorised",
              "check that the boundary conditions hold every body");
          }

        constraints.distribute(solution);
        x.zero_out_ghost_values();
        for (const auto i : owned)
          x(i) = solution(i);
        x.update_ghost_values();
      }

      unsigned int
      n_iterations() const override
      {
        return iterations;
      }

      std::string
      name() const override
      {
        return multigrid ? "CG with ML" : "MUMPS";
      }

    private:
      const AffineConstraints<double> &constraints;
      const bool                       multigrid;
      const double                     tolerance;
      IndexSet                         owned;
      TrilinosWrappers::SparseMatrix   matrix;
      TrilinosWrappers::MPI::Vector    right_hand_side;
      TrilinosWrappers::MPI::Vector    solution;
      std::vector<std::vector<bool>>   constant_modes;
      unsigned int                     iterations = 1;
    };
  } // namespace



  template <int dim>
  std::unique_ptr<LinearSystem>
  make_linear_system(const DoFHandler<dim>           &dof_handler,
                     const AffineConstraints<double> &constraints,
                     const std::string               &type,
                     const double                     tolerance,
                     const DofGroups                 &couplings)
  {
    const bool serial =
      Utilities::MPI::n_mpi_processes(dof_handler.get_communicator()) == 1;
    if (type == "UMFPACK" && !serial)
      throw InputError("Solver / Linear solver",
                       "UMFPACK works on one process only",
                       "use MUMPS, multigrid or automatic");
    if (type == "UMFPACK" || (type == "automatic" && serial))
      return std::make_unique<SerialSystem>(dof_handler,
                                            constraints,
                                            couplings);
    return std::make_unique<DistributedSystem>(
      dof_handler, constraints, type == "multigrid", tolerance, couplings);
  }

  template std::unique_ptr<LinearSystem>
  make_linear_system(const DoFHandler<2> &,
                     const AffineConstraints<double> &,
                     const std::string &,
                     const double,
                     const DofGroups &);
  template std::unique_ptr<LinearSystem>
  make_linear_system(const DoFHandler<3> &,
                     const AffineConstraints<double> &,
                     const std::string &,
                     const double,
                     const DofGroups &);
} // namespace alveolus
