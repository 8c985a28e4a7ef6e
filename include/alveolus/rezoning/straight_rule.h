// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_straight_rule_h
#define alveolus_rezoning_straight_rule_h

#include <alveolus/rezoning/anchored_curve.h>
#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /**
   * Lines that stay straight: a node at relative place r between the anchors a
   * and b goes to x = (1-r) x_a + r x_b, with the proposed positions of the
   * anchors (the ends, and nodes set by rules of earlier stages) and r from the
   * lengths along the line when the rule was attached.
   */
  template <int dim>
  class StraightRule : public RezoningRule<dim>
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
    std::vector<std::string>   on;
    std::vector<AnchoredCurve> lines;
    std::vector<NodeId>        touched;
  };
} // namespace alveolus

#endif
