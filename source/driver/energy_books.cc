// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/driver/energy_books.h>

#include <deal.II/fe/fe_values.h>

#include <array>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    bool
    any_contact(const Model<dim> &model)
    {
      for (const auto &condition : model.conditions)
        if (condition->is_contact())
          return true;
      return false;
    }

    template <int dim>
    bool
    any_layer(const Model<dim> &model)
    {
      for (const auto &condition : model.conditions)
        if (condition->is_layer())
          return true;
      return false;
    }
  } // namespace



  template <int dim>
  EnergyBooks<dim>::EnergyBooks(Model<dim> &model)
  {
    model.staggered_step->book_energy();
    take_stock(model);
    sum.initial = sum.stored;
  }



  template <int dim>
  double
  EnergyBooks<dim>::stored_in_cells(const Model<dim> &model) const
  {
    const State<dim>         &state         = *model.state;
    const Configuration<dim> &configuration = state.configuration;
    const HistoryStore<dim>  &history       = state.history;
    const QGauss<dim>         quadrature(configuration.degree + 1);
    FEValues<dim>             fe_values(configuration.mapping(),
                            configuration.fe,
                            quadrature,
                            update_JxW_values);
    const Tensor<2, 3>        at_rest(unit_symmetric_tensor<3>());
    std::vector<double>       trial;
    MaterialResponse          response;
    response.no_flow = true; // which the next step books
    double energy    = 0.;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c        = cell->active_cell_index();
          const unsigned int region   = history.region(c);
          const Material    &material = *model.regions[region].material;
          trial.resize(history.layout(region).size);
          fe_values.reinit(cell);
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              const double *record = history.old_record(c, q);
              material.evaluate(at_rest, record, trial.data(), false, response);
              energy += response.energy * fe_values.JxW(q) /
                        material.volume_ratio(record);
            }
        }
    return Utilities::MPI::sum(energy, configuration.communicator());
  }



  template <int dim>
  double
  EnergyBooks<dim>::stored_in_layers(const Model<dim> &model) const
  {
    if (!any_layer(model))
      return 0.;
    double energy = 0.;
    for (const auto &condition : model.conditions)
      energy += condition->stored_energy(*model.state);
    return Utilities::MPI::sum(energy,
                               model.state->configuration.communicator());
  }



  template <int dim>
  NodalVector
  EnergyBooks<dim>::contact_forces(Model<dim>        &model,
                                   const NodalVector &increment) const
  {
    NodalVector forces(model.state->configuration.make_vector());
    forces = 0.;
    const AssemblyTarget target{forces};
    for (auto &condition : model.conditions)
      if (condition->is_contact())
        condition->add_forces(*model.state, increment, target);
    forces.compress(VectorOperation::add);
    return forces;
  }



  template <int dim>
  void
  EnergyBooks<dim>::begin(Model<dim> &model)
  {
    if (begun)
      return;
    const AssemblyResult result = model.equilibrium->assemble_committed();
    if (!result.good)
      throw RunError("t = " + std::to_string(model.state->time) + " T",
                     result.reason,
                     "reduce the time step");
    internal = model.equilibrium->assembly().internal_forces;
    residual = model.equilibrium->residual();
    if (any_contact(model))
      {
        NodalVector none(model.state->configuration.make_vector());
        contact = contact_forces(model, none);
      }
    for (auto &condition : model.conditions)
      if (condition->is_layer())
        condition->begin_work();
    begun = true;
  }



  template <int dim>
  void
  EnergyBooks<dim>::book_step(Model<dim>               &model,
                              const EquilibriumReport  &mechanics,
                              const RemodellingSummary &remodelling)
  {
    const Equilibrium<dim> &solver       = *model.equilibrium;
    const NodalVector      &du           = solver.increment;
    const NodalVector      &new_internal = solver.assembly().internal_forces;
    const NodalVector      &new_residual = solver.residual();
    const IndexSet         &owned = model.state->configuration.locally_owned;

    // Work along du: of all conditions' forces on the mesh, of supports, of
    // what is out of balance, of contact; then of layers
    std::array<double, 8> work{};
    unsigned int          k = 0;
    for (const auto i : owned)
      {
        const double x = 0.5 * du.local_element(k);
        const double R =
          residual.local_element(k) + new_residual.local_element(k);
        work[0] +=
          x * (internal.local_element(k) + new_internal.local_element(k) - R);
        work[solver.is_held(i) ? 1 : 2] += x * R;
        ++k;
      }
    if (any_contact(model))
      {
        const NodalVector now = contact_forces(model, du);
        for (k = 0; k < owned.n_elements(); ++k)
          work[3] += 0.5 * du.local_element(k) *
                     (contact.local_element(k) + now.local_element(k));
      }
    for (const auto &condition : model.conditions)
      if (condition->is_layer())
        {
          const LayerWork layer = condition->layer_work(*model.state, du);
          work[4] += layer.by_body;
          work[5] += layer.on_boundary;
          work[6] += layer.stored_before;
          work[7] += layer.stored_after;
        }
    for (double &w : work)
      w = Utilities::MPI::sum(w, model.state->configuration.communicator());

    // The contact forces on the bodies are minus those in the residual.
    book(sum.external, work[0] + work[3] - work[5] + work[1] + work[4]);
    book(sum.unbalanced, work[2]);
    book(sum.contact, work[3]);
    book(sum.dissipated, mechanics.dissipation);

    // What the step itself stores, and what remodelling and the new weights of
    // the points change
    const double moved    = mechanics.energy_moved + remodelling.stored_moved;
    const bool   iterated = model.scene->coupling.coupling == "iterated";
    const double update   = iterated
                              ? moved - mechanics.energy - remodelling.stored
                              : mechanics.energy_moved - mechanics.energy;
    book(sum.remodelling, remodelling.energy);
    book(sum.update, update);
    const double layers = work[7] - work[6];
    sum.changes += std::abs(moved - in_cells - update - remodelling.energy) +
                   std::abs(layers);
    in_cells = moved;
    sum.layers += layers;
    sum.stored = in_cells + sum.layers;
    begun      = false;
  }



  template <int dim>
  void
  EnergyBooks<dim>::book_commit(const Model<dim> &model)
  {
    if (any_layer(model))
      {
        const double layers = stored_in_layers(model);
        book(sum.update, layers - sum.layers);
        sum.layers = layers;
        sum.stored = in_cells + layers;
      }
    sum.worst = std::max(sum.worst, std::abs(balance()));
  }



  template <int dim>
  double
  EnergyBooks<dim>::take_stock(const Model<dim> &model)
  {
    const double before = sum.stored;
    in_cells            = stored_in_cells(model);
    sum.layers          = stored_in_layers(model);
    sum.stored          = in_cells + sum.layers;
    begun               = false;
    return sum.stored - before;
  }



  template <int dim>
  void
  EnergyBooks<dim>::book_transfer(const Model<dim> &model)
  {
    book(sum.transfer, take_stock(model));
  }



  template <int dim>
  void
  EnergyBooks<dim>::book_remesh(Model<dim> &model)
  {
    model.staggered_step->book_energy();
    book(sum.remeshing, take_stock(model));
  }



  template <int dim>
  double
  EnergyBooks<dim>::check_resultants(const Model<dim> &model,
                                     const double      force_scale)
  {
    const State<dim>       &state    = *model.state;
    const Equilibrium<dim> &solver   = *model.equilibrium;
    const NodalVector      &internal = solver.assembly().internal_forces;
    const NodalVector       x        = state.configuration.positions();
    Tensor<1, 3>            force, moment;
    Point<dim>              least, greatest;
    for (unsigned int d = 0; d < dim; ++d)
      {
        least[d]    = std::numeric_limits<double>::max();
        greatest[d] = -least[d];
      }
    for (const NodeId node : state.nodes.relevant())
      if (state.nodes.is_owned(node))
        {
          // External forces and reactions: internal ones less what is left
          Tensor<1, 3> arm, f;
          for (unsigned int d = 0; d < dim; ++d)
            {
              const auto   dof = state.nodes.dofs(node)[d];
              const double X   = x(dof);
              arm[d]           = X + solver.increment(dof);
              f[d]             = internal(dof);
              if (!solver.is_held(dof))
                f[d] -= solver.residual()(dof);
              least[d]    = std::min(least[d], X);
              greatest[d] = std::max(greatest[d], X);
            }
          force += f;
          moment += cross_product_3d(arm, f);
        }
    const MPI_Comm communicator = state.configuration.communicator();
    force                       = Utilities::MPI::sum(force, communicator);
    moment                      = Utilities::MPI::sum(moment, communicator);
    double       length         = 0.;
    Tensor<1, 3> centre;
    for (unsigned int d = 0; d < dim; ++d)
      {
        const double from = Utilities::MPI::min(least[d], communicator);
        const double to   = Utilities::MPI::max(greatest[d], communicator);
        length            = std::max(length, to - from);
        centre[d]         = 0.5 * (from + to);
      }
    moment -= cross_product_3d(centre, force);
    resultants =
      force_scale > 0.
        ? std::max(force.norm(), moment.norm() / length) / force_scale
        : 0.;
    return resultants;
  }



  template <int dim>
  double
  EnergyBooks<dim>::balance() const
  {
    const double rest = sum.external + sum.unbalanced - sum.contact -
                        sum.dissipated + sum.remodelling + sum.update +
                        sum.transfer + sum.remeshing -
                        (sum.stored - sum.initial);
    return sum.changes > 0. ? rest / sum.changes : 0.;
  }



  template <int dim>
  std::vector<Recorded>
  EnergyBooks<dim>::record(const Model<dim> &model) const
  {
    std::vector<Recorded> row;
    bool                  plastic = false, remodelled = false;
    for (unsigned int r = 0; r < model.regions.size(); ++r)
      {
        plastic = plastic ||
                  model.state->history.layout(r).offset("plastic strain") >= 0;
        remodelled = remodelled || model.remodelling[r].law != nullptr;
      }
    row.emplace_back("external work [mJ]", sum.external);
    row.emplace_back("work of unbalanced forces [mJ]", sum.unbalanced);
    row.emplace_back("elastic energy [mJ]", sum.stored);
    if (any_layer(model))
      row.emplace_back("energy of layers [mJ]", sum.layers);
    if (plastic)
      row.emplace_back("plastic dissipation [mJ]", sum.dissipated);
    if (any_contact(model))
      row.emplace_back("work lost in contact [mJ]", sum.contact);
    if (remodelled)
      row.emplace_back("energy by remodelling [mJ]", sum.remodelling);
    row.emplace_back("energy by update [mJ]", sum.update);
    if (model.rezoner)
      row.emplace_back("energy by transfer [mJ]", sum.transfer);
    if (model.scene->remesher_type != "none")
      row.emplace_back("energy by remeshing [mJ]", sum.remeshing);
    row.emplace_back("energy balance", balance());
    row.emplace_back("resultant of forces", resultants);
    return row;
  }



  template <int dim>
  std::vector<Recorded>
  EnergyBooks<dim>::totals() const
  {
    return {{"external work [mJ]", sum.external},
            {"work of unbalanced forces [mJ]", sum.unbalanced},
            {"elastic energy [mJ]", sum.stored},
            {"initial elastic energy [mJ]", sum.initial},
            {"energy of layers [mJ]", sum.layers},
            {"plastic dissipation [mJ]", sum.dissipated},
            {"work lost in contact [mJ]", sum.contact},
            {"energy by remodelling [mJ]", sum.remodelling},
            {"energy by update [mJ]", sum.update},
            {"energy by transfer [mJ]", sum.transfer},
            {"energy by remeshing [mJ]", sum.remeshing},
            {"sum of absolute changes [mJ]", sum.changes},
            {"energy balance", balance()},
            {"worst energy balance", sum.worst}};
  }



  template <int dim>
  void
  EnergyBooks<dim>::save(BlockFile &blocks) const
  {
    blocks.put("energy books",
               BlockFile::Numbers{sum.external,
                                  sum.unbalanced,
                                  sum.dissipated,
                                  sum.contact,
                                  sum.remodelling,
                                  sum.update,
                                  sum.transfer,
                                  sum.remeshing,
                                  sum.stored,
                                  sum.layers,
                                  sum.initial,
                                  sum.changes,
                                  sum.worst,
                                  in_cells,
                                  resultants});
  }



  template <int dim>
  void
  EnergyBooks<dim>::load(const BlockFile &blocks)
  {
    const auto                    &v = blocks.numbers("energy books");
    const std::array<double *, 15> all{{&sum.external,
                                        &sum.unbalanced,
                                        &sum.dissipated,
                                        &sum.contact,
                                        &sum.remodelling,
                                        &sum.update,
                                        &sum.transfer,
                                        &sum.remeshing,
                                        &sum.stored,
                                        &sum.layers,
                                        &sum.initial,
                                        &sum.changes,
                                        &sum.worst,
                                        &in_cells,
                                        &resultants}};
    if (v.size() != all.size())
      blocks.refuse("energy books", "does not hold 15 numbers");
    for (unsigned int i = 0; i < all.size(); ++i)
      *all[i] = v[i];
    begun = false;
  }

  template class EnergyBooks<2>;
  template class EnergyBooks<3>;
} // namespace alveolus
