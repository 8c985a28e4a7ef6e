// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/sub_cell_overlap.h>
#include <alveolus/transfer/sub_cell_shapes.h>

#include <deal.II/base/parallel.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Overlaps below this part of the smaller body are round-off. */
    constexpr double sliver = 1e-14;

    template <int dim>
    BoundingBox<dim>
    box_of(const ConvexPiece<dim> &piece)
    {
      return BoxTree<dim>::around(piece.corners, piece.n_corners);
    }

  } // namespace

  template <int dim>
  SubCellOverlap<dim>::SubCellOverlap(const HistoryPicture<dim> &old)
    : old(old)
  {
    const SubCellShapes<dim>      shapes(old.nodes, old.breaks);
    std::vector<ConvexPiece<dim>> pieces;
    std::vector<unsigned int>     point;
    regions.resize(old.layouts.size());
    volumes.resize(old.n_cells() * old.n_points);
    centroids.resize(volumes.size());
    for (unsigned int c = 0; c < old.n_cells(); ++c)
      {
        Region &region = regions[old.region[c]];
        folded += shapes.pieces(old.positions[c], pieces, point);
        region.cells.push_back(c);
        region.pieces.insert(region.pieces.end(), pieces.begin(), pieces.end());
        // Moments relative to one node, for the sake of round-off.
        const Tensor<1, dim> base = old.positions[c][0];
        for (unsigned int i = 0; i < pieces.size(); ++i)
          {
            const unsigned int s = c * old.n_points + point[i];
            const auto         m = moments(pieces[i]);
            region.sub_cell.push_back(s);
            volumes[s] += m.volume;
            centroids[s] +=
              m.first + m.volume * (pieces[i].corners[0] - Point<dim>(base));
          }
        for (unsigned int s = c * old.n_points; s < (c + 1) * old.n_points; ++s)
          centroids[s] = Point<dim>(base + centroids[s] / volumes[s]);
      }

    for (Region &region : regions)
      {
        std::vector<BoundingBox<dim>> boxes;
        for (const auto &piece : region.pieces)
          boxes.push_back(box_of(piece));
        region.tree = std::make_unique<BoxTree<dim>>(boxes);
      }
  }

  template <int dim>
  unsigned int
  SubCellOverlap<dim>::nearest(const unsigned int region,
                               const Point<dim>  &x) const
  {
    double       least  = std::numeric_limits<double>::max();
    unsigned int result = 0;
    for (const unsigned int c : regions[region].cells)
      for (unsigned int s = c * old.n_points; s < (c + 1) * old.n_points; ++s)
        {
          const double distance = x.distance_square(centroids[s]);
          if (distance < least)
            {
              least  = distance;
              result = s;
            }
        }
    return result;
  }

  template <int dim>
  std::vector<OverlapTarget<dim>>
  SubCellOverlap<dim>::targets(const SubCells<dim>     &cells,
                               const HistoryStore<dim> &new_store,
                               const NodalVector       &x) const
  {
    // Cells are independent of each other: any order gives the same result.
    const SubCellShapes<dim>        shapes(cells.nodes, cells.breaks());
    const auto                     &owned = cells.owned_cells();
    std::vector<OverlapTarget<dim>> result(owned.size() * old.n_points);
    parallel::apply_to_subranges(
      0U,
      static_cast<unsigned int>(owned.size()),
      [&](const unsigned int begin, const unsigned int end) {
        std::vector<ConvexPiece<dim>>        pieces;
        std::vector<unsigned int>            point, found;
        typename CellNodes<dim>::NodeTensors position;
        for (unsigned int i = begin; i < end; ++i)
          {
            const unsigned int  c      = owned[i];
            const Region       &region = regions[new_store.region(c)];
            OverlapTarget<dim> *first  = result.data() + i * old.n_points;
            for (unsigned int q = 0; q < old.n_points; ++q)
              {
                first[q].cell  = c;
                first[q].point = q;
              }
            cells.nodes.gather(x, c, position);
            shapes.pieces(position, pieces, point);
            for (unsigned int k = 0; k < pieces.size(); ++k)
              add_shares(region, pieces[k], found, first[point[k]]);
            for (unsigned int q = 0; q < old.n_points; ++q)
              merge_shares(first[q]);
          }
      },
      16);
    return result;
  }



  template <int dim>
  void
  SubCellOverlap<dim>::add_shares(const Region              &region,
                                  const ConvexPiece<dim>    &piece,
                                  std::vector<unsigned int> &found,
                                  OverlapTarget<dim>        &target) const
  {
    const double own = moments(piece).volume;
    target.volume += own;
    region.tree->meeting(box_of(piece), found);
    for (const unsigned int k : found)
      {
        const unsigned int s      = region.sub_cell[k];
        const auto         common = overlap(piece, region.pieces[k]);
        if (common.volume > sliver * std::min(own, volumes[s]))
          target.shares.push_back(
            {s,
             common.volume,
             common.first + common.volume * (piece.corners[0] - centroids[s])});
      }
  }



  template <int dim>
  void
  SubCellOverlap<dim>::merge_shares(OverlapTarget<dim> &target)
  {
    auto &shares = target.shares;
    std::stable_sort(shares.begin(),
                     shares.end(),
                     [](const Share<dim> &a, const Share<dim> &b) {
                       return a.old < b.old;
                     });
    std::vector<Share<dim>> merged;
    for (const Share<dim> &share : shares)
      {
        target.covered += share.volume;
        if (merged.empty() || merged.back().old != share.old)
          merged.push_back(share);
        else
          {
            merged.back().volume += share.volume;
            merged.back().first += share.first;
          }
      }
    shares = std::move(merged);
  }

  template class SubCellOverlap<2>;
  template class SubCellOverlap<3>;
} // namespace alveolus
