// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/distributed_system.h>
#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/serial_system.h>
#include <alveolus/base/errors.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  DynamicSparsityPattern
  make_sparsity(const DoFHandler<dim>           &dof_handler,
                const AffineConstraints<double> &constraints,
                const IndexSet                  &relevant,
                const IndexSet                  &owned,
                const DofGroups                 &couplings)
  {
    DynamicSparsityPattern pattern(relevant);
    DoFTools::make_sparsity_pattern(dof_handler,
                                    pattern,
                                    constraints,
                                    /*keep constrained*/ false);
    std::vector<types::global_dof_index> rows;
    for (const auto &group : couplings)
      {
        rows.clear();
        for (const auto dof : group)
          if (owned.is_element(dof))
            rows.push_back(dof);
        if (!rows.empty())
          constraints.add_entries_local_to_global(rows,
                                                  group,
                                                  pattern,
                                                  /*keep constrained*/ false);
      }
    return pattern;
  }



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
          make_sparsity(dof_handler, constraints, all, all, couplings),
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

  template DynamicSparsityPattern
  make_sparsity(const DoFHandler<2> &,
                const AffineConstraints<double> &,
                const IndexSet &,
                const IndexSet &,
                const DofGroups &);
  template DynamicSparsityPattern
  make_sparsity(const DoFHandler<3> &,
                const AffineConstraints<double> &,
                const IndexSet &,
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
