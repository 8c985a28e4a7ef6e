// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_step_control_h
#define alveolus_solver_step_control_h

#include <alveolus/base/block_file.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <vector>

namespace alveolus
{
  /** A quantity of a step that is to stay below a bound. */
  struct StepLimit
  {
    std::string cause;    ///< what it is, in few words
    double      measured; ///< in the last step
    double      allowed;  ///< 0: no limit
  };

  /**
   * Length of the time steps: cut after a rejected attempt, grown again after
   * easy steps, shortened to hit given times exactly. Quantities that go with
   * the length of a step limit the next one before an attempt has to be
   * rejected.
   */
  class StepControl
  {
  public:
    struct Parameters
    {
      double end          = 1.;   ///< of the run [T]
      double initial_step = 0.1;  ///< [T]
      double minimum_step = 1e-5; ///< shorter ones stop the run [T]
      double maximum_step = 0.1;  ///< [T]
      /** Of the step after a rejected attempt [-]. */
      double       cut_factor      = 0.5;
      double       growth_factor   = 1.5; ///< of the step after an easy one [-]
      unsigned int easy_iterations = 6; ///< of Newton, at most, in an easy step
      /** Part of a sub-cell's volume that rezoning sweeps in a step. */
      double largest_swept_fraction = 10.;
      /** Of the smallest scaled Jacobian, by the motion of the material. */
      double largest_quality_loss = 0.5;
      /** Largest change of density in a step to aim at [g/cc]; 0: none. */
      double wanted_density_change = 0.;

      /**
       * Add the parameters, bound to the members, to the current subsection.
       */
      void
      declare(dealii::ParameterHandler &prm);
    };

    /** Begin with the initial step. */
    explicit StepControl(const Parameters &parameters);

    /**
     * Length of the next attempt from @p time, not beyond @p stop (the end or
     * an output time); a remainder shorter than half a step is shared.
     */
    double
    next(const double time, const double stop) const;

    /**
     * The attempt of length @p attempted was accepted. The next one is to be so
     * long that no limit is passed if the quantities grow in proportion, but
     * not shorter than the minimum.
     * @return what limits it, with numbers, for the log; empty if nothing does
     */
    std::string
    accepted(const double                  attempted,
             const unsigned int            n_iterations,
             const std::vector<StepLimit> &limits = {});

    /** Number of accepted steps whose next one was limited, by cause. */
    const std::map<std::string, unsigned int> &
    limited() const
    {
      return n_limited;
    }

    /** Number of rejected attempts by cause. */
    const std::map<std::string, unsigned int> &
    rejections() const
    {
      return n_rejected;
    }

    /**
     * The attempt was rejected: cut. @return false if the step would fall below
     * its minimum
     */
    bool
    rejected(const double attempted, const std::string &cause = "other");

    /** Begin again with the first step, e.g. on a new mesh. */
    void
    restart();

    /** Into and from blocks "step control/..." of a checkpoint. */
    void
    save(BlockFile &blocks) const;
    /** The same back. @throws InputError */
    void
    load(const BlockFile &blocks);

    /** Length of the next step before next() shortens it [T]. */
    double
    step() const
    {
      return dt;
    }

  private:
    const Parameters                   &parameters;
    double                              dt;
    std::map<std::string, unsigned int> n_limited, n_rejected;
  };
} // namespace alveolus

#endif
