// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/work_sharing.h>

#include <algorithm>
#include <numeric>

namespace alveolus
{
  std::vector<WorkGift>
  balance_work(const std::vector<double> &work, const double worth)
  {
    constexpr double   tolerated = 1.05;
    const unsigned int n         = work.size();
    const double       mean = std::accumulate(work.begin(), work.end(), 0.) / n;
    std::vector<WorkGift> gifts;
    if (!(*std::max_element(work.begin(), work.end()) >
          std::max(tolerated * mean, mean + worth)))
      return gifts;
    std::vector<double> rest(work);
    unsigned int        from = 0, to = 0;
    while (true)
      {
        while (from < n && rest[from] <= mean)
          ++from;
        while (to < n && rest[to] >= mean)
          ++to;
        if (from == n || to == n)
          return gifts;
        const double gift = std::min(rest[from] - mean, mean - rest[to]);
        gifts.push_back({from, to, gift});
        // Exactly, so that one of them is done with
        if (rest[from] - mean <= mean - rest[to])
          {
            rest[to] += gift;
            rest[from] = mean;
          }
        else
          {
            rest[from] -= gift;
            rest[to] = mean;
          }
      }
  }



  std::map<unsigned int, std::vector<unsigned int>>
  items_to_give(const std::vector<double>   &costs,
                const std::vector<WorkGift> &gifts,
                const unsigned int           this_process)
  {
    std::map<unsigned int, std::vector<unsigned int>> given;
    unsigned int                                      next = 0;
    for (const WorkGift &gift : gifts)
      if (gift.from == this_process)
        for (double done = 0.; next < costs.size() && done < gift.work; ++next)
          {
            given[gift.to].push_back(next);
            done += costs[next];
          }
    return given;
  }
} // namespace alveolus
