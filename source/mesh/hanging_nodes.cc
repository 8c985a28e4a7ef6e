// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/hanging_nodes.h>

#include <deal.II/dofs/dof_tools.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  HangingNodes<dim>::HangingNodes(const Configuration<dim> &configuration)
    : none(!configuration.mesh.triangulation->has_hanging_nodes())
    , owned(configuration.locally_owned)
  {
    if (none)
      return;
    if (configuration.degree > 1)
      throw InputError("Mesh / Degree",
                       "it is " + std::to_string(configuration.degree) +
                         " and the mesh has hanging nodes",
                       "set it to 1, or refine the mesh as a whole");
    lines.reinit(configuration.locally_relevant);
    DoFTools::make_hanging_node_constraints(configuration.dof_handler, lines);
    lines.close();
  }

  template <int dim>
  void
  HangingNodes<dim>::distribute(NodalVector &v) const
  {
    if (none)
      return;
    v.update_ghost_values();
    std::vector<std::pair<types::global_dof_index, double>> values;
    for (const auto i : owned)
      if (const auto *entries =
            lines.is_constrained(i) ? lines.get_constraint_entries(i) : nullptr)
        {
          double value = 0.;
          for (const auto &[j, weight] : *entries)
            value += weight * v(j);
          values.emplace_back(i, value);
        }
    v.zero_out_ghost_values();
    for (const auto &[i, value] : values)
      v(i) = value;
    v.update_ghost_values();
  }

  template <int dim>
  void
  HangingNodes<dim>::condense(NodalVector &f) const
  {
    if (none)
      return;
    f.zero_out_ghost_values();
    std::vector<std::pair<types::global_dof_index, double>> values;
    for (const auto i : owned)
      if (lines.is_constrained(i))
        {
          values.emplace_back(i, f(i));
          f(i) = 0.;
        }
    for (const auto &[i, value] : values)
      for (const auto &[j, weight] : *lines.get_constraint_entries(i))
        f(j) += weight * value;
    f.compress(VectorOperation::add);
  }

  template class HangingNodes<2>;
  template class HangingNodes<3>;
} // namespace alveolus
