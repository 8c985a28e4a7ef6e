// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_adaptive_tolerance_h
#define alveolus_algebra_adaptive_tolerance_h

namespace alveolus
{
  /** What a LinearSystem can be besides: one whose accuracy may be chosen. */
  class AdaptiveTolerance
  {
  public:
    virtual ~AdaptiveTolerance() = default;

    /** Relative residual that is enough in the next solution; it does not go
     * below the tolerance the system was made with. */
    virtual void
    ask(const double relative_residual) = 0;
  };
} // namespace alveolus

#endif
