// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/distributed_system.h>
#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/umfpack.h>
#include <alveolus/base/errors.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_matrix.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  DynamicSparsityPattern
  make_sparsity(const DoFHandler<dim>           &dof_handler,
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



  namespace
  {
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
          make_sparsity(dof_handler, constraints, all, couplings));
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

  template DynamicSparsityPattern
  make_sparsity(const DoFHandler<2> &,
                const AffineConstraints<double> &,
                const IndexSet &,
                const DofGroups &);
  template DynamicSparsityPattern
  make_sparsity(const DoFHandler<3> &,
                const AffineConstraints<double> &,
                const IndexSet &,
                const DofGroups &);

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
