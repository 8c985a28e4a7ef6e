// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_simulation_h
#define alveolus_driver_simulation_h

#include <alveolus/base/whole_file.h>
#include <alveolus/driver/bone_mass.h>
#include <alveolus/driver/energy_books.h>
#include <alveolus/driver/model.h>
#include <alveolus/driver/state_check.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/io/field_writer.h>
#include <alveolus/io/history_file.h>
#include <alveolus/io/log.h>
#include <alveolus/state/portable_fields.h>
#include <alveolus/transfer/overlap_transfer.h>

#include <deal.II/base/timer.h>

#include <map>
#include <memory>
#include <string>

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
   * Between two steps the state is whole: only then checkpoints are written
   * (simulation_checkpoint.cc) and signals are heeded. A run that goes on from
   * a checkpoint takes the same path from there.
   *
   * Before a step the mesh is replaced where the scene's plan asks for it: new
   * mesh, transfer by overlap, equilibrium at constant load. Start and remesh
   * make the same Model.
   *
   * Whatever a scene does not ask for is a null pointer here: it costs nothing.
   */
  template <int dim>
  class Simulation
  {
  public:
    /**
     * Make output folder, mesh and all objects; solve nothing.
     * @param resumed a checkpoint to go on from, or null. Its settings are
     *        those of the scene, or the differences are accepted.
     * @throws InputError
     */
    Simulation(std::shared_ptr<Scene<dim>>      scene,
               const MPI_Comm                  &communicator,
               Log                             &log,
               std::shared_ptr<const BlockFile> resumed = nullptr);

    /** Say what will be modelled and what not (`--validate`). */
    void
    describe();

    /**
     * Say what the names of the mesh stand for and draw it with them into
     * `mesh.svg` of the output folder (simulation_names.cc).
     * @throws RunError if the file cannot be written
     */
    void
    describe_names();

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
      unsigned int skipped_rezonings        = 0;
      unsigned int quality_warnings         = 0;
      unsigned int at_round_off             = 0; ///< steps, see Equilibrium
      unsigned int max_iterations_of_a_step = 0;
      double       smallest_quality         = 1.;
      double       largest_transfer_error   = 0.;
      unsigned int most_beyond_bounds       = 0; ///< points, of a step
    };

    Verdict
    attempt(const Interval &interval);
    /**
     * Count, and say in the log, what of the committed history is beyond its
     * bounds. @throws RunError if it is garbage
     */
    void
    check_committed(const Model<dim> &checked);
    Verdict
    judge_corners(const Model<dim> &candidate) const;
    void
    commit(const Interval &interval);
    void
    rezone(Model<dim>        &rezoned_model,
           const NodalVector &start,
           const bool         booked);

    // simulation_steps.cc:
    /** Reject what takes too much of the quality of the mesh. */
    Verdict
    judge_quality(const QualitySummary<dim> &candidate) const;
    /** Choose the next step by what was measured in the one of length @p dt. */
    void
    choose_next_step(const double dt);
    /** A line in the log when the quality has fallen below the bound. */
    void
    warn_of_quality();
    /**
     * For a message: that the mesh is bad, where, and what helps; empty if it
     * is not below `Monitor / Warn below quality`.
     */
    std::string
    quality_if_low(const QualitySummary<dim> &judged) const;
    /** What to do where no step is short enough, by the cause of that. */
    std::string
    advice_against(const std::string &cause) const;
    /**
     * Rezone if the plan asks for it; else remember where the mesh was, since
     * rules count from the last rezoning.
     * @param start positions before the step
     */
    void
    rezone_if_due(const NodalVector &start);

    /** What became of one candidate of a remesh. */
    struct Remeshed
    {
      std::unique_ptr<Model<dim>> model;
      OverlapReport               transfer;
      EquilibriumReport           settling;
      unsigned int                n_parts   = 0;
      double                      imbalance = 0.;
      QualitySummary<dim>         before, after; ///< of the settling
      double                      seconds_transfer = 0., seconds_settling = 0.;
      std::string                 description;
    };

    /**
     * Replace the mesh (simulation_remesh.cc). The new one's smallest scaled
     * Jacobian has to reach `Accept quality`, or that of the old mesh; of which
     * it may lose a tenth unless it is @p for_quality that it is wanted.
     * @return false if no candidate was good enough: then nothing has changed
     */
    bool
    remesh(const std::string &reason, const bool for_quality);
    /**
     * By active cell, also ghosts: the density of the stored energy [MPa]
     * ("strain energy") or of the bone [g/cc] ("density").
     */
    std::vector<double>
    cell_means(const std::string &quantity) const;
    /** Transfer to a candidate and bring it into equilibrium. */
    Remeshed
    try_candidate(RemeshCandidate<dim>        candidate,
                  const OverlapTransfer<dim> &overlap);
    void
    settle(Remeshed &candidate);
    void
    write_remesh(const std::string         &reason,
                 const Remeshed            &taken,
                 const std::vector<double> &areas_before,
                 const HistoryFile::Row    &row_before,
                 const double               seconds_meshing);

    /** The loop over the steps. @return why it ended early; empty if not */
    std::string
    advance();
    /** Last files. @return whether the run is complete */
    bool
    finish(std::string reason);

    // simulation_reference.cc, where some region has a reference map:
    /** Keep the undeformed body, or get it from a checkpoint. */
    void
    begin_reference();
    /** Of the volumes at rest, relative; in the order of the map's regions. */
    std::vector<double>
    reference_volume_errors() const;
    /** A line in the log where they have become large. */
    void
    note_reference_volumes();
    /**
     * The material displacement on the mesh at @p rezoned; with a reference map
     * that objects, @p rezoned is cut back towards @p lagrangian.
     */
    NodalVector
    carry_displacement(Model<dim>        &carried,
                       const NodalVector &lagrangian,
                       NodalVector       &rezoned);

    // simulation_checkpoint.cc:
    Mesh<dim>
    first_mesh();
    /** Set everything that a checkpoint knows. */
    void
    restore();
    /** Begin the files of the run, or go on with them. */
    void
    open_files();
    /** Where a resumed model was attached, for its constructor; or empty. */
    std::function<NodalVector(const Configuration<dim> &)>
    first_positions() const;
    void
    save_checkpoint();
    /**
     * Between two steps: save if it is time to.
     * @return the signal that asks the run to stop, or 0
     */
    int
    pause();

    /** Wall time of each phase [s], with that before a checkpoint. */
    std::map<std::string, double>
    phase_seconds() const;

    /** Say which optional parts are on, and which are off. */
    void
    describe_parts();
    /** Say what the scene takes: unknowns, entries of the matrix, bytes. */
    void
    describe_cost();

    HistoryFile::Row
    history_row();
    void
    write_history();
    void
    write_fields(const bool always);
    void
    write_summary(const bool completed, const std::string &reason);
    void
    report_progress();

    std::unique_ptr<FolderLock> folder_lock; ///< on the first process
    std::shared_ptr<Scene<dim>> scene_object;
    Scene<dim>                 &scene; ///< the same
    MPI_Comm                    communicator;
    Log                        &log;
    dealii::TimerOutput         timer;

    std::unique_ptr<Model<dim>> model;
    // Present only where the scene remeshes:
    std::unique_ptr<RemeshPlan>  remesh_plan;
    std::unique_ptr<HistoryFile> remesh_file;
    // Present only where some region has a density:
    std::unique_ptr<BoneMass<dim>>    bone_mass;
    StateFindings                     findings;     ///< of the present history
    std::unique_ptr<EnergyBooks<dim>> energy_books; ///< null if not asked for
    // Present only where some region has a reference map:
    std::unique_ptr<ReferenceOutline<dim>> reference_outline;
    std::vector<double> reference_volumes; ///< of the undeformed regions
    std::vector<double> noted_volume_errors;

    std::unique_ptr<HistoryFile>      history_file;
    HistoryFile::Row                  last_row; ///< of history_file
    std::unique_ptr<FieldWriter<dim>> field_writer;
    StepControl                       step_control;
    double                            next_field_time = 0.;
    double                            last_field_time = -1.;

    EquilibriumReport  mechanics_report;
    RemodellingSummary remodelling_report;
    RezoningReport     rezoning_report;
    double             swept_fraction = 0.; ///< of the last step's transfer
    /** Positions after the last rezoning, if steps were not rezoned since. */
    std::unique_ptr<NodalVector> rezoning_start;
    bool                quality_is_low = false; ///< and the log has told it
    QualitySummary<dim> quality;
    unsigned int        rejected_attempts = 0; ///< of the current step
    Totals              totals;
    dealii::Timer       wall_clock;

    std::shared_ptr<const BlockFile> resumed; ///< until run() begins
    /** Wall time spent before the checkpoint that this run goes on from [s]. */
    std::map<std::string, double> seconds_before;
    double                        wall_before = 0.;

    /** Between two steps: state, books and history file belong together. */
    bool                                 state_is_whole = true;
    CheckpointFolder                     checkpoints;
    std::unique_ptr<PortableFields<dim>> portable; ///< of the present mesh
    struct
    {
      std::string  file; ///< the last one written or gone on from
      unsigned int steps    = dealii::numbers::invalid_unsigned_int;
      unsigned int rejected = 0, remeshes = 0;
      double       wall_time = 0.;
      bool         failed    = false;
    } last_checkpoint;
  };
} // namespace alveolus

#endif
