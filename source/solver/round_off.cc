// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/round_off.h>

#include <algorithm>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  NodalVector
  round_off_displacement(const Configuration<dim> &configuration)
  {
    NodalVector                          size(configuration.make_vector());
    std::vector<types::global_dof_index> dofs(
      configuration.fe.n_dofs_per_cell());
    // Of relevant cells, so that every owned node knows all of its cells.
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          const double h = cell->minimum_vertex_distance();
          cell->get_dof_indices(dofs);
          for (const auto dof : dofs)
            if (configuration.locally_owned.is_element(dof))
              size(dof) = size(dof) == 0. ? h : std::min<double>(size(dof), h);
        }
    for (const auto dof : configuration.locally_owned)
      // The sign looks like chance, so that no mode is left out; Knuth's
      // factor.
      size(dof) *=
        std::numeric_limits<double>::epsilon() *
        ((static_cast<unsigned int>(dof * 2654435761u) >> 16) % 2 ? 1. : -1.);
    size.update_ghost_values();
    return size;
  }



  bool
  stagnates(const std::vector<double> &residuals, const std::size_t first)
  {
    constexpr std::size_t n = 3;
    if (residuals.size() < first + n + 1)
      return false;
    const auto last = residuals.end() - n;
    return *std::min_element(last, residuals.end()) >
           0.5 * *std::min_element(residuals.begin() + first, last);
  }

  template NodalVector
  round_off_displacement(const Configuration<2> &);
  template NodalVector
  round_off_displacement(const Configuration<3> &);
} // namespace alveolus
