// SPDX-License-Identifier: LGPL-2.1-or-later
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
  Simulation<dim>::Simulation(Scene<dim>     &scene,
                              const MPI_Comm &communicator,
                              Log            &log)
    : scene(scene)
    , communicator(communicator)
    , log(log)
    , timer(std::cout, TimerOutput::never, TimerOutput::wall_times)
    , step_control(scene.time)
  {
    on_first_process<InputError>(communicator, [&]() {
      std::error_code error;
      std::filesystem::create_directories(scene.output_directory, error);
      log.open(scene.output_directory + "/log.txt");
      std::ofstream resolved(scene.output_directory + "/parameters.prm");
      scene.write_resolved(resolved);
      if (!resolved)
        throw InputError(scene.output_directory,
                         "the output folder cannot be written",
                         "choose another `Output / Directory` or `--output`");
    });
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
               mesh.names.region(name,
                                 "Regions / " + definition.name + " / On"))
            region_of_material[id] = r;
        const Material &material =
          *scene.materials[scene.material_of(definition)].object;
        regions.push_back({definition.name,
                           &material,
                           definition.treatment == "mean dilatation"});
        layouts.emplace_back(material.history_fields(), dim);
        const int law = scene.remodelling_of(definition);
        remodelling.push_back(
          law < 0 ? RegionRemodelling{}
                  : RegionRemodelling{scene.remodelling_laws[law].object.get(),
                                      dynamic_cast<const RemodelledBone *>(
                                        &material)});
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

    equilibrium = std::make_unique<Equilibrium<dim>>(
      *state, regions, conditions, scene.solver, timer);
    staggered_step = std::make_unique<StaggeredStep<dim>>(
      *state, *equilibrium, remodelling, scene.coupling, timer);
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
                         number(quality.where[0]) + ", " +
                         number(quality.where[1]) + ") mm");
    totals.smallest_quality = quality.smallest_scaled_jacobian;
  }



  template <int dim>
  bool
  Simulation<dim>::run()
  {
    describe();
    wall_clock.start();
    on_first_process<InputError>(communicator, [&]() {
      history_file =
        std::make_unique<HistoryFile>(scene.output_directory + "/history.csv");
    });
    if (scene.fields)
      field_writer = std::make_unique<FieldWriter<dim>>(scene.output_directory);
    write_fields(true);

    std::string reason;
    try
      {
        while (state->time < scene.time.end * (1. - 1e-12))
          {
            const double   stop = scene.field_interval > 0.
                                    ? std::min(next_field_time, scene.time.end)
                                    : scene.time.end;
            const double   dt   = step_control.next(state->time, stop);
            const Interval interval{
              state->time, dt == stop - state->time ? stop : state->time + dt};

            const Verdict verdict = attempt(interval);
            if (verdict.repeats())
              {
                ++rejected_attempts;
                ++totals.rejected;
                log.note("t = " + number(interval.end, 8) +
                         " T rejected (step " + number(dt, 4) +
                         "): " + verdict.reason);
                if (!step_control.rejected(dt))
                  throw RunError(
                    "t = " + number(state->time, 8) + " T",
                    verdict.reason + " even in the smallest step allowed (" +
                      number(scene.time.minimum_step) + " T)",
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
                "t = " + number(state->time, 8) + " T",
                "the smallest scaled Jacobian is " +
                  number(quality.smallest_scaled_jacobian),
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
    try
      {
        write_fields(true);
      }
    catch (const RunError &error)
      {
        reason += (reason.empty() ? "" : "; ") + std::string(error.what());
      }
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
    Verdict verdict =
      staggered_step->solve(interval, mechanics_report, remodelling_report);
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
    log.note("t = " + number(state->time, 8) + " T accepted, residuals" +
             residuals.str());
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
        log.note("rezoning cut back to " + number(rezoning_report.fraction) +
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
    unsigned int n_limited   = report.n_limited;
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



  template class Simulation<2>;
  template class Simulation<3>;
} // namespace alveolus
