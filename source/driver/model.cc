// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/problems.h>
#include <alveolus/driver/messages.h>
#include <alveolus/driver/model.h>

#include <deal.II/base/utilities.h>
#include <deal.II/fe/fe_values.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  Model<dim>::Model(
    std::shared_ptr<Scene<dim>>                                   scene_object,
    Mesh<dim>                                                     mesh_object,
    TimerOutput                                                  &timer,
    const std::function<NodalVector(const Configuration<dim> &)> &positions)
    : scene(std::move(scene_object))
    , mesh(std::move(mesh_object))
  {
    make_state();
    if (positions)
      {
        attached_at =
          std::make_unique<NodalVector>(positions(state->configuration));
        state->configuration.set_positions(*attached_at);
      }
    // All problems at once, not one for each run
    Problems problems;
    for (auto &condition : scene->conditions)
      {
        problems.collect([&]() {
          condition.object->choose_interface_law(scene->interface_laws,
                                                 condition.where);
          condition.object->attach(*state, condition.where);
        });
        conditions.push_back(std::move(condition.object));
      }
    for (auto &recorder : scene->recorders)
      problems.collect([&]() {
        recorder.object->offer_regions(regions);
        recorder.object->attach(*state, recorder.where);
      });
    if (!scene->rezoning_rules.empty())
      problems.collect([&]() { make_rezoning(); });
    problems.throw_if_any();

    equilibrium = std::make_unique<Equilibrium<dim>>(
      *state, regions, conditions, scene->solver, timer);
    staggered_step = std::make_unique<StaggeredStep<dim>>(
      *state, *equilibrium, remodelling, scene->coupling, timer);

    if (rezoner || scene->remesher)
      {
        make_reference_map();
        for (unsigned int r = 0; r < regions.size(); ++r)
          if (regions[r].mean_dilatation)
            projected_regions.insert(r);
        if (!projected_regions.empty())
          {
            if (!rezoner)
              sub_cells = std::make_unique<SubCells<dim>>(
                state->configuration, [&](const unsigned int cell) {
                  return state->history.region(cell);
                });
            trace_projection = std::make_unique<TraceProjection<dim>>(
              rezoner ? swept_transfer->subcells() : *sub_cells);
          }
      }
  }



  template <int dim>
  void
  Model<dim>::make_state()
  {
    std::map<types::material_id, unsigned int> region_of_material;
    std::vector<HistoryLayout>                 layouts;
    Problems                                   problems;
    for (unsigned int r = 0; r < scene->regions.size(); ++r)
      {
        const auto &definition = scene->regions[r];
        for (const auto &name :
             Utilities::split_string_list(definition.on, ','))
          problems.collect([&]() {
            for (const auto id :
                 mesh.names.region(name,
                                   "Regions / " + definition.name + " / On"))
              {
                const auto entry = region_of_material.emplace(id, r);
                if (entry.first->second != r)
                  throw InputError("Regions / " + definition.name + " / On",
                                   "cells of '" + name +
                                     "' belong to region '" +
                                     scene->regions[entry.first->second].name +
                                     "', too",
                                   "name each part of the mesh in one region");
              }
          });
        const Material &material =
          *scene->materials[scene->material_of(definition)].object;
        regions.push_back({definition.name,
                           &material,
                           definition.treatment == "mean dilatation"});
        layouts.emplace_back(material.history_fields(), dim);
        const int law = scene->remodelling_of(definition);
        remodelling.push_back(
          law < 0 ? RegionRemodelling{}
                  : RegionRemodelling{scene->remodelling_laws[law].object.get(),
                                      dynamic_cast<const RemodelledBone *>(
                                        &material)});
      }
    problems.throw_if_any();
    state = std::make_unique<State<dim>>(mesh,
                                         scene->degree,
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
  }



  template <int dim>
  void
  Model<dim>::make_rezoning()
  {
    rezoner = std::make_unique<Rezoner<dim>>();
    for (auto &rule : scene->rezoning_rules)
      rezoner->add(std::move(rule.object), rule.where);
    rezoner->attach(state->nodes, state->configuration.positions());
    swept_transfer = std::make_unique<SweptTransfer<dim>>(
      state->configuration,
      state->history,
      Registry<TransferScheme<dim>>::create(scene->transfer_scheme,
                                            "Transfer / Scheme"),
      "density",
      scene->largest_donor_fraction);
    nodal_transfer = std::make_unique<NodalTransfer<dim>>(state->configuration);
    for (auto &condition : conditions)
      if (condition->face_history() != nullptr && !face_transfer)
        face_transfer =
          std::make_unique<FaceTransfer<dim>>(state->configuration);
  }



  template <int dim>
  void
  Model<dim>::make_reference_map()
  {
    std::map<unsigned int, ReferenceMapRegion> mapped;
    for (unsigned int r = 0; r < regions.size(); ++r)
      if (scene->regions[r].deformation != "history")
        mapped[r] = {scene->regions[r].deformation == "reference map",
                     regions[r].mean_dilatation};
    if (!mapped.empty())
      reference_map = std::make_unique<ReferenceMap<dim>>(state->configuration,
                                                          state->history,
                                                          mapped);
  }



  template <int dim>
  unsigned int
  Model<dim>::make_history_admissible()
  {
    if (trace_projection)
      trace_projection->apply(state->history,
                              state->configuration.positions(),
                              projected_regions);
    unsigned int n = 0;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c = cell->active_cell_index();
          for (unsigned int q = 0; q < state->history.n_points; ++q)
            n += regions[state->history.region(c)].material->make_admissible(
              state->history.old_record(c, q));
        }
    if (reference_map)
      reference_map->apply(state->configuration.positions(),
                           state->displacement,
                           state->history);
    return Utilities::MPI::sum(n, state->configuration.communicator());
  }



  template <int dim>
  std::vector<double>
  Model<dim>::measures() const
  {
    const auto         &configuration = state->configuration;
    const QGauss<dim>   quadrature(configuration.degree + 1);
    FEValues<dim>       fe_values(configuration.mapping(),
                            configuration.fe,
                            quadrature,
                            update_JxW_values);
    std::vector<double> result(regions.size(), 0.);
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          fe_values.reinit(cell);
          for (unsigned int q = 0; q < quadrature.size(); ++q)
            result[state->history.region(cell->active_cell_index())] +=
              fe_values.JxW(q);
        }
    for (double &value : result)
      value = Utilities::MPI::sum(value, configuration.communicator());
    return result;
  }

  template class Model<2>;
  template class Model<3>;
} // namespace alveolus
