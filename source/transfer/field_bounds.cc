// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/field_bounds.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Relative excess over a bound that counts as round-off. */
    constexpr double round_off = 1e-12;
  } // namespace

  template <int dim>
  unsigned int
  enforce_bounds(HistoryStore<dim> &store)
  {
    unsigned int counted = 0;
    const auto   limit   = [&](const HistoryField &field, double &value) {
      if (value >= field.lower && value <= field.upper)
        return;
      // Not a number: neither bound helps, leave it to be seen.
      if (std::isnan(value))
        {
          ++counted;
          return;
        }
      const double bound = value < field.lower ? field.lower : field.upper;
      const double scale =
        std::max({std::abs(bound),
                  std::isinf(field.lower) ? 0. : std::abs(field.lower),
                  std::isinf(field.upper) ? 0. : std::abs(field.upper)});
      if (std::abs(value - bound) > round_off * (scale + 1e-300))
        ++counted;
      value = bound;
    };

    for (const auto &cell : store.triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int   c      = cell->active_cell_index();
          const HistoryLayout &layout = store.layout(store.region(c));
          for (unsigned int i = 0; i < layout.fields.size(); ++i)
            {
              const HistoryField &field = layout.fields[i];
              if (field.shape != HistoryField::Shape::scalar ||
                  (std::isinf(field.lower) && std::isinf(field.upper)))
                continue;
              for (unsigned int q = 0; q < store.n_points; ++q)
                limit(field, store.old_record(c, q)[layout.offsets[i]]);
            }
        }
    return Utilities::MPI::sum(counted, store.triangulation.get_communicator());
  }

  template unsigned int
  enforce_bounds(HistoryStore<2> &);
  template unsigned int
  enforce_bounds(HistoryStore<3> &);
} // namespace alveolus
