// SPDX-License-Identifier: LGPL-2.1-or-later
// Replacing the mesh: candidates, transfer by overlap, equilibrium at constant
// load, and what became of it.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <alveolus/transfer/face_overlap.h>

#include <deal.II/base/timer.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  bool
  Simulation<dim>::remesh(const std::string &reason, const bool for_quality)
  {
    TimerOutput::Scope scope(timer, "remeshing");
    const State<dim>  &old   = *model->state;
    const std::string  place = "t = " + number(old.time, 8) + " T";
    const std::string  name =
      "remesh-" + std::to_string(remesh_plan->n_remeshes() + 1);
    log.say(place + ": remesh (" + reason + "), smallest scaled Jacobian " +
            number(quality.smallest_scaled_jacobian, 4));

    Timer                             clock;
    std::vector<RemeshCandidate<dim>> candidates;
    try
      {
        if (!scene.remesher->indicator().empty())
          scene.remesher->tell(cell_means(scene.remesher->indicator()));
        candidates = scene.remesher->candidates(old.configuration,
                                                scene.output_directory,
                                                name);
      }
    catch (const RunError &error)
      {
        log.say("  no mesh: " + std::string(error.what()));
      }
    const double seconds_meshing = clock.wall_time();

    Remeshed best;
    if (!candidates.empty())
      {
        typename OverlapTransfer<dim>::Limits limits;
        limits.uncovered = scene.remesh_plan.uncovered_part;
        const OverlapTransfer<dim> overlap(old.configuration,
                                           old.history,
                                           scene.transfer_scheme,
                                           "density",
                                           limits);
        for (auto &candidate : candidates)
          {
            Remeshed tried;
            try
              {
                tried = try_candidate(std::move(candidate), overlap);
              }
            catch (const RunError &error)
              {
                log.note("  not taken: " + std::string(error.what()));
                continue;
              }
            catch (const InputError &error)
              {
                // E.g. a rule that does not fit the new mesh
                log.note("  not taken: " + std::string(error.what()));
                continue;
              }
            const double found = tried.after.smallest_scaled_jacobian;
            log.note("  " + tried.description + ": quality " +
                     number(tried.before.smallest_scaled_jacobian, 4) +
                     ", in equilibrium " + number(found, 4));
            if (!best.model || found > best.after.smallest_scaled_jacobian)
              best = std::move(tried);
            if (best.after.smallest_scaled_jacobian >=
                scene.remesh_plan.accept_quality)
              break;
          }
      }
    const double reached =
      best.model ? best.after.smallest_scaled_jacobian : -1.;
    if (for_quality && reached < scene.remesh_plan.accept_quality &&
        scene.remesh_plan.if_none_is_acceptable == "stop")
      throw RunError(
        place,
        "the smallest scaled Jacobian is " +
          number(quality.smallest_scaled_jacobian, 4) + ", and " +
          (best.model ? "the best new mesh has " + number(reached, 4) +
                          ", less than `Remeshing / Accept quality`"
                      : std::string("there is no new mesh")),
        "resume with other densities, with a lower `Accept quality`, or with "
        "`If none is acceptable = go on`; or remesh earlier (`Below quality`)");
    // Unless it was quality that asked for it, a remesh may cost a little:
    // where no step is short enough, other elements than the worst ones are the
    // cause
    const double least =
      (for_quality ? 1. : 0.9) * quality.smallest_scaled_jacobian;
    if (!best.model || best.after.smallest_scaled_jacobian <
                         std::min(scene.remesh_plan.accept_quality, least))
      {
        log.say("  the old mesh is kept: no new one is better");
        remesh_plan->tried(old.time, quality.smallest_scaled_jacobian, false);
        return false;
      }

    write_fields(true);
    const std::vector<double> areas_before = model->measures();
    // Not what rejected attempts have left, and the same after a resume
    const HistoryFile::Row row_before =
      last_row.empty() ? history_row() : last_row;
    state_is_whole = false;
    portable.reset(); // numbers the old mesh
    rezoning_start.reset();
    model            = std::move(best.model);
    mechanics_report = best.settling;
    totals.limited += best.transfer.n_limited;
    if (bone_mass)
      {
        auto books = std::make_unique<BoneMass<dim>>(*model->state);
        books->take_over(*bone_mass,
                         best.transfer.content_gained(),
                         best.transfer.content_after());
        bone_mass = std::move(books);
      }
    if (energy_books)
      energy_books->book_remesh(*model);
    remesh_plan->tried(model->state->time,
                       best.after.smallest_scaled_jacobian,
                       true);
    log.say("  taken: " + best.description + ", smallest scaled Jacobian " +
            number(best.after.smallest_scaled_jacobian, 4) + ", settled in " +
            std::to_string(best.n_parts) + " part(s) and " +
            std::to_string(best.settling.n_iterations) +
            " Newton iterations from an imbalance of " +
            number(best.imbalance, 3));
    quality  = best.after;
    findings = check_state(*model->state, model->regions, false);
    if (reference_outline)
      note_reference_volumes();
    if (totals.steps > 0)
      write_history();
    write_remesh(reason, best, areas_before, row_before, seconds_meshing);
    state_is_whole  = true;
    last_field_time = -1.;
    write_fields(true);
    return true;
  }



  template <int dim>
  std::vector<double>
  Simulation<dim>::cell_means(const std::string &quantity) const
  {
    const State<dim>        &state   = *model->state;
    const HistoryStore<dim> &history = state.history;
    const unsigned int  n_cells = model->mesh.triangulation->n_active_cells();
    std::vector<double> result(n_cells, 0.), trial;
    MaterialResponse    response;
    const Tensor<2, 3>  at_rest(unit_symmetric_tensor<3>());
    for (const auto &cell : model->mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int   c      = cell->active_cell_index();
          const HistoryLayout &layout = history.layout(history.region(c));
          const Material      &material =
            *model->regions[history.region(c)].material;
          const int density = layout.offset("density");
          trial.resize(layout.size);
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              const double *record = history.old_record(c, q);
              if (quantity == "density")
                {
                  result[c] +=
                    density < 0 ? 0. : record[density] / history.n_points;
                  continue;
                }
              material.evaluate(at_rest, record, trial.data(), false, response);
              result[c] += response.energy / material.volume_ratio(record) /
                           history.n_points;
            }
        }
    std::vector<std::size_t> begin(n_cells + 1);
    for (unsigned int c = 0; c <= n_cells; ++c)
      begin[c] = c;
    history.ghost_exchange().update(result, begin);
    return result;
  }



  template <int dim>
  typename Simulation<dim>::Remeshed
  Simulation<dim>::try_candidate(RemeshCandidate<dim>        candidate,
                                 const OverlapTransfer<dim> &overlap)
  {
    const State<dim> &old = *model->state;
    Timer             clock;
    Remeshed          result;
    result.description = candidate.description;
    result.model       = std::make_unique<Model<dim>>(scene.another(),
                                                std::move(candidate.mesh),
                                                timer,
                                                candidate.positions);
    Model<dim> &fresh  = *result.model;
    State<dim> &state  = *fresh.state;
    result.transfer    = overlap.transfer(state.configuration, state.history);
    state.displacement = overlap.nodal(old.displacement,
                                       state.configuration,
                                       state.history,
                                       result.transfer);
    state.displacement.update_ghost_values();
    HangingNodes<dim>(state.configuration).distribute(state.displacement);
    if (fresh.reference_map)
      {
        const std::string objection = fresh.reference_map
                                        ->admit(*reference_outline,
                                                state.configuration.positions(),
                                                state.displacement)
                                        .objection();
        if (!objection.empty())
          throw RunError("Transfer",
                         objection,
                         "remesh earlier, or use `Transfer of deformation = "
                         "history`");
      }
    result.transfer.n_limited += fresh.make_history_admissible();
    state.history.trial_values = state.history.old_values;
    state.time                 = old.time;
    for (unsigned int i = 0; i < fresh.conditions.size(); ++i)
      {
        fresh.conditions[i]->take_over(*model->conditions[i]);
        const FaceHistory<dim> *jumps = model->conditions[i]->face_history();
        if (jumps == nullptr)
          continue;
        const FaceTransferReport carried =
          FaceOverlap<dim>(old.configuration, *jumps)
            .transfer(state.configuration,
                      *fresh.conditions[i]->face_history());
        if (carried.n_beyond > 0)
          log.note("  " + fresh.conditions[i]->where + ": " +
                   std::to_string(carried.n_beyond) +
                   " new parts of the boundary lie beyond the old one and take "
                   "its nearest values");
      }
    result.seconds_transfer = clock.wall_time();
    result.before           = fresh.quality();

    clock.restart();
    settle(result);
    const StateFindings settled = check_state(state, fresh.regions, false);
    if (!settled.garbage.empty())
      throw RunError("Remeshing", settled.garbage, "try other densities");
    result.seconds_settling = clock.wall_time();
    result.after            = fresh.quality();
    return result;
  }



  // The forces left unbalanced by the transfer are held and released in parts:
  // all at once if that converges, else in halves. Each part is a Lagrangian
  // step at constant load, followed by rezoning.
  template <int dim>
  void
  Simulation<dim>::settle(Remeshed &candidate)
  {
    Model<dim>       &fresh  = *candidate.model;
    State<dim>       &state  = *fresh.state;
    Equilibrium<dim> &solver = *fresh.equilibrium;
    const Interval    now{state.time, state.time};
    auto              held = solver.imbalance(state.time, candidate.imbalance);
    double            released = 0., part = 1.;
    while (released < 1.)
      {
        const double next = std::min(1., released + part);
        held.part         = 1. - next;
        EquilibriumReport report;
        Verdict           verdict = solver.solve(now, report, &held);
        candidate.settling.n_iterations += report.n_iterations;
        if (!verdict.repeats())
          verdict.combine(judge_corners(fresh));
        if (verdict.repeats())
          {
            part /= 2.;
            if (part < std::pow(0.5, scene.remesh_plan.max_halvings))
              throw RunError("Remeshing",
                             "no equilibrium on the new mesh: " +
                               verdict.reason,
                             "try other densities, or raise `Remeshing / "
                             "Settling halvings`");
            continue;
          }
        const NodalVector start = state.configuration.positions();
        state.accept(solver.increment);
        for (auto &condition : fresh.conditions)
          condition->commit();
        ++candidate.n_parts;
        if (fresh.rezoner && next < 1.)
          rezone(fresh, start, false);
        released = next;
        part *= 2.;
        candidate.settling.residuals = report.residuals;
        candidate.settling.energy    = report.energy;
      }
  }



  template <int dim>
  void
  Simulation<dim>::write_remesh(const std::string         &reason,
                                const Remeshed            &taken,
                                const std::vector<double> &areas_before,
                                const HistoryFile::Row    &row_before,
                                const double               seconds_meshing)
  {
    HistoryFile::Row row;
    row.emplace_back("remesh", remesh_plan->n_remeshes());
    row.emplace_back("time [T]", model->state->time);
    row.emplace_back("cells",
                     model->mesh.triangulation->n_global_active_cells());
    row.emplace_back("quality of the new mesh",
                     taken.before.smallest_scaled_jacobian);
    row.emplace_back("quality in equilibrium",
                     taken.after.smallest_scaled_jacobian);
    row.emplace_back("imbalance", taken.imbalance);
    row.emplace_back("parts", taken.n_parts);
    row.emplace_back("Newton iterations", taken.settling.n_iterations);
    row.emplace_back("limited values", taken.transfer.n_limited);
    row.emplace_back("sub-cells not covered", taken.transfer.n_uncovered);
    row.emplace_back("largest uncovered part",
                     taken.transfer.largest_uncovered_part());
    row.emplace_back("nodes outside", taken.transfer.n_nodes_outside);
    row.emplace_back("their largest distance [mm]",
                     taken.transfer.largest_distance);
    const std::vector<double> areas = model->measures();
    for (unsigned int r = 0; r < areas.size(); ++r)
      row.emplace_back("relative change of " + model->regions[r].name,
                       areas[r] / areas_before[r] - 1.);
    row.emplace_back("meshing [s]", seconds_meshing);
    row.emplace_back("transfer [s]", taken.seconds_transfer);
    row.emplace_back("settling [s]", taken.seconds_settling);
    const HistoryFile::Row row_after = history_row();
    for (unsigned int i = 0; i < row_after.size(); ++i)
      if (row_after[i].first.find("[s]") == std::string::npos)
        {
          row.emplace_back(row_after[i].first + " before",
                           row_before[i].second);
          row.emplace_back(row_after[i].first + " after", row_after[i].second);
        }
    on_first_process<RunError>(communicator, [&]() {
      if (!remesh_file)
        remesh_file = std::make_unique<HistoryFile>(scene.output_directory +
                                                    "/remeshes.csv");
      remesh_file->write(row);
    });
    log.note("remesh " + std::to_string(remesh_plan->n_remeshes()) + " (" +
             reason + "): " + taken.description);
  }

  template bool
  Simulation<2>::remesh(const std::string &, const bool);
  template bool
  Simulation<3>::remesh(const std::string &, const bool);
} // namespace alveolus
