// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/condition.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  void
  PrescribedIncrements::prescribe(const types::global_dof_index dof,
                                  const double                  value,
                                  const std::string            &where)
  {
    const auto result = values.emplace(dof, std::make_pair(value, where));
    if (result.second)
      return;
    const double other = result.first->second.first;
    if (std::abs(other - value) >
        1e-9 * std::max({std::abs(other), std::abs(value), 1e-3}))
      throw InputError(where,
                       "prescribes " + std::to_string(value) +
                         " mm for a node that " + result.first->second.second +
                         " moves by " + std::to_string(other) + " mm",
                       "let one of them act on other components or nodes");
  }



  void
  AssemblyTarget::add(const FullMatrix<double>                   &matrix,
                      const Vector<double>                       &forces,
                      const std::vector<types::global_dof_index> &dofs) const
  {
    for (unsigned int i = 0; i < dofs.size(); ++i)
      residual(dofs[i]) += forces[i];
    if (system == nullptr)
      return;
    system->add(matrix, dofs);
    add_lifted(matrix, dofs);
  }



  void
  AssemblyTarget::add_replicated(
    const FullMatrix<double>                   &matrix,
    const Vector<double>                       &forces,
    const std::vector<types::global_dof_index> &dofs) const
  {
    const auto               &partitioner = *residual.get_partitioner();
    std::vector<unsigned int> mine;
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (partitioner.in_local_range(dofs[i]))
        {
          mine.push_back(i);
          residual(dofs[i]) += forces[i];
        }
    if (system == nullptr || mine.empty())
      return;
    system->add_rows(matrix, dofs, mine);
    if (lift == nullptr)
      return;
    for (unsigned int j = 0; j < dofs.size(); ++j)
      if (lift->is_constrained(dofs[j]))
        for (const unsigned int i : mine)
          (*lifted)(dofs[i]) -= matrix(i, j) * lift->get_inhomogeneity(dofs[j]);
  }



  void
  AssemblyTarget::add_lifted(
    const FullMatrix<double>                   &matrix,
    const std::vector<types::global_dof_index> &dofs) const
  {
    if (lift == nullptr)
      return;
    for (unsigned int j = 0; j < dofs.size(); ++j)
      if (lift->is_constrained(dofs[j]))
        {
          const double g = lift->get_inhomogeneity(dofs[j]);
          if (g != 0.)
            for (unsigned int i = 0; i < dofs.size(); ++i)
              (*lifted)(dofs[i]) -= matrix(i, j) * g;
        }
  }



  template <int dim>
  std::vector<
    std::pair<typename DoFHandler<dim>::active_cell_iterator, unsigned int>>
  boundary_faces(const Configuration<dim>           &configuration,
                 const std::set<types::boundary_id> &ids)
  {
    std::vector<
      std::pair<typename DoFHandler<dim>::active_cell_iterator, unsigned int>>
      result;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int face : cell->face_indices())
          if (cell->face(face)->at_boundary() &&
              ids.count(cell->face(face)->boundary_id()) > 0)
            result.emplace_back(cell, face);
    return result;
  }



  std::vector<unsigned int>
  parse_components(const std::string &list,
                   const unsigned int dim,
                   const std::string &where)
  {
    std::vector<unsigned int> components;
    for (const auto &name : Utilities::split_string_list(list, ','))
      {
        const auto at = std::string("xyz").find(name);
        if (name.size() != 1 || at == std::string::npos || at >= dim)
          throw InputError(where + " / Components",
                           "'" + name + "' is not a component",
                           dim == 2 ? "use x, y or both"
                                    : "use a list of x, y, z");
        components.push_back(at);
      }
    return components;
  }

  template std::vector<
    std::pair<DoFHandler<2>::active_cell_iterator, unsigned int>>
  boundary_faces(const Configuration<2> &,
                 const std::set<types::boundary_id> &);
  template std::vector<
    std::pair<DoFHandler<3>::active_cell_iterator, unsigned int>>
  boundary_faces(const Configuration<3> &,
                 const std::set<types::boundary_id> &);
} // namespace alveolus
