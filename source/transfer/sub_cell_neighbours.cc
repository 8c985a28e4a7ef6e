// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/sub_cell_neighbours.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/grid/cell_id.h>

#include <algorithm>
#include <array>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * Name of a corner of sub-cells, the same from all cells around it: the
     * vertices that span the vertex, edge, face or cell it lies in (the
     * smallest one, then its neighbours in ascending order), and its place
     * there.
     */
    template <int dim>
    using Key = std::array<unsigned int, 2 * dim + 1>;

    template <int dim, class Cell>
    Key<dim>
    key_of(const Cell                          &cell,
           const std::array<unsigned int, dim> &place,
           const unsigned int                   n_1d)
    {
      // The smallest vertex among those of the vertex, edge, face or cell.
      unsigned int origin = numbers::invalid_unsigned_int;
      for (const unsigned int v : cell->vertex_indices())
        {
          bool has = true;
          for (unsigned int d = 0; d < dim; ++d)
            has = has && !(place[d] == 0 && (v >> d & 1)) &&
                  !(place[d] == n_1d && !(v >> d & 1));
          if (has && (origin == numbers::invalid_unsigned_int ||
                      cell->vertex_index(v) < cell->vertex_index(origin)))
            origin = v;
        }
      std::vector<std::pair<unsigned int, unsigned int>> axes;
      for (unsigned int d = 0; d < dim; ++d)
        if (place[d] > 0 && place[d] < n_1d)
          axes.emplace_back(cell->vertex_index(origin ^ (1u << d)),
                            origin >> d & 1 ? n_1d - place[d] : place[d]);
      std::sort(axes.begin(), axes.end());
      Key<dim> key{};
      key[0] = cell->vertex_index(origin);

      // In the middle of an edge or face that finer cells divide is a vertex.
      // (Only degree 1 has hanging nodes, and only middles, then.)
      const auto is_end = [&](const unsigned int vertex) {
        bool found = vertex == key[0];
        for (const auto &axis : axes)
          found = found || vertex == axis.first;
        return found;
      };
      if (axes.size() == 1 && n_1d == 2)
        for (const unsigned int l : cell->line_indices())
          if (cell->line(l)->has_children() &&
              is_end(cell->line(l)->vertex_index(0)) &&
              is_end(cell->line(l)->vertex_index(1)))
            {
              key[0] = cell->line(l)->child(0)->vertex_index(1);
              return key;
            }
      if constexpr (dim == 3)
        if (axes.size() == 2 && n_1d == 2)
          for (const unsigned int f : cell->face_indices())
            {
              unsigned int n_ends = 0;
              for (unsigned int v = 0; v < 4; ++v)
                n_ends += is_end(cell->face(f)->vertex_index(v));
              if (n_ends == 3 && cell->face(f)->has_children())
                {
                  key[0] = cell->face(f)->isotropic_child(0)->vertex_index(3);
                  return key;
                }
            }
      for (unsigned int a = 0; a < axes.size(); ++a)
        {
          key[2 * a + 1] = axes[a].first;
          key[2 * a + 2] = axes[a].second;
        }
      return key;
    }
  } // namespace

  template <int dim>
  SubCellNeighbours<dim>::SubCellNeighbours(const SubCells<dim>     &cells,
                                            const HistoryStore<dim> &store)
    : neighbours(cells.n_sub_cells())
  {
    const unsigned int n_1d = cells.breaks().size() - 1;
    using Cell              = typename Triangulation<dim>::active_cell_iterator;
    std::vector<Cell> order;
    for (const auto &cell : store.triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        order.push_back(cell);
    std::vector<std::pair<CellId, Cell>> by_id;
    for (const Cell &cell : order)
      by_id.emplace_back(cell->id(), cell);
    std::sort(by_id.begin(), by_id.end(), [](const auto &a, const auto &b) {
      return a.first < b.first;
    });

    // Sub-cells around each corner, in the order of cell ids and points.
    std::map<Key<dim>, std::vector<unsigned int>> around;
    std::vector<unsigned int> rank(store.triangulation.n_active_cells());
    const auto                for_corners =
      [&](const Cell &cell, const unsigned int point, auto &&action) {
        std::array<unsigned int, dim> place;
        for (const unsigned int v : cell->vertex_indices())
          {
            for (unsigned int d = 0, rest = point; d < dim; ++d, rest /= n_1d)
              place[d] = rest % n_1d + (v >> d & 1);
            action(key_of<dim>(cell, place, n_1d));
          }
      };
    for (unsigned int i = 0; i < by_id.size(); ++i)
      {
        const Cell        &cell = by_id[i].second;
        const unsigned int c    = cell->active_cell_index();
        rank[c]                 = i;
        for (unsigned int q = 0; q < cells.n_points; ++q)
          for_corners(cell, q, [&](const Key<dim> &key) {
            around[key].push_back(c * cells.n_points + q);
          });
      }

    for (const auto &entry : by_id)
      if (entry.second->is_locally_owned())
        for (unsigned int q = 0; q < cells.n_points; ++q)
          {
            const unsigned int c    = entry.second->active_cell_index();
            const unsigned int s    = c * cells.n_points + q;
            auto              &list = neighbours[s];
            for_corners(entry.second, q, [&](const Key<dim> &key) {
              for (const unsigned int other : around.at(key))
                if (other != s &&
                    store.region(other / cells.n_points) == store.region(c))
                  list.push_back(other);
            });
            const auto before = [&](const unsigned int a,
                                    const unsigned int b) {
              return std::make_pair(rank[a / cells.n_points], a) <
                     std::make_pair(rank[b / cells.n_points], b);
            };
            std::sort(list.begin(), list.end(), before);
            list.erase(std::unique(list.begin(), list.end()), list.end());
          }
  }

  template class SubCellNeighbours<2>;
  template class SubCellNeighbours<3>;
} // namespace alveolus
