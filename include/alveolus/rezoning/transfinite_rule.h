// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_transfinite_rule_h
#define alveolus_rezoning_transfinite_rule_h

#include <alveolus/rezoning/rezoning_rule.h>

#include <utility>

namespace alveolus
{
  /**
   * Inner nodes of structured blocks from their edges (2D) or faces (3D) by
   * transfinite interpolation (W. J. Gordon, C. A. Hall, Int. J. Numer. Methods
   * Eng. 7 (1973) 461-477). With the projector (P_a x) = (1-xi_a) x(I_a = 0) +
   * xi_a x(I_a = n_a) between the two sides across the direction a,
   *
   *   x = P_1 + P_2 - P_1 P_2   (2D; Boolean sum of three projectors in 3D)
   *
   * The relative parameters xi_a blend the relative lengths along the edges of
   * direction a, linearly with the other xi. A block that was not made in this
   * way differs from it by a residual; it is expressed in the vectors between
   * opposite sides, x += sum_a alpha_a (x(I_a = n_a) - x(I_a = 0)). All xi and
   * alpha are those of the mesh to which the rule was attached. Therefore an
   * undeformed block stays as it is, however graded, every affine motion of the
   * border is followed exactly, and a block of bilinear shape with equal
   * spacing on opposite edges is reproduced.
   *
   * The block is found from the connectivity of the cells alone: its corners
   * are the vertices with one cell of the region. Its border keeps what other
   * rules (or the material) gave. Border and connectivity of the region are
   * replicated on every process, inner positions are not.
   */
  template <int dim>
  class TransfiniteRule : public RezoningRule<dim>
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
    bool
    needs_lattices() const override
    {
      return true;
    }
    const std::vector<NodeId> &
    touched_nodes() const override
    {
      return touched;
    }

  private:
    /** A node inside, as a fixed combination of border nodes. */
    struct InnerNode
    {
      NodeId                                       node;
      std::vector<std::pair<double, unsigned int>> parents;
    };

    struct Block
    {
      std::vector<NodeId>    border;
      std::vector<InnerNode> inner; ///< owned ones
    };

    Block
    make_block(const Nodes<dim>       &nodes,
               const NodalVector      &positions,
               const std::set<NodeId> &taken,
               const std::string      &name,
               const std::string      &where) const;

    std::vector<std::string> on;
    std::vector<Block>       blocks;
    std::vector<NodeId>      touched;
  };
} // namespace alveolus

#endif
