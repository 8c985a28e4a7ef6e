// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/work_sharing.h>
#include <alveolus/solver/point_remodelling.h>

#include <deal.II/base/parallel.h>

#include <algorithm>
#include <chrono>
#include <numeric>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Points of each cell that tell the cost of the others. */
    constexpr unsigned int n_sampled = 1;

    /** Add to @p sum what one more point did. */
    void
    add(RemodellingSummary &sum, const RemodellingReport &point)
    {
      sum.largest_density_change =
        std::max(sum.largest_density_change, std::abs(point.density_change));
      sum.n_fabric_limited += point.n_fabric_limited;
      sum.n_at_lower_bound += point.at_lower_bound;
      sum.n_at_upper_bound += point.at_upper_bound;
    }

    /** Add to @p sum what other points did. */
    void
    add(RemodellingSummary &sum, const RemodellingSummary &more)
    {
      sum.largest_density_change =
        std::max(sum.largest_density_change, more.largest_density_change);
      sum.n_fabric_limited += more.n_fabric_limited;
      sum.n_at_lower_bound += more.n_at_lower_bound;
      sum.n_at_upper_bound += more.n_at_upper_bound;
      sum.n_shared += more.n_shared;
      if (!more.failure.empty())
        sum.failure = more.failure;
    }
  } // namespace

  template <int dim>
  PointRemodelling<dim>::PointRemodelling(
    State<dim>                           &state,
    const std::vector<RegionRemodelling> &laws,
    const std::vector<unsigned int>      &cells,
    const double                          tolerance)
    : state(state)
    , laws(laws)
    , cells(cells)
    , tolerance(tolerance)
  {}



  template <int dim>
  std::vector<typename PointRemodelling<dim>::Task>
  PointRemodelling<dim>::tasks_of(const unsigned int         first,
                                  const unsigned int         last,
                                  const std::vector<double> *stimulus) const
  {
    auto             &history = state.history;
    std::vector<Task> tasks;
    tasks.reserve(cells.size());
    for (unsigned int c = 0; c < cells.size(); ++c)
      tasks.push_back({history.region(cells[c]),
                       last - first,
                       history.trial_record(cells[c], first),
                       stimulus == nullptr
                         ? nullptr
                         : stimulus->data() + c * history.n_points + first});
    return tasks;
  }



  template <int dim>
  typename PointRemodelling<dim>::Outcome
  PointRemodelling<dim>::work_off(const std::vector<Task> &tasks,
                                  const double             dt) const
  {
    using Clock = std::chrono::steady_clock;
    // Points are independent: any order gives the same result.
    std::vector<RemodellingSummary> summaries(tasks.size());
    Outcome                         outcome;
    outcome.seconds.resize(tasks.size());
    parallel::apply_to_subranges(
      0U,
      static_cast<unsigned int>(tasks.size()),
      [&](const unsigned int begin, const unsigned int end) {
        for (unsigned int t = begin; t < end; ++t)
          {
            const Task           &task  = tasks[t];
            const auto            start = Clock::now();
            const LocalIntegrator integrator(*laws[task.region].law,
                                             *laws[task.region].bone,
                                             tolerance);
            const unsigned int    size = state.history.layout(task.region).size;
            try
              {
                for (unsigned int q = 0; q < task.n_points; ++q)
                  add(summaries[t],
                      integrator.advance(task.records + q * size,
                                         dt,
                                         task.stimulus == nullptr
                                           ? nullptr
                                           : task.stimulus + q));
              }
            catch (const RunError &error)
              {
                summaries[t].failure = error.what();
              }
            outcome.seconds[t] =
              std::chrono::duration<double>(Clock::now() - start).count();
          }
      },
      16);
    // In the order of the cells
    for (const RemodellingSummary &summary : summaries)
      add(outcome.summary, summary);
    return outcome;
  }



  template <int dim>
  RemodellingSummary
  PointRemodelling<dim>::share(const std::vector<Task>   &mine,
                               const std::vector<double> &costs,
                               const bool                 filtered,
                               const double               dt) const
  {
    constexpr double worth        = 1e-3; // [s]: messages take a part of it
    const MPI_Comm   communicator = state.configuration.communicator();
    const double     sum = std::accumulate(costs.begin(), costs.end(), 0.);
    const auto       gifts =
      balance_work(Utilities::MPI::all_gather(communicator, sum), worth);
    if (gifts.empty())
      return work_off(mine, dt).summary;

    // Of each task: its region, records and, if there is one, stimulus
    const auto n_records = [&](const Task &task) {
      return task.n_points * state.history.layout(task.region).size;
    };
    std::map<unsigned int, std::vector<double>> sent;
    std::vector<bool>                           is_given(mine.size(), false);
    const auto                                  given =
      items_to_give(costs,
                    gifts,
                    Utilities::MPI::this_mpi_process(communicator));
    for (const auto &[process, items] : given)
      for (const unsigned int i : items)
        {
          const Task &task = mine[i];
          auto       &to   = sent[process];
          to.push_back(task.region);
          to.insert(to.end(), task.records, task.records + n_records(task));
          if (filtered)
            to.insert(to.end(), task.stimulus, task.stimulus + task.n_points);
          is_given[i] = true;
        }
    auto received = Utilities::MPI::some_to_some(communicator, sent);

    std::vector<Task> tasks;
    for (unsigned int i = 0; i < mine.size(); ++i)
      if (!is_given[i])
        tasks.push_back(mine[i]);
    unsigned int n_shared = 0;
    for (auto &[process, numbers] : received)
      for (auto number = numbers.data();
           number < numbers.data() + numbers.size();)
        {
          Task task{static_cast<unsigned int>(*number),
                    state.history.n_points - n_sampled,
                    number + 1,
                    nullptr};
          number += 1 + n_records(task);
          if (filtered)
            {
              task.stimulus = number;
              number += task.n_points;
            }
          n_shared += task.n_points;
          tasks.push_back(task);
        }
    RemodellingSummary summary = work_off(tasks, dt).summary;
    summary.n_shared           = n_shared;
    for (const auto &[process, numbers] :
         Utilities::MPI::some_to_some(communicator, received))
      {
        auto number = numbers.begin();
        for (const unsigned int i : given.at(process))
          {
            const Task &task = mine[i];
            ++number; // the region
            std::copy(number, number + n_records(task), task.records);
            number += n_records(task) + (filtered ? task.n_points : 0);
          }
      }
    return summary;
  }



  template <int dim>
  RemodellingSummary
  PointRemodelling<dim>::advance(const double               dt,
                                 const std::vector<double> *stimulus) const
  {
    const MPI_Comm     communicator = state.configuration.communicator();
    const unsigned int n        = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int n_points = state.history.n_points;
    if (n == 1)
      return work_off(tasks_of(0, n_points, stimulus), dt).summary;

    Outcome first = work_off(tasks_of(0, n_sampled, stimulus), dt);
    for (double &seconds : first.seconds) // of the cell's other points
      seconds *= double(n_points - n_sampled) / n_sampled;
    RemodellingSummary summary = first.summary;
    add(summary,
        share(tasks_of(n_sampled, n_points, stimulus),
              first.seconds,
              stimulus != nullptr,
              dt));

    summary.largest_density_change =
      Utilities::MPI::max(summary.largest_density_change, communicator);
    for (unsigned int *count : {&summary.n_fabric_limited,
                                &summary.n_at_lower_bound,
                                &summary.n_at_upper_bound,
                                &summary.n_shared})
      *count = Utilities::MPI::sum(*count, communicator);
    const unsigned int first_failed =
      Utilities::MPI::min(summary.failure.empty()
                            ? n
                            : Utilities::MPI::this_mpi_process(communicator),
                          communicator);
    if (first_failed < n)
      summary.failure =
        Utilities::MPI::broadcast(communicator, summary.failure, first_failed);
    return summary;
  }

  template class PointRemodelling<2>;
  template class PointRemodelling<3>;
} // namespace alveolus
