// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/solver/staggered_step.h>

#include <deal.II/base/work_stream.h>

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

    // Points are independent: any order gives the same result, and the
    // reports are combined in the order of the cells.
    std::vector<RemodellingReport> reports(cells.size() * n_points);
    std::vector<std::string>       failures(cells.size());
    parallel::apply_to_subranges(
      0U,
      static_cast<unsigned int>(cells.size()),
      [&](const unsigned int begin, const unsigned int end) {
        for (unsigned int c = begin; c < end; ++c)
          {
            const auto           &region = laws[state.history.region(cells[c])];
            const LocalIntegrator integrator(*region.law,
                                             *region.bone,
                                             parameters.local_tolerance);
            try
              {
                for (unsigned int q = 0; q < n_points; ++q)
                  reports[c * n_points + q] =
                    integrator.advance(state.history.trial_record(cells[c], q),
                                       dt,
                                       filter ? &stimulus[c * n_points + q]
                                              : nullptr);
              }
            catch (const RunError &error)
              {
                failures[c] = error.what();
              }
          }
      },
      16);
    RemodellingSummary summary;
    for (const auto &failure : failures)
      if (!failure.empty())
        summary.failure = failure;
    for (const auto &report : reports)
      {
        summary.largest_density_change =
          std::max(summary.largest_density_change,
                   std::abs(report.density_change));
        summary.n_fabric_limited += report.n_fabric_limited;
        summary.n_at_lower_bound += report.at_lower_bound;
        summary.n_at_upper_bound += report.at_upper_bound;
      }
    const MPI_Comm communicator = state.configuration.communicator();
    summary.largest_density_change =
      Utilities::MPI::max(summary.largest_density_change, communicator);
    const unsigned int n = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int first_failed =
      Utilities::MPI::min(summary.failure.empty()
                            ? n
                            : Utilities::MPI::this_mpi_process(communicator),
                          communicator);
    if (first_failed < n)
      summary.failure =
        Utilities::MPI::broadcast(communicator, summary.failure, first_failed);
    summary.n_fabric_limited =
      Utilities::MPI::sum(summary.n_fabric_limited, communicator);
    summary.n_at_lower_bound =
      Utilities::MPI::sum(summary.n_at_lower_bound, communicator);
    summary.n_at_upper_bound =
      Utilities::MPI::sum(summary.n_at_upper_bound, communicator);
    return summary;
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
    remodelling     = remodel(dt);

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
            mechanics.n_iterations += again.n_iterations;
            if (verdict.repeats())
              break;
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
            remodelling = remodel(dt);
        } while (remodelling.failure.empty() &&
                 change > parameters.coupling_tolerance);
        remodelling.n_coupling_iterations = n;
        if (verdict.repeats())
          return verdict;
      }

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
