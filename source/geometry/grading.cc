// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/geometry/grading.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  std::vector<double>
  graded_division(const double                                 length,
                  const std::function<double(const double s)> &size,
                  const unsigned int                           multiple,
                  const unsigned int                           least)
  {
    // Integral of 1/size by the midpoint rule, linear between the samples
    constexpr unsigned int n_samples = 2000;
    const double           step      = length / n_samples;
    std::vector<double>    integral(1, 0.);
    for (unsigned int i = 0; i < n_samples; ++i)
      integral.push_back(integral.back() + step / size((i + 0.5) * step));

    // A number that is whole but for round-off stays as it is.
    const double       wanted = std::max<double>(integral.back(), least);
    const unsigned int n =
      multiple * static_cast<unsigned int>(std::ceil(wanted / multiple - 1e-6));
    std::vector<double> positions(1, 0.);
    unsigned int        sample = 0;
    for (unsigned int i = 1; i < n; ++i)
      {
        const double target = integral.back() * i / n;
        while (integral[sample + 1] < target)
          ++sample;
        positions.push_back(
          step * (sample + (target - integral[sample]) /
                             (integral[sample + 1] - integral[sample])));
      }
    positions.push_back(length);
    return positions;
  }
} // namespace alveolus
