// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_outline_h
#define alveolus_assembly_contact_outline_h

#include <alveolus/mesh/nodes.h>

#include <array>
#include <string>
#include <vector>

namespace alveolus
{
  /** No edge. */
  constexpr unsigned int no_edge = dealii::numbers::invalid_unsigned_int;

  /**
   * One boundary line of a plane mesh as a curve of its nodes, in the parameter
   * xi in [0, 1] from its begin to its end: a straight line (degree 1) or a
   * parabola (degree 2).
   */
  class EdgeCurve
  {
  public:
    /** Nodes in the order begin, end(, middle). */
    EdgeCurve(const std::array<dealii::Point<2>, 3> &nodes,
              const unsigned int                     n_nodes);

    /** Shape functions and their derivatives, in the order of the nodes. */
    static std::array<double, 3>
    shapes(const double xi, const unsigned int n_nodes);
    /** Derivatives of the shape functions by xi, in the order of the nodes. */
    static std::array<double, 3>
    shape_derivatives(const double xi, const unsigned int n_nodes);

    /** Point of the curve at xi [mm]. */
    dealii::Point<2>
    point(const double xi) const;

    /** dx/dxi [mm]. */
    dealii::Tensor<1, 2>
    tangent(const double xi) const;

    /** d2x/dxi2 [mm], the same everywhere. */
    dealii::Tensor<1, 2>
    curvature() const;

    /** Unit normal that points out of the body, which is on the left. */
    dealii::Tensor<1, 2>
    normal(const double xi) const;

    /** Length of the part from xi = @p a to @p b [mm]. */
    double
    length(const double a = 0., const double b = 1.) const;

    /**
     * Parameter of the point of the curve, continued beyond its ends, where the
     * perpendicular goes through @p x; the one reached from @p start.
     */
    double
    foot(const dealii::Point<2> &x, const double start) const;

    /** The same, from the foot on the chord. */
    double
    foot(const dealii::Point<2> &x) const;

    const std::array<dealii::Point<2>, 3> nodes; ///< begin, end(, middle) [mm]
    /** 2 (degree 1) or 3 (degree 2). */
    const unsigned int n_nodes;
  };

  /**
   * The lines of named boundary pieces of a plane mesh, each with its body on
   * the left, and how they follow each other; the same on every process.
   * Deformed positions are kept by the user, one point for each node of the
   * outline.
   */
  class ContactOutline
  {
  public:
    struct Edge
    {
      /** Begin, end(, middle), as numbers of nodes of the outline. */
      std::array<unsigned int, 3> nodes;
      unsigned int previous = no_edge; ///< ends where this begins
      unsigned int next     = no_edge; ///< begins where this ends
    };

    /** Edges first, first + 1, ... of one piece that follow each other. */
    struct Chain
    {
      unsigned int first   = 0;     ///< its first edge
      unsigned int n_edges = 0;     ///< number of its edges
      bool         closed  = false; ///< whether the last edge meets the first
    };

    ContactOutline() = default;

    /**
     * (Collective.) @p mesh_nodes must outlive this object.
     * @param list names of boundary pieces, separated by commas
     * @throws InputError for an unknown name, or where more than two of the
     *         lines meet in a point
     */
    ContactOutline(const Nodes<2>    &mesh_nodes,
                   const std::string &list,
                   const std::string &where);

    /** Values of a nodal vector at the nodes of the outline (collective). */
    std::vector<dealii::Point<2>>
    get(const NodalVector &field) const;

    /** An edge as a curve through its nodes at @p positions [mm]. */
    EdgeCurve
    curve(const unsigned int                   edge,
          const std::vector<dealii::Point<2>> &positions) const;

    /** Number of lines of all pieces. */
    unsigned int
    n_edges() const
    {
      return edges.size();
    }

    /**
     * Chain by chain in the order of the names, along the boundary with the
     * body on the left. A closed chain begins at its node with the smallest
     * position (x, then y) in the initial mesh.
     */
    std::vector<Edge> edges;
    /** Pieces of connected edges. */
    std::vector<Chain> chains;
    /** Mesh nodes, by number of the outline. */
    std::vector<NodeId> nodes;
    /** Of x and y of each node. */
    std::vector<std::array<dealii::types::global_dof_index, 2>> dofs;
    unsigned int n_nodes_per_edge = 2; ///< degree + 1

  private:
    const Nodes<2> *mesh_nodes = nullptr; ///< that know the owners
  };
} // namespace alveolus

#endif
