// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/interrupt.h>
#include <alveolus/base/text_file.h>
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <deal.II/base/multithread_info.h>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;



  template <int dim>
  Simulation<dim>::Simulation(std::shared_ptr<Scene<dim>>      scene_object,
                              const MPI_Comm                  &communicator,
                              Log                             &log,
                              std::shared_ptr<const BlockFile> resumed)
    : scene_object(std::move(scene_object))
    , scene(*this->scene_object)
    , communicator(communicator)
    , log(log)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , step_control(scene.time)
    , resumed(std::move(resumed))
    , checkpoints(scene.output_directory)
  {
    on_first_process<InputError>(communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directories(scene.output_directory, error);
      folder_lock = std::make_unique<FolderLock>(scene.output_directory);
      log.open(scene.output_directory + "/log.txt", this->resumed != nullptr);
      std::ostringstream resolved;
      scene.write_resolved(resolved);
      try
        {
          write_text_file(scene.output_directory + "/parameters.prm",
                          resolved.str());
        }
      catch (const RunError &error)
        {
          throw InputError(scene.output_directory,
                           error.what(),
                           "choose another `Output / Directory` or `--output`");
        }
    });
    model = std::make_unique<Model<dim>>(this->scene_object,
                                         first_mesh(),
                                         timer,
                                         first_positions());
    if (scene.remesher)
      {
        scene.remesher->initialize(model->mesh.names,
                                   "Remeshing / " + scene.remesher_type);
        remesh_plan =
          std::make_unique<RemeshPlan>(scene.remesh_plan, "Remeshing");
      }
    if (BoneMass<dim>::present(*model->state))
      bone_mass = std::make_unique<BoneMass<dim>>(*model->state);
    if (scene.energy_balance)
      energy_books = std::make_unique<EnergyBooks<dim>>(*model);
    begin_reference();
    if (this->resumed)
      {
        restore();
        return;
      }
    quality = model->quality();
    if (quality.n_inverted_corners > 0 || quality.smallest_point_jacobian <= 0.)
      throw InputError("Mesh",
                       "the initial mesh has inverted elements",
                       "repair it; the worst one is near (" +
                         number(quality.where[0]) + ", " +
                         number(quality.where[1]) + ") mm");
    totals.smallest_quality = quality.smallest_scaled_jacobian;
    warn_of_quality();

    // Contradictory conditions show in the first step: rather now.
    const Interval first{0., std::min(scene.time.initial_step, scene.time.end)};
    PrescribedIncrements increments;
    for (auto &condition : model->conditions)
      {
        condition->begin_step(*model->state, first);
        condition->prescribe(*model->state, first, increments);
      }
  }



  template <int dim>
  bool
  Simulation<dim>::run()
  {
    describe();
    wall_clock.start();
    open_files();

    std::string reason;
    try
      {
        reason = advance();
      }
    catch (const InputError &error)
      {
        // What was computed before stays a result.
        if (totals.steps == 0)
          throw;
        reason = error.what();
      }
    catch (const RunError &error)
      {
        reason = error.what();
      }
    catch (const ExceptionBase &error)
      {
        std::ostringstream message;
        error.print_info(message);
        reason = "internal error: " + message.str();
      }
    catch (const std::bad_alloc &)
      {
        reason = "out of memory; use a coarser mesh";
      }
    return finish(reason);
  }



  template <int dim>
  std::string
  Simulation<dim>::advance()
  {
    const auto interrupted = [&](const int signal) {
      return "interrupted by " + Interrupt::name(signal) +
             " at t = " + number(model->state->time, 8) + " T";
    };
    write_fields(totals.steps == 0);
    while (model->state->time < scene.time.end * (1. - 1e-12))
      {
        if (const int signal = pause())
          return interrupted(signal);
        if (remesh_plan)
          {
            const std::string due =
              remesh_plan->due(model->state->time,
                               quality.smallest_scaled_jacobian,
                               totals.steps);
            if (!due.empty())
              {
                if (scene.checkpoint.write)
                  save_checkpoint();
                remesh(due, due != "planned");
                if (const int signal = pause())
                  return interrupted(signal);
              }
          }
        const double time = model->state->time;
        double       stop = scene.time.end;
        if (field_writer && scene.field_interval > 0.)
          stop = std::min(next_field_time, stop);
        if (remesh_plan)
          stop = remesh_plan->next_time(time, stop);
        const double   dt = step_control.next(time, stop);
        const Interval interval{time, dt == stop - time ? stop : time + dt};

        const Verdict verdict = attempt(interval);
        if (verdict.repeats())
          {
            ++rejected_attempts;
            ++totals.rejected;
            log.note("t = " + number(interval.end, 8) + " T rejected (step " +
                     number(dt, 4) + "): " + verdict.reason);
            if (step_control.rejected(dt, verdict.cause))
              continue;
            if (remesh_plan && remesh_plan->after_failure(time) &&
                remesh("no step is short enough", false))
              {
                step_control.restart();
                continue;
              }
            throw RunError("t = " + number(time, 8) + " T",
                           verdict.reason +
                             " even in the smallest step allowed (" +
                             number(scene.time.minimum_step) + " T)",
                           advice_against(verdict.cause));
          }

        const NodalVector start = model->state->configuration.positions();
        state_is_whole          = false;
        commit(interval);
        const auto conclude = [&]() {
          choose_next_step(dt);
          write_history();
          rejected_attempts = 0;
          state_is_whole    = true;
        };
        if (model->rezoner)
          try
            {
              rezone_if_due(start);
            }
          catch (const RunError &error)
            {
              // It left the mesh as it was: the step itself is a result.
              std::string mesh = quality_if_low(model->quality());
              if (mesh.empty() && rezoning_report.cut_back)
                mesh =
                  "the rules of `Rezoning` would have inverted elements, "
                  "so that only " +
                  number(rezoning_report.fraction, 2) +
                  " of their motion was tried: remesh earlier, or rezone "
                  "by other rules";
              conclude();
              throw RunError("t = " + number(model->state->time, 8) +
                               " T, after the step",
                             error.what() + (mesh.empty() ? "" : "; " + mesh),
                             "");
            }
        conclude();
        write_fields(false);
        report_progress();
        if (quality.smallest_scaled_jacobian < scene.minimum_quality)
          throw RunError("t = " + number(model->state->time, 8) + " T",
                         "the smallest scaled Jacobian is " +
                           number(quality.smallest_scaled_jacobian),
                         "below `Monitor / Minimum quality`; rezone or remesh");
      }
    return "";
  }



  template <int dim>
  bool
  Simulation<dim>::finish(std::string reason)
  {
    // Whatever fails here, the rest is still tried.
    const auto try_to = [&](const auto &action) {
      std::string problem;
      try
        {
          action();
        }
      catch (const ExceptionBase &error)
        {
          std::ostringstream message;
          error.print_info(message);
          problem = "internal error: " + message.str();
        }
      catch (const std::exception &error)
        {
          problem = error.what();
        }
      if (reason.find(problem) == std::string::npos)
        reason += (reason.empty() ? "" : "; ") + problem;
    };
    // Before the fields: what is written for the end only is no part of the
    // run that goes on.
    if (scene.checkpoint.write && state_is_whole && !last_checkpoint.failed)
      try_to([&]() { save_checkpoint(); });
    try_to([&]() { write_fields(true); });
    if (!reason.empty())
      log.say("Stopped early: " + reason);
    if (!reason.empty() && !last_checkpoint.file.empty())
      log.say("Go on from " + last_checkpoint.file + " with --resume " +
              scene.output_directory);
    try
      {
        write_summary(reason.empty(), reason);
      }
    catch (const RunError &error)
      {
        // Then only the screen can tell.
        throw RunError("stopped",
                       (reason.empty() ? "" : reason + "; ") + error.what(),
                       "");
      }
    return reason.empty();
  }



  template <int dim>
  Verdict
  Simulation<dim>::attempt(const Interval &interval)
  {
    mechanics_report   = EquilibriumReport();
    remodelling_report = RemodellingSummary();
    if (energy_books)
      energy_books->begin(*model);
    Verdict verdict = model->staggered_step->solve(interval,
                                                   mechanics_report,
                                                   remodelling_report);
    if (!verdict.repeats())
      verdict.combine(judge_corners(*model));
    if (!verdict.repeats())
      {
        TimerOutput::Scope scope(timer, "monitor");
        findings = check_state(*model->state, model->regions, true);
        if (!findings.garbage.empty())
          verdict.combine(
            {Verdict::Kind::repeat, findings.garbage, "history invalid"});
      }
    if (!verdict.repeats() && energy_books)
      {
        // Newton's tolerance is all that may be missing, unless something is
        // wrong with the forces themselves.
        const double error =
          energy_books->check_resultants(*model, mechanics_report.force_scale);
        const double bound =
          std::max({1e-6,
                    100. * scene.solver.tolerance,
                    100. * mechanics_report.round_off,
                    100. * scene.solver.absolute_tolerance /
                      std::max(mechanics_report.force_scale, 1e-300)});
        if (!(error <= bound))
          verdict.combine({Verdict::Kind::repeat,
                           "forces and reactions have a resultant of " +
                             number(error) + " of the internal forces",
                           "resultants"});
      }
    return verdict;
  }



  template <int dim>
  void
  Simulation<dim>::check_committed(const Model<dim> &checked)
  {
    TimerOutput::Scope scope(timer, "monitor");
    findings = check_state(*checked.state, checked.regions, false);
    if (!findings.garbage.empty())
      throw RunError("t = " + number(checked.state->time, 8) + " T",
                     "after the transfer, " + findings.garbage,
                     "go on from the last checkpoint with smaller steps");
  }



  template <int dim>
  Verdict
  Simulation<dim>::judge_corners(const Model<dim> &judged) const
  {
    // With "report" a mesh may go through anything.
    if (scene.inverted_corners == "report")
      return Verdict{};
    const auto &configuration = judged.state->configuration;
    NodalVector x             = configuration.positions();
    x.zero_out_ghost_values();
    x += judged.equilibrium->increment;
    x.update_ghost_values();
    const QualitySummary<dim> candidate = mesh_quality(configuration, x);
    if (candidate.n_inverted_corners == 0)
      return &judged == model.get() ? judge_quality(candidate) : Verdict{};
    std::ostringstream reason;
    reason << candidate.n_inverted_corners
           << " corner(s) of elements turned inside out, the worst near ("
           << candidate.where << ") mm";
    return {Verdict::Kind::repeat, reason.str(), "inverted corners"};
  }



  template <int dim>
  void
  Simulation<dim>::commit(const Interval &interval)
  {
    State<dim>        &state     = *model->state;
    const NodalVector &increment = model->equilibrium->increment;
    if (bone_mass)
      {
        NodalVector x = state.configuration.positions();
        x.zero_out_ghost_values();
        x += increment;
        x.update_ghost_values();
        bone_mass->book_step(state, x);
      }
    if (energy_books)
      energy_books->book_step(*model, mechanics_report, remodelling_report);
    state.accept(increment);
    for (auto &condition : model->conditions)
      condition->commit();
    if (energy_books)
      energy_books->book_commit(*model);
    state.time      = interval.end;
    state.last_step = interval.end - interval.begin;
    ++totals.steps;
    totals.iterations += mechanics_report.n_iterations;
    totals.max_iterations_of_a_step =
      std::max(totals.max_iterations_of_a_step, mechanics_report.n_iterations);
    totals.limited += remodelling_report.n_fabric_limited;

    std::ostringstream residuals;
    residuals << std::scientific << std::setprecision(2);
    for (const double r : mechanics_report.residuals)
      residuals << ' ' << r;
    if (model->equilibrium->solves_by_iteration())
      residuals << "; " << mechanics_report.n_linear_iterations
                << " linear iterations in " << mechanics_report.n_iterations
                << " solutions, relative residual at most "
                << mechanics_report.linear_residual;
    if (mechanics_report.n_direct_instead > 0)
      residuals << "; the iteration failed "
                << mechanics_report.n_direct_instead
                << " times and MUMPS took over, try `Solver / Linear solver = "
                   "multigrid GMRES` or MUMPS";
    if (mechanics_report.round_off > 0.)
      {
        ++totals.at_round_off;
        residuals << "; above `Solver / Tolerance` but no longer falling: "
                     "round-off alone makes "
                  << mechanics_report.round_off;
      }
    log.note("t = " + number(state.time, 8) + " T accepted, residuals" +
             residuals.str());
  }



  template class Simulation<2>;
  template class Simulation<3>;
} // namespace alveolus
