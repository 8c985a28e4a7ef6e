// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_reproducible_sum_h
#define alveolus_state_reproducible_sum_h

#include <deal.II/base/mpi.h>

#include <vector>

namespace alveolus
{
  /**
   * Sum of all @p values of all processes of @p communicator, the same to the
   * last bit for any order of the values and any number of processes
   * (collective): the values are rounded to 2^-90 of the largest one and added
   * as 128-bit integers, which is exact. At most 2^35 values.
   * @return NaN if any value is not finite
   */
  double
  reproducible_sum(const std::vector<double> &values,
                   const MPI_Comm            &communicator);
} // namespace alveolus

#endif
