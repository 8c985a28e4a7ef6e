// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_rezoning_plan_h
#define alveolus_rezoning_rezoning_plan_h

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace alveolus
{
  /**
   * After which steps the mesh is rezoned: all, every so many, or those that
   * leave a bad mesh. Between two rezonings the mesh is Lagrangian.
   */
  struct RezoningPlan
  {
    /** Steps from one to the next; 0: not by steps. */
    unsigned int every = 1;
    /** Also below this quality; -1: not by it. */
    double below_quality = -1.;

    /** Add the parameters to the current subsection. */
    void
    declare(dealii::ParameterHandler &prm);

    /** @throws InputError if rules would never be applied */
    void
    check(const std::string &where) const;

    /** Whether the quality of the mesh decides, too. */
    bool
    asks_for_quality() const
    {
      return every != 1 && below_quality > -1.;
    }

    /**
     * Whether to rezone after step number @p n_steps (the first is 1).
     * @param quality smallest scaled Jacobian that the step has left; not used
     *        unless asks_for_quality()
     */
    bool
    due(const unsigned int n_steps, const double quality) const
    {
      return (every > 0 && n_steps % every == 0) ||
             (asks_for_quality() && quality < below_quality);
    }
  };
} // namespace alveolus

#endif
