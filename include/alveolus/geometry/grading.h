// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_grading_h
#define alveolus_geometry_grading_h

#include <functional>
#include <vector>

namespace alveolus
{
  /**
   * Positions 0 = s_0 < ... < s_n = @p length that divide a curve into segments
   * of the size @p size(s) asked for at their place: the integral of ds/size is
   * the same over every segment. The number n of them is that integral over the
   * whole curve, rounded up to a multiple of @p multiple, at least @p least.
   * @param size positive, in the unit of the length
   */
  std::vector<double>
  graded_division(const double                                 length,
                  const std::function<double(const double s)> &size,
                  const unsigned int                           multiple = 2,
                  const unsigned int                           least    = 2);
} // namespace alveolus

#endif
