// SPDX-License-Identifier: LGPL-2.1-or-later
// Checkpoints: what of a simulation is saved, and how a run goes on.
#include <alveolus/base/interrupt.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/mesh/mesh_record.h>
#include <alveolus/scene/settings.h>

#include <filesystem>
#include <sstream>

namespace alveolus
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const std::string version =
      "alveolus " ALVEOLUS_VERSION ", deal.II " DEAL_II_PACKAGE_VERSION;
  } // namespace



  template <int dim>
  Mesh<dim>
  Simulation<dim>::first_mesh()
  {
    Mesh<dim> mesh =
      resumed && resumed->has("mesh/cells")
        ? load_mesh<dim>(*resumed, communicator)
        : scene.mesh_source->create(communicator,
                                    ".", // paths are resolved already
                                    scene.output_directory);
    if (resumed && fingerprint(mesh) != resumed->integer("mesh/fingerprint"))
      throw InputError(resumed->source,
                       "the mesh made now (" + mesh.description +
                         ") is not the one of the checkpoint",
                       "resume with the same mesh file and the same versions "
                       "of programs");
    return mesh;
  }



  template <int dim>
  std::function<NodalVector(const Configuration<dim> &)>
  Simulation<dim>::first_positions() const
  {
    static const std::string name = "mesh/attached at";
    if (!resumed || !resumed->has(name))
      return {};
    return [this](const Configuration<dim> &configuration) {
      NodalVector x = configuration.make_vector();
      PortableFields<dim>(configuration).load(*resumed, name, x);
      x.update_ghost_values();
      return x;
    };
  }



  template <int dim>
  void
  Simulation<dim>::save_checkpoint()
  {
    const State<dim>  &state      = *model->state;
    const unsigned int n_remeshes = remesh_plan ? remesh_plan->n_remeshes() : 0;
    if (last_checkpoint.steps == totals.steps &&
        last_checkpoint.rejected == totals.rejected &&
        last_checkpoint.remeshes == n_remeshes)
      return; // nothing new
    TimerOutput::Scope scope(timer, "output");
    last_checkpoint.failed = true; // until it is written
    if (!portable)
      portable = std::make_unique<PortableFields<dim>>(state.configuration);

    BlockFile blocks;
    blocks.put("program", version);
    std::ostringstream resolved;
    scene.write_resolved(resolved);
    save_settings(scene.parameter_text(), resolved.str(), blocks);

    // A refined first mesh is made again by its source: it may have curved
    // manifolds or ids that coarse cells do not tell.
    blocks.put_integer("mesh/fingerprint", fingerprint(model->mesh));
    if (n_remeshes > 0 || model->mesh.triangulation->n_global_levels() == 1)
      {
        if (can_be_stored(model->mesh))
          save_mesh(model->mesh, blocks);
        else if (n_remeshes > 0)
          throw RunError("checkpoint",
                         "the mesh of the last remesh has curved manifolds",
                         "set `Checkpoint / Write = false` with this remesher");
      }

    if (model->attached_at)
      portable->save(*model->attached_at, "mesh/attached at", blocks);
    portable->save(state.configuration.mesh_displacement(),
                   "state/mesh displacement",
                   blocks);
    portable->save(state.displacement, "state/displacement", blocks);
    portable->save(state.increment, "state/increment", blocks);
    portable->save(state.history, "state/history", blocks);
    blocks.put_number("state/time", state.time);
    blocks.put_number("state/last step", state.last_step);
    for (const auto &condition : model->conditions)
      condition->save(*portable, condition->where + " / ", blocks);

    step_control.save(blocks);
    if (remesh_plan)
      remesh_plan->save(blocks);
    if (bone_mass)
      bone_mass->save(*portable, blocks);
    if (energy_books)
      energy_books->save(blocks);
    if (reference_outline)
      {
        reference_outline->save(blocks);
        blocks.put("reference outline/volumes", reference_volumes);
      }

    blocks.put("totals",
               BlockFile::Integers{totals.steps,
                                   totals.rejected,
                                   totals.iterations,
                                   totals.limited,
                                   totals.cut_back,
                                   totals.subcycles,
                                   totals.unconverged_rezonings,
                                   totals.max_iterations_of_a_step,
                                   rejected_attempts});
    blocks.put("totals/bounds",
               BlockFile::Integers{totals.most_beyond_bounds,
                                   findings.n_beyond_bounds});
    blocks.put("extremes",
               BlockFile::Numbers{totals.smallest_quality,
                                  totals.largest_transfer_error});
    blocks.put("totals/further",
               BlockFile::Integers{totals.skipped_rezonings,
                                   totals.quality_warnings,
                                   quality_is_low ? 1u : 0u});
    blocks.put("totals/round-off", BlockFile::Integers{totals.at_round_off});
    blocks.put("last step/limits",
               BlockFile::Numbers{swept_fraction,
                                  remodelling_report.largest_density_change});
    if (rezoning_start)
      portable->save(*rezoning_start, "rezoning/start", blocks);
    blocks.put("last step/residuals", mechanics_report.residuals);
    blocks.put("last step/mechanics",
               BlockFile::Numbers{mechanics_report.energy,
                                  mechanics_report.imbalance});
    blocks.put("last step/counts",
               BlockFile::Integers{mechanics_report.n_iterations,
                                   remodelling_report.n_at_lower_bound,
                                   remodelling_report.n_at_upper_bound});

    std::string        names;
    BlockFile::Numbers values;
    for (const auto &[name, value] : last_row)
      {
        names += name + '\n';
        values.push_back(value);
      }
    blocks.put("last row/names", std::move(names));
    blocks.put("last row/values", std::move(values));

    blocks.put("fields/when",
               BlockFile::Numbers{next_field_time, last_field_time});
    if (field_writer)
      field_writer->save(blocks);
    BlockFile::Numbers seconds;
    for (const auto &phase : phase_seconds())
      seconds.push_back(phase.second);
    blocks.put("seconds/phases", std::move(seconds));
    blocks.put_number("seconds/all", wall_before + wall_clock.wall_time());

    std::string file;
    on_first_process<RunError>(communicator, [&]() {
      // What the checkpoint counts on has to be on the disk before it.
      history_file->bring_to_disk();
      blocks.put_integer("files/rows of history", history_file->n_rows());
      blocks.put_integer("files/rows of remeshes",
                         remesh_file ? remesh_file->n_rows() : 0);
      if (remesh_file)
        remesh_file->bring_to_disk();
      file = checkpoints.write(blocks);
    });
    last_checkpoint.file      = Utilities::MPI::broadcast(communicator, file);
    last_checkpoint.steps     = totals.steps;
    last_checkpoint.rejected  = totals.rejected;
    last_checkpoint.remeshes  = n_remeshes;
    last_checkpoint.wall_time = wall_clock.wall_time();
    last_checkpoint.failed    = false;
    log.note("t = " + number(state.time, 8) + " T: checkpoint " +
             last_checkpoint.file);
  }



  template <int dim>
  void
  Simulation<dim>::restore()
  {
    const BlockFile &blocks = *resumed;
    State<dim>      &state  = *model->state;
    portable = std::make_unique<PortableFields<dim>>(state.configuration);

    NodalVector v = state.configuration.make_vector();
    portable->load(blocks, "state/mesh displacement", v);
    state.configuration.set_mesh_displacement(v);
    portable->load(blocks, "state/displacement", state.displacement);
    portable->load(blocks, "state/increment", state.increment);
    portable->load(blocks, "state/history", state.history);
    state.time      = blocks.number("state/time");
    state.last_step = blocks.number("state/last step");
    for (auto &condition : model->conditions)
      condition->load(*portable, condition->where + " / ", blocks);

    step_control.load(blocks);
    if (remesh_plan && blocks.has("remesh plan/accepted"))
      remesh_plan->load(blocks);
    if (bone_mass)
      bone_mass->load(*portable, blocks);
    if (energy_books && blocks.has("energy books"))
      energy_books->load(blocks);

    const auto &t = blocks.integers("totals");
    if (t.size() != 9)
      blocks.refuse("totals", "does not hold 9 integers");
    totals.steps                    = t[0];
    totals.rejected                 = t[1];
    totals.iterations               = t[2];
    totals.limited                  = t[3];
    totals.cut_back                 = t[4];
    totals.subcycles                = t[5];
    totals.unconverged_rezonings    = t[6];
    totals.max_iterations_of_a_step = t[7];
    rejected_attempts               = t[8];
    // Not in checkpoints of earlier versions
    if (blocks.has("totals/bounds"))
      {
        const auto &bounds = blocks.integers("totals/bounds");
        if (bounds.size() != 2)
          blocks.refuse("totals/bounds", "does not hold 2 integers");
        totals.most_beyond_bounds = bounds[0];
        findings.n_beyond_bounds  = bounds[1];
      }
    if (blocks.has("totals/further"))
      {
        const auto &further = blocks.integers("totals/further");
        const auto &limits  = blocks.numbers("last step/limits");
        if (further.size() != 3)
          blocks.refuse("totals/further", "does not hold 3 integers");
        if (limits.size() != 2)
          blocks.refuse("last step/limits", "does not hold 2 numbers");
        totals.skipped_rezonings                  = further[0];
        totals.quality_warnings                   = further[1];
        quality_is_low                            = further[2] != 0;
        swept_fraction                            = limits[0];
        remodelling_report.largest_density_change = limits[1];
      }
    if (blocks.has("totals/round-off"))
      {
        const auto &n = blocks.integers("totals/round-off");
        if (n.size() != 1)
          blocks.refuse("totals/round-off", "does not hold an integer");
        totals.at_round_off = n[0];
      }
    if (blocks.has("rezoning/start"))
      {
        rezoning_start =
          std::make_unique<NodalVector>(state.configuration.make_vector());
        portable->load(blocks, "rezoning/start", *rezoning_start);
        rezoning_start->update_ghost_values();
      }
    const auto &extremes  = blocks.numbers("extremes");
    const auto &mechanics = blocks.numbers("last step/mechanics");
    const auto &counts    = blocks.integers("last step/counts");
    const auto &when      = blocks.numbers("fields/when");
    const auto &seconds   = blocks.numbers("seconds/phases");
    if (extremes.size() != 2)
      blocks.refuse("extremes", "does not hold 2 numbers");
    if (mechanics.size() != 2)
      blocks.refuse("last step/mechanics", "does not hold 2 numbers");
    if (counts.size() != 3)
      blocks.refuse("last step/counts", "does not hold 3 integers");
    if (when.size() != 2)
      blocks.refuse("fields/when", "does not hold 2 numbers");
    totals.smallest_quality             = extremes[0];
    totals.largest_transfer_error       = extremes[1];
    mechanics_report.residuals          = blocks.numbers("last step/residuals");
    mechanics_report.energy             = mechanics[0];
    mechanics_report.imbalance          = mechanics[1];
    mechanics_report.n_iterations       = counts[0];
    remodelling_report.n_at_lower_bound = counts[1];
    remodelling_report.n_at_upper_bound = counts[2];
    next_field_time                     = when[0];
    last_field_time                     = when[1];
    quality                             = model->quality();

    std::istringstream names(blocks.text("last row/names"));
    std::string        name;
    for (const double value : blocks.numbers("last row/values"))
      {
        if (!std::getline(names, name))
          blocks.refuse("last row/names", "is shorter than the values");
        last_row.emplace_back(name, value);
      }

    std::size_t next = 0;
    for (const auto &phase : phase_seconds())
      if (next < seconds.size())
        seconds_before[phase.first] = seconds[next++];
    wall_before = blocks.number("seconds/all");

    last_checkpoint.file     = blocks.source;
    last_checkpoint.steps    = totals.steps;
    last_checkpoint.rejected = totals.rejected;
    last_checkpoint.remeshes = remesh_plan ? remesh_plan->n_remeshes() : 0;
    if (blocks.text("program") != version)
      log.say("The checkpoint was written by " + blocks.text("program") +
              ", this is " + version + ": results may differ");
  }



  template <int dim>
  void
  Simulation<dim>::open_files()
  {
    const std::string &folder   = scene.output_directory;
    const std::string  history  = folder + "/history.csv";
    const std::string  remeshes = folder + "/remeshes.csv";
    if (scene.fields)
      field_writer = std::make_unique<FieldWriter<dim>>(folder);
    if (!resumed)
      {
        on_first_process<InputError>(communicator, [&]() {
          std::error_code ignored;
          fs::remove(remeshes, ignored);
          remove_unfinished(folder);
          checkpoints.clear();
          history_file = std::make_unique<HistoryFile>(history);
        });
        return;
      }

    log.say("Resumed from " + resumed->source +
            " at t = " + number(model->state->time, 8) + " T, step " +
            std::to_string(totals.steps));
    const HistoryFile::Row row = history_row(); // collective
    std::string            news;
    bool                   elsewhere = false;
    on_first_process<InputError>(communicator, [&]() {
      std::error_code ignored;
      remove_unfinished(folder);
      const fs::path origin =
        fs::path(resumed->source).parent_path().parent_path();
      elsewhere =
        !fs::equivalent(origin.empty() ? "." : origin, folder, ignored);
      if (elsewhere)
        {
          checkpoints.clear();
          for (const std::string name : {"history.csv", "remeshes.csv"})
            {
              fs::remove(folder + "/" + name, ignored);
              fs::copy_file(origin / name, folder + "/" + name, ignored);
            }
        }
      checkpoints.go_on_from(resumed->source);
      history_file = std::make_unique<HistoryFile>(
        history, resumed->integer("files/rows of history"));
      const std::string difference = history_file->difference(row);
      if (!difference.empty() && elsewhere)
        {
          news         = history + " begins anew: " + difference;
          history_file = std::make_unique<HistoryFile>(history);
        }
      else if (!difference.empty())
        throw InputError(history,
                         difference,
                         "choose another folder by `--output`");
      else if (history_file->missing_rows() > 0)
        news = history + " has lost " +
               std::to_string(history_file->missing_rows()) +
               " rows of the time before";
      const unsigned int n_remeshes =
        resumed->integer("files/rows of remeshes");
      if (n_remeshes > 0)
        remesh_file = std::make_unique<HistoryFile>(remeshes, n_remeshes);
      else
        fs::remove(remeshes, ignored);
    });
    if (!news.empty())
      log.say("  " + news);
    elsewhere = Utilities::MPI::broadcast(communicator, elsewhere ? 1 : 0) != 0;
    if (elsewhere)
      last_checkpoint.steps = numbers::invalid_unsigned_int; // none here yet
    // Fields of the time before stay in their folder.
    if (field_writer && !elsewhere && resumed->has("fields/files"))
      field_writer->load(*resumed);
    resumed.reset();
  }



  template <int dim>
  int
  Simulation<dim>::pause()
  {
    const auto &when = scene.checkpoint;
    // One process decides by its clock.
    int due = 0;
    if (when.write && when.wall_interval > 0. &&
        Utilities::MPI::this_mpi_process(communicator) == 0 &&
        wall_clock.wall_time() - last_checkpoint.wall_time >=
          when.wall_interval)
      due = 1;
    const int code =
      Utilities::MPI::max(2 * Interrupt::signal() + due, communicator);
    if (code > 1)
      return code / 2; // everything is saved at the end
    const unsigned int last =
      last_checkpoint.steps == numbers::invalid_unsigned_int
        ? 0
        : last_checkpoint.steps;
    if (code == 1 || (when.write && when.step_interval > 0 &&
                      totals.steps >= last + when.step_interval))
      save_checkpoint();
    return 0;
  }

#define INSTANTIATE(dim)                                          \
  template Mesh<dim> Simulation<dim>::first_mesh();               \
  template std::function<NodalVector(const Configuration<dim> &)> \
                Simulation<dim>::first_positions() const;         \
  template void Simulation<dim>::save_checkpoint();               \
  template void Simulation<dim>::restore();                       \
  template void Simulation<dim>::open_files();                    \
  template int  Simulation<dim>::pause();
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
