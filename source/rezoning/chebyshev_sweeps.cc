// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/chebyshev_sweeps.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/partitioner.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** The numbers of the nodes from @p begin to before @p end, each of @p n
     * components. */
    IndexSet
    range(const types::global_dof_index begin,
          const types::global_dof_index end,
          const types::global_dof_index all,
          const unsigned int            n)
    {
      IndexSet set(all * n);
      set.add_range(begin * n, end * n);
      return set;
    }
  } // namespace



  template <int dim>
  void
  ChebyshevSweeps<dim>::reinit(const NodalVector                    &positions,
                               const std::vector<LocalNode>         &moving,
                               const std::vector<std::vector<Link>> &all_links)
  {
    const MPI_Comm     communicator = positions.get_mpi_communicator();
    const unsigned int n_processes =
      Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
    vertices              = moving;

    // The nodes of the mesh one process after the other
    const types::global_dof_index n_own = vertices.size();
    types::global_dof_index       begin = 0, n = 0;
    const auto counts = Utilities::MPI::all_gather(communicator, n_own);
    for (unsigned int p = 0; p < n_processes; ++p)
      {
        begin += p < me ? counts[p] : 0;
        n += counts[p];
      }
    const auto first_of = [&](const unsigned int process) {
      return n * process / n_processes;
    };
    const types::global_dof_index first = first_of(me), last = first_of(me + 1);

    to_sweeps = std::make_shared<const Partitioner>(
      range(begin, begin + n_own, n, n_sent),
      range(first, last, n, n_sent),
      communicator);
    to_mesh =
      std::make_shared<const Partitioner>(range(first, last, n, dim),
                                          range(begin, begin + n_own, n, dim),
                                          communicator);

    NodalVector number(positions);
    number = -1.;
    for (types::global_dof_index v = 0; v < n_own; ++v)
      number.local_element(vertices[v][0]) = begin + v;
    number.update_ghost_values();

    // Rows for the processes that sweep them: how many links, then these
    held.assign(n_own, {});
    std::map<unsigned int, std::vector<double>> rows;
    double                                      largest_row = 0.;
    unsigned int                                process     = 0;
    for (types::global_dof_index v = 0; v < n_own; ++v)
      {
        while (begin + v >= first_of(process + 1))
          ++process;
        std::vector<double> &row  = rows[process];
        const std::size_t    size = row.size();
        row.push_back(0.);
        double sum = 0.;
        for (const auto &[weight, node] : all_links[v])
          {
            sum += std::abs(weight);
            const double neighbour = number.local_element(node[0]);
            if (neighbour < 0.)
              {
                held[v].emplace_back(weight, node);
                continue;
              }
            ++row[size];
            row.push_back(weight);
            row.push_back(neighbour);
          }
        largest_row = std::max(largest_row, sum);
      }

    // In the order of the processes, which is that of the nodes
    first_link.assign(1, 0);
    links.clear();
    std::vector<std::pair<double, types::global_dof_index>> found;
    IndexSet                                                neighbours(n * dim);
    for (const auto &[from, row] :
         Utilities::MPI::some_to_some(communicator, rows))
      for (std::size_t i = 0; i < row.size();)
        {
          const unsigned int n_links = row[i++];
          for (unsigned int k = 0; k < n_links; ++k, i += 2)
            {
              const types::global_dof_index node = row[i + 1];
              found.emplace_back(row[i], node);
              if (node < first || node >= last)
                neighbours.add_range(node * dim, (node + 1) * dim);
            }
          first_link.push_back(found.size());
        }
    swept = std::make_shared<const Partitioner>(range(first, last, n, dim),
                                                neighbours,
                                                communicator);
    for (const auto &[weight, node] : found)
      links.emplace_back(weight, swept->global_to_local(node * dim));
    inner.clear();
    at_ghosts.clear();
    for (unsigned int v = 0; v < last - first; ++v)
      {
        bool needs_ghosts = false;
        for (unsigned int i = first_link[v]; i < first_link[v + 1]; ++i)
          needs_ghosts =
            needs_ghosts || links[i].second >= swept->locally_owned_size();
        (needs_ghosts ? at_ghosts : inner).push_back(v);
      }

    find_eigenvalues(Utilities::MPI::max(largest_row, communicator));
  }



  template <int dim>
  void
  ChebyshevSweeps<dim>::find_eigenvalues(const double largest_row)
  {
    largest_eigenvalue = 1. + largest_row;

    // Power iteration with I - (I - W)/2, from a smooth start
    constexpr unsigned int n_sweeps = 100;
    const unsigned int     n        = first_link.size() - 1;
    NodalVector            mode(swept);
    std::vector<double>    next(n);
    for (unsigned int v = 0; v < n; ++v)
      mode.local_element(v * dim) = 1.;
    double sum = 1., last_sum = 1.;
    for (unsigned int sweep = 0; sweep <= n_sweeps; ++sweep)
      {
        mode.update_ghost_values();
        last_sum = sum;
        sum      = 0.;
        for (unsigned int v = 0; v < n; ++v)
          {
            next[v] = 0.5 * mode.local_element(v * dim);
            for (unsigned int i = first_link[v]; i < first_link[v + 1]; ++i)
              next[v] +=
                0.5 * links[i].first * mode.local_element(links[i].second);
            sum += next[v];
          }
        mode.zero_out_ghost_values();
        for (unsigned int v = 0; v < n; ++v)
          mode.local_element(v * dim) = next[v];
        sum = Utilities::MPI::sum(sum, swept->get_mpi_communicator());
      }
    // From above, hence the factor
    smallest_eigenvalue =
      sum > 0. && sum < last_sum ? 0.7 * 2. * (1. - sum / last_sum) : 1e-4;
  }



  template <int dim>
  typename ChebyshevSweeps<dim>::Report
  ChebyshevSweeps<dim>::solve(NodalVector               &positions,
                              const std::vector<double> &sizes,
                              const double               tolerance,
                              const unsigned int         largest_sweeps) const
  {
    NodalVector sent(to_sweeps);
    double     *value = sent.begin();
    for (unsigned int v = 0; v < vertices.size(); ++v)
      {
        Tensor<1, dim> from_held;
        for (const auto &[weight, node] : held[v])
          for (unsigned int c = 0; c < dim; ++c)
            from_held[c] += weight * positions.local_element(node[c]);
        for (unsigned int c = 0; c < dim; ++c)
          *value++ = positions.local_element(vertices[v][c]);
        for (unsigned int c = 0; c < dim; ++c)
          *value++ = from_held[c];
        *value++ = sizes[v];
      }
    sent.update_ghost_values();

    const unsigned int            n     = first_link.size() - 1;
    const types::global_dof_index first = swept->local_range().first / dim;
    NodalVector                   moved(swept);
    std::vector<Tensor<1, dim>>   from_held(n), steps(n);
    std::vector<double>           local_size(n);
    for (unsigned int v = 0; v < n; ++v)
      {
        const types::global_dof_index at = (first + v) * n_sent;
        for (unsigned int c = 0; c < dim; ++c)
          {
            moved.local_element(v * dim + c) = sent(at + c);
            from_held[v][c]                  = sent(at + dim + c);
          }
        local_size[v] = sent(at + 2 * dim);
      }

    Report       report;
    const double middle = 0.5 * (largest_eigenvalue + smallest_eigenvalue);
    const double radius = 0.5 * (largest_eigenvalue - smallest_eigenvalue);
    double       rho    = 0.;
    while (!report.converged && report.n_sweeps < largest_sweeps)
      {
        const bool   is_first = report.n_sweeps == 0;
        const double next     = 1. / (2. * middle / radius - rho);
        const double keep     = is_first ? 0. : next * rho;
        const double gain     = is_first ? 1. / middle : 2. * next / radius;
        rho                   = is_first ? radius / middle : next;

        double     furthest = 0.;
        double    *x        = moved.begin();
        const auto advance  = [&](const unsigned int v) {
          Tensor<1, dim> way = from_held[v];
          for (unsigned int i = first_link[v]; i < first_link[v + 1]; ++i)
            for (unsigned int c = 0; c < dim; ++c)
              way[c] += links[i].first * x[links[i].second + c];
          for (unsigned int c = 0; c < dim; ++c)
            way[c] -= x[v * dim + c];
          const double rest = way.norm() / local_size[v];
          // A number that is none is never close.
          if (!(rest <= furthest))
            furthest =
              std::isnan(rest) ? std::numeric_limits<double>::max() : rest;
          steps[v] = keep * steps[v] + gain * way;
        };
        // Those that need no ghosts while these are on their way
        moved.update_ghost_values_start();
        for (const unsigned int v : inner)
          advance(v);
        moved.update_ghost_values_finish();
        for (const unsigned int v : at_ghosts)
          advance(v);
        for (unsigned int v = 0; v < n; ++v)
          for (unsigned int c = 0; c < dim; ++c)
            x[v * dim + c] += steps[v][c];
        ++report.n_sweeps;
        report.converged =
          Utilities::MPI::max(furthest, swept->get_mpi_communicator()) <=
          tolerance;
      }

    NodalVector back(to_mesh);
    std::copy(moved.begin(), moved.end(), back.begin());
    back.update_ghost_values();
    const types::global_dof_index begin =
      to_sweeps->local_range().first / n_sent;
    for (unsigned int v = 0; v < vertices.size(); ++v)
      for (unsigned int c = 0; c < dim; ++c)
        positions.local_element(vertices[v][c]) = back((begin + v) * dim + c);
    positions.update_ghost_values();
    return report;
  }

  template class ChebyshevSweeps<2>;
  template class ChebyshevSweeps<3>;
} // namespace alveolus
