// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_giuliani_rule_h
#define alveolus_rezoning_giuliani_rule_h

#include <alveolus/rezoning/chebyshev_sweeps.h>
#include <alveolus/rezoning/rezoning_rule.h>

#include <array>
#include <utility>

namespace alveolus
{
  /**
   * Smoothing after S. Giuliani (Nucl. Eng. Des. 72 (1982) 205-212), in our
   * reading. Around a node P each quadrilateral has the triangle P, A, B with
   * A, B the neighbours of P along its edges. The node should stand above the
   * middle m of the base AB (no shear) at the height H = 2 S/|AB| that gives
   * the triangle the mean area S of those around P (no squeeze). With n the
   * unit normal of AB on the side of the element,
   *
   *   x_P = mean over the elements of (m + H n),
   *
   * which minimises the sum of (offset along the base)^2 + (height - H)^2. In
   * 3D the base is the triangle of the three neighbours along edges, m its
   * centroid, and H = 3 V/|ABC| with the mean volume V of the tetrahedra.
   *
   * This pulls graded meshes towards uniform ones, and as an iteration it
   * diverges at irregular vertices, because it does not keep affine images of
   * a mesh. By default [ours] a vertex therefore keeps its place among its
   * neighbours in the sense of the Laplacian on the same triangles at the time
   * of attach(): x_P = sum w_j x_j, with w_j the row of the P1 stiffness matrix
   * of these triangles. The weights are positive where no angle at the base is
   * obtuse; then the iteration converges, and the mesh of attach() and all its
   * affine images are fixed points.
   *
   * Jacobi iteration x <- x + w (x_P - x) with the factor w until no node is
   * further from its x_P than the tolerance times its local size (side of the
   * square, or cube, of twice the mean area, or six times the mean volume), so
   * that the result depends neither on the order of nodes nor on the number of
   * processes. A parallelogram mesh is left alone.
   *
   * Moved are the vertices inside each region, i.e. neither at the boundary nor
   * shared with another region, that no rule of an earlier stage sets. For
   * degree 2, nodes inside cells, faces and lines are then placed between their
   * neighbours (transfinite interpolation: the mean for straight edges).
   */
  template <int dim>
  class GiulianiRule : public RezoningRule<dim>
  {
  public:
    /** When the rule runs, see RezoningRule. */
    using Stage = typename RezoningRule<dim>::Stage;

    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    Stage
    stage(const NamedSets<dim> &names, const std::string &where) const override;
    void
    attach(const Nodes<dim>       &nodes,
           const NodalVector      &positions,
           const std::set<NodeId> &taken,
           const std::string      &where) override;
    void
    apply(const Nodes<dim>  &nodes,
          const NodalVector &start,
          const NodalVector &lagrangian,
          NodalVector       &proposed,
          RezoningReport    &report) const override;
    const std::vector<NodeId> &
    touched_nodes() const override
    {
      return touched;
    }

  private:
    /** A neighbour by the local indices of its components. */
    using LocalNode = std::array<unsigned int, dim>;

    /** Corner of a cell at a vertex: neighbours along the edges. */
    struct Corner
    {
      std::array<LocalNode, dim> neighbours; ///< right-handed seen from P
      std::array<double, dim>    weights;    ///< of the neighbours in x_P
    };

    /** A node placed between others with given weights. */
    struct MiddleNode
    {
      LocalNode                                 node;
      std::vector<std::pair<double, LocalNode>> parents;
    };

    /** Take the weights of the corners @p around a vertex from the mesh. */
    void
    keep_shapes(const NodalVector   &positions,
                const LocalNode     &vertex,
                std::vector<Corner> &around) const;

    /** Gather the weights of each neighbour of a vertex (collective). */
    void
    prepare_chebyshev(const NodalVector &positions);

    /** New place of vertex @p v by its corners, and the local size. */
    std::pair<dealii::Point<dim>, double>
    target(const NodalVector &positions, const unsigned int v) const;

    std::vector<std::string> on;
    std::string              shapes         = "initial";
    bool                     equalise       = false; ///< shapes == "equal"
    std::string              iteration      = "Jacobi";
    double                   tolerance      = 1e-4;
    double                   relaxation     = 0.7;
    unsigned int             largest_sweeps = 500;

    std::vector<LocalNode>    vertices;
    std::vector<unsigned int> first_corner; ///< of each vertex, and the end
    std::vector<Corner>       corners;
    ChebyshevSweeps<dim>      chebyshev;
    /** On lines, faces (3D) and inside cells, in this order. */
    std::array<std::vector<MiddleNode>, dim> middles;
    std::vector<NodeId>                      touched;
  };
} // namespace alveolus

#endif
