// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /**
   * Nodes that go only a part of the way of the material in each step:
   * x = x_start + s (x_lagrangian - x_start). 0 is the rule `fixed`, 1 is
   * `material`.
   */
  template <int dim>
  class TrailingRule : public RezoningRule<dim>
  {
  public:
    using Stage = typename RezoningRule<dim>::Stage;

    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("On",
                        on,
                        "Points, curves, boundaries or regions.",
                        dealii::Patterns::List(dealii::Patterns::Anything()));
      prm.add_parameter("Share",
                        share,
                        "Part s of the material's way [-].",
                        dealii::Patterns::Double(0., 1.));
    }

    Stage
    stage(const NamedSets<dim> &names, const std::string &where) const override
    {
      return stage_of(on, names, where); // points, lines, surfaces or volumes
    }

    void
    attach(const Nodes<dim> &nodes,
           const NodalVector & /*positions*/,
           const std::set<NodeId> &taken,
           const std::string      &where) override
    {
      touched = nodes_of(on, nodes, taken, where);
    }

    void
    apply(const Nodes<dim>  &nodes,
          const NodalVector &start,
          const NodalVector &lagrangian,
          NodalVector       &proposed,
          RezoningReport & /*report*/) const override
    {
      for (const NodeId node : touched)
        if (nodes.is_owned(node))
          {
            const dealii::Point<dim> from = nodes.get(start, node);
            nodes.set(proposed,
                      node,
                      from + share * (nodes.get(lagrangian, node) - from));
          }
      proposed.update_ghost_values();
    }

    const std::vector<NodeId> &
    touched_nodes() const override
    {
      return touched;
    }

  private:
    std::vector<std::string> on;
    double                   share = 0.5;
    std::vector<NodeId>      touched;
  };
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::TrailingRule,
  "trailing",
  "The nodes `On` go the part s, `Share`, of the way of the material in each "
  "step: x = x_start + s (x_lagrangian - x_start).")
