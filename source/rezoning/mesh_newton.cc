// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/mesh_newton.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  MinimiseReport
  minimise(const MeshEnergy<dim> &energy,
           LinearSystem          &system,
           const double           tolerance,
           const unsigned int     largest_iterations,
           NodalVector           &x)
  {
    constexpr double sufficient  = 1e-4;
    constexpr double least_exact = 1. / 8.;
    constexpr double least       = 1e-12;

    MinimiseReport report;
    report.energy = energy.value(x);
    ++report.values;
    if (!std::isfinite(report.energy))
      return report;

    NodalVector gradient(x), step(x), trial(x);
    while (report.iterations < largest_iterations && !report.converged)
      {
        energy.gradient(x, gradient);
        gradient *= -1.;
        bool accepted = false;
        for (const bool positive : {false, true})
          {
            energy.hessian(x, system, positive);
            system.solve(step, gradient);
            const double slope = -(gradient * step);
            if (positive)
              ++report.modified;
            // Also if there is nothing left to do
            else if (!(slope <= 0.))
              continue;

            const double noise = 1e-13 * (1. + report.energy);
            for (double part = 1.; part >= (positive ? least : least_exact);
                 part *= 0.5)
              {
                trial = x;
                trial.zero_out_ghost_values();
                trial.add(part, step);
                trial.update_ghost_values();
                const double value = energy.value(trial);
                ++report.values;
                accepted = std::isfinite(value) &&
                           (-slope <= noise ||
                            value <= report.energy + sufficient * part * slope);
                if (accepted)
                  {
                    report.converged =
                      part == 1. && energy.largest_strain(x, step) <= tolerance;
                    report.energy = value;
                    x.swap(trial);
                    break;
                  }
              }
            if (accepted)
              break;
          }
        ++report.iterations;
        if (!accepted)
          break;
      }
    return report;
  }

  template MinimiseReport
  minimise(const MeshEnergy<2> &,
           LinearSystem &,
           const double,
           const unsigned int,
           NodalVector &);
  template MinimiseReport
  minimise(const MeshEnergy<3> &,
           LinearSystem &,
           const double,
           const unsigned int,
           NodalVector &);
} // namespace alveolus
