// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_verdict_h
#define alveolus_base_verdict_h

#include <string>

namespace alveolus
{
  /**
   * What a judge says of a step, ordered by severity; of several judges the
   * most severe (smallest) one counts.
   */
  struct Verdict
  {
    /** What is to follow, the most severe first. */
    enum class Kind
    {
      remesh_and_repeat,
      repeat,
      remesh_and_advance,
      advance
    };

    Kind        kind = Kind::advance; ///< what is to follow
    std::string reason; ///< for the log, empty if the step is accepted
    std::string cause;  ///< of a repetition, in few words, to count it by

    /** Whether the step has to be done again. */
    bool
    repeats() const
    {
      return kind == Kind::repeat || kind == Kind::remesh_and_repeat;
    }

    /** Keep the more severe one of this verdict and @p other. */
    void
    combine(const Verdict &other)
    {
      if (other.kind < kind)
        *this = other;
    }
  };
} // namespace alveolus

#endif
