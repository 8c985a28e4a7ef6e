// SPDX-License-Identifier: LGPL-2.1-or-later
// What a simulation says of itself before it begins: what is modelled, which
// optional parts are on, and what they cost.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <deal.II/base/multithread_info.h>

#include <cstdio>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** The optional parts of a scene: those it uses with what they are. */
    class Parts
    {
    public:
      void
      add(const std::string &name, const std::string &what)
      {
        if (what.empty())
          off += (off.empty() ? "" : ", ") + name;
        else
          on.emplace_back(name, what);
      }

      std::vector<std::pair<std::string, std::string>> on;
      std::string                                      off;
    };

    /** Adds @p name to a list if @p condition. */
    void
    list(std::string &names, const bool condition, const std::string &name)
    {
      if (condition)
        names += (names.empty() ? "" : ", ") + name;
    }

    /** A label padded to the column where the texts begin. */
    std::string
    label(const std::string &text)
    {
      return "  " + text +
             std::string(text.size() < 12 ? 12 - text.size() : 1, ' ');
    }

    std::string
    megabytes(const double bytes)
    {
      char text[40];
      std::snprintf(text, sizeof(text), "%.1f MB", bytes / 1e6);
      return text;
    }
  } // namespace



  template <int dim>
  void
  Simulation<dim>::describe()
  {
    log.say("Alveolus " ALVEOLUS_VERSION ": " + scene.title);
    log.say(label("mesh") + model->mesh.description + "; degree " +
            std::to_string(scene.degree) + ", " +
            std::to_string(model->state->configuration.dof_handler.n_dofs()) +
            " unknowns");
    if (scene.accuracy().used())
      {
        log.say(label("accuracy") + scene.accuracy().chosen());
        for (const auto &setting : scene.accuracy().settings())
          log.say(label("") + setting);
      }
    for (unsigned int r = 0; r < model->regions.size(); ++r)
      {
        const auto &definition = scene.regions[r];
        log.say(label("region") + definition.name + ": " +
                scene.materials[scene.material_of(definition)].type + ", " +
                (model->regions[r].mean_dilatation ? "mean dilatation"
                                                   : "full integration") +
                ", remodelling " + definition.remodelling + ", " +
                std::to_string(model->state->history.layout(r).size * 2 *
                               model->state->history.n_points *
                               sizeof(double)) +
                " bytes of history per cell");
      }
    for (const auto &condition : model->conditions)
      log.say(label("condition") + condition->describe());
    if (model->rezoner)
      {
        std::string rules;
        for (const auto &rule : scene.rezoning_rules)
          rules += (rules.empty() ? "" : ", ") + rule.name;
        log.say(label("rezoning") + rules + "; transfer " +
                scene.transfer_scheme);
      }
    else
      log.say(label("rezoning") + "off (Lagrangian mesh)");
    if (remesh_plan)
      log.say(label("remeshing") + scene.remesher_type);
    log.say(label("solver") + model->equilibrium->linear_solver_name() + ", " +
            std::to_string(Utilities::MPI::n_mpi_processes(communicator)) +
            " process(es), " + std::to_string(MultithreadInfo::n_threads()) +
            " thread(s)");
    describe_parts();
    describe_cost();
    log.say(label("output") + scene.output_directory);
  }



  template <int dim>
  void
  Simulation<dim>::describe_parts()
  {
    std::string plasticity, remodelling, fabric, dilatation, map, interface,
      contact;
    for (unsigned int r = 0; r < model->regions.size(); ++r)
      {
        const auto &definition = scene.regions[r];
        const auto &layout     = model->state->history.layout(r);
        list(plasticity, layout.offset("plastic strain") >= 0, definition.name);
        list(remodelling,
             definition.remodelling != "none",
             definition.name + " by " + definition.remodelling);
        list(fabric, layout.offset("log fabric") >= 0, definition.name);
        list(dilatation, model->regions[r].mean_dilatation, definition.name);
        list(map,
             model->reference_map != nullptr &&
               definition.deformation != "history",
             definition.name);
      }
    for (unsigned int c = 0; c < model->conditions.size(); ++c)
      {
        const std::string &where = model->conditions[c]->where;
        const std::string  name  = where.substr(where.find("/ ") + 2);
        list(interface, model->conditions[c]->face_history() != nullptr, name);
        for (const auto &condition : scene.conditions)
          list(contact,
               condition.type == "contact" && condition.name == name,
               name);
      }
    std::string records;
    for (const auto &recorder : scene.recorders)
      list(records, true, recorder.name);

    Parts parts;
    parts.add("plasticity", plasticity);
    parts.add("remodelling", remodelling);
    parts.add("fabric", fabric);
    parts.add("mean dilatation", dilatation);
    parts.add("interface", interface);
    parts.add("contact", contact);
    parts.add("rezoning",
              model->rezoner
                ? std::to_string(scene.rezoning_rules.size()) + " rules"
                : "");
    parts.add("transfer of history",
              !model->rezoner
                ? ""
                : scene.transfer_scheme + (scene.transfer_scheme == "Godunov"
                                             ? " (first order)"
                                             : ""));
    parts.add("reference map", map);
    parts.add("remeshing", remesh_plan ? scene.remesher_type : "");
    parts.add("records", records);
    parts.add("fields",
              !scene.fields ? ""
              : scene.field_interval > 0.
                ? "every " + number(scene.field_interval) + " T"
                : "first and last");
    parts.add("checkpoints",
              scene.checkpoint.write
                ? "every " + number(scene.checkpoint.wall_interval) + " s"
                : "");
    for (const auto &part : parts.on)
      log.say(label("on") + part.first + ": " + part.second);
    if (!parts.off.empty())
      log.say(label("off") + parts.off);
  }



  template <int dim>
  void
  Simulation<dim>::describe_cost()
  {
    const auto sum = [&](const std::size_t mine) {
      return Utilities::MPI::sum(static_cast<double>(mine), communicator);
    };
    LinearSystem &system   = model->equilibrium->linear_system();
    const double  n_dofs   = model->state->configuration.dof_handler.n_dofs();
    const double  cells    = model->mesh.triangulation->n_global_active_cells();
    const double  nonzeros = sum(system.n_nonzeros());
    const double  matrix   = sum(system.memory_consumption());
    const double  factors  = sum(system.expected_factor_bytes());
    const double  history  = sum(model->state->history.memory_consumption());
    const double  shapes =
      sum(model->equilibrium->assembly().step_geometry().memory_consumption());
    // d, X, u, du, the increment, forces, residual, lifted, correction, trial
    const double vectors = 10. * sizeof(double) * n_dofs;

    char text[200];
    std::snprintf(text,
                  sizeof(text),
                  "%.0f unknowns, %.0f nonzeros in the matrix (%.1f a row)",
                  n_dofs,
                  nonzeros,
                  nonzeros / n_dofs);
    log.say(label("cost") + text);
    log.say(
      label("") +
      "memory: " + (matrix > 0. ? "matrix " + megabytes(matrix) + ", " : "") +
      (factors > 0. ? "its factors about " + megabytes(factors) + ", " : "") +
      "history " + megabytes(history) + ", shape gradients " +
      megabytes(shapes) + ", vectors " + megabytes(vectors));
    std::snprintf(text,
                  sizeof(text),
                  "together about %.0f bytes a cell, besides mesh, libraries "
                  "and whatever rezoning and remeshing hold",
                  (matrix + factors + history + shapes + vectors) / cells);
    log.say(label("") + text);
  }

  template void
  Simulation<2>::describe();
  template void
  Simulation<3>::describe();
  template void
  Simulation<2>::describe_parts();
  template void
  Simulation<3>::describe_parts();
  template void
  Simulation<2>::describe_cost();
  template void
  Simulation<3>::describe_cost();
} // namespace alveolus
