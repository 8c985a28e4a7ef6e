// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_best_first_h
#define alveolus_mesh_best_first_h

#include <algorithm>
#include <cmath>
#include <vector>

namespace alveolus
{
  /**
   * Sort meshes by their qualities, the best first, those that are equal to
   * three digits as they were: the order is no matter of round-off, and the
   * same on all processes and machines.
   * @param quality of an entry, its smallest scaled Jacobian [-]
   */
  template <class Entry, class Quality>
  void
  sort_best_first(std::vector<Entry> &entries, const Quality &quality)
  {
    std::stable_sort(entries.begin(),
                     entries.end(),
                     [&quality](const Entry &a, const Entry &b) {
                       return std::lround(1e3 * quality(a)) >
                              std::lround(1e3 * quality(b));
                     });
  }
} // namespace alveolus

#endif
