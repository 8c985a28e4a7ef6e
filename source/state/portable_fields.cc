// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/state/portable_fields.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <type_traits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr int message_tag = 7302;
    /** Numbers in one message; MPI counts with int. */
    constexpr std::size_t most_at_once = 1 << 26;

    template <class Number>
    MPI_Datatype
    mpi_type()
    {
      static_assert(sizeof(Number) == 8, "8 bytes each");
      return std::is_same<Number, double>::value ? MPI_DOUBLE : MPI_UINT64_T;
    }
  } // namespace



  template <class Number>
  std::vector<Number>
  gather_on_first(const std::vector<Number> &values,
                  const MPI_Comm            &communicator)
  {
    const auto sizes =
      Utilities::MPI::gather(communicator,
                             static_cast<std::uint64_t>(values.size()));
    const auto pieces = [](const std::size_t n, const auto &action) {
      for (std::size_t i = 0; i < n; i += most_at_once)
        action(i, static_cast<int>(std::min(n - i, most_at_once)));
    };
    if (Utilities::MPI::this_mpi_process(communicator) != 0)
      {
        pieces(values.size(), [&](const std::size_t begin, const int n) {
          const int error = MPI_Send(values.data() + begin,
                                     n,
                                     mpi_type<Number>(),
                                     0,
                                     message_tag,
                                     communicator);
          AssertThrowMPI(error);
        });
        return {};
      }
    std::vector<Number> all(
      std::accumulate(sizes.begin(), sizes.end(), std::uint64_t(0)));
    std::copy(values.begin(), values.end(), all.begin());
    std::size_t offset = sizes[0];
    for (unsigned int rank = 1; rank < sizes.size(); ++rank)
      {
        pieces(sizes[rank], [&](const std::size_t begin, const int n) {
          const int error = MPI_Recv(all.data() + offset + begin,
                                     n,
                                     mpi_type<Number>(),
                                     rank,
                                     message_tag,
                                     communicator,
                                     MPI_STATUS_IGNORE);
          AssertThrowMPI(error);
        });
        offset += sizes[rank];
      }
    return all;
  }



  template <int dim>
  PortableFields<dim>::PortableFields(const Configuration<dim> &configuration)
    : configuration(configuration)
    , communicator(configuration.communicator())
    , n_cells(configuration.mesh.triangulation->n_global_active_cells())
    , n_nodal_values(configuration.dof_handler.n_dofs())
  {
    using Key                 = CellId::binary_type;
    const unsigned int n_dofs = configuration.fe.n_dofs_per_cell();
    const auto        &owned  = configuration.locally_owned;
    const bool is_first = Utilities::MPI::this_mpi_process(communicator) == 0;
    BlockFile::Integers                  keys, dofs;
    std::vector<types::global_dof_index> cell_dofs(n_dofs);
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          owned_cells.push_back(cell->active_cell_index());
          const Key key = cell->id().template to_binary<dim>();
          keys.insert(keys.end(), key.begin(), key.end());
          cell->get_dof_indices(cell_dofs);
          dofs.insert(dofs.end(), cell_dofs.begin(), cell_dofs.end());
        }
    keys = gather_on_first(keys, communicator);
    dofs = gather_on_first(dofs, communicator);
    // The values of all processes one after the other are in the order of
    // their global indices, which this relies on.
    AssertThrow(owned.is_contiguous(), ExcInternalError());

    all_cell_places.resize(n_cells);
    all_node_places.assign(n_nodal_values, n_nodal_values);
    if (is_first)
      {
        const std::size_t   n_key = Key().size();
        BlockFile::Integers order(n_cells);
        std::iota(order.begin(), order.end(), 0);
        std::sort(order.begin(), order.end(), [&](const auto a, const auto b) {
          return std::lexicographical_compare(keys.begin() + a * n_key,
                                              keys.begin() + (a + 1) * n_key,
                                              keys.begin() + b * n_key,
                                              keys.begin() + (b + 1) * n_key);
        });
        std::uint64_t next = 0;
        for (std::uint64_t place = 0; place < n_cells; ++place)
          {
            all_cell_places[order[place]] = place;
            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                auto &node = all_node_places[dofs[order[place] * n_dofs + i]];
                if (node == n_nodal_values)
                  node = next++;
              }
          }
      }

    // Each process takes the places of its own.
    Utilities::MPI::broadcast(all_cell_places.data(),
                              all_cell_places.size(),
                              0,
                              communicator);
    Utilities::MPI::broadcast(all_node_places.data(),
                              all_node_places.size(),
                              0,
                              communicator);
    const auto n_owned =
      Utilities::MPI::all_gather(communicator, owned_cells.size());
    std::size_t begin = 0;
    for (unsigned int rank = 0;
         rank < Utilities::MPI::this_mpi_process(communicator);
         ++rank)
      begin += n_owned[rank];
    cell_places.assign(all_cell_places.begin() + begin,
                       all_cell_places.begin() + begin + owned_cells.size());
    const std::size_t first =
      owned.n_elements() > 0 ? owned.nth_index_in_set(0) : 0;
    node_places.assign(all_node_places.begin() + first,
                       all_node_places.begin() + first + owned.n_elements());
    if (!is_first)
      {
        all_cell_places = {};
        all_node_places = {};
      }
  }



  template <int dim>
  void
  PortableFields<dim>::save(const NodalVector &v,
                            const std::string &name,
                            BlockFile         &blocks) const
  {
    std::vector<double> values(node_places.size());
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = v.local_element(i);
    values = gather_on_first(values, communicator);
    if (all_node_places.empty())
      return;
    std::vector<double> ordered(n_nodal_values);
    for (std::size_t i = 0; i < values.size(); ++i)
      ordered[all_node_places[i]] = values[i];
    blocks.put(name, std::move(ordered));
  }



  template <int dim>
  void
  PortableFields<dim>::load(const BlockFile   &blocks,
                            const std::string &name,
                            NodalVector       &v) const
  {
    const auto &values = blocks.numbers(name);
    if (values.size() != n_nodal_values)
      blocks.refuse(name,
                    "has " + std::to_string(values.size()) +
                      " nodal values, the mesh " +
                      std::to_string(n_nodal_values));
    v.zero_out_ghost_values();
    for (std::size_t i = 0; i < node_places.size(); ++i)
      v.local_element(i) = values[node_places[i]];
    v.update_ghost_values();
  }



  template <int dim>
  void
  PortableFields<dim>::save(const std::vector<double>      &values,
                            const std::vector<std::size_t> &begin,
                            const std::string              &name,
                            BlockFile                      &blocks) const
  {
    std::vector<double> own;
    BlockFile::Integers sizes;
    for (const unsigned int c : owned_cells)
      {
        own.insert(own.end(),
                   values.begin() + begin[c],
                   values.begin() + begin[c + 1]);
        sizes.push_back(begin[c + 1] - begin[c]);
      }
    own   = gather_on_first(own, communicator);
    sizes = gather_on_first(sizes, communicator);
    if (all_cell_places.empty())
      return;
    BlockFile::Integers ordered_sizes(n_cells), offsets(n_cells, 0);
    for (std::size_t c = 0; c < sizes.size(); ++c)
      ordered_sizes[all_cell_places[c]] = sizes[c];
    std::partial_sum(ordered_sizes.begin(),
                     ordered_sizes.end() - 1,
                     offsets.begin() + 1);
    std::vector<double> ordered(own.size());
    auto                next = own.begin();
    for (std::size_t c = 0; c < sizes.size(); ++c)
      {
        std::copy(next,
                  next + sizes[c],
                  ordered.begin() + offsets[all_cell_places[c]]);
        next += sizes[c];
      }
    blocks.put(name + " per cell", std::move(ordered_sizes));
    blocks.put(name, std::move(ordered));
  }



  template <int dim>
  void
  PortableFields<dim>::load(const BlockFile                &blocks,
                            const std::string              &name,
                            const std::vector<std::size_t> &begin,
                            std::vector<double>            &values) const
  {
    const auto &ordered = blocks.numbers(name);
    const auto &sizes   = blocks.integers(name + " per cell");
    if (sizes.size() != n_cells)
      blocks.refuse(name,
                    "is of " + std::to_string(sizes.size()) +
                      " cells, the mesh has " + std::to_string(n_cells));
    BlockFile::Integers offsets(n_cells + 1, 0);
    for (std::size_t c = 0; c < n_cells; ++c)
      {
        offsets[c + 1] = offsets[c] + sizes[c];
        if (sizes[c] > ordered.size() || offsets[c + 1] > ordered.size())
          blocks.refuse(name, "is shorter than its cells need");
      }
    unsigned int misfits = 0;
    for (std::size_t i = 0; i < owned_cells.size(); ++i)
      {
        const unsigned int c = owned_cells[i];
        if (sizes[cell_places[i]] != begin[c + 1] - begin[c])
          ++misfits;
        else
          std::copy(ordered.begin() + offsets[cell_places[i]],
                    ordered.begin() + offsets[cell_places[i] + 1],
                    values.begin() + begin[c]);
      }
    misfits = Utilities::MPI::sum(misfits, communicator);
    if (misfits > 0)
      blocks.refuse(name,
                    "holds another number of values than this scene for " +
                      std::to_string(misfits) + " cells");
  }



  template <int dim>
  void
  PortableFields<dim>::save(const HistoryStore<dim> &history,
                            const std::string       &name,
                            BlockFile               &blocks) const
  {
    save(history.old_values, history.offsets(), name, blocks);
  }

  template <int dim>
  void
  PortableFields<dim>::load(const BlockFile   &blocks,
                            const std::string &name,
                            HistoryStore<dim> &history) const
  {
    load(blocks, name, history.offsets(), history.old_values);
    history.update_ghosts();
    history.trial_values = history.old_values;
  }



  template <int dim>
  std::vector<std::size_t>
  PortableFields<dim>::begin_of_faces(const FaceHistory<dim> &history) const
  {
    // Faces are listed by cell.
    const std::size_t        size = history.n_points * history.n_components;
    std::vector<std::size_t> begin(history.triangulation.n_active_cells() + 1,
                                   0);
    for (const auto &face : history.faces())
      begin[face.cell->active_cell_index() + 1] += size;
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    return begin;
  }

  template <int dim>
  void
  PortableFields<dim>::save(const FaceHistory<dim> &history,
                            const std::string      &name,
                            BlockFile              &blocks) const
  {
    save(history.old_values, begin_of_faces(history), name, blocks);
  }

  template <int dim>
  void
  PortableFields<dim>::load(const BlockFile   &blocks,
                            const std::string &name,
                            FaceHistory<dim>  &history) const
  {
    load(blocks, name, begin_of_faces(history), history.old_values);
    history.trial_values = history.old_values;
  }

  template class PortableFields<2>;
  template class PortableFields<3>;
  template std::vector<double>
  gather_on_first(const std::vector<double> &, const MPI_Comm &);
  template std::vector<std::uint64_t>
  gather_on_first(const std::vector<std::uint64_t> &, const MPI_Comm &);
} // namespace alveolus
