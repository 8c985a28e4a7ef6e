// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_follow_rule_h
#define alveolus_rezoning_follow_rule_h

#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /**
   * Nodes that take the displacement of a leader over the step, in chosen
   * components c:
   *
   *   x_c = x_start,c + (x_leader,proposed - x_leader,start)_c
   *
   * (Mengoni et al. 2016, model 1: B, H, I move horizontally with C). The other
   * components stay as proposed, i.e. Lagrangian unless another rule sets them.
   * A leader that an earlier rule moves counts with its proposed position.
   */
  template <int dim>
  class FollowRule : public RezoningRule<dim>
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
      return followers;
    }
    std::bitset<dim>
    touched_components() const override
    {
      return components;
    }

  private:
    std::vector<std::string> on, component_names;
    std::string              leader_name;
    std::bitset<dim>         components;
    NodeId                   leader = dealii::numbers::invalid_dof_index;
    std::vector<NodeId>      followers;
  };
} // namespace alveolus

#endif
