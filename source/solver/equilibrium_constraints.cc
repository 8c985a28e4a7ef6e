// SPDX-License-Identifier: LGPL-2.1-or-later
// Which degrees of freedom an equilibrium holds, and the system for the others.
#include <alveolus/solver/equilibrium.h>

#include <cmath>
#include <set>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  Equilibrium<dim>::update_system(const Interval &interval)
  {
    std::vector<unsigned int> revisions;
    for (const auto &condition : conditions)
      revisions.push_back(condition->couplings_revision());
    if (system && revisions == coupled)
      {
        set_constraints(interval);
        return;
      }
    coupled = revisions;
    DofGroups couplings;
    for (const auto &condition : conditions)
      condition->add_couplings(couplings);
    if (Utilities::MPI::n_mpi_processes(state.configuration.communicator()) > 1)
      {
        std::set<types::global_dof_index> dofs;
        for (const auto &group : couplings)
          dofs.insert(group.begin(), group.end());
        coupled_dofs.assign(dofs.begin(), dofs.end());
      }
    set_constraints(interval);
    system = make_linear_system(state.configuration.dof_handler,
                                held,
                                parameters.linear_solver,
                                parameters.linear_tolerance,
                                couplings);
  }


  template <int dim>
  void
  Equilibrium<dim>::set_constraints(const Interval &interval)
  {
    PrescribedIncrements increments;
    for (const auto &condition : conditions)
      condition->prescribe(state, interval, increments);
    IndexSet known = state.configuration.locally_relevant;
    known.add_indices(coupled_dofs.begin(), coupled_dofs.end());
    prescribed.reinit(known);
    held.reinit(known);
    if (!hanging.empty())
      {
        prescribed.merge(hanging.constraints());
        held.merge(hanging.constraints());
      }
    for (const auto &[dof, value] : increments.all())
      {
        // A hanging node goes where its neighbours take it (3D boundaries).
        if (!hanging.empty() && hanging.constraints().is_constrained(dof))
          continue;
        prescribed.add_line(dof);
        prescribed.set_inhomogeneity(dof, value.first);
        held.add_line(dof);
      }
    share_constraints();
    prescribed.close();
    held.close();
  }


  template <int dim>
  void
  Equilibrium<dim>::share_constraints()
  {
    if (coupled_dofs.empty())
      return;
    // Each comes from its owner, all others add zero.
    const auto         &owned = state.configuration.locally_owned;
    std::vector<double> sum(2 * coupled_dofs.size(), 0.);
    for (unsigned int i = 0; i < coupled_dofs.size(); ++i)
      if (owned.is_element(coupled_dofs[i]) &&
          held.is_constrained(coupled_dofs[i]))
        {
          sum[2 * i]     = 1.;
          sum[2 * i + 1] = prescribed.get_inhomogeneity(coupled_dofs[i]);
        }
    Utilities::MPI::sum(sum, state.configuration.communicator(), sum);
    for (unsigned int i = 0; i < coupled_dofs.size(); ++i)
      if (sum[2 * i] > 0. && !held.is_constrained(coupled_dofs[i]))
        {
          prescribed.add_line(coupled_dofs[i]);
          prescribed.set_inhomogeneity(coupled_dofs[i], sum[2 * i + 1]);
          held.add_line(coupled_dofs[i]);
        }
  }


  template <int dim>
  double
  Equilibrium<dim>::free_norm(const NodalVector &v) const
  {
    double sum = 0.;
    for (const auto i : state.configuration.locally_owned)
      if (!held.is_constrained(i))
        sum += std::abs(v(i));
    return Utilities::MPI::sum(sum, state.configuration.communicator());
  }


  template <int dim>
  double
  Equilibrium<dim>::free_work(const NodalVector &u, const NodalVector &v) const
  {
    double sum = 0.;
    for (const auto i : state.configuration.locally_owned)
      if (!held.is_constrained(i))
        sum += u(i) * v(i);
    return Utilities::MPI::sum(sum, state.configuration.communicator());
  }

#define INSTANTIATE(dim)                                                  \
  template void   Equilibrium<dim>::update_system(const Interval &);      \
  template void   Equilibrium<dim>::set_constraints(const Interval &);    \
  template void   Equilibrium<dim>::share_constraints();                  \
  template double Equilibrium<dim>::free_norm(const NodalVector &) const; \
  template double Equilibrium<dim>::free_work(const NodalVector &,        \
                                              const NodalVector &) const;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
