// SPDX-License-Identifier: LGPL-2.1-or-later
// What a simulation tells: screen, history file, fields, summary.
#include <alveolus/assembly/rigid_body.h>
#include <alveolus/base/text_file.h>
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
                                  "remeshing",
                                  "monitor",
                                  "output"};
  } // namespace



  template <int dim>
  void
  Simulation<dim>::write_history()
  {
    {
      TimerOutput::Scope scope(timer, "monitor");
      quality = model->quality();
      totals.smallest_quality =
        std::min(totals.smallest_quality, quality.smallest_scaled_jacobian);
      warn_of_quality();
    }
    if (findings.n_beyond_bounds > totals.most_beyond_bounds)
      {
        totals.most_beyond_bounds = findings.n_beyond_bounds;
        log.note(std::to_string(findings.n_beyond_bounds) +
                 " point(s) beyond the bounds of their history, worst " +
                 findings.worst);
      }
    last_row = history_row();
    TimerOutput::Scope scope(timer, "output");
    on_first_process<RunError>(communicator,
                               [&]() { history_file->write(last_row); });
  }



  template <int dim>
  std::map<std::string, double>
  Simulation<dim>::phase_seconds() const
  {
    const auto now = timer.get_summary_data(TimerOutput::total_wall_time);
    std::map<std::string, double> seconds;
    for (const char *const phase : phases)
      seconds[phase] =
        (now.count(phase) > 0 ? now.at(phase) : 0.) +
        (seconds_before.count(phase) > 0 ? seconds_before.at(phase) : 0.);
    return seconds;
  }



  template <int dim>
  HistoryFile::Row
  Simulation<dim>::history_row()
  {
    TimerOutput::Scope scope(timer, "output");
    HistoryFile::Row   row, further;
    row.emplace_back("time [T]", model->state->time);
    // What is applied comes before what answers, of the first load without its
    // name.
    const auto name_of = [](const Condition<dim> &condition) {
      return condition.where.substr(condition.where.find("/ ") + 2) + ": ";
    };
    bool first_load = true;
    for (const auto &condition : model->conditions)
      {
        const auto applied = condition->applied(*model->state);
        for (const auto &value : applied)
          row.emplace_back((first_load ? "" : name_of(*condition)) +
                             value.first,
                           value.second);
        first_load = first_load && applied.empty();
      }
    // The first rigid body leads the row; what else it knows comes last.
    bool lead = true;
    for (const auto &condition : model->conditions)
      {
        const auto recorded =
          condition->record(*model->state, model->equilibrium->residual());
        const bool leads = lead && dynamic_cast<const RigidBody<dim> *>(
                                     condition.get()) != nullptr;
        const std::size_t n_leading =
          leads ? std::min<std::size_t>(recorded.size(), dim == 2 ? 4 : 7) : 0;
        row.insert(row.end(), recorded.begin(), recorded.begin() + n_leading);
        for (std::size_t i = n_leading; i < recorded.size(); ++i)
          further.emplace_back(name_of(*condition) + recorded[i].first,
                               recorded[i].second);
        lead = lead && !leads;
      }
    row.emplace_back("time step [T]", model->state->last_step);
    row.emplace_back("Newton iterations", mechanics_report.n_iterations);
    if (model->equilibrium->solves_by_iteration())
      row.emplace_back("linear iterations",
                       mechanics_report.n_linear_iterations);
    row.emplace_back("rejected attempts", rejected_attempts);
    unsigned int n_limited = 0;
    for (const auto &entry : step_control.limited())
      n_limited += entry.second;
    row.emplace_back("limited steps", n_limited);
    row.emplace_back("smallest scaled Jacobian",
                     quality.smallest_scaled_jacobian);
    row.emplace_back("inverted corners", quality.n_inverted_corners);
    if (bone_mass)
      {
        const auto density = bone_mass->extremes(*model->state);
        row.emplace_back("bone mass [mg]", bone_mass->mass);
        row.emplace_back("bone mass balance", bone_mass->balance());
        row.emplace_back("mass by remodelling [mg]", bone_mass->by_remodelling);
        row.emplace_back("mass by volume change [mg]",
                         bone_mass->by_volume_change);
        row.emplace_back("mass through boundaries [mg]",
                         bone_mass->through_boundary);
        if (scene.remesher)
          row.emplace_back("mass by remeshing [mg]", bone_mass->by_remeshing);
        row.emplace_back("least density [g/cc]", density.first);
        row.emplace_back("greatest density [g/cc]", density.second);
        row.emplace_back("density change [g/cc]",
                         remodelling_report.largest_density_change);
        row.emplace_back("points at least density",
                         remodelling_report.n_at_lower_bound);
        row.emplace_back("points at greatest density",
                         remodelling_report.n_at_upper_bound);
      }
    if (model->rezoner)
      {
        row.emplace_back("swept fraction", swept_fraction);
        row.emplace_back("limited values", totals.limited);
      }
    row.emplace_back("points beyond bounds", findings.n_beyond_bounds);
    if (remesh_plan)
      row.emplace_back("remeshes", remesh_plan->n_remeshes());
    if (reference_outline)
      {
        const std::vector<double> errors = reference_volume_errors();
        const auto                list = model->reference_map->region_indices();
        for (unsigned int i = 0; i < list.size(); ++i)
          row.emplace_back("volume error at rest of " +
                             model->regions[list[i]].name,
                           errors[i]);
      }
    row.emplace_back("stored energy [mJ]", mechanics_report.energy);
    if (energy_books)
      for (const auto &value : energy_books->record(*model))
        row.push_back(value);
    const auto seconds = phase_seconds();
    for (const char *const phase : phases)
      row.emplace_back(std::string(phase) + " [s]", seconds.at(phase));
    row.insert(row.end(), further.begin(), further.end());
    for (const auto &recorder : model->scene->recorders)
      for (const auto &value :
           recorder.object->record(*model->state,
                                   model->equilibrium->residual()))
        row.emplace_back(recorder.name + ": " + value.first, value.second);
    if (scene.solver.report_imbalance)
      row.emplace_back("imbalance before step", mechanics_report.imbalance);
    return row;
  }



  template <int dim>
  void
  Simulation<dim>::write_fields(const bool always)
  {
    if (!field_writer || model->state->time == last_field_time)
      return;
    const bool due = scene.field_interval > 0. &&
                     model->state->time >= next_field_time * (1. - 1e-12);
    if (!always && !due)
      return;
    TimerOutput::Scope scope(timer, "output");
    field_writer->write(*model->state, model->regions);
    last_field_time = model->state->time;
    while (scene.field_interval > 0. &&
           next_field_time <= model->state->time * (1. + 1e-12))
      next_field_time += scene.field_interval;
  }



  template <int dim>
  void
  Simulation<dim>::report_progress()
  {
    const double elapsed = wall_before + wall_clock.wall_time();
    const double left =
      elapsed * (scene.time.end - model->state->time) / model->state->time;
    char line[200];
    std::snprintf(line,
                  sizeof(line),
                  "t = %9.4f T (%5.1f %%)  step %5u  dt %8.2e  Newton %2u  "
                  "quality %6.3f  rejected %u  left %.0f s",
                  model->state->time,
                  100. * model->state->time / scene.time.end,
                  totals.steps,
                  model->state->last_step,
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
      Utilities::MPI::sum(model->state->history.memory_consumption(),
                          communicator);
    nlohmann::ordered_json summary;
    summary["completed"] = completed;
    summary["reason"]    = reason;
    summary["title"]     = scene.title;
    if (scene.accuracy().used())
      summary["accuracy"] = scene.accuracy().chosen();
    summary["time"]              = model->state->time;
    summary["steps"]             = totals.steps;
    summary["rejected attempts"] = totals.rejected;
    for (const auto &[cause, n] : step_control.rejections())
      summary["rejected attempts by cause"][cause] = n;
    for (const auto &[cause, n] : step_control.limited())
      summary["steps limited by"][cause] = n;
    summary["quality warnings"]         = totals.quality_warnings;
    summary["steps ended by round-off"] = totals.at_round_off;
    summary["Newton iterations"]        = totals.iterations;
    summary["Newton iterations per step"] =
      totals.steps > 0 ? static_cast<double>(totals.iterations) / totals.steps
                       : 0.;
    summary["most Newton iterations of a step"] =
      totals.max_iterations_of_a_step;
    summary["last residual history"]     = mechanics_report.residuals;
    summary["smallest scaled Jacobian"]  = totals.smallest_quality;
    summary["inverted corners"]          = quality.n_inverted_corners;
    summary["limited values"]            = totals.limited;
    summary["most points beyond bounds"] = totals.most_beyond_bounds;
    if (model->rezoner)
      {
        summary["rezonings cut back"]      = totals.cut_back;
        summary["steps not rezoned"]       = totals.skipped_rezonings;
        summary["rezonings not converged"] = totals.unconverged_rezonings;
        summary["transfer sub-cycles"]     = totals.subcycles;
      }
    if (remesh_plan)
      summary["remeshes"] = remesh_plan->n_remeshes();
    if (bone_mass)
      {
        summary["bone mass [mg]"]               = bone_mass->mass;
        summary["initial bone mass [mg]"]       = bone_mass->initial;
        summary["mass by remodelling [mg]"]     = bone_mass->by_remodelling;
        summary["mass by volume change [mg]"]   = bone_mass->by_volume_change;
        summary["mass through boundaries [mg]"] = bone_mass->through_boundary;
        if (scene.remesher)
          summary["mass by remeshing [mg]"] = bone_mass->by_remeshing;
        summary["bone mass balance"] = bone_mass->balance();
      }
    if (energy_books)
      for (const auto &[name, value] : energy_books->totals())
        summary["energy"][name] = value;
    summary["cells"]    = model->mesh.triangulation->n_global_active_cells();
    summary["unknowns"] = model->state->configuration.dof_handler.n_dofs();
    summary["history [bytes]"]  = history_bytes;
    summary["peak memory [kB]"] = peak;
    const double wall_time      = wall_before + wall_clock.wall_time();
    summary["wall time [s]"]    = wall_time;
    const auto seconds          = phase_seconds();
    for (const char *const phase : phases)
      summary["seconds per phase"][phase] = seconds.at(phase);
    // Of this process since its start, also where others want the processor
    const auto cpu = timer.get_summary_data(TimerOutput::total_cpu_time);
    for (const auto &phase : cpu)
      summary["CPU seconds per phase"][phase.first] = phase.second;
    summary["checkpoint"] = last_checkpoint.file;
    summary["processes"]  = Utilities::MPI::n_mpi_processes(communicator);
    summary["threads"]    = MultithreadInfo::n_threads();
    summary["versions"]["alveolus"] = ALVEOLUS_VERSION;
    summary["versions"]["deal.II"]  = DEAL_II_PACKAGE_VERSION;
    // Whatever bytes a title or a message holds
    const auto quiet = nlohmann::ordered_json::error_handler_t::replace;
    on_first_process<RunError>(communicator, [&]() {
      write_text_file(scene.output_directory + "/summary.json",
                      summary.dump(2, ' ', false, quiet) + "\n");
    });
    if (completed)
      log.say("Completed in " + number(wall_time, 4) +
              " s: " + std::to_string(totals.steps) + " steps, " +
              std::to_string(totals.iterations) + " Newton iterations, " +
              std::to_string(totals.rejected) +
              " rejected attempts, smallest scaled Jacobian " +
              number(totals.smallest_quality, 4));
  }

  template std::map<std::string, double>
  Simulation<2>::phase_seconds() const;
  template std::map<std::string, double>
  Simulation<3>::phase_seconds() const;
  template HistoryFile::Row
  Simulation<2>::history_row();
  template HistoryFile::Row
  Simulation<3>::history_row();
  template void
  Simulation<2>::write_history();
  template void
  Simulation<3>::write_history();
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
