// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/state/face_history.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  FaceHistory<dim>::FaceHistory(
    const Triangulation                &triangulation,
    const std::set<types::boundary_id> &boundary_ids,
    const unsigned int                  n_points_per_face,
    const unsigned int                  n_components)
    : triangulation(triangulation)
    , n_points(n_points_per_face)
    , n_components(n_components)
  {
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() &&
              boundary_ids.count(cell->face(f)->boundary_id()) > 0)
            {
              indices[{cell->active_cell_index(), f}] = face_list.size();
              face_list.push_back({cell, f});
            }
    old_values.assign(face_list.size() * n_points * n_components, 0.);
    trial_values = old_values;
  }

  template <int dim>
  unsigned int
  FaceHistory<dim>::index(const unsigned int cell,
                          const unsigned int face_no) const
  {
    const auto found = indices.find({cell, face_no});
    return found == indices.end() ? numbers::invalid_unsigned_int
                                  : found->second;
  }

  template class FaceHistory<2>;
  template class FaceHistory<3>;
} // namespace alveolus
