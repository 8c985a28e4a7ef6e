// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/driver/simulation.h>

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/revision.h>

#include <nlohmann/json.hpp>

#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Phases in the order of the columns of the history file. */
    const char *const phases[] = {"assembly",
                                  "linear solver",
                                  "remodelling",
                                  "rezoning",
                                  "transfer",
                                  "monitor",
                                  "output"};
  } // namespace



  template <int dim>
  Simulation<dim>::Simulation(Scene<dim>     &scene,
                              const MPI_Comm &communicator,
                              Log            &log)
    : scene(scene)
    , communicator(communicator)
    , log(log)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , step_control(scene.time)
  {
    std::error_code error;
    std::filesystem::create_directories(scene.output_directory, error);
    log.open(scene.output_directory + "/log.txt");
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        std::ofstream resolved(scene.output_directory + "/parameters.prm");
        scene.write_resolved(resolved);
        if (!resolved)
          throw InputError(scene.output_directory,
                           "the output folder cannot be written",
                           "choose another `Output / Directory` or `--output`");
      }
    MPI_Barrier(communicator);
    mesh = scene.mesh_source->create(communicator,
                                     ".", // paths are resolved already
                                     scene.output_directory);
    build();
  }



  // Everything that depends on the mesh is made here and nowhere else.
  template <int dim>
  void
  Simulation<dim>::build()
  {
    std::map<types::material_id, unsigned int> region_of_material;
    std::vector<HistoryLayout>                 layouts;
    regions.clear();
    remodelling.clear();
    for (unsigned int r = 0; r < scene.regions.size(); ++r)
      {
        const auto &definition = scene.regions[r];
        for (const auto &name :
             Utilities::split_string_list(definition.on, ','))
          for (const auto id :
               mesh.names.region(name, "Regions / " + definition.name + " / On"))
            region_of_material[id] = r;
        const Material &material =
          *scene.materials[scene.material_of(definition)].object;
        regions.push_back({definition.name,
                           &material,
                           definition.treatment == "mean dilatation"});
        layouts.emplace_back(material.history_fields(), dim);
        const int law = scene.remodelling_of(definition);
        remodelling.push_back(
          law < 0 ?
            RegionRemodelling{} :
            RegionRemodelling{scene.remodelling_laws[law].object.get(),
                              dynamic_cast<const RemodelledBone *>(&material)});
      }
    state = std::make_unique<State<dim>>(mesh,
                                         scene.degree,
                                         region_of_material,
                                         layouts);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c = cell->active_cell_index();
          for (unsigned int q = 0; q < state->history.n_points; ++q)
            regions[state->history.region(c)].material->initial_history(
              state->history.old_record(c, q));
        }
    state->history.trial_values = state->history.old_values;

    for (auto &condition : scene.conditions)
      {
        condition.object->choose_interface_law(scene.interface_laws,
                                               condition.where);
        condition.object->attach(*state, condition.where);
        conditions.push_back(std::move(condition.object));
      }
    for (auto &recorder : scene.recorders)
      recorder.object->attach(*state, recorder.where);

    equilibrium    = std::make_unique<Equilibrium<dim>>(*state,
                                                     regions,
                                                     conditions,
                                                     scene.solver,
                                                     timer);
    staggered_step = std::make_unique<StaggeredStep<dim>>(*state,
                                                          *equilibrium,
                                                          remodelling,
                                                          scene.coupling,
                                                          timer);
    if (BoneMass<dim>::present(*state))
      bone_mass = std::make_unique<BoneMass<dim>>(*state);

    if (!scene.rezoning_rules.empty())
      {
        rezoner = std::make_unique<Rezoner<dim>>();
        for (auto &rule : scene.rezoning_rules)
          rezoner->add(std::move(rule.object), rule.where);
        rezoner->attach(state->nodes, state->configuration.positions());
        swept_transfer = std::make_unique<SweptTransfer<dim>>(
          state->configuration,
          state->history,
          Registry<TransferScheme<dim>>::create(scene.transfer_scheme,
                                                "Transfer / Scheme"),
          "density",
          scene.largest_donor_fraction);
        nodal_transfer =
          std::make_unique<NodalTransfer<dim>>(state->configuration);
        for (auto &condition : conditions)
          if (condition->face_history() != nullptr && !face_transfer)
            face_transfer =
              std::make_unique<FaceTransfer<dim>>(state->configuration);
        for (unsigned int r = 0; r < regions.size(); ++r)
          if (regions[r].mean_dilatation)
            projected_regions.insert(r);
        if (!projected_regions.empty())
          trace_projection =
            std::make_unique<TraceProjection<dim>>(swept_transfer->subcells());
      }
    quality =
      mesh_quality(state->configuration, state->configuration.positions());
    if (quality.n_inverted_corners > 0 || quality.smallest_point_jacobian <= 0.)
      throw InputError("Mesh",
                       "the initial mesh has inverted elements",
                       "repair it; the worst one is near (" +
                         Utilities::to_string(quality.where[0]) + ", " +
                         Utilities::to_string(quality.where[1]) + ") mm");
    totals.smallest_quality = quality.smallest_scaled_jacobian;
  }



  template <int dim>
  void
  Simulation<dim>::describe()
  {
    log.say("Alveolus " ALVEOLUS_VERSION ": " + scene.title);
    log.say("  mesh        " + mesh.description + ", " +
            std::to_string(mesh.triangulation->n_global_active_cells()) +
            " cells, degree " + std::to_string(scene.degree) + ", " +
            std::to_string(state->configuration.dof_handler.n_dofs()) +
            " unknowns, smallest scaled Jacobian " +
            Utilities::to_string(quality.smallest_scaled_jacobian));
    for (unsigned int r = 0; r < regions.size(); ++r)
      {
        const auto &definition = scene.regions[r];
        log.say("  region      " + definition.name + ": " +
                scene.materials[scene.material_of(definition)].type + ", " +
                (regions[r].mean_dilatation ? "mean dilatation" :
                                              "full integration") +
                ", remodelling " + definition.remodelling + ", " +
                std::to_string(state->history.layout(r).size * 2 *
                               state->history.n_points * sizeof(double)) +
                " bytes of history per cell");
      }
    for (const auto &condition : conditions)
      log.say("  condition   " + condition->describe());
    if (rezoner)
      {
        std::string rules;
        for (const auto &rule : scene.rezoning_rules)
          rules += (rules.empty() ? "" : ", ") + rule.name;
        log.say("  rezoning    " + rules + "; transfer " +
                scene.transfer_scheme);
      }
    else
      log.say("  rezoning    off (Lagrangian mesh)");
    log.say("  solver      " + equilibrium->linear_solver_name() + ", " +
            std::to_string(Utilities::MPI::n_mpi_processes(communicator)) +
            " process(es), " + std::to_string(MultithreadInfo::n_threads()) +
            " thread(s)");
    log.say("  output      " + scene.output_directory);
  }



  template <int dim>
  bool
  Simulation<dim>::run()
  {
    describe();
    wall_clock.start();
    if (Utilities::MPI::this_mpi_process(communicator) == 0)
      history_file = std::make_unique<HistoryFile>(scene.output_directory +
                                                   "/history.csv");
    if (scene.fields)
      field_writer = std::make_unique<FieldWriter<dim>>(scene.output_directory);
    write_fields(true);

    std::string reason;
    try
      {
        while (state->time < scene.time.end * (1. - 1e-12))
          {
            const double stop = scene.field_interval > 0. ?
                                  std::min(next_field_time, scene.time.end) :
                                  scene.time.end;
            const double dt   = step_control.next(state->time, stop);
            const Interval interval{state->time,
                                    dt == stop - state->time ?
                                      stop :
                                      state->time + dt};

            const Verdict verdict = attempt(interval);
            if (verdict.repeats())
              {
                ++rejected_attempts;
                ++totals.rejected;
                log.note("t = " + Utilities::to_string(interval.end, 8) +
                         " T rejected (step " + Utilities::to_string(dt, 4) +
                         "): " + verdict.reason);
                if (!step_control.rejected(dt))
                  throw RunError(
                    "t = " + Utilities::to_string(state->time, 8) + " T",
                    verdict.reason +
                      " even in the smallest step allowed (" +
                      Utilities::to_string(scene.time.minimum_step) + " T)",
                    "rezone the mesh there, or reduce `Time / Minimum step`");
                continue;
              }

            const NodalVector start = state->configuration.positions();
            commit(interval);
            if (rezoner)
              rezone(start);
            write_history(interval);
            write_fields(false);
            step_control.accepted(dt, mechanics_report.n_iterations);
            rejected_attempts = 0;
            report_progress();
            if (quality.smallest_scaled_jacobian < scene.minimum_quality)
              throw RunError(
                "t = " + Utilities::to_string(state->time, 8) + " T",
                "the smallest scaled Jacobian is " +
                  Utilities::to_string(quality.smallest_scaled_jacobian),
                "below `Monitor / Minimum quality`; rezone or remesh");
          }
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
    write_fields(true);
    write_summary(reason.empty(), reason);
    if (!reason.empty())
      log.say("Stopped early: " + reason);
    return reason.empty();
  }



  template <int dim>
  Verdict
  Simulation<dim>::attempt(const Interval &interval)
  {
    mechanics_report   = EquilibriumReport();
    remodelling_report = RemodellingSummary();
    Verdict verdict    = staggered_step->solve(interval,
                                            mechanics_report,
                                            remodelling_report);
    if (!verdict.repeats())
      verdict.combine(judge_corners());
    return verdict;
  }



  template <int dim>
  Verdict
  Simulation<dim>::judge_corners() const
  {
    if (scene.inverted_corners == "report")
      return Verdict{};
    NodalVector x = state->configuration.positions();
    x.zero_out_ghost_values();
    x += equilibrium->increment;
    x.update_ghost_values();
    const QualitySummary<dim> candidate = mesh_quality(state->configuration, x);
    if (candidate.n_inverted_corners == 0)
      return Verdict{};
    std::ostringstream reason;
    reason << candidate.n_inverted_corners
           << " corner(s) of elements turned inside out, the worst near ("
           << candidate.where << ") mm";
    return {Verdict::Kind::repeat, reason.str()};
  }



  template <int dim>
  void
  Simulation<dim>::commit(const Interval &interval)
  {
    const NodalVector &increment = equilibrium->increment;
    if (bone_mass)
      {
        NodalVector x = state->configuration.positions();
        x.zero_out_ghost_values();
        x += increment;
        x.update_ghost_values();
        bone_mass->book_step(*state, x);
      }
    state->configuration.move(increment);
    state->displacement.zero_out_ghost_values();
    state->displacement += increment;
    state->displacement.update_ghost_values();
    state->increment.zero_out_ghost_values();
    state->increment = increment;
    state->increment.update_ghost_values();
    state->history.commit();
    for (auto &condition : conditions)
      condition->commit();
    state->time      = interval.end;
    state->last_step = interval.end - interval.begin;
    ++totals.steps;
    totals.iterations += mechanics_report.n_iterations;
    totals.max_iterations_of_a_step =
      std::max(totals.max_iterations_of_a_step, mechanics_report.n_iterations);
    totals.limited += remodelling_report.n_fabric_limited;

    std::ostringstream residuals;
    residuals << std::scientific << std::setprecision(2);
    for (const double r : mechanics_report.residuals)
      residuals << ' ' << r;
    log.note("t = " + Utilities::to_string(state->time, 8) +
             " T accepted, residuals" + residuals.str());
  }



  template <int dim>
  void
  Simulation<dim>::rezone(const NodalVector &start)
  {
    const NodalVector lagrangian = state->configuration.positions();
    rezoning_report              = RezoningReport();
    NodalVector rezoned;
    {
      TimerOutput::Scope scope(timer, "rezoning");
      rezoned =
        rezoner->propose(state->nodes, start, lagrangian, rezoning_report);
    }
    if (rezoning_report.cut_back)
      {
        ++totals.cut_back;
        log.note("rezoning cut back to " +
                 Utilities::to_string(rezoning_report.fraction) +
                 " of its motion, it would have inverted elements");
      }
    if (rezoning_report.unconverged_rules > 0)
      {
        ++totals.unconverged_rezonings;
        log.note("rezoning did not converge in " +
                 std::to_string(rezoning_report.sweeps) + " sweeps");
      }
    if (rezoning_report.largest_motion == 0.)
      return;

    TimerOutput::Scope   scope(timer, "transfer");
    const TransferReport report =
      swept_transfer->transfer(state->history, lagrangian, rezoned);
    nodal_transfer->transfer(state->displacement, lagrangian, rezoned);
    for (auto &condition : conditions)
      if (condition->face_history() != nullptr)
        face_transfer->transfer(*condition->face_history(),
                                lagrangian,
                                rezoned);
    state->configuration.set_positions(rezoned);

    if (trace_projection)
      trace_projection->apply(state->history, rezoned, projected_regions);
    unsigned int n_limited = report.n_limited;
    unsigned int n_projected = 0;
    for (const unsigned int cell : swept_transfer->subcells().owned_cells())
      for (unsigned int q = 0; q < state->history.n_points; ++q)
        n_projected +=
          regions[state->history.region(cell)].material->make_admissible(
            state->history.old_record(cell, q));
    n_limited += Utilities::MPI::sum(n_projected, communicator);
    totals.limited += n_limited;
    totals.subcycles += report.n_subcycles;
    if (bone_mass)
      bone_mass->book_transfer(*state, report);
  }



  template <int dim>
  void
  Simulation<dim>::write_history(const Interval &interval)
  {
    {
      TimerOutput::Scope scope(timer, "monitor");
      quality =
        mesh_quality(state->configuration, state->configuration.positions());
      totals.smallest_quality =
        std::min(totals.smallest_quality, quality.smallest_scaled_jacobian);
    }
    TimerOutput::Scope scope(timer, "output");
    HistoryFile::Row   row, further;
    row.emplace_back("time [T]", state->time);
    // The first rigid body leads the row; what else it knows comes last.
    bool lead = true;
    for (const auto &condition : conditions)
      {
        const auto recorded =
          condition->record(*state, equilibrium->residual());
        const std::size_t n_leading =
          lead ? std::min<std::size_t>(recorded.size(), dim == 2 ? 4 : 7) : 0;
        row.insert(row.end(), recorded.begin(), recorded.begin() + n_leading);
        const std::string name =
          condition->where.substr(condition->where.find("/ ") + 2);
        for (std::size_t i = n_leading; i < recorded.size(); ++i)
          further.emplace_back(name + ": " + recorded[i].first,
                               recorded[i].second);
        lead = lead && recorded.empty();
      }
    row.emplace_back("time step [T]", interval.end - interval.begin);
    row.emplace_back("Newton iterations", mechanics_report.n_iterations);
    row.emplace_back("rejected attempts", rejected_attempts);
    row.emplace_back("smallest scaled Jacobian",
                     quality.smallest_scaled_jacobian);
    row.emplace_back("inverted corners", quality.n_inverted_corners);
    if (bone_mass)
      {
        const auto density = bone_mass->extremes(*state);
        row.emplace_back("bone mass [mg]", bone_mass->mass);
        row.emplace_back("bone mass balance", bone_mass->balance());
        row.emplace_back("mass by remodelling [mg]", bone_mass->by_remodelling);
        row.emplace_back("mass by volume change [mg]",
                         bone_mass->by_volume_change);
        row.emplace_back("mass through boundaries [mg]",
                         bone_mass->through_boundary);
        row.emplace_back("least density [g/cc]", density.first);
        row.emplace_back("greatest density [g/cc]", density.second);
        row.emplace_back("points at least density",
                         remodelling_report.n_at_lower_bound);
        row.emplace_back("points at greatest density",
                         remodelling_report.n_at_upper_bound);
      }
    if (rezoner)
      row.emplace_back("limited values", totals.limited);
    row.emplace_back("stored energy [mJ]", mechanics_report.energy);
    const auto seconds =
      timer.get_summary_data(TimerOutput::total_wall_time);
    for (const char *const phase : phases)
      row.emplace_back(std::string(phase) + " [s]",
                       seconds.count(phase) > 0 ? seconds.at(phase) : 0.);
    row.insert(row.end(), further.begin(), further.end());
    for (const auto &recorder : scene.recorders)
      for (const auto &value :
           recorder.object->record(*state, equilibrium->residual()))
        row.emplace_back(recorder.name + ": " + value.first, value.second);
    if (history_file)
      history_file->write(row);
  }



  template <int dim>
  void
  Simulation<dim>::write_fields(const bool always)
  {
    if (!field_writer || state->time == last_field_time)
      return;
    const bool due = scene.field_interval > 0. &&
                     state->time >= next_field_time * (1. - 1e-12);
    if (!always && !due)
      return;
    TimerOutput::Scope scope(timer, "output");
    field_writer->write(*state, regions);
    last_field_time = state->time;
    while (scene.field_interval > 0. &&
           next_field_time <= state->time * (1. + 1e-12))
      next_field_time += scene.field_interval;
  }



  template <int dim>
  void
  Simulation<dim>::report_progress()
  {
    const double elapsed = wall_clock.wall_time();
    const double left =
      elapsed * (scene.time.end - state->time) / state->time;
    char line[200];
    std::snprintf(line,
                  sizeof(line),
                  "t = %9.4f T (%5.1f %%)  step %5u  dt %8.2e  Newton %2u  "
                  "quality %6.3f  rejected %u  left %.0f s",
                  state->time,
                  100. * state->time / scene.time.end,
                  totals.steps,
                  state->last_step,
                  mechanics_report.n_iterations,
                  quality.smallest_scaled_jacobian,
                  totals.rejected,
                  left);
    log.progress(line);
  }



  template <int dim>
  void
  Simulation<dim>::write_summary(const bool completed, const std::string &reason)
  {
    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    const double peak =
      Utilities::MPI::sum(static_cast<double>(memory.VmHWM), communicator);
    const std::size_t history_bytes =
      Utilities::MPI::sum(state->history.memory_consumption(), communicator);
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      return;
    nlohmann::ordered_json summary;
    summary["completed"] = completed;
    summary["reason"]    = reason;
    summary["title"]     = scene.title;
    summary["time"]      = state->time;
    summary["steps"]     = totals.steps;
    summary["rejected attempts"]         = totals.rejected;
    summary["Newton iterations"]         = totals.iterations;
    summary["Newton iterations per step"] =
      totals.steps > 0 ? static_cast<double>(totals.iterations) / totals.steps :
                         0.;
    summary["most Newton iterations of a step"] =
      totals.max_iterations_of_a_step;
    summary["last residual history"]    = mechanics_report.residuals;
    summary["smallest scaled Jacobian"] = totals.smallest_quality;
    summary["inverted corners"]         = quality.n_inverted_corners;
    summary["limited values"]           = totals.limited;
    if (rezoner)
      {
        summary["rezonings cut back"] = totals.cut_back;
        summary["rezonings not converged"] = totals.unconverged_rezonings;
        summary["transfer sub-cycles"] = totals.subcycles;
      }
    if (bone_mass)
      {
        summary["bone mass [mg]"]              = bone_mass->mass;
        summary["initial bone mass [mg]"]      = bone_mass->initial;
        summary["mass by remodelling [mg]"]    = bone_mass->by_remodelling;
        summary["mass by volume change [mg]"]  = bone_mass->by_volume_change;
        summary["mass through boundaries [mg]"] = bone_mass->through_boundary;
        summary["bone mass balance"]           = bone_mass->balance();
      }
    summary["cells"]    = mesh.triangulation->n_global_active_cells();
    summary["unknowns"] = state->configuration.dof_handler.n_dofs();
    summary["history [bytes]"]     = history_bytes;
    summary["peak memory [kB]"]    = peak;
    summary["wall time [s]"]       = wall_clock.wall_time();
    const auto seconds = timer.get_summary_data(TimerOutput::total_wall_time);
    for (const char *const phase : phases)
      summary["seconds per phase"][phase] =
        seconds.count(phase) > 0 ? seconds.at(phase) : 0.;
    summary["processes"] = Utilities::MPI::n_mpi_processes(communicator);
    summary["threads"]   = MultithreadInfo::n_threads();
    summary["versions"]["alveolus"] = ALVEOLUS_VERSION;
    summary["versions"]["deal.II"]  = DEAL_II_PACKAGE_VERSION;
    std::ofstream file(scene.output_directory + "/summary.json");
    file << summary.dump(2) << std::endl;
    if (completed)
      log.say("Completed in " +
              Utilities::to_string(wall_clock.wall_time(), 4) + " s: " +
              std::to_string(totals.steps) + " steps, " +
              std::to_string(totals.iterations) + " Newton iterations, " +
              std::to_string(totals.rejected) +
              " rejected attempts, smallest scaled Jacobian " +
              Utilities::to_string(totals.smallest_quality, 4));
  }

  template class Simulation<2>;
  template class Simulation<3>;
} // namespace alveolus
