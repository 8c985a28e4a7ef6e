// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_work_sharing_h
#define alveolus_base_work_sharing_h

#include <map>
#include <vector>

namespace alveolus
{
  /** An amount of work that one process gives to another. */
  struct WorkGift
  {
    unsigned int from = 0;  ///< the process that has too much
    unsigned int to   = 0;  ///< the one that has too little
    double       work = 0.; ///< how much
  };

  /**
   * What has to be given for all processes to have the mean work: from those
   * above it to those below it, in the order of the processes. P processes make
   * P - 1 gifts at most.
   * @param work  of each process, not negative
   * @param worth excess of the largest work over the mean up to which nothing
   *        is given, beside a twentieth of the mean
   */
  std::vector<WorkGift>
  balance_work(const std::vector<double> &work, const double worth = 0.);

  /**
   * Choose the items that others are to do: the first ones, until each gift is
   * complete. Not the dearest: where costs are estimates, these are those whose
   * cost is most likely overestimated.
   * @param costs of the items of this process
   * @param gifts of all processes
   * @return indices of items by the process that is to do them
   */
  std::map<unsigned int, std::vector<unsigned int>>
  items_to_give(const std::vector<double>   &costs,
                const std::vector<WorkGift> &gifts,
                const unsigned int           this_process);
} // namespace alveolus

#endif
