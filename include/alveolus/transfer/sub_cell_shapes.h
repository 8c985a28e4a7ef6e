// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_sub_cell_shapes_h
#define alveolus_transfer_sub_cell_shapes_h

#include <alveolus/geometry/convex_overlap.h>
#include <alveolus/transfer/cell_nodes.h>

#include <vector>

namespace alveolus
{
  /**
   * The sub-cells of a cell (see SubCells) as convex pieces, for intersections.
   *
   * In 2D a sub-cell of degree 1 has straight edges: one quadrilateral, or two
   * triangles where it is not convex. For degree 2 its edges are parabolas and
   * are replaced by polylines of four chords: it is cut, on the unit cell, into
   * 4 x 4 quadrilaterals with straight edges. The inner points of the polylines
   * lie outside the parabola by 1/15 of their height over its chord, so that
   * the enclosed area is that of the sub-cell exactly; neighbours share their
   * polylines. In 3D a sub-cell (degree 2: each of its 2 x 2 x 2 parts) is cut
   * into 24 tetrahedra through the means of its faces and of all its corners;
   * for degree 1 their volumes add up to that of the trilinear sub-cell
   * exactly.
   */
  template <int dim>
  class SubCellShapes
  {
  public:
    /** @param breaks ends of the sub-cells on the unit interval, 0, ..., 1 */
    SubCellShapes(const CellNodes<dim>      &nodes,
                  const std::vector<double> &breaks);

    /**
     * Convex pieces of the sub-cells of the cell whose nodes are at
     * @p positions, and the number 0, ..., n_points-1 of the sub-cell of each.
     * @return number of pieces that are folded over (inverted corners): of
     *         these only the parts with positive volume are taken
     */
    unsigned int
    pieces(const typename CellNodes<dim>::NodeTensors &positions,
           std::vector<ConvexPiece<dim>>              &result,
           std::vector<unsigned int>                  &sub_cell) const;

  private:
    unsigned int        n_nodes;
    unsigned int        n_1d;    ///< sub-cells in one direction
    unsigned int        n_parts; ///< of a sub-cell in one direction
    std::vector<double> shape;   ///< at each lattice point, for each node
  };
} // namespace alveolus

#endif
