// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/staggered_step.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  StaggeredStep<dim>::Parameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Coupling",
                      coupling,
                      "staggered: equilibrium, then remodelling, once a step; "
                      "iterated: both in turn until the density agrees.",
                      Patterns::Selection("staggered|iterated"));
    prm.add_parameter("Coupling tolerance",
                      coupling_tolerance,
                      "Largest change of density between two iterations of "
                      "iterated coupling [g/cc].",
                      Patterns::Double(1e-14, 1.));
    prm.add_parameter("Maximum coupling iterations",
                      max_coupling_iterations,
                      "Iterations of iterated coupling after which a step is "
                      "repeated with a smaller increment.",
                      Patterns::Integer(1, 1000));
    prm.add_parameter("Local tolerance",
                      local_tolerance,
                      "Error of the time integration at a point, absolute "
                      "[g/cc] and relative.",
                      Patterns::Double(1e-14, 1e-1));
    prm.add_parameter("Maximum density change",
                      max_density_change,
                      "A step that changes the density of a point by more than "
                      "this [g/cc] is repeated with a smaller increment.",
                      Patterns::Double(1e-6));
    prm.add_parameter("Filter length",
                      filter_length,
                      "Length of the Helmholtz filter of the stimulus [mm]; 0 "
                      "is off.",
                      Patterns::Double(0.));
  }



  template <int dim>
  StaggeredStep<dim>::StaggeredStep(
    State<dim>                           &state,
    Equilibrium<dim>                     &equilibrium,
    const std::vector<RegionRemodelling> &remodelling,
    const Parameters                     &parameters,
    TimerOutput                          &timer)
    : state(state)
    , equilibrium(equilibrium)
    , laws(remodelling)
    , parameters(parameters)
    , timer(timer)
  {
    for (const auto &region : laws)
      active = active || region.law != nullptr;
    if (!active)
      return;
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() &&
          laws[state.history.region(cell->active_cell_index())].law != nullptr)
        cells.push_back(cell->active_cell_index());
    points = std::make_unique<PointRemodelling<dim>>(
      state, laws, cells, parameters.local_tolerance);
    if (parameters.filter_length > 0.)
      filter = std::make_unique<HelmholtzFilter<dim>>(state.configuration,
                                                      cells,
                                                      parameters.filter_length);
  }



  template <int dim>
  RemodellingSummary
  StaggeredStep<dim>::remodel(const double dt)
  {
    TimerOutput::Scope scope(timer, "remodelling");
    const unsigned int n_points = state.history.n_points;

    std::vector<double> stimulus;
    if (filter)
      {
        stimulus.reserve(cells.size() * n_points);
        for (const unsigned int cell : cells)
          for (unsigned int q = 0; q < n_points; ++q)
            {
              const auto &region = laws[state.history.region(cell)];
              stimulus.push_back(region.law->stimulus(
                *region.bone,
                region.bone->point(state.history.trial_record(cell, q))));
            }
        filter->apply(equilibrium.assembly().step_geometry(), stimulus);
      }

    return points->advance(dt, filter ? &stimulus : nullptr);
  }



  template <int dim>
  void
  StaggeredStep<dim>::book_energy()
  {
    booked = active;
    if (booked)
      equilibrium.keep_moved_weights();
  }



  template <int dim>
  std::vector<double>
  StaggeredStep<dim>::point_energies(const std::vector<double> &values) const
  {
    const HistoryStore<dim> &history = state.history;
    std::vector<double>      energies;
    energies.reserve(cells.size() * history.n_points);
    for (const unsigned int cell : cells)
      {
        const auto &bone = *laws[history.region(cell)].bone;
        for (unsigned int q = 0; q < history.n_points; ++q)
          energies.push_back(bone.energy(
            bone.point(values.data() + (history.old_record(cell, q) -
                                        history.old_values.data()))));
      }
    return energies;
  }



  // Staggered, the equilibrium saw the density of t_n all the time: the change
  // of the energy comes after it, at the strain of t_{n+1}. Iterated, it saw
  // that of t_{n+1} at the end: the mean of the changes at the strains of both
  // ends is right to second order, as the work of the forces is.
  template <int dim>
  void
  StaggeredStep<dim>::balance(const std::vector<double> &before,
                              const std::vector<double> &seen,
                              const std::vector<double> *iterated,
                              RemodellingSummary        &summary) const
  {
    const HistoryStore<dim>  &history = state.history;
    const auto               &forces  = equilibrium.assembly();
    const std::vector<double> after   = point_energies(history.trial_values);
    const auto               &fe      = state.configuration.fe;
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    unsigned int                         c = 0, i = 0;
    for (const auto &cell :
         state.configuration.dof_handler.active_cell_iterators())
      {
        if (c == cells.size())
          break;
        if (cell->active_cell_index() != cells[c])
          continue;
        const auto   &bone    = *laws[history.region(cells[c])].bone;
        const double *weights = forces.step_geometry().weights(cells[c]);
        cell->get_dof_indices(dofs);
        for (unsigned int q = 0; q < history.n_points; ++q, ++i)
          {
            const double *old = history.old_record(cells[c], q);
            if (iterated != nullptr)
              old = iterated->data() + (old - history.old_values.data());
            const double weight = weights[q] / bone.volume_ratio(old);
            const double moved  = forces.moved_weight(cells[c], q);
            summary.stored += (after[i] - seen[i]) * weight;
            summary.stored_moved += (after[i] - seen[i]) * moved;
            if (iterated == nullptr)
              {
                summary.energy += (after[i] - before[i]) * moved;
                continue;
              }
            const BonePoint start = bone.point(old);
            BonePoint       end = bone.point(history.trial_record(cells[c], q));
            end.elastic_strain  = start.elastic_strain;
            if (bone.stores_fabric())
              {
                // As it would be had the material not turned
                const auto  *G = forces.step_geometry().gradients(cells[c], q);
                Tensor<2, 3> f(unit_symmetric_tensor<3>());
                for (unsigned int k = 0; k < dofs.size(); ++k)
                  {
                    const auto [d, a] = fe.system_to_component_index(k);
                    for (unsigned int e = 0; e < dim; ++e)
                      f[d][e] += equilibrium.increment(dofs[k]) * G[a][e];
                  }
                end.log_fabric = rotate(transpose(polar(f).R), end.log_fabric);
              }
            summary.energy +=
              0.5 * weight *
              (after[i] - before[i] + bone.energy(end) - bone.energy(start));
          }
        ++c;
      }
    const MPI_Comm communicator = state.configuration.communicator();
    for (double *sum :
         {&summary.energy, &summary.stored, &summary.stored_moved})
      *sum = Utilities::MPI::sum(*sum, communicator);
  }



  template <int dim>
  double
  StaggeredStep<dim>::feed_back()
  {
    // Equilibrium is to see the density and fabric of the end of the step.
    // The change since t_n is added to the committed values, so that the
    // rotation within the step (second order) stays with the equilibrium.
    HistoryStore<dim> &history = state.history;
    double             change  = 0.;
    for (const unsigned int cell : cells)
      {
        const auto        &layout  = history.layout(history.region(cell));
        const int          density = layout.offset("density");
        const int          fabric  = layout.offset("log fabric");
        const unsigned int n_fabric =
          fabric < 0 ? 0 : n_values(HistoryField::Shape::symmetric_tensor, dim);
        for (unsigned int q = 0; q < history.n_points; ++q)
          {
            double       *old   = history.old_record(cell, q);
            const double *trial = history.trial_record(cell, q);
            change = std::max(change, std::abs(old[density] - trial[density]));
            old[density] = trial[density];
            for (unsigned int i = 0; i < n_fabric; ++i)
              old[fabric + i] = trial[fabric + i];
          }
      }
    return Utilities::MPI::max(change, state.configuration.communicator());
  }



  template <int dim>
  Verdict
  StaggeredStep<dim>::solve(const Interval     &interval,
                            EquilibriumReport  &mechanics,
                            RemodellingSummary &remodelling)
  {
    Verdict verdict = equilibrium.solve(interval, mechanics);
    if (verdict.repeats() || !active)
      return verdict;
    const double dt = interval.end - interval.begin;
    // By point, before remodelling and as the last equilibrium left them
    std::vector<double> before, seen;
    if (booked)
      before = seen = point_energies(state.history.trial_values);
    remodelling = remodel(dt);

    if (parameters.coupling == "iterated")
      {
        HistoryStore<dim>        &history   = state.history;
        const std::vector<double> committed = history.old_values;
        // They come back on every way out, exceptions too.
        struct Restore
        {
          ~Restore()
          {
            values = committed;
          }
          std::vector<double>       &values;
          const std::vector<double> &committed;
        } const restore{history.old_values, committed};
        double       change = 0.;
        unsigned int n      = 0;
        do
          {
            if (++n > parameters.max_coupling_iterations)
              {
                verdict = {Verdict::Kind::repeat,
                           "mechanics and remodelling did not agree in " +
                             std::to_string(n - 1) + " iterations",
                           "coupling"};
                break;
              }
            change = feed_back();
            EquilibriumReport again;
            verdict = equilibrium.solve(interval, again);
            again.n_iterations += mechanics.n_iterations;
            again.n_line_search += mechanics.n_line_search;
            again.n_linear_iterations += mechanics.n_linear_iterations;
            again.n_augmentations += mechanics.n_augmentations;
            again.n_direct_instead += mechanics.n_direct_instead;
            again.linear_residual =
              std::max(again.linear_residual, mechanics.linear_residual);
            again.imbalance = mechanics.imbalance;
            again.round_off = std::max(again.round_off, mechanics.round_off);
            mechanics       = again;
            if (verdict.repeats())
              break;
            if (booked)
              seen = point_energies(history.trial_values);
            // Remodelling starts from the committed density and fabric, but
            // with the elastic strain of the new equilibrium.
            for (const unsigned int cell : cells)
              {
                const auto &layout  = history.layout(history.region(cell));
                const int   density = layout.offset("density");
                const int   fabric  = layout.offset("log fabric");
                for (unsigned int q = 0; q < history.n_points; ++q)
                  {
                    double       *trial = history.trial_record(cell, q);
                    const double *old   = history.old_record(cell, q);
                    const double *first =
                      committed.data() + (old - history.old_values.data());
                    trial[density] = first[density];
                    // The fabric at t_n, turned as the equilibrium turned the
                    // one of the end of the step: to first order its increment.
                    if (fabric >= 0)
                      for (unsigned int i = 0;
                           i <
                           n_values(HistoryField::Shape::symmetric_tensor, dim);
                           ++i)
                        trial[fabric + i] +=
                          first[fabric + i] - old[fabric + i];
                  }
              }
            if (booked)
              before = point_energies(history.trial_values);
            remodelling = remodel(dt);
        } while (remodelling.failure.empty() &&
                 change > parameters.coupling_tolerance);
        remodelling.n_coupling_iterations = n;
        if (verdict.repeats())
          return verdict;
        if (booked)
          balance(before, seen, &committed, remodelling);
      }
    else if (booked)
      balance(before, seen, nullptr, remodelling);

    if (!remodelling.failure.empty())
      return {Verdict::Kind::repeat, remodelling.failure, "remodelling"};
    if (remodelling.largest_density_change > parameters.max_density_change)
      {
        std::ostringstream reason;
        reason << "density changed by " << remodelling.largest_density_change
               << " g/cc in a step, more than "
               << parameters.max_density_change;
        return {Verdict::Kind::repeat, reason.str(), "density change"};
      }
    return verdict;
  }

  template class StaggeredStep<2>;
  template class StaggeredStep<3>;
} // namespace alveolus
