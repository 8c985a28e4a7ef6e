// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/state/ghost_exchange.h>

#include <deal.II/base/mpi.h>

#include <map>
#include <unordered_map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr int message_tag = 7301;

    std::size_t
    n_values(const std::vector<unsigned int> &cells,
             const std::vector<std::size_t>  &begin)
    {
      std::size_t n = 0;
      for (const unsigned int cell : cells)
        n += begin[cell + 1] - begin[cell];
      return n;
    }
  } // namespace

  template <int dim>
  GhostExchange<dim>::GhostExchange(const Triangulation &triangulation)
    : communicator(triangulation.get_communicator())
  {
    // Each process asks the owners for its ghosts by their global indices; the
    // order of the request is the order of the messages from then on.
    using GlobalIndices = std::vector<types::global_cell_index>;
    std::map<unsigned int, GlobalIndices>                      wanted;
    std::map<unsigned int, std::vector<unsigned int>>          receive;
    std::unordered_map<types::global_cell_index, unsigned int> owned;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        owned[cell->global_active_cell_index()] = cell->active_cell_index();
      else if (cell->is_ghost())
        {
          wanted[cell->subdomain_id()].push_back(
            cell->global_active_cell_index());
          receive[cell->subdomain_id()].push_back(cell->active_cell_index());
        }

    const auto requests = Utilities::MPI::some_to_some(communicator, wanted);

    std::map<unsigned int, Link> by_rank;
    for (const auto &[rank, cells] : receive)
      by_rank[rank].receive = cells;
    for (const auto &[rank, cells] : requests)
      for (const auto cell : cells)
        by_rank[rank].send.push_back(owned.at(cell));
    for (auto &[rank, link] : by_rank)
      {
        link.rank = rank;
        links.push_back(std::move(link));
      }
  }

  template <int dim>
  void
  GhostExchange<dim>::update(std::vector<double>            &values,
                             const std::vector<std::size_t> &begin) const
  {
    if (links.empty())
      return;

    std::vector<std::vector<double>> out(links.size()), in(links.size());
    std::vector<MPI_Request>         requests;
    requests.reserve(2 * links.size());
    for (unsigned int l = 0; l < links.size(); ++l)
      {
        in[l].resize(n_values(links[l].receive, begin));
        if (in[l].empty())
          continue;
        requests.emplace_back();
        const int error = MPI_Irecv(in[l].data(),
                                    in[l].size(),
                                    MPI_DOUBLE,
                                    links[l].rank,
                                    message_tag,
                                    communicator,
                                    &requests.back());
        AssertThrowMPI(error);
      }
    for (unsigned int l = 0; l < links.size(); ++l)
      {
        out[l].reserve(n_values(links[l].send, begin));
        for (const unsigned int cell : links[l].send)
          out[l].insert(out[l].end(),
                        values.begin() + begin[cell],
                        values.begin() + begin[cell + 1]);
        if (out[l].empty())
          continue;
        requests.emplace_back();
        const int error = MPI_Isend(out[l].data(),
                                    out[l].size(),
                                    MPI_DOUBLE,
                                    links[l].rank,
                                    message_tag,
                                    communicator,
                                    &requests.back());
        AssertThrowMPI(error);
      }
    const int error =
      MPI_Waitall(requests.size(), requests.data(), MPI_STATUSES_IGNORE);
    AssertThrowMPI(error);

    for (unsigned int l = 0; l < links.size(); ++l)
      {
        const double *next = in[l].data();
        for (const unsigned int cell : links[l].receive)
          {
            const std::size_t n = begin[cell + 1] - begin[cell];
            std::copy(next, next + n, values.begin() + begin[cell]);
            next += n;
          }
      }
  }

  template class GhostExchange<2>;
  template class GhostExchange<3>;
} // namespace alveolus
