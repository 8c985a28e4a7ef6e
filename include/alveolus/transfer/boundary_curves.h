// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_boundary_curves_h
#define alveolus_transfer_boundary_curves_h

#include <alveolus/state/face_history.h>
#include <alveolus/transfer/cell_nodes.h>

#include <deal.II/base/quadrature_lib.h>

#include <array>
#include <functional>
#include <vector>

namespace alveolus
{
  /** A boundary edge of the plane with its history, kept by every process. */
  struct BoundaryEdge
  {
    /** Positions of all nodes of an edge [mm]. */
    using Nodes = std::vector<dealii::Point<2>>;

    std::array<dealii::types::global_dof_index, 2> vertex; ///< ids of the ends
    std::array<dealii::Point<2>, 2> initial; ///< where the ends began [mm]
    Nodes                           before;  ///< in the face's direction [mm]
    Nodes                           after;   ///< the same, moved [mm]
    std::vector<double>             values;  ///< by sub-segment and component

    /** For Boost.Serialization. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &vertex &initial &before &after &values;
    }
  };

  /** Edges that follow each other. */
  struct BoundaryCurve
  {
    /** The place of an edge in its curve. */
    struct Link
    {
      unsigned int edge;     ///< index of the edge
      bool         reversed; ///< against the edge's direction
    };

    std::vector<Link> links;          ///< edges from begin to end
    bool              closed = false; ///< whether the last one meets the first
  };

  /**
   * Put edges in order. An open curve begins at the end with the smaller
   * initial position, a closed one at its smallest vertex, whatever the numbers
   * of vertices, which depend on the number of processes.
   * @throws RunError if the boundary branches
   */
  std::vector<BoundaryCurve>
  find_curves(const std::vector<BoundaryEdge> &edges);

  /**
   * The edges of all processes, those of each in the order of its records
   * (collective), with nodes `before` at @p x_before and `after` at @p x_after.
   * @param first_own number of the first edge of this process
   */
  std::vector<BoundaryEdge>
  gather_edges(const dealii::DoFHandler<2> &dof_handler,
               const CellNodes<2>          &cells,
               const FaceHistory<2>        &history,
               const NodalVector           &x_initial,
               const NodalVector           &x_before,
               const NodalVector           &x_after,
               unsigned int                &first_own);

  /** The polynomial through the nodes of an edge on the unit interval. */
  class EdgeMap
  {
  public:
    /** @param degree 1, 2 or 3 */
    explicit EdgeMap(const CellNodes<2> &cells);

    /** Position and derivative at @p s. */
    void
    evaluate(const BoundaryEdge::Nodes &nodes,
             const double               s,
             dealii::Point<2>          &x,
             dealii::Tensor<1, 2>      &tangent) const;

    /** Length between two unit coordinates [mm]. */
    double
    length(const BoundaryEdge::Nodes &nodes,
           const double               from,
           const double               to) const;

    /** Unit coordinate of the point nearest to @p y, and its distance [mm]. */
    double
    project(const BoundaryEdge::Nodes &nodes,
            const dealii::Point<2>    &y,
            double                    &distance) const;

  private:
    const CellNodes<2>      cells;
    const dealii::QGauss<1> gauss;
  };

  /** Ends of the sub-segments on the unit interval: 0, ..., 1. */
  std::vector<double>
  segment_breaks(const unsigned int n_points);

  /**
   * A curve by the arc length at the ends of its sub-segments [mm], 0, ...,
   * whole length.
   */
  struct ArcLengths
  {
    std::vector<double> ends;           ///< by sub-segment [mm]
    bool                closed = false; ///< whether the end is the begin

    /** Number of the sub-segment at arc length @p x (not unwound). */
    unsigned int
    segment_at(const double x) const;

    /**
     * Call add(sub-segment, part) with the parts, which add up to one, that
     * sub-segments have in the piece of curve from @p a to @p b >= a. On a
     * closed curve it may begin or end up to one turn away; on an open one the
     * first and last sub-segment go on beyond the ends.
     */
    void
    pieces(const double                                     a,
           const double                                     b,
           const std::function<void(unsigned int, double)> &add) const;
  };

  /** Arc lengths of the sub-segments of @p curve at positions @p nodes. */
  ArcLengths
  arc_lengths(const EdgeMap                   &map,
              const std::vector<double>       &breaks,
              const BoundaryCurve             &curve,
              const std::vector<BoundaryEdge> &edges,
              BoundaryEdge::Nodes BoundaryEdge::*nodes);
} // namespace alveolus

#endif
