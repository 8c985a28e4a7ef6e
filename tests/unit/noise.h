// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_noise_h
#define alveolus_tests_unit_noise_h

// Values without pattern, for tests of transfer.
#include <deal.II/base/point.h>

#include <cmath>

namespace alveolus::bench
{
  using namespace dealii;

  /** A number in [-1,1] without pattern, the same on every process. */
  template <int dim>
  double
  noise(const Point<dim> &x, const unsigned int seed)
  {
    double sum = 0.7 * seed;
    for (unsigned int d = 0; d < dim; ++d)
      sum += (12.9898 + 31.4 * d + seed) * std::round(x[d] * 1e6) * 1e-6;
    const double y = std::sin(sum) * 437.5453;
    return 2. * (y - std::floor(y)) - 1.;
  }
} // namespace alveolus::bench

#endif
