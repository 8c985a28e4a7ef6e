// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/driver/messages.h>

#include <map>

namespace alveolus
{
  std::string
  advice_for(const std::string &cause)
  {
    static const std::map<std::string, std::string> advice = {
      {"Newton",
       "the load may be more than the body carries: see the forces in "
       "history.csv, and go on beyond by a motion in its place; then look at "
       "the residuals in log.txt: if they no longer fall, raise `Solver / "
       "Tolerance`; if they jump, check loads and materials, or allow more "
       "`Solver / Maximum iterations`"},
      {"linear solver",
       "check that the conditions hold every body, or choose another `Solver / "
       "Linear solver`"},
      {"contact",
       "raise the contact's `Stiffness`, `Augmentations` or `Search distance`"},
      {"coupling",
       "allow more coupling iterations, or use `Remodelling / Coupling = "
       "staggered`"},
      {"remodelling", "check the remodelling law's rates and bounds"},
      {"density change",
       "raise `Remodelling / Maximum density change`, or reduce `Time / Minimum "
       "step`"}};
    const auto found = advice.find(cause);
    return found != advice.end()
             ? found->second
             : "rezone or remesh there, or reduce `Time / Minimum step`";
  }
} // namespace alveolus
