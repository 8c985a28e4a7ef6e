// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_history_picture_h
#define alveolus_transfer_history_picture_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/cell_nodes.h>

#include <vector>

namespace alveolus
{
  /**
   * A picture of mesh and history, whole on every process: about 0.6 kB for
   * each cell of degree 1 with the history of bone in 2D, so that 1e5 cells
   * take 60 MB. Cells are in the order of their ids, hence the same for any
   * number of processes; sub-cell q of cell c has the number c * n_points + q.
   * What it was taken of may be gone afterwards.
   */
  template <int dim>
  class HistoryPicture
  {
  public:
    /** A vector at each node of a cell. */
    using NodeTensors = typename CellNodes<dim>::NodeTensors;

    /**
     * @param with_neighbours whether to find the neighbours of sub-cells
     * Collective. @throws RunError on a mesh with hanging nodes
     */
    HistoryPicture(const Configuration<dim> &configuration,
                   const HistoryStore<dim>  &store,
                   const bool                with_neighbours);

    /**
     * Values of a nodal vector of that mesh at the nodes of each cell, on every
     * process of @p communicator, which are those of the picture (collective).
     */
    std::vector<NodeTensors>
    gather(const NodalVector &u, const MPI_Comm &communicator) const;

    /** The values of a sub-cell, in the layout of its region. */
    const double *
    record(const unsigned int sub_cell) const
    {
      const unsigned int cell = sub_cell / n_points;
      return values.data() + begin[cell] +
             (sub_cell % n_points) * layouts[region[cell]].size;
    }

    /** Cells of all processes. */
    unsigned int
    n_cells() const
    {
      return region.size();
    }

    const CellNodes<dim>       nodes;    ///< shape functions of its cells
    const unsigned int         n_points; ///< sub-cells per cell
    std::vector<double>        breaks;   ///< of SubCells
    std::vector<HistoryLayout> layouts;  ///< by region

    std::vector<unsigned int> region;    ///< by cell
    std::vector<NodeTensors>  positions; ///< by cell [mm]
    /** By sub-cell, in the sense of SubCellNeighbours, if wanted. */
    std::vector<std::vector<unsigned int>> neighbours;

  private:
    std::vector<std::size_t>  begin; ///< of the records of a cell
    std::vector<double>       values;
    std::vector<unsigned int> owned; ///< active indices of own cells
    /** Place of the cells in the order they come from the processes. */
    std::vector<unsigned int> place;
  };
} // namespace alveolus

#endif
