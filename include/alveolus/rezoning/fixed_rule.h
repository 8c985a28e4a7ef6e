// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_fixed_rule_h
#define alveolus_rezoning_fixed_rule_h

#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /**
   * Eulerian nodes: the chosen components c return to where they were before
   * the step, x_c = x_start,c; the material flows through.
   */
  template <int dim>
  class FixedRule : public RezoningRule<dim>
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
    std::bitset<dim>
    touched_components() const override
    {
      return components;
    }

  private:
    std::vector<std::string> on, component_names;
    std::bitset<dim>         components;
    std::vector<NodeId>      touched;
  };
} // namespace alveolus

#endif
