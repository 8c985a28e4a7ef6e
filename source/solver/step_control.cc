// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/step_control.h>

#include <algorithm>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    void
    put_counts(const std::string                         &name,
               const std::map<std::string, unsigned int> &counts,
               BlockFile                                 &blocks)
    {
      std::string         causes;
      BlockFile::Integers numbers;
      for (const auto &entry : counts)
        {
          causes += entry.first + '\n';
          numbers.push_back(entry.second);
        }
      blocks.put(name + " causes", causes);
      blocks.put(name, numbers);
    }

    void
    get_counts(const std::string                   &name,
               std::map<std::string, unsigned int> &counts,
               const BlockFile                     &blocks)
    {
      counts.clear();
      if (!blocks.has(name))
        return; // of an earlier version
      std::istringstream causes(blocks.text(name + " causes"));
      std::string        cause;
      for (const auto n : blocks.integers(name))
        {
          if (!std::getline(causes, cause))
            blocks.refuse(name, "is longer than the list of its causes");
          counts[cause] = n;
        }
    }
  } // namespace



  void
  StepControl::Parameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("End",
                      end,
                      "The run ends at this time [T].",
                      Patterns::Double(0.));
    prm.add_parameter("Initial step",
                      initial_step,
                      "First time step [T].",
                      Patterns::Double(1e-12));
    prm.add_parameter("Minimum step",
                      minimum_step,
                      "A run whose step would have to be smaller [T] stops.",
                      Patterns::Double(1e-14));
    prm.add_parameter("Maximum step",
                      maximum_step,
                      "Largest time step [T].",
                      Patterns::Double(1e-12));
    prm.add_parameter("Cut factor",
                      cut_factor,
                      "A rejected step is repeated with this part of it.",
                      Patterns::Double(0.01, 0.99));
    prm.add_parameter(
      "Growth factor",
      growth_factor,
      "After an easy step the next one is longer by this factor.",
      Patterns::Double(1., 10.));
    prm.add_parameter("Easy iterations",
                      easy_iterations,
                      "A step is easy if Newton took at most this many "
                      "iterations.",
                      Patterns::Integer(1));
    prm.add_parameter(
      "Largest swept fraction",
      largest_swept_fraction,
      "Where rezoning sweeps more than this part of a sub-cell's volume in a "
      "step (the CFL number of the transfer), the next step is shorter in "
      "proportion; 0: no limit.",
      Patterns::Double(0.));
    prm.add_parameter(
      "Largest loss of quality",
      largest_quality_loss,
      "A step in which the material takes more than this from the smallest "
      "scaled Jacobian of the mesh is repeated with a smaller increment; 2: no "
      "limit.",
      Patterns::Double(1e-3, 2.));
    prm.add_parameter(
      "Wanted density change",
      wanted_density_change,
      "The next step is so long that the density of no point changes by more "
      "than about this [g/cc], which saves attempts that `Remodelling / "
      "Maximum density change` rejects; 0: no limit.",
      Patterns::Double(0.));
  }



  StepControl::StepControl(const Parameters &parameters)
    : parameters(parameters)
    , dt(std::min(parameters.initial_step, parameters.maximum_step))
  {}



  void
  StepControl::restart()
  {
    dt = std::min(parameters.initial_step, parameters.maximum_step);
  }



  void
  StepControl::save(BlockFile &blocks) const
  {
    blocks.put_number("step control/step", dt);
    put_counts("step control/limited", n_limited, blocks);
    put_counts("step control/rejected", n_rejected, blocks);
  }

  void
  StepControl::load(const BlockFile &blocks)
  {
    dt = std::min(blocks.number("step control/step"), parameters.maximum_step);
    get_counts("step control/limited", n_limited, blocks);
    get_counts("step control/rejected", n_rejected, blocks);
  }



  double
  StepControl::next(const double time, const double stop) const
  {
    const double left = stop - time;
    if (dt >= left * (1. - 1e-10))
      return left;
    return dt > 0.5 * left ? 0.5 * left : dt;
  }



  std::string
  StepControl::accepted(const double                  attempted,
                        const unsigned int            n_iterations,
                        const std::vector<StepLimit> &limits)
  {
    // An attempt shortened to hit an output time says nothing about dt.
    double wanted = dt;
    if (n_iterations <= parameters.easy_iterations &&
        attempted >= dt * (1. - 1e-10))
      wanted = std::min(dt * parameters.growth_factor, parameters.maximum_step);

    const StepLimit *tightest = nullptr;
    for (const StepLimit &limit : limits)
      {
        if (!(limit.allowed > 0. && limit.measured > 0.))
          continue;
        const double longest = attempted * limit.allowed / limit.measured;
        if (longest < wanted * (1. - 1e-10))
          {
            wanted   = longest;
            tightest = &limit;
          }
      }
    std::ostringstream text;
    if (tightest != nullptr)
      {
        ++n_limited[tightest->cause];
        text << "next step limited by " << tightest->cause << " ("
             << tightest->measured << ", allowed " << tightest->allowed << ")";
        if (wanted < parameters.minimum_step)
          {
            wanted = parameters.minimum_step;
            ++n_limited["minimum step"];
            text << ", but not below the minimum step";
          }
      }
    dt = wanted;
    return text.str();
  }



  bool
  StepControl::rejected(const double attempted, const std::string &cause)
  {
    ++n_rejected[cause];
    dt = attempted * parameters.cut_factor;
    return dt >= parameters.minimum_step;
  }
} // namespace alveolus
