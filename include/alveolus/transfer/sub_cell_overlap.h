// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_sub_cell_overlap_h
#define alveolus_transfer_sub_cell_overlap_h

#include <alveolus/geometry/box_tree.h>
#include <alveolus/geometry/convex_overlap.h>
#include <alveolus/transfer/history_picture.h>
#include <alveolus/transfer/subcells.h>

#include <vector>

namespace alveolus
{
  /** What a new sub-cell has in common with an old one. */
  template <int dim>
  struct Share
  {
    unsigned int           old;    ///< number in the picture
    double                 volume; ///< [mm^dim]
    dealii::Tensor<1, dim> first;  ///< moment about the old centroid
  };

  /** A new sub-cell, with its shares in the order of the old sub-cells. */
  template <int dim>
  struct OverlapTarget
  {
    unsigned int            cell;   ///< active cell index
    unsigned int            point;  ///< quadrature point of the sub-cell
    std::vector<Share<dim>> shares; ///< of the old sub-cells that it overlaps
    double                  volume  = 0.; ///< of its pieces [mm^dim]
    double                  covered = 0.; ///< of all shares [mm^dim]
  };

  /**
   * Intersects the sub-cells of a picture with those of another mesh, region by
   * region, piece by piece (see SubCellShapes), found by a tree of boxes.
   */
  template <int dim>
  class SubCellOverlap
  {
  public:
    /** @param old must outlive this object */
    explicit SubCellOverlap(const HistoryPicture<dim> &old);

    /**
     * The owned sub-cells of another mesh at the positions @p x; in the order
     * of cells.owned_cells() and points.
     */
    std::vector<OverlapTarget<dim>>
    targets(const SubCells<dim>     &cells,
            const HistoryStore<dim> &new_store,
            const NodalVector       &x) const;

    /** The old sub-cell of a region with the centroid nearest to @p x. */
    unsigned int
    nearest(const unsigned int region, const dealii::Point<dim> &x) const;

    /** Old cells of a region. */
    const std::vector<unsigned int> &
    cells_of(const unsigned int region) const
    {
      return regions[region].cells;
    }

    /** Volume of the pieces of an old sub-cell [mm^dim]. */
    double
    volume(const unsigned int sub_cell) const
    {
      return volumes[sub_cell];
    }

    /** Their centroid [mm]. */
    const dealii::Point<dim> &
    centroid(const unsigned int sub_cell) const
    {
      return centroids[sub_cell];
    }

    /** Number of folded pieces of old sub-cells. */
    unsigned int
    n_folded() const
    {
      return folded;
    }

  private:
    /** The old sub-cells of one region. */
    struct Region
    {
      std::vector<ConvexPiece<dim>> pieces;
      std::vector<unsigned int>     sub_cell; ///< of each piece
      std::vector<unsigned int>     cells;
      std::unique_ptr<BoxTree<dim>> tree;
    };

    /** Overlaps of one piece of a new sub-cell; @p found is work space. */
    void
    add_shares(const Region              &region,
               const ConvexPiece<dim>    &piece,
               std::vector<unsigned int> &found,
               OverlapTarget<dim>        &target) const;
    /** One share for each old sub-cell, in their order. */
    static void
    merge_shares(OverlapTarget<dim> &target);

    const HistoryPicture<dim>      &old;
    std::vector<Region>             regions;
    std::vector<double>             volumes;
    std::vector<dealii::Point<dim>> centroids;
    unsigned int                    folded = 0;
  };
} // namespace alveolus

#endif
