// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remodelling_local_integrator_h
#define alveolus_remodelling_local_integrator_h

#include <alveolus/remodelling/remodelling_law.h>

namespace alveolus
{
  /** What remodelling did at a point during a step. */
  struct RemodellingReport
  {
    double       density_change   = 0.; ///< [g/cc]
    unsigned int n_substeps       = 0;  ///< steps the integration took
    unsigned int n_fabric_limited = 0;  ///< projections onto the fabric bounds
    /** Came to rest where formation and resorption meet in a jump. */
    bool at_reversal    = false;
    bool at_lower_bound = false; ///< density cut off at it
    bool at_upper_bound = false; ///< density cut off at it
  };

  /**
   * Advances density and fabric of one point at fixed elastic strain with error
   * control (Boost.odeint, Dormand-Prince), re-evaluating the stimulus with the
   * evolving density; bounds are respected and counted.
   *
   * A signed stimulus jumps where the trace of the stress vanishes, from
   * formation to resorption. A point that is driven there from both sides rests
   * there, which is the limit of a smoothed sign (`Pressure smoothing`): in
   * between lies the homeostatic stimulus. Such points are reported.
   */
  class LocalIntegrator
  {
  public:
    /** @param tolerance absolute [g/cc] and relative error per step */
    LocalIntegrator(const RemodellingLaw &law,
                    const RemodelledBone &bone,
                    const double          tolerance);

    /**
     * Change density and fabric in @p record (layout of the bone's history)
     * over @p dt [T].
     * @param filtered_stimulus if not null, replaces the point's own stimulus
     * at the beginning of the step; while density evolves it is scaled by
     *        energy(now)/energy(begin)
     * @throws RunError if the integration does not finish
     */
    RemodellingReport
    advance(double       *record,
            const double  dt,
            const double *filtered_stimulus = nullptr) const;

  private:
    const RemodellingLaw &law;
    const RemodelledBone &bone;
    double                tolerance;
  };
} // namespace alveolus

#endif
