// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/step_control.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

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
  }

  void
  StepControl::load(const BlockFile &blocks)
  {
    dt = std::min(blocks.number("step control/step"), parameters.maximum_step);
  }



  double
  StepControl::next(const double time, const double stop) const
  {
    const double left = stop - time;
    if (dt >= left * (1. - 1e-10))
      return left;
    return dt > 0.5 * left ? 0.5 * left : dt;
  }



  void
  StepControl::accepted(const double attempted, const unsigned int n_iterations)
  {
    // An attempt shortened to hit an output time says nothing about dt.
    if (attempted < dt * (1. - 1e-10) &&
        n_iterations <= parameters.easy_iterations)
      return;
    if (n_iterations <= parameters.easy_iterations)
      dt = std::min(dt * parameters.growth_factor, parameters.maximum_step);
  }



  bool
  StepControl::rejected(const double attempted)
  {
    dt = attempted * parameters.cut_factor;
    return dt >= parameters.minimum_step;
  }
} // namespace alveolus
