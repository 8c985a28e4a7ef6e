// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_spline_rule_h
#define alveolus_rezoning_spline_rule_h

#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/rezoning/anchored_curve.h>
#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /**
   * Curves whose shape is the material's while their nodes keep their spacing:
   * the nodes are relocated along the cubic spline through their Lagrangian
   * positions to the relative arc lengths they had when the rule was attached.
   * Anchors (the ends of an open curve, the first node of a closed one, and
   * nodes set by rules of earlier stages) do not move; the spline goes through
   * their proposed positions.
   */
  template <int dim>
  class SplineRule : public RezoningRule<dim>
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
    CubicSpline<dim>
    fit(const std::vector<dealii::Point<dim>> &points, const bool closed) const;

    std::vector<std::string>   on;
    std::string                ends = "not-a-knot", knots = "chord length";
    std::vector<AnchoredCurve> curves;
    std::vector<NodeId>        touched;
  };
} // namespace alveolus

#endif
