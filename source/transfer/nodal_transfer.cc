// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/nodal_transfer.h>

#include <algorithm>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** In unit coordinates: this far outside a cell is still inside. */
    constexpr double inside_tolerance = 1e-8;

    /**
     * In unit coordinates: how far a boundary node may be beyond a boundary
     * face, and, in the wedge between two boundary faces that bend, beyond the
     * interior face between their cells.
     */
    constexpr double beyond_boundary = 0.5, beyond_wedge = 0.1;

    constexpr unsigned int most_parts = 64;

    /** Candidate::node of a cell that does not have the node. */
    constexpr unsigned int elsewhere = numbers::invalid_unsigned_int;
  } // namespace

  template <int dim>
  NodalTransfer<dim>::NodalTransfer(const Configuration<dim> &configuration)
    : configuration(configuration)
    , cells(configuration)
    , hanging(configuration)
  {
    const auto &triangulation = *configuration.mesh.triangulation;
    const auto &partitioner =
      *configuration.mesh_displacement().get_partitioner();
    const unsigned int n_owned = partitioner.locally_owned_size();
    boundary_face.resize(triangulation.n_active_cells());

    using Cell = typename Triangulation<dim>::active_cell_iterator;
    std::vector<Cell> order;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (!cell->is_artificial())
        {
          order.push_back(cell);
          for (const unsigned int f : cell->face_indices())
            boundary_face[cell->active_cell_index()][f] =
              cell->face(f)->at_boundary();
        }
    std::sort(order.begin(), order.end(), [](const Cell &a, const Cell &b) {
      return a->global_active_cell_index() < b->global_active_cell_index();
    });
    std::vector<std::vector<unsigned int>> around(triangulation.n_vertices());
    for (const Cell &cell : order)
      for (const unsigned int v : cell->vertex_indices())
        around[cell->vertex_index(v)].push_back(cell->active_cell_index());

    // First the cells that have the node, by global order, then (nodes inside
    // edges, faces and cells) the others around the vertices of that edge, face
    // or cell: all of them are owned or ghost cells.
    std::map<unsigned int, Node> by_entry;
    for (const Cell &cell : order)
      for (unsigned int i = 0; i < cells.n_nodes; ++i)
        {
          const unsigned int c     = cell->active_cell_index();
          const unsigned int entry = cells.local_entries(c, i)[0];
          // The value of a hanging node follows from the others.
          if (entry >= n_owned ||
              (!hanging.empty() && hanging.constraints().is_constrained(
                                     partitioner.local_to_global(entry))))
            continue;
          Node &node = by_entry[entry];
          node.candidates.push_back({c, i});
          for (unsigned int f = 0; f < 2 * dim; ++f)
            if (boundary_face[c][f] &&
                std::abs(cells.unit_position(i)[f / 2] - f % 2) < 1e-10)
              node.at_boundary = true;
        }
    for (const Cell &cell : order)
      for (unsigned int i = 0; i < cells.n_nodes; ++i)
        {
          const unsigned int c    = cell->active_cell_index();
          const auto         node = by_entry.find(cells.local_entries(c, i)[0]);
          if (node == by_entry.end() || node->second.candidates[0].cell != c)
            continue;
          for (const unsigned int v : cell->vertex_indices())
            {
              const Point<dim> corner = GeometryInfo<dim>::unit_cell_vertex(v);
              bool             near   = true;
              for (unsigned int d = 0; d < dim; ++d)
                near = near && std::abs(cells.unit_position(i)[d] - corner[d]) <
                                 1. - 1e-10;
              if (near)
                for (const unsigned int other : around[cell->vertex_index(v)])
                  {
                    bool known = false;
                    for (const auto &candidate : node->second.candidates)
                      known = known || candidate.cell == other;
                    if (!known)
                      node->second.candidates.push_back({other, elsewhere});
                  }
            }
        }
    for (auto &[entry, node] : by_entry)
      nodes.push_back(std::move(node));
  }

  template <int dim>
  unsigned int
  NodalTransfer<dim>::evaluate(const NodalVector   &u,
                               const NodalVector   &x_old,
                               const NodalVector   &x_new,
                               NodalVector         &result,
                               NodalTransferReport &report) const
  {
    unsigned int                         n_lost = 0;
    typename CellNodes<dim>::NodeTensors position;
    typename CellNodes<dim>::NodeNumbers shape;
    for (const Node &node : nodes)
      {
        const unsigned int *entries =
          cells.local_entries(node.candidates[0].cell, node.candidates[0].node);
        Point<dim> x;
        bool       moved = false;
        for (unsigned int d = 0; d < dim; ++d)
          {
            x[d]  = x_new.local_element(entries[d]);
            moved = moved || x[d] != x_old.local_element(entries[d]);
          }
        if (!moved)
          continue;
        ++report.n_moved;

        // The first cell that has the point wins; else the one it is least
        // outside of.
        double       least = std::numeric_limits<double>::max();
        unsigned int best  = 0;
        Point<dim>   best_xi;
        bool         allowed = false;
        for (const Candidate &candidate : node.candidates)
          {
            cells.gather(x_old, candidate.cell, position);
            Point<dim> xi;
            for (unsigned int d = 0; d < dim; ++d)
              xi[d] = candidate.node == elsewhere
                        ? 0.5
                        : cells.unit_position(candidate.node)[d];
            if (!cells.invert(position, x, xi))
              continue;
            double outside = 0.;
            bool   near    = true;
            for (unsigned int f = 0; f < 2 * dim; ++f)
              {
                const double beyond = f % 2 == 0 ? -xi[f / 2] : xi[f / 2] - 1.;
                outside             = std::max(outside, beyond);
                near =
                  near && beyond <= (boundary_face[candidate.cell][f]
                                       ? beyond_boundary
                                       : (node.at_boundary ? beyond_wedge
                                                           : inside_tolerance));
              }
            if (outside < least)
              {
                least   = outside;
                best    = candidate.cell;
                best_xi = xi;
                allowed = near;
              }
            if (least <= inside_tolerance)
              break;
          }

        if (!allowed)
          {
            ++n_lost;
            continue;
          }
        if (least > inside_tolerance)
          {
            ++report.n_extrapolated;
            Point<dim> nearest = best_xi;
            for (unsigned int d = 0; d < dim; ++d)
              nearest[d] = std::min(1., std::max(0., nearest[d]));
            cells.gather(x_old, best, position);
            cells.shape_values(nearest, shape);
            Tensor<1, dim> distance = x;
            for (unsigned int i = 0; i < cells.n_nodes; ++i)
              distance -= shape[i] * position[i];
            report.largest_distance =
              std::max(report.largest_distance, distance.norm());
          }
        // u is the value of the node plus differences, so that a constant field
        // is kept exactly.
        cells.gather(u, best, position);
        cells.shape_values(best_xi, shape);
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double own   = u.local_element(entries[d]);
            double       value = own;
            for (unsigned int i = 0; i < cells.n_nodes; ++i)
              value += shape[i] * (position[i][d] - own);
            result.local_element(entries[d]) = value;
          }
      }
    return n_lost;
  }

  template <int dim>
  NodalTransferReport
  NodalTransfer<dim>::transfer(NodalVector       &u,
                               const NodalVector &x_old,
                               const NodalVector &x_new) const
  {
    cells.check(u);
    cells.check(x_old);
    cells.check(x_new);
    const MPI_Comm     communicator = configuration.communicator();
    const unsigned int n_local = x_old.get_partitioner()->locally_owned_size() +
                                 x_old.get_partitioner()->n_ghost_indices();

    for (unsigned int parts = 1; parts <= most_parts; parts *= 2)
      {
        NodalTransferReport report;
        NodalVector         from(x_old), to(x_old), current(u), next(u);
        from.update_ghost_values();
        to.update_ghost_values();
        current.update_ghost_values();
        unsigned int n_lost = 0;
        for (unsigned int part = 0; part < parts && n_lost == 0; ++part)
          {
            const double fraction = static_cast<double>(part + 1) / parts;
            for (unsigned int i = 0; i < n_local; ++i)
              {
                const double x0 = x_old.local_element(i);
                const double x1 = x_new.local_element(i);
                to.local_element(i) =
                  part + 1 == parts ? x1 : x0 + fraction * (x1 - x0);
              }
            next.zero_out_ghost_values();
            n_lost =
              Utilities::MPI::sum(evaluate(current, from, to, next, report),
                                  communicator);
            next.update_ghost_values();
            hanging.distribute(next);
            for (unsigned int i = 0; i < n_local; ++i)
              current.local_element(i) = next.local_element(i);
            from.swap(to);
          }
        if (n_lost > 0)
          continue;

        for (unsigned int i = 0; i < n_local; ++i)
          u.local_element(i) = current.local_element(i);
        hanging.distribute(u);
        report.n_subcycles = parts;
        report.n_moved     = Utilities::MPI::sum(report.n_moved, communicator);
        report.n_extrapolated =
          Utilities::MPI::sum(report.n_extrapolated, communicator);
        report.largest_distance =
          Utilities::MPI::max(report.largest_distance, communicator);
        return report;
      }
    throw RunError("Transfer",
                   "a node moved out of the cells around it, even in " +
                     std::to_string(most_parts) + " parts",
                   "take smaller steps or rezone more often, so that the mesh "
                   "moves less at once");
  }

  template class NodalTransfer<2>;
  template class NodalTransfer<3>;
} // namespace alveolus
