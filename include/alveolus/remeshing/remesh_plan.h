// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_remesh_plan_h
#define alveolus_remeshing_remesh_plan_h

#include <alveolus/base/block_file.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace alveolus
{
  /**
   * When to remesh: at planned times, when the quality of the mesh falls below
   * a bound, and (if allowed) when no step is short enough any more.
   */
  class RemeshPlan
  {
  public:
    struct Parameters
    {
      std::vector<double> times; ///< planned, ascending [T]
      /** Steps between two remeshes; 0: never for this. */
      unsigned int every = 0;
      /** Remesh below this scaled Jacobian [-]. */
      double below_quality = 0.2;
      /** New meshes below it are not taken [-]. */
      double      accept_quality        = 0.3;
      std::string if_none_is_acceptable = "stop"; ///< "stop" or "go on"
      /** Try a new mesh when steps fail. */
      bool         after_failure = true;
      unsigned int max_remeshes  = 1000; ///< of a run
      /** Of the part of left forces released at once. */
      unsigned int max_halvings = 8;
      /** Of a region outside the old one, at most [-]. */
      double uncovered_part = 0.02;

      /**
       * Add the parameters, bound to the members, to the current subsection.
       */
      void
      declare(dealii::ParameterHandler &prm);
    };

    /** @throws InputError if the planned times do not increase */
    RemeshPlan(const Parameters &parameters, const std::string &where);

    /** The next planned time after @p time [T], or @p end. */
    double
    next_time(const double time, const double end) const;

    /**
     * Why a remesh is due now; empty if it is not.
     * @param quality smallest scaled Jacobian now
     * @param n_steps steps done
     */
    std::string
    due(const double       time,
        const double       quality,
        const unsigned int n_steps = 0) const;

    /** Whether a run that failed at @p time may try again on a new mesh. */
    bool
    after_failure(const double time) const;

    /**
     * A remesh was tried at @p time and left a mesh of this quality: the next
     * automatic one is due when the bound is passed and a fifth of the quality
     * was lost again, so that a bound that cannot be reached does not cause a
     * remesh in every step.
     */
    void
    tried(const double time, const double quality, const bool accepted);

    /** Into and from blocks "remesh plan/..." of a checkpoint. */
    void
    save(BlockFile &blocks) const;
    /** The same back. @throws InputError */
    void
    load(const BlockFile &blocks);

    /** New meshes taken so far. */
    unsigned int
    n_remeshes() const
    {
      return n_accepted;
    }

  private:
    const Parameters &parameters;
    unsigned int      n_accepted    = 0;
    double            last_time     = -1.;
    double            quality_after = 2.;
  };
} // namespace alveolus

#endif
