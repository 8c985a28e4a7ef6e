// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_step_control_h
#define alveolus_solver_step_control_h

#include <alveolus/base/block_file.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace alveolus
{
  /**
   * Length of the time steps: cut after a rejected attempt, grown again after
   * easy steps, shortened to hit given times exactly.
   */
  class StepControl
  {
  public:
    struct Parameters
    {
      double       end             = 1.;
      double       initial_step    = 0.1;
      double       minimum_step    = 1e-5;
      double       maximum_step    = 0.1;
      double       cut_factor      = 0.5;
      double       growth_factor   = 1.5;
      unsigned int easy_iterations = 6;

      void
      declare(dealii::ParameterHandler &prm);
    };

    explicit StepControl(const Parameters &parameters);

    /**
     * Length of the next attempt from @p time, not beyond @p stop (the end or
     * an output time); a remainder shorter than half a step is shared.
     */
    double
    next(const double time, const double stop) const;

    /** The attempt of length @p attempted was accepted. */
    void
    accepted(const double attempted, const unsigned int n_iterations);

    /**
     * The attempt was rejected: cut. @return false if the step would fall below
     * its minimum
     */
    bool
    rejected(const double attempted);

    /** Begin again with the first step, e.g. on a new mesh. */
    void
    restart();

    /** Into and from blocks "step control/..." of a checkpoint. */
    void
    save(BlockFile &blocks) const;
    void
    load(const BlockFile &blocks);

    double
    step() const
    {
      return dt;
    }

  private:
    const Parameters &parameters;
    double            dt;
  };
} // namespace alveolus

#endif
