// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/rezoning_plan.h>

namespace alveolus
{
  using namespace dealii;

  void
  RezoningPlan::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Every steps",
                      every,
                      "Rezone after every so many steps; 0: not by steps.",
                      Patterns::Integer(0));
    prm.add_parameter("Below quality",
                      below_quality,
                      "Also rezone after a step that leaves a smaller smallest "
                      "scaled Jacobian than this; -1: never for that.",
                      Patterns::Double(-1., 1.));
  }



  void
  RezoningPlan::check(const std::string &where) const
  {
    if (every == 0 && below_quality <= -1.)
      throw InputError(where + " / Every steps",
                       "is 0, and `Below quality` is -1: the rules would never "
                       "be applied",
                       "set one of them, or leave `Names` empty for a "
                       "Lagrangian mesh");
  }
} // namespace alveolus
