// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/field_bounds.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/reconstruction.h>
#include <alveolus/transfer/transfer_scheme.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** A new sub-cell that is covered by less than this is not covered. */
    constexpr double least_cover = 1e-10;

    std::string
    text(const double x)
    {
      std::ostringstream out;
      out << x;
      return out.str();
    }
  } // namespace

  double
  OverlapReport::content_before() const
  {
    return std::accumulate(regions.begin(),
                           regions.end(),
                           0.,
                           [](const double sum, const Region &r) {
                             return sum + r.content_before;
                           });
  }

  double
  OverlapReport::content_gained() const
  {
    return std::accumulate(regions.begin(),
                           regions.end(),
                           0.,
                           [](const double sum, const Region &r) {
                             return sum + (r.content_gained - r.content_lost);
                           });
  }

  double
  OverlapReport::largest_uncovered_part() const
  {
    double result = 0.;
    for (const Region &region : regions)
      if (region.volume_after > 0.)
        result = std::max(result, region.uncovered / region.volume_after);
    return result;
  }

  double
  OverlapReport::content_after() const
  {
    return std::accumulate(regions.begin(),
                           regions.end(),
                           0.,
                           [](const double sum, const Region &r) {
                             return sum + r.content_after;
                           });
  }

  template <int dim>
  OverlapTransfer<dim>::OverlapTransfer(
    const Configuration<dim> &old_configuration,
    const HistoryStore<dim>  &old_store,
    const std::string        &scheme,
    const std::string        &content_field,
    const Limits             &limits)
    : limits(limits)
    , content_field(content_field)
    , second_order(
        Registry<TransferScheme<dim>>::create(scheme, "Transfer / Scheme")
          ->has_correction())
    , old(old_configuration, old_store, second_order)
    , overlap(old)
    , search(old.nodes, old.positions, old.region)
  {
    if (scheme != "Godunov" && scheme != "limited linear")
      throw InputError(
        "Transfer / Scheme",
        "transfer between unrelated meshes is not written for '" + scheme + "'",
        "choose 'Godunov' or 'limited linear'");

    for (unsigned int r = 0; r < old.layouts.size(); ++r)
      {
        const int           offset = old.layouts[r].offset(content_field);
        std::vector<double> volumes, contents;
        for (const unsigned int c : overlap.cells_of(r))
          for (unsigned int s = c * old.n_points; s < (c + 1) * old.n_points;
               ++s)
            {
              volumes.push_back(overlap.volume(s));
              contents.push_back(
                offset < 0 ? 0. : volumes.back() * old.record(s)[offset]);
            }
        old_volume.push_back(reproducible_sum(volumes, MPI_COMM_SELF));
        old_content.push_back(reproducible_sum(contents, MPI_COMM_SELF));
      }
    if (second_order)
      reconstruct();
  }

  template <int dim>
  void
  OverlapTransfer<dim>::reconstruct()
  {
    gradient.resize(old.n_cells() * old.n_points);
    std::vector<Point<dim>>     around;
    std::vector<Tensor<1, dim>> weights;
    for (unsigned int s = 0; s < gradient.size(); ++s)
      {
        around.clear();
        for (const unsigned int other : old.neighbours[s])
          around.push_back(overlap.centroid(other));
        gradient_weights(overlap.centroid(s), around, weights);
        const unsigned int size =
          old.layouts[old.region[s / old.n_points]].size;
        const double *own = old.record(s);
        gradient[s].assign(size * dim, 0.);
        for (unsigned int j = 0; j < weights.size(); ++j)
          {
            const double *other = old.record(old.neighbours[s][j]);
            for (unsigned int v = 0; v < size; ++v)
              for (unsigned int d = 0; d < dim; ++d)
                gradient[s][v * dim + d] += weights[j][d] * (other[v] - own[v]);
          }
      }
  }

  template <int dim>
  void
  OverlapTransfer<dim>::check_fit(const HistoryStore<dim> &new_store) const
  {
    bool fits = new_store.n_regions() == old.layouts.size() &&
                new_store.n_points == old.n_points;
    for (unsigned int r = 0; fits && r < old.layouts.size(); ++r)
      {
        const HistoryLayout &a = old.layouts[r], &b = new_store.layout(r);
        fits = a.fields.size() == b.fields.size() && a.size == b.size;
        for (unsigned int i = 0; fits && i < a.fields.size(); ++i)
          fits = a.fields[i].name == b.fields[i].name;
      }
    if (!fits)
      throw RunError("Transfer",
                     "the new mesh has other regions, fields or points in a "
                     "cell than the old one",
                     "only the mesh may change");
  }

  template <int dim>
  void
  OverlapTransfer<dim>::constant_part(const Target      &target,
                                      const unsigned int size,
                                      double            *result) const
  {
    // One old value plus differences: a constant is kept exactly.
    const double *first = old.record(target.shares[0].old);
    std::copy(first, first + size, result);
    for (const Share<dim> &share : target.shares)
      {
        const double *value  = old.record(share.old);
        const double  weight = share.volume / target.covered;
        for (unsigned int v = 0; v < size; ++v)
          result[v] += weight * (value[v] - first[v]);
      }
  }

  template <int dim>
  void
  OverlapTransfer<dim>::add_linear_part(const std::vector<Target> &targets,
                                        HistoryStore<dim> &new_store) const
  {
    const MPI_Comm communicator = new_store.triangulation.get_communicator();
    unsigned int   n_fields     = 0;
    for (const auto &layout : old.layouts)
      n_fields = std::max<unsigned int>(n_fields, layout.fields.size());

    // Parts of the gradient of each old sub-cell and field that are taken. The
    // corrections it makes to all new means add up to no content, whatever the
    // factor. New means that keep the bounds ask for nothing; one that does not
    // asks for factors that are right whatever the others do, so that it need
    // not be looked at again.
    std::vector<double>        factor(gradient.size() * n_fields, 1.), wish;
    std::vector<unsigned char> level(targets.size() * n_fields, 0);

    std::vector<std::vector<double>> parts;
    std::vector<const double *>      corrections, around;
    std::vector<double>              sum, wishes;
    std::vector<unsigned int>        near;
    const auto                       evaluate = [&](const Target        &target,
                              const HistoryLayout &layout) {
      parts.resize(std::max(parts.size(), target.shares.size()));
      corrections.clear();
      for (unsigned int i = 0; i < target.shares.size(); ++i)
        {
          const Share<dim> &share = target.shares[i];
          const double     *g = gradient[share.old].data();
          parts[i].assign(layout.size, 0.);
          for (unsigned int v = 0; v < layout.size; ++v)
            for (unsigned int d = 0; d < dim; ++d)
              parts[i][v] += *(g++) * share.first[d] / target.covered;
          corrections.push_back(parts[i].data());
        }
    };
    const auto add = [&](const Target        &target,
                         const HistoryLayout &layout,
                         const unsigned int   field,
                         double              *values) {
      const unsigned int first = layout.offsets[field];
      const unsigned int n     = n_values(layout.fields[field].shape, dim);
      for (unsigned int v = first; v < first + n; ++v)
        for (unsigned int i = 0; i < target.shares.size(); ++i)
          values[v] +=
            factor[target.shares[i].old * n_fields + field] * parts[i][v];
    };

    bool again = true;
    while (again)
      {
        wish  = factor;
        again = false;
        for (unsigned int t = 0; t < targets.size(); ++t)
          {
            const Target &target = targets[t];
            if (target.shares.empty())
              continue;
            const HistoryLayout &layout =
              old.layouts[new_store.region(target.cell)];
            const double *low = new_store.old_record(target.cell, target.point);
            evaluate(target, layout);
            near.clear();
            for (const Share<dim> &share : target.shares)
              {
                near.push_back(share.old);
                near.insert(near.end(),
                            old.neighbours[share.old].begin(),
                            old.neighbours[share.old].end());
              }
            std::sort(near.begin(), near.end());
            near.erase(std::unique(near.begin(), near.end()), near.end());
            around.clear();
            for (const unsigned int s : near)
              around.push_back(old.record(s));

            for (unsigned int a = 0; a < layout.fields.size(); ++a)
              {
                CorrectionLimiter limiter(layout.fields[a],
                                          layout.offsets[a],
                                          dim);
                limiter.set(low, around);
                sum.assign(low, low + layout.size);
                add(target, layout, a, sum.data());
                if (limiter.admits(sum.data(), level[t * n_fields + a]))
                  continue;
                ++level[t * n_fields + a];
                again = true;
                limiter.factors(corrections, level[t * n_fields + a], wishes);
                for (unsigned int i = 0; i < wishes.size(); ++i)
                  {
                    double &w = wish[target.shares[i].old * n_fields + a];
                    w         = std::min(w, wishes[i]);
                  }
              }
          }
        again = Utilities::MPI::max(again ? 1u : 0u, communicator) > 0;
        if (again)
          Utilities::MPI::min(wish, communicator, factor);
      }

    for (const Target &target : targets)
      if (!target.shares.empty())
        {
          const HistoryLayout &layout =
            old.layouts[new_store.region(target.cell)];
          evaluate(target, layout);
          for (unsigned int a = 0; a < layout.fields.size(); ++a)
            add(target,
                layout,
                a,
                new_store.old_record(target.cell, target.point));
        }
  }

  template <int dim>
  OverlapReport
  OverlapTransfer<dim>::transfer(const Configuration<dim> &new_configuration,
                                 HistoryStore<dim>        &new_store) const
  {
    check_fit(new_store);
    const MPI_Comm      communicator = new_configuration.communicator();
    const SubCells<dim> cells(new_configuration, [&](const unsigned int c) {
      return new_store.region(c);
    });
    unsigned int empty = 0; // number of a region without old cells, plus one
    for (const unsigned int c : cells.owned_cells())
      if (overlap.cells_of(new_store.region(c)).empty())
        empty = new_store.region(c) + 1;
    empty = Utilities::MPI::max(empty, communicator);
    if (empty > 0)
      throw RunError("Transfer",
                     "region " + std::to_string(empty - 1) +
                       " has cells in the new mesh and none in the old one",
                     "remeshing must keep the regions");

    std::vector<Point<dim>> new_centroid;
    std::vector<double>     new_volume;
    const NodalVector       x = new_configuration.positions();
    cells.centroids(x, new_centroid, new_volume);
    std::vector<Target> targets = overlap.targets(cells, new_store, x);

    OverlapReport report;
    report.regions.resize(old.layouts.size());
    report.n_folded = overlap.n_folded();
    std::vector<std::vector<double>> uncovered(old.layouts.size()),
      volumes(old.layouts.size()), contents(old.layouts.size());
    for (Target &target : targets)
      {
        const unsigned int r    = new_store.region(target.cell);
        const double       part = target.covered / target.volume;
        report.regions[r].least_covered =
          std::min(report.regions[r].least_covered, part);
        uncovered[r].push_back(std::max(0., target.volume - target.covered));
        double *result = new_store.old_record(target.cell, target.point);
        if (part > least_cover)
          {
            constant_part(target, old.layouts[r].size, result);
            continue;
          }
        ++report.n_uncovered;
        target.shares.clear();
        const double *value = old.record(overlap.nearest(
          r, new_centroid[target.cell * old.n_points + target.point]));
        std::copy(value, value + old.layouts[r].size, result);
      }
    // What is lost is the old function where no new sub-cell is: where it is
    // linear, its moments there, i.e. less what the gradients bring elsewhere.
    const auto covered_content = [&]() {
      std::vector<std::vector<double>> sums(old.layouts.size());
      for (const Target &target : targets)
        {
          const unsigned int r      = new_store.region(target.cell);
          const int          offset = old.layouts[r].offset(content_field);
          if (offset >= 0 && !target.shares.empty())
            sums[r].push_back(
              target.covered *
              new_store.old_record(target.cell, target.point)[offset]);
        }
      std::vector<double> result;
      for (const auto &values : sums)
        result.push_back(reproducible_sum(values, communicator));
      return result;
    };
    std::vector<double> by_gradients(old.layouts.size(), 0.);
    if (second_order)
      {
        const auto before = covered_content();
        add_linear_part(targets, new_store);
        by_gradients = covered_content();
        for (unsigned int r = 0; r < before.size(); ++r)
          by_gradients[r] -= before[r];
      }
    report.n_limited = enforce_bounds(new_store);
    new_store.update_ghosts();

    report.n_uncovered = Utilities::MPI::sum(report.n_uncovered, communicator);
    for (const Target &target : targets)
      {
        const unsigned int r      = new_store.region(target.cell);
        const int          offset = old.layouts[r].offset(content_field);
        volumes[r].push_back(
          new_volume[target.cell * old.n_points + target.point]);
        if (offset >= 0)
          contents[r].push_back(
            volumes[r].back() *
            new_store.old_record(target.cell, target.point)[offset]);
      }
    // Old sub-cells are known to all processes, the shares to those of the new
    std::vector<double>              taken(old.n_cells() * old.n_points, 0.);
    std::vector<std::vector<double>> gained(old.layouts.size());
    for (const Target &target : targets)
      {
        const unsigned int r      = new_store.region(target.cell);
        const int          offset = old.layouts[r].offset(content_field);
        for (const Share<dim> &share : target.shares)
          taken[share.old] += share.volume;
        if (offset >= 0)
          gained[r].push_back(
            (new_volume[target.cell * old.n_points + target.point] -
             (target.shares.empty() ? 0. : target.covered)) *
            new_store.old_record(target.cell, target.point)[offset]);
      }
    Utilities::MPI::sum(taken, communicator, taken);
    std::vector<std::vector<double>> lost(old.layouts.size());
    for (unsigned int s = 0; s < taken.size(); ++s)
      {
        const unsigned int r      = old.region[s / old.n_points];
        const int          offset = old.layouts[r].offset(content_field);
        if (offset >= 0)
          lost[r].push_back((overlap.volume(s) - taken[s]) *
                            old.record(s)[offset]);
      }
    for (unsigned int r = 0; r < old.layouts.size(); ++r)
      {
        OverlapReport::Region &region = report.regions[r];
        region.content_gained = reproducible_sum(gained[r], communicator);
        region.content_lost =
          reproducible_sum(lost[r], MPI_COMM_SELF) - by_gradients[r];
        region.volume_before  = old_volume[r];
        region.content_before = old_content[r];
        region.volume_after   = reproducible_sum(volumes[r], communicator);
        region.content_after  = reproducible_sum(contents[r], communicator);
        region.uncovered      = reproducible_sum(uncovered[r], communicator);
        region.least_covered =
          Utilities::MPI::min(region.least_covered, communicator);
        if (region.uncovered > limits.uncovered * region.volume_after)
          throw RunError("Transfer",
                         text(100. * region.uncovered / region.volume_after) +
                           " % of region " + std::to_string(r) +
                           " of the new mesh is outside the old one",
                         "let the new mesh follow the outline more closely, "
                         "e.g. with a smaller element size");
      }
    return report;
  }

  template <int dim>
  NodalVector
  OverlapTransfer<dim>::nodal(const NodalVector        &u_old,
                              const Configuration<dim> &new_configuration,
                              const HistoryStore<dim>  &new_store,
                              OverlapReport            &report) const
  {
    const MPI_Comm communicator      = new_configuration.communicator();
    const std::vector<NodeTensors> u = old.gather(u_old, communicator);
    NodeTensors                    f;

    // The new nodes, with the regions of all cells around them.
    const CellNodes<dim> new_nodes(new_configuration);
    NodalVector          result  = new_configuration.make_vector();
    const NodalVector    x       = new_configuration.positions();
    const unsigned int   n_owned = result.locally_owned_size();
    struct NewNode
    {
      const unsigned int    *entries;
      Point<dim>             x;
      std::set<unsigned int> regions;
    };
    std::map<unsigned int, NewNode> new_node;
    for (const auto &cell :
         new_configuration.mesh.triangulation->active_cell_iterators())
      if (!cell->is_artificial())
        {
          const unsigned int c = cell->active_cell_index();
          new_nodes.gather(x, c, f);
          for (unsigned int i = 0; i < new_nodes.n_nodes; ++i)
            {
              const unsigned int *entries = new_nodes.local_entries(c, i);
              if (entries[0] >= n_owned)
                continue;
              NewNode &node = new_node[entries[0]];
              node.entries  = entries;
              node.x        = Point<dim>(f[i]);
              node.regions.insert(new_store.region(c));
            }
        }

    result.zero_out_ghost_values();
    unsigned int n_outside = 0, n_lost = 0;
    double       largest = 0., largest_lost = 0.;
    for (const auto &[entry, node] : new_node)
      {
        const auto found = search.find(node.x, node.regions);
        if (found.cell == numbers::invalid_unsigned_int ||
            !(found.excess <= limits.excess))
          {
            ++n_lost;
            largest_lost = std::max(largest_lost, found.distance);
            continue;
          }
        if (found.excess > 0.)
          {
            ++n_outside;
            largest = std::max(largest, found.distance);
          }
        const Tensor<1, dim> value = search.evaluate(found, u[found.cell]);
        for (unsigned int d = 0; d < dim; ++d)
          result.local_element(node.entries[d]) = value[d];
      }
    result.update_ghost_values();

    n_lost = Utilities::MPI::sum(n_lost, communicator);
    if (n_lost > 0)
      throw RunError("Transfer",
                     std::to_string(n_lost) +
                       " nodes of the new mesh are too far outside the old "
                       "one, up to " +
                       text(Utilities::MPI::max(largest_lost, communicator)) +
                       " mm",
                     "let the new mesh follow the outline more closely, e.g. "
                     "with a smaller element size");
    report.n_nodes_outside += Utilities::MPI::sum(n_outside, communicator);
    report.largest_distance =
      std::max(report.largest_distance,
               Utilities::MPI::max(largest, communicator));
    return result;
  }

  template class OverlapTransfer<2>;
  template class OverlapTransfer<3>;
} // namespace alveolus
