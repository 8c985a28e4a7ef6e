// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_staggered_step_h
#define alveolus_solver_staggered_step_h

#include <alveolus/remodelling/local_integrator.h>
#include <alveolus/solver/equilibrium.h>
#include <alveolus/solver/helmholtz_filter.h>

namespace alveolus
{
  /** What remodelling did in a step, over all processes. */
  struct RemodellingSummary
  {
    double       largest_density_change = 0.; ///< at a point [g/cc]
    unsigned int n_fabric_limited       = 0;
    unsigned int n_at_lower_bound       = 0;
    unsigned int n_at_upper_bound       = 0;
    unsigned int n_coupling_iterations  = 0;
    std::string  failure; ///< why a point could not be integrated, if any
  };

  /** The remodelling of one region: null pointers where there is none. */
  struct RegionRemodelling
  {
    const RemodellingLaw *law  = nullptr;
    const RemodelledBone *bone = nullptr;
  };

  /**
   * The Lagrangian phase of a step: equilibrium with density and fabric frozen
   * in the material, then remodelling of every point at fixed elastic strain
   * over the step (theory, section 3). Optionally the two are iterated until
   * the density they exchange no longer changes, which measures the splitting
   * error. Writes trial values only.
   */
  template <int dim>
  class StaggeredStep
  {
  public:
    struct Parameters
    {
      std::string  coupling                = "staggered";
      double       coupling_tolerance      = 1e-4;
      unsigned int max_coupling_iterations = 20;
      double       local_tolerance         = 1e-6;
      double       max_density_change      = 0.1;
      double       filter_length           = 0.;

      void
      declare(dealii::ParameterHandler &prm);
    };

    StaggeredStep(State<dim>                           &state,
                  Equilibrium<dim>                     &equilibrium,
                  const std::vector<RegionRemodelling> &remodelling,
                  const Parameters                     &parameters,
                  dealii::TimerOutput                  &timer);

    /** Solve the step; the trial history holds the result. */
    Verdict
    solve(const Interval     &interval,
          EquilibriumReport  &mechanics,
          RemodellingSummary &remodelling);

  private:
    /** Advance every trial record from the density it has to t_{n+1}. */
    RemodellingSummary
    remodel(const double dt);
    /**
     * Let equilibrium see the density and fabric of the end of the step.
     * @return largest change of density against what it saw before [g/cc]
     */
    double
    feed_back();

    State<dim>                           &state;
    Equilibrium<dim>                     &equilibrium;
    const std::vector<RegionRemodelling> &laws;
    const Parameters                     &parameters;
    dealii::TimerOutput                  &timer;
    bool                                  active = false;
    std::vector<unsigned int>             cells; ///< owned, remodelled
    std::unique_ptr<HelmholtzFilter<dim>> filter;
  };
} // namespace alveolus

#endif
