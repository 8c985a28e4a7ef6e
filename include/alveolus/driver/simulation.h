// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_simulation_h
#define alveolus_driver_simulation_h

#include <alveolus/driver/bone_mass.h>
#include <alveolus/io/field_writer.h>
#include <alveolus/io/history_file.h>
#include <alveolus/io/log.h>
#include <alveolus/mesh/quality.h>
#include <alveolus/scene/scene.h>
#include <alveolus/transfer/face_transfer.h>
#include <alveolus/transfer/nodal_transfer.h>
#include <alveolus/transfer/swept_transfer.h>
#include <alveolus/transfer/trace_projection.h>

#include <deal.II/base/timer.h>

#include <memory>

namespace alveolus
{
  /**
   * The time loop. A step is an operator split (theory, section 1):
   *
   *   1. Lagrangian phase: equilibrium and remodelling (StaggeredStep). It
   *      writes trial values only, so a rejected attempt leaves no trace.
   *   2. Judgement: Newton, quadrature points, corners, remodelling rate. A
   *      rejected attempt is repeated with a smaller step.
   *   3. Commit: the mesh follows the material, d <- d + du.
   *   4. Rezoning and transfer, if the scene has rezoning rules.
   *   5. Output.
   *
   * Whatever a scene does not ask for is a null pointer here: it costs nothing.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * Make output folder, mesh and all objects; solve nothing. @p scene must
     * outlive this object; its conditions and rules move here.
     * @throws InputError
     */
    Simulation(Scene<dim> &scene, const MPI_Comm &communicator, Log &log);

    /** Say what will be modelled and what not (`--validate`). */
    void
    describe();

    /**
     * Run to the end.
     * @return true if completed; false if stopped early, with complete results
     *         and the reason on disk
     */
    bool
    run();

  private:
    /** Totals that history and summary report. */
    struct Totals
    {
      unsigned int steps = 0, rejected = 0, iterations = 0;
      unsigned int limited = 0, cut_back = 0, subcycles = 0;
      unsigned int unconverged_rezonings    = 0;
      unsigned int max_iterations_of_a_step = 0;
      double       smallest_quality         = 1.;
      double       largest_transfer_error   = 0.;
    };

    void
    build();
    Verdict
    attempt(const Interval &interval);
    Verdict
    judge_corners() const;
    void
    commit(const Interval &interval);
    void
    rezone(const NodalVector &start);
    void
    write_history(const Interval &interval);
    void
    write_fields(const bool always);
    void
    write_summary(const bool completed, const std::string &reason);
    void
    report_progress();

    Scene<dim>         &scene;
    MPI_Comm            communicator;
    Log                &log;
    dealii::TimerOutput timer;

    Mesh<dim>                                    mesh;
    std::unique_ptr<State<dim>>                  state;
    std::vector<Region>                          regions;
    std::vector<RegionRemodelling>               remodelling;
    typename MechanicsAssembler<dim>::Conditions conditions;
    std::unique_ptr<Equilibrium<dim>>            equilibrium;
    std::unique_ptr<StaggeredStep<dim>>          staggered_step;

    // Present only where the scene rezones:
    std::unique_ptr<Rezoner<dim>>         rezoner;
    std::unique_ptr<SweptTransfer<dim>>   swept_transfer;
    std::unique_ptr<NodalTransfer<dim>>   nodal_transfer;
    std::unique_ptr<FaceTransfer<dim>>    face_transfer;
    std::unique_ptr<TraceProjection<dim>> trace_projection;
    std::set<unsigned int>                projected_regions;
    // Present only where some region has a density:
    std::unique_ptr<BoneMass<dim>> bone_mass;

    std::unique_ptr<HistoryFile>      history_file;
    std::unique_ptr<FieldWriter<dim>> field_writer;
    StepControl                       step_control;
    double                            next_field_time = 0.;
    double                            last_field_time = -1.;

    EquilibriumReport   mechanics_report;
    RemodellingSummary  remodelling_report;
    RezoningReport      rezoning_report;
    QualitySummary<dim> quality;
    unsigned int        rejected_attempts = 0; ///< of the current step
    Totals              totals;
    dealii::Timer       wall_clock;
    double              start_time = 0.;
  };
} // namespace alveolus

#endif
