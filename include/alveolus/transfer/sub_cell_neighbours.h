// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_sub_cell_neighbours_h
#define alveolus_transfer_sub_cell_neighbours_h

#include <alveolus/state/history_store.h>
#include <alveolus/transfer/subcells.h>

#include <vector>

namespace alveolus
{
  /**
   * Which sub-cells (see SubCells) of the same region share a corner with a
   * sub-cell: in the middle of a structured mesh 8 in 2D and 26 in 3D. Found
   * from the vertices of cells, once per mesh; positions do not matter.
   */
  template <int dim>
  class SubCellNeighbours
  {
  public:
    /** For the owned sub-cells; ghosts are among their neighbours. */
    SubCellNeighbours(const SubCells<dim>     &cells,
                      const HistoryStore<dim> &store);

    /**
     * Neighbours of an owned sub-cell, without itself, in the order of cell ids
     * and points, which is the same for any number of processes.
     */
    const std::vector<unsigned int> &
    operator[](const unsigned int sub_cell) const
    {
      return neighbours[sub_cell];
    }

  private:
    std::vector<std::vector<unsigned int>> neighbours;
  };
} // namespace alveolus

#endif
