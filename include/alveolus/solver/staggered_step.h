// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_staggered_step_h
#define alveolus_solver_staggered_step_h

#include <alveolus/solver/equilibrium.h>
#include <alveolus/solver/helmholtz_filter.h>
#include <alveolus/solver/point_remodelling.h>

namespace alveolus
{
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
      /** "staggered" or "iterated". */
      std::string coupling = "staggered";
      /** Of the density between iterations [g/cc]. */
      double coupling_tolerance = 1e-4;
      /** Then the step is repeated, smaller. */
      unsigned int max_coupling_iterations = 20;
      /** Of the integration at a point [g/cc, and relative]. */
      double local_tolerance = 1e-6;
      /** At a point in a step, else it is repeated [g/cc]. */
      double max_density_change = 0.1;
      /** Of the stimulus [mm]; 0: none. */
      double filter_length = 0.;

      /**
       * Add the parameters, bound to the members, to the current subsection.
       */
      void
      declare(dealii::ParameterHandler &prm);
    };

    /**
     * @param remodelling by region
     * @param timer of the phases of a step; all must outlive this object
     */
    StaggeredStep(State<dim>                           &state,
                  Equilibrium<dim>                     &equilibrium,
                  const std::vector<RegionRemodelling> &remodelling,
                  const Parameters                     &parameters,
                  dealii::TimerOutput                  &timer);

    /** From now on tell what remodelling does to the stored energy. */
    void
    book_energy();

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
    /** Stored energy per undeformed volume of all points of `cells` [MPa]. */
    std::vector<double>
    point_energies(const std::vector<double> &values) const;
    /**
     * Fill the energies of @p summary.
     * @param before  of the trial records before remodelling
     * @param seen    of the trial records as the last equilibrium left them
     * @param iterated history at t_n, if coupling is iterated
     */
    void
    balance(const std::vector<double> &before,
            const std::vector<double> &seen,
            const std::vector<double> *iterated,
            RemodellingSummary        &summary) const;

    State<dim>                            &state;
    Equilibrium<dim>                      &equilibrium;
    const std::vector<RegionRemodelling>  &laws;
    const Parameters                      &parameters;
    dealii::TimerOutput                   &timer;
    bool                                   active = false, booked = false;
    std::vector<unsigned int>              cells; ///< owned, remodelled
    std::unique_ptr<PointRemodelling<dim>> points;
    std::unique_ptr<HelmholtzFilter<dim>>  filter;
  };
} // namespace alveolus

#endif
