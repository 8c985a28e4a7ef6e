// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_cell_search_h
#define alveolus_transfer_cell_search_h

#include <alveolus/geometry/box_tree.h>
#include <alveolus/transfer/cell_nodes.h>

#include <set>
#include <vector>

namespace alveolus
{
  /**
   * Finds the cell that has a point, among cells given by their nodal positions
   * and regions, wherever they come from.
   */
  template <int dim>
  class CellSearch
  {
  public:
    /** A vector at each node of a cell. */
    using NodeTensors = typename CellNodes<dim>::NodeTensors;

    /** Where a point is. */
    struct Place
    {
      /** Active cell index, or invalid. */
      unsigned int       cell = dealii::numbers::invalid_unsigned_int;
      dealii::Point<dim> xi; ///< unit coordinates in that cell
      /** Node of the cell that the point coincides with, if any. */
      unsigned int node = dealii::numbers::invalid_unsigned_int;
      /** From the nearest cell; 0 inside [mm]. */
      double distance = 0.;
      /** How far outside in unit coordinates; 0 inside. */
      double excess = 0.;
    };

    /**
     * @param nodes     the map of the cells; copied
     * @param positions of the nodes of each cell
     * @param regions   region index of each cell
     */
    CellSearch(const CellNodes<dim>            &nodes,
               const std::vector<NodeTensors>  &positions,
               const std::vector<unsigned int> &regions);

    /**
     * The first cell of one of @p regions, in their order and in that of the
     * cells, that has @p x; else the nearest one among the 24 cells with the
     * nearest bounding boxes. Place::cell is invalid if there is none.
     */
    Place
    find(const dealii::Point<dim>     &x,
         const std::set<unsigned int> &regions) const;

    /** Value at @p place of a function with the values @p f at its cell's nodes
     */
    dealii::Tensor<1, dim>
    evaluate(const Place &place, const NodeTensors &f) const;

  private:
    /** The cells of one region. */
    struct Region
    {
      std::vector<unsigned int> cells;
      BoxTree<dim>              tree;
    };

    CellNodes<dim>           nodes;
    std::vector<NodeTensors> positions;
    std::vector<Region>      by_region;
  };
} // namespace alveolus

#endif
