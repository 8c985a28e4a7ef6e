// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/history_picture.h>
#include <alveolus/transfer/sub_cell_neighbours.h>
#include <alveolus/transfer/subcells.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** What one process contributes. */
    struct Contribution
    {
      std::vector<unsigned int> ids; ///< four numbers for each cell
      std::vector<unsigned int> region;
      std::vector<double>       nodes, values;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &ids &region &nodes &values;
      }
    };

    /** A cell of a contribution. */
    struct Gathered
    {
      CellId       id;
      unsigned int process, cell;
      std::size_t  first_value;
      unsigned int number; ///< in the order of the contributions
    };
  } // namespace

  template <int dim>
  HistoryPicture<dim>::HistoryPicture(const Configuration<dim> &configuration,
                                      const HistoryStore<dim>  &store,
                                      const bool                with_neighbours)
    : nodes(configuration)
    , n_points(store.n_points)
  {
    const SubCells<dim> cells(configuration, [&](const unsigned int c) {
      return store.region(c);
    });
    const NodalVector   x             = configuration.positions();
    const MPI_Comm      communicator  = configuration.communicator();
    const auto         &triangulation = *configuration.mesh.triangulation;
    breaks                            = cells.breaks();
    for (unsigned int r = 0; r < store.n_regions(); ++r)
      layouts.push_back(store.layout(r));

    Contribution own;
    NodeTensors  position;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c  = cell->active_cell_index();
          const auto         id = cell->id().template to_binary<dim>();
          owned.push_back(c);
          own.ids.insert(own.ids.end(), id.begin(), id.end());
          own.region.push_back(store.region(c));
          nodes.gather(x, c, position);
          for (unsigned int i = 0; i < nodes.n_nodes; ++i)
            for (unsigned int d = 0; d < dim; ++d)
              own.nodes.push_back(position[i][d]);
          own.values.insert(own.values.end(),
                            store.old_values.begin() + store.offsets()[c],
                            store.old_values.begin() + store.offsets()[c + 1]);
        }

    const std::vector<Contribution> all =
      Utilities::MPI::all_gather(communicator, own);
    std::vector<Gathered> gathered;
    for (unsigned int p = 0; p < all.size(); ++p)
      {
        std::size_t first_value = 0;
        for (unsigned int i = 0; i < all[p].region.size(); ++i)
          {
            CellId::binary_type id;
            std::copy_n(all[p].ids.begin() + i * id.size(),
                        id.size(),
                        id.begin());
            const unsigned int number = gathered.size();
            gathered.push_back({CellId(id), p, i, first_value, number});
            first_value += layouts[all[p].region[i]].size * n_points;
          }
      }
    std::sort(gathered.begin(),
              gathered.end(),
              [](const Gathered &a, const Gathered &b) { return a.id < b.id; });

    place.resize(gathered.size());
    begin.push_back(0);
    for (const Gathered &g : gathered)
      {
        const Contribution &from = all[g.process];
        place[g.number]          = region.size();
        region.push_back(from.region[g.cell]);
        const double *p = from.nodes.data() + g.cell * nodes.n_nodes * dim;
        for (unsigned int i = 0; i < nodes.n_nodes; ++i)
          for (unsigned int d = 0; d < dim; ++d)
            position[i][d] = *(p++);
        positions.push_back(position);
        values.insert(values.end(),
                      from.values.begin() + g.first_value,
                      from.values.begin() + g.first_value +
                        layouts[region.back()].size * n_points);
        begin.push_back(values.size());
      }
    if (!with_neighbours)
      return;

    // Numbers here of the cells that this process sees.
    std::vector<unsigned int> number(triangulation.n_active_cells());
    for (const auto &cell : triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        number[cell->active_cell_index()] =
          std::lower_bound(gathered.begin(),
                           gathered.end(),
                           cell->id(),
                           [](const Gathered &a, const CellId &id) {
                             return a.id < id;
                           }) -
          gathered.begin();
    const SubCellNeighbours<dim>           found(cells, store);
    std::vector<std::vector<unsigned int>> own_lists;
    for (const unsigned int c : owned)
      for (unsigned int s = c * n_points; s < (c + 1) * n_points; ++s)
        {
          own_lists.emplace_back();
          for (const unsigned int other : found[s])
            own_lists.back().push_back(number[other / n_points] * n_points +
                                       other % n_points);
        }
    neighbours.resize(n_cells() * n_points);
    unsigned int cell = 0;
    for (const auto &lists :
         Utilities::MPI::all_gather(communicator, own_lists))
      for (unsigned int i = 0; i < lists.size(); ++cell)
        for (unsigned int q = 0; q < n_points; ++q, ++i)
          neighbours[place[cell] * n_points + q] = lists[i];
  }

  template <int dim>
  std::vector<typename CellNodes<dim>::NodeTensors>
  HistoryPicture<dim>::gather(const NodalVector &u,
                              const MPI_Comm    &communicator) const
  {
    nodes.check(u);
    std::vector<double> own;
    NodeTensors         f;
    for (const unsigned int c : owned)
      {
        nodes.gather(u, c, f);
        for (unsigned int i = 0; i < nodes.n_nodes; ++i)
          for (unsigned int d = 0; d < dim; ++d)
            own.push_back(f[i][d]);
      }
    std::vector<NodeTensors> result(n_cells());
    unsigned int             number = 0;
    for (const auto &part : Utilities::MPI::all_gather(communicator, own))
      for (auto value = part.begin(); value != part.end(); ++number)
        for (unsigned int i = 0; i < nodes.n_nodes; ++i)
          for (unsigned int d = 0; d < dim; ++d)
            result[place[number]][i][d] = *(value++);
    AssertThrow(number == n_cells(), ExcInternalError());
    return result;
  }

  template class HistoryPicture<2>;
  template class HistoryPicture<3>;
} // namespace alveolus
