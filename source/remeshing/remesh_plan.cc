// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/remeshing/remesh_plan.h>

#include <algorithm>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Times closer than this part of them are the same. */
    constexpr double same = 1e-10;
  } // namespace

  void
  RemeshPlan::Parameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Times",
                      times,
                      "Planned remeshes: increasing times [T], which steps hit "
                      "exactly; 0 is before the first step.",
                      Patterns::List(Patterns::Double(0.)));
    prm.add_parameter("Every steps",
                      every,
                      "Remesh after every so many steps; 0: never.",
                      Patterns::Integer(0));
    prm.add_parameter("Below quality",
                      below_quality,
                      "Remesh when the smallest scaled Jacobian falls below "
                      "this (and has lost a fifth since the last remesh); -1 "
                      "is never.",
                      Patterns::Double(-1., 1.));
    prm.add_parameter("Accept quality",
                      accept_quality,
                      "A new mesh is taken if its smallest scaled Jacobian in "
                      "equilibrium is at least this; else the best one that "
                      "is better than the old mesh, unless `If none is "
                      "acceptable` forbids.",
                      Patterns::Double(-1., 1.));
    prm.add_parameter("If none is acceptable",
                      if_none_is_acceptable,
                      "After a remesh for quality that no candidate reached "
                      "`Accept quality`: stop the run, or go on with the best "
                      "mesh there is.",
                      Patterns::Selection("stop|go on"));
    prm.add_parameter("After failure",
                      after_failure,
                      "Also remesh where no step is short enough, once per "
                      "time.",
                      Patterns::Bool());
    prm.add_parameter("Maximum number",
                      max_remeshes,
                      "No more remeshes than this.",
                      Patterns::Integer(0));
    prm.add_parameter("Settling halvings",
                      max_halvings,
                      "The forces a remesh leaves unbalanced are released in "
                      "parts, halved at most this many times.",
                      Patterns::Integer(0, 30));
    prm.add_parameter("Largest uncovered part",
                      uncovered_part,
                      "A new mesh is refused if more than this part of the "
                      "volume of a region is outside the old mesh of the "
                      "region. There the history takes the mean over what is "
                      "covered, or the nearest value. Thin layers with coarse "
                      "curved walls need more.",
                      Patterns::Double(0., 1.));
  }

  RemeshPlan::RemeshPlan(const Parameters &parameters, const std::string &where)
    : parameters(parameters)
  {
    for (unsigned int i = 1; i < parameters.times.size(); ++i)
      if (parameters.times[i] <= parameters.times[i - 1])
        {
          std::ostringstream found;
          found << parameters.times[i] << " follows "
                << parameters.times[i - 1];
          throw InputError(where + " / Times",
                           found.str(),
                           "list increasing times");
        }
  }

  double
  RemeshPlan::next_time(const double time, const double end) const
  {
    for (const double planned : parameters.times)
      if (planned > time * (1. + same) && planned > 0.)
        return std::min(planned, end);
    return end;
  }

  std::string
  RemeshPlan::due(const double       time,
                  const double       quality,
                  const unsigned int n_steps) const
  {
    if (n_accepted >= parameters.max_remeshes)
      return "";
    if (time != last_time)
      for (const double planned : parameters.times)
        if (std::abs(planned - time) <= same * std::max(planned, time))
          return "planned";
    if (time != last_time && parameters.every > 0 && n_steps > 0 &&
        n_steps % parameters.every == 0)
      return "planned";
    if (quality < parameters.below_quality && quality < 0.8 * quality_after)
      {
        std::ostringstream reason;
        reason << "quality " << quality << " below "
               << parameters.below_quality;
        return reason.str();
      }
    return "";
  }

  bool
  RemeshPlan::after_failure(const double time) const
  {
    return parameters.after_failure && time != last_time &&
           n_accepted < parameters.max_remeshes;
  }

  void
  RemeshPlan::save(BlockFile &blocks) const
  {
    blocks.put_integer("remesh plan/accepted", n_accepted);
    blocks.put_number("remesh plan/last time", last_time);
    blocks.put_number("remesh plan/quality after", quality_after);
  }

  void
  RemeshPlan::load(const BlockFile &blocks)
  {
    n_accepted    = blocks.integer("remesh plan/accepted");
    last_time     = blocks.number("remesh plan/last time");
    quality_after = blocks.number("remesh plan/quality after");
  }

  void
  RemeshPlan::tried(const double time,
                    const double quality,
                    const bool   accepted)
  {
    last_time     = time;
    quality_after = quality;
    n_accepted += accepted;
  }
} // namespace alveolus
