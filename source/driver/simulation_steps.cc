// SPDX-License-Identifier: LGPL-2.1-or-later
// What makes steps longer or shorter, and what is said of the quality of the
// mesh.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  Verdict
  Simulation<dim>::judge_quality(const QualitySummary<dim> &candidate) const
  {
    const double loss =
      quality.smallest_scaled_jacobian - candidate.smallest_scaled_jacobian;
    if (!(loss > scene.time.largest_quality_loss))
      return Verdict{};
    std::ostringstream reason;
    reason << "the smallest scaled Jacobian falls from "
           << number(quality.smallest_scaled_jacobian, 4) << " to "
           << number(candidate.smallest_scaled_jacobian, 4) << " near ("
           << candidate.where << ") mm, more than `Time / Largest loss of "
           << "quality`";
    return {Verdict::Kind::repeat, reason.str(), "loss of quality"};
  }



  template <int dim>
  void
  Simulation<dim>::choose_next_step(const double dt)
  {
    const auto       &allowed = scene.time;
    const std::string limited = step_control.accepted(
      dt,
      mechanics_report.n_iterations,
      {{"swept fraction", swept_fraction, allowed.largest_swept_fraction},
       {"density change",
        remodelling_report.largest_density_change,
        allowed.wanted_density_change}});
    if (!limited.empty())
      log.note("t = " + number(model->state->time, 8) + " T: " + limited +
               " to " + number(step_control.step(), 4) + " T");
  }



  template <int dim>
  void
  Simulation<dim>::warn_of_quality()
  {
    const bool low = quality.smallest_scaled_jacobian < scene.warn_quality;
    if (low && !quality_is_low)
      {
        ++totals.quality_warnings;
        std::ostringstream place;
        place << quality.where;
        log.say("t = " + number(model->state->time, 8) +
                " T: warning: the smallest scaled Jacobian is " +
                number(quality.smallest_scaled_jacobian, 4) + ", below " +
                number(scene.warn_quality) + ", near (" + place.str() + ") mm");
      }
    else if (!low && quality_is_low)
      log.note("t = " + number(model->state->time, 8) +
               " T: the smallest scaled Jacobian is above " +
               number(scene.warn_quality) + " again");
    quality_is_low = low;
  }



  template <int dim>
  std::string
  Simulation<dim>::quality_if_low(const QualitySummary<dim> &judged) const
  {
    if (!(judged.smallest_scaled_jacobian < scene.warn_quality))
      return "";
    std::ostringstream text;
    text << "elements have become flat, the smallest scaled Jacobian is "
         << number(judged.smallest_scaled_jacobian, 2) << " near ("
         << judged.where << ") mm: "
         << (model->rezoner || remesh_plan
               ? "remesh earlier, or rezone by other rules"
               : "rezone or remesh");
    return text.str();
  }



  template <int dim>
  std::string
  Simulation<dim>::advice_against(const std::string &cause) const
  {
    // Shorter steps were tried: what they do not help against is the answer.
    const std::string mesh = quality_if_low(quality);
    for (const std::string of_mesh :
         {"inverted corners", "loss of quality", "material or mesh", "Newton"})
      if (cause == of_mesh && !mesh.empty())
        return mesh;
    return advice_for(cause);
  }

#define INSTANTIATE(dim)                                                       \
  template Verdict Simulation<dim>::judge_quality(const QualitySummary<dim> &) \
    const;                                                                     \
  template void        Simulation<dim>::choose_next_step(const double);        \
  template void        Simulation<dim>::warn_of_quality();                     \
  template std::string Simulation<dim>::quality_if_low(                        \
    const QualitySummary<dim> &) const;                                        \
  template std::string Simulation<dim>::advice_against(const std::string &)    \
    const;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
