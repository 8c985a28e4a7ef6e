// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_field_bounds_h
#define alveolus_transfer_field_bounds_h

#include <alveolus/state/history_store.h>

namespace alveolus
{
  /**
   * Bring the scalars of the old records of owned cells back into the bounds of
   * their fields. Excess by more than round-off (1e-12 of the bounds) is
   * counted; a value that is not a number is counted and left to be seen.
   * @return the number counted over all processes (collective)
   */
  template <int dim>
  unsigned int
  enforce_bounds(HistoryStore<dim> &store);
} // namespace alveolus

#endif
