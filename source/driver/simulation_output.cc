// SPDX-License-Identifier: LGPL-2.1-or-later
// What a simulation tells: screen, history file, fields, summary.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <deal.II/base/multithread_info.h>
#include <deal.II/base/revision.h>

#include <nlohmann/json.hpp>

#include <cstdio>

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
  void
  Simulation<dim>::describe()
  {
    log.say("Alveolus " ALVEOLUS_VERSION ": " + scene.title);
    log.say("  mesh        " + mesh.description + "; degree " +
            std::to_string(scene.degree) + ", " +
            std::to_string(state->configuration.dof_handler.n_dofs()) +
            " unknowns");
    for (unsigned int r = 0; r < regions.size(); ++r)
      {
        const auto &definition = scene.regions[r];
        log.say("  region      " + definition.name + ": " +
                scene.materials[scene.material_of(definition)].type + ", " +
                (regions[r].mean_dilatation ? "mean dilatation"
                                            : "full integration") +
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
    const auto seconds = timer.get_summary_data(TimerOutput::total_wall_time);
    for (const char *const phase : phases)
      row.emplace_back(std::string(phase) + " [s]",
                       seconds.count(phase) > 0 ? seconds.at(phase) : 0.);
    row.insert(row.end(), further.begin(), further.end());
    for (const auto &recorder : scene.recorders)
      for (const auto &value :
           recorder.object->record(*state, equilibrium->residual()))
        row.emplace_back(recorder.name + ": " + value.first, value.second);
    if (scene.solver.report_imbalance)
      row.emplace_back("imbalance before step", mechanics_report.imbalance);
    on_first_process<RunError>(communicator,
                               [&]() { history_file->write(row); });
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
    const double left = elapsed * (scene.time.end - state->time) / state->time;
    char         line[200];
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
  Simulation<dim>::write_summary(const bool         completed,
                                 const std::string &reason)
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
    summary["completed"]         = completed;
    summary["reason"]            = reason;
    summary["title"]             = scene.title;
    summary["time"]              = state->time;
    summary["steps"]             = totals.steps;
    summary["rejected attempts"] = totals.rejected;
    summary["Newton iterations"] = totals.iterations;
    summary["Newton iterations per step"] =
      totals.steps > 0 ? static_cast<double>(totals.iterations) / totals.steps
                       : 0.;
    summary["most Newton iterations of a step"] =
      totals.max_iterations_of_a_step;
    summary["last residual history"]    = mechanics_report.residuals;
    summary["smallest scaled Jacobian"] = totals.smallest_quality;
    summary["inverted corners"]         = quality.n_inverted_corners;
    summary["limited values"]           = totals.limited;
    if (rezoner)
      {
        summary["rezonings cut back"]      = totals.cut_back;
        summary["rezonings not converged"] = totals.unconverged_rezonings;
        summary["transfer sub-cycles"]     = totals.subcycles;
      }
    if (bone_mass)
      {
        summary["bone mass [mg]"]               = bone_mass->mass;
        summary["initial bone mass [mg]"]       = bone_mass->initial;
        summary["mass by remodelling [mg]"]     = bone_mass->by_remodelling;
        summary["mass by volume change [mg]"]   = bone_mass->by_volume_change;
        summary["mass through boundaries [mg]"] = bone_mass->through_boundary;
        summary["bone mass balance"]            = bone_mass->balance();
      }
    summary["cells"]            = mesh.triangulation->n_global_active_cells();
    summary["unknowns"]         = state->configuration.dof_handler.n_dofs();
    summary["history [bytes]"]  = history_bytes;
    summary["peak memory [kB]"] = peak;
    summary["wall time [s]"]    = wall_clock.wall_time();
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
      log.say("Completed in " + number(wall_clock.wall_time(), 4) +
              " s: " + std::to_string(totals.steps) + " steps, " +
              std::to_string(totals.iterations) + " Newton iterations, " +
              std::to_string(totals.rejected) +
              " rejected attempts, smallest scaled Jacobian " +
              number(totals.smallest_quality, 4));
  }

  template void
  Simulation<2>::describe();
  template void
  Simulation<3>::describe();
  template void
  Simulation<2>::write_history(const Interval &);
  template void
  Simulation<3>::write_history(const Interval &);
  template void
  Simulation<2>::write_fields(const bool);
  template void
  Simulation<3>::write_fields(const bool);
  template void
  Simulation<2>::report_progress();
  template void
  Simulation<3>::report_progress();
  template void
  Simulation<2>::write_summary(const bool, const std::string &);
  template void
  Simulation<3>::write_summary(const bool, const std::string &);
} // namespace alveolus
