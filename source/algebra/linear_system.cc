// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/serial_system.h>
#include <alveolus/base/errors.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/sparsity_tools.h>
#include <deal.II/lac/trilinos_precondition.h>
#include <deal.II/lac/trilinos_solver.h>
#include <deal.II/lac/trilinos_sparse_matrix.h>
#include <deal.II/lac/trilinos_vector.h>

#include <Epetra_MultiVector.h>
#include <Teuchos_ParameterList.hpp>

#include <array>

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



    /**
     * Trilinos' matrix with MUMPS, or with CG or GMRES and algebraic multigrid:
     * smoothed aggregation (ML) over nodes, with the rigid motions of the mesh
     * as near null space. Where the iteration fails, MUMPS is asked instead,
     * which is counted.
     */
    template <int dim>
    class DistributedSystem : public LinearSystem
    {
    public:
      enum class Method
      {
        direct,
        cg,
        gmres
      };

      DistributedSystem(const DoFHandler<dim>           &dof_handler,
                        const AffineConstraints<double> &constraints,
                        const Method                     method,
                        const double                     tolerance,
                        const DofGroups                 &couplings)
        : constraints(constraints)
        , method(method)
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
        if (method != Method::direct)
          find_nodes(dof_handler);
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
      set_positions(const NodalVector &positions) override
      {
        if (method == Method::direct)
          return;
        Tensor<1, dim> middle;
        for (unsigned int n = 0; n < nodes.size(); ++n)
          for (unsigned int c = 0; c < dim; ++c)
            {
              places[n][c] = positions(nodes[n][c]);
              middle[c] += places[n][c];
            }
        const MPI_Comm communicator = positions.get_mpi_communicator();
        middle = Utilities::MPI::sum(middle, communicator) /
                 Utilities::MPI::sum(1. * nodes.size(), communicator);
        for (auto &x : places)
          x -= middle;
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

        const double norm = right_hand_side.l2_norm();
        iterations        = 1;
        rest              = 0.;
        if (method == Method::direct || !(norm > 0.) || !iterate(norm))
          factorise(norm);

        constraints.distribute(solution);
        x.zero_out_ghost_values();
        for (const auto i : owned)
          x(i) = solution(i);
        x.update_ghost_values();
      }

      bool
      is_iterative() const override
      {
        return method != Method::direct;
      }

      unsigned int
      n_iterations() const override
      {
        return iterations;
      }

      double
      residual() const override
      {
        return rest;
      }

      unsigned int
      n_replaced() const override
      {
        return replaced;
      }

      std::size_t
      n_nonzeros() const override
      {
        return matrix.n_nonzero_elements() /
               Utilities::MPI::n_mpi_processes(matrix.get_mpi_communicator());
      }

      std::string
      name() const override
      {
        return method == Method::direct ? "MUMPS"
               : method == Method::cg   ? "CG with ML"
                                        : "GMRES with ML";
      }

    private:
      void
      find_nodes(const DoFHandler<dim> &dof_handler)
      {
        const auto                          &fe = dof_handler.get_fe();
        std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
        std::vector<bool>                    found(owned.n_elements(), false);
        for (const auto &cell : dof_handler.active_cell_iterators())
          if (!cell->is_artificial())
            {
              cell->get_dof_indices(dofs);
              for (unsigned int k = 0; k < dofs.size() / dim; ++k)
                {
                  std::array<types::global_dof_index, dim> node;
                  for (unsigned int c = 0; c < dim; ++c)
                    node[c] = dofs[fe.component_to_system_index(c, k)];
                  if (!owned.is_element(node[0]) ||
                      found[owned.index_within_set(node[0])])
                    continue;
                  found[owned.index_within_set(node[0])] = true;
                  nodes.push_back(node);
                }
            }
        places.resize(nodes.size());
      }

      /** Translations and (linearised) rotations at the nodes, one a column. */
      void
      rigid_motions(Epetra_MultiVector &modes) const
      {
        modes.PutScalar(0.);
        for (unsigned int n = 0; n < nodes.size(); ++n)
          {
            const Tensor<1, dim> &x = places[n];
            for (unsigned int c = 0; c < dim; ++c)
              {
                const auto row      = owned.index_within_set(nodes[n][c]);
                modes[c][row]       = 1.;
                unsigned int column = dim;
                for (unsigned int a = 0; a < dim; ++a)
                  for (unsigned int b = 0; b < a; ++b, ++column)
                    if (c == a)
                      modes[column][row] = x[b];
                    else if (c == b)
                      modes[column][row] = -x[a];
              }
          }
      }

      /** Solve by iteration; false if it does not get there. */
      bool
      iterate(const double norm)
      {
        TrilinosWrappers::PreconditionAMG::AdditionalData data;
        data.elliptic              = true;
        data.smoother_sweeps       = 2;
        data.aggregation_threshold = 0.02;
        Teuchos::ParameterList              parameters;
        std::unique_ptr<Epetra_MultiVector> unused;
        data.set_parameters(parameters, unused, matrix);
        constexpr int      n_modes = dim * (dim + 1) / 2;
        Epetra_MultiVector modes(matrix.trilinos_matrix().RowMap(), n_modes);
        rigid_motions(modes);
        parameters.set("PDE equations", dim);
        parameters.set("null space: type", "pre-computed");
        parameters.set("null space: dimension", n_modes);
        parameters.set("null space: vectors", modes.Values());

        SolverControl control(max_iterations, tolerance * norm);
        try
          {
            TrilinosWrappers::PreconditionAMG preconditioner;
            preconditioner.initialize(matrix, parameters);
            if (method == Method::cg)
              TrilinosWrappers::SolverCG(control).solve(matrix,
                                                        solution,
                                                        right_hand_side,
                                                        preconditioner);
            else
              TrilinosWrappers::SolverGMRES(
                control,
                TrilinosWrappers::SolverGMRES::AdditionalData(false, 100))
                .solve(matrix, solution, right_hand_side, preconditioner);
          }
        catch (const ExceptionBase &)
          {
            // Among them: no convergence, an indefinite matrix in CG
            ++replaced;
            return false;
          }
        iterations = control.last_step();
        rest       = control.last_value() / norm;
        return true;
      }

      void
      factorise(const double norm)
      {
        SolverControl control(1, tolerance * norm + 1e-300);
        try
          {
            TrilinosWrappers::SolverDirect::AdditionalData data(false,
                                                                "Amesos_Mumps");
            TrilinosWrappers::SolverDirect solver(control, data);
            solver.solve(matrix, solution, right_hand_side);
          }
        catch (const ExceptionBase &failure)
          {
            throw RunError(
              "linear solver " + name(),
              "the matrix could not be factorised",
              "check that the boundary conditions hold every body");
          }
      }

      static constexpr unsigned int max_iterations = 500;

      const AffineConstraints<double> &constraints;
      const Method                     method;
      const double                     tolerance;
      IndexSet                         owned;
      TrilinosWrappers::SparseMatrix   matrix;
      TrilinosWrappers::MPI::Vector    right_hand_side;
      TrilinosWrappers::MPI::Vector    solution;
      /** Degrees of freedom of the owned nodes, and where these are [mm],
       * counted from the middle of all. */
      std::vector<std::array<types::global_dof_index, dim>> nodes;
      std::vector<Tensor<1, dim>>                           places;
      unsigned int                                          iterations = 1;
      unsigned int                                          replaced   = 0;
      double                                                rest       = 0.;
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
      {
        IndexSet all(dof_handler.n_dofs());
        all.add_range(0, dof_handler.n_dofs());
        return std::make_unique<SerialSystem>(
          make_pattern(dof_handler, constraints, all, couplings),
          constraints,
          dof_handler.get_triangulation().n_active_cells());
      }
    using Distributed = DistributedSystem<dim>;
    return std::make_unique<Distributed>(dof_handler,
                                         constraints,
                                         type == "multigrid"
                                           ? Distributed::Method::cg
                                         : type == "multigrid GMRES"
                                           ? Distributed::Method::gmres
                                           : Distributed::Method::direct,
                                         tolerance,
                                         couplings);
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
