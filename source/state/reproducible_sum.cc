// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/state/reproducible_sum.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace alveolus
{
  namespace
  {
    __extension__ using Integer = __int128;

    /**
     * @p x times @p scale times 2^45, rounded. Two parts, as a conversion
     * from double to a 128-bit integer is slow.
     */
    Integer
    to_fixed_point(const double x, const double scale)
    {
      constexpr double two_to_45 = 35184372088832.;
      const double     y         = x * scale; // |y| < 2^46
      const double     high      = std::nearbyint(y);
      const double     low       = std::nearbyint((y - high) * two_to_45);
      return static_cast<Integer>(static_cast<std::int64_t>(high)) *
               static_cast<Integer>(std::int64_t(1) << 45) +
             static_cast<std::int64_t>(low);
    }
  } // namespace

  double
  reproducible_sum(const std::vector<double> &values,
                   const MPI_Comm            &communicator)
  {
    double largest = 0.;
    for (const double value : values)
      // A NaN must survive the comparison.
      largest = std::isfinite(value) ? std::max(largest, std::abs(value))
                                     : std::numeric_limits<double>::infinity();
    largest = dealii::Utilities::MPI::max(largest, communicator);
    if (largest == 0.)
      return 0.;
    if (!std::isfinite(largest))
      return std::numeric_limits<double>::quiet_NaN();

    const int    exponent = 45 - std::ilogb(largest);
    const double scale    = std::ldexp(1., exponent);
    Integer      sum      = 0;
    for (const double value : values)
      sum += to_fixed_point(value, scale);

    const auto parts = dealii::Utilities::MPI::all_gather(
      communicator,
      std::array<std::int64_t, 2>{
        {static_cast<std::int64_t>(sum >> 64),
         static_cast<std::int64_t>(static_cast<std::uint64_t>(sum))}});
    Integer total = 0;
    for (const auto &part : parts)
      total += static_cast<Integer>(part[0]) * (static_cast<Integer>(1) << 64) +
               static_cast<Integer>(static_cast<std::uint64_t>(part[1]));
    return std::ldexp(static_cast<double>(total), -exponent - 45);
  }
} // namespace alveolus
