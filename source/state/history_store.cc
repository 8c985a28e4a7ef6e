// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/state/history_store.h>

#include <deal.II/base/memory_consumption.h>
#include <deal.II/base/mpi.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  HistoryStore<dim>::HistoryStore(
    const Triangulation                              &triangulation,
    const std::map<types::material_id, unsigned int> &region_of_material,
    const std::vector<HistoryLayout>                 &layouts,
    const unsigned int                                n_points_per_cell)
    : triangulation(triangulation)
    , n_points(n_points_per_cell)
    , layouts(layouts)
    , cell_region(triangulation.n_active_cells(), 0)
    , begin(triangulation.n_active_cells() + 1, 0)
    , exchange(triangulation)
  {
    unsigned int unknown = numbers::invalid_unsigned_int;
    for (const auto &cell : triangulation.active_cell_iterators())
      {
        const unsigned int c = cell->active_cell_index();
        begin[c + 1]         = begin[c];
        if (cell->is_artificial())
          continue;
        const auto region = region_of_material.find(cell->material_id());
        if (region == region_of_material.end() ||
            region->second >= layouts.size())
          {
            unknown = std::min<unsigned int>(unknown, cell->material_id());
            continue;
          }
        cell_region[c] = region->second;
        begin[c + 1] += n_points * layouts[region->second].size;
      }

    // Every process must throw if one does.
    unknown = Utilities::MPI::min(unknown, triangulation.get_communicator());
    if (unknown != numbers::invalid_unsigned_int)
      throw InputError("Regions",
                       "cells with material id " + std::to_string(unknown) +
                         " belong to no region",
                       "assign this part of the mesh to a region with a "
                       "material");

    old_values.assign(begin.back(), 0.);
    trial_values.assign(begin.back(), 0.);
  }

  template <int dim>
  void
  HistoryStore<dim>::update_ghosts()
  {
    exchange.update(old_values, begin);
  }

  template <int dim>
  std::size_t
  HistoryStore<dim>::memory_consumption() const
  {
    return MemoryConsumption::memory_consumption(old_values) +
           MemoryConsumption::memory_consumption(trial_values);
  }

  template class HistoryStore<2>;
  template class HistoryStore<3>;
} // namespace alveolus
