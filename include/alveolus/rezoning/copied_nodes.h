// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_copied_nodes_h
#define alveolus_rezoning_copied_nodes_h

#include <alveolus/rezoning/rezoning_rule.h>

namespace alveolus
{
  /** Rules that take the chosen components of positions from elsewhere. */
  template <int dim>
  class CopiedNodes : public RezoningRule<dim>
  {
  public:
    /** When the rule runs, see RezoningRule. */
    using Stage = typename RezoningRule<dim>::Stage;

    /** Where the positions come from. */
    enum class Source
    {
      start,     ///< of the mesh before the step
      lagrangian ///< of the material after it
    };

    /** @param which components the parameter `Components` chooses, for the
     *        manual */
    CopiedNodes(const std::string &which, const Source source);

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
    std::bitset<dim>         components; ///< that are copied
    std::vector<NodeId>      touched;    ///< nodes that are copied
    const std::string        which;
    const Source             source;
    std::vector<std::string> on, component_names;
  };

  /**
   * Eulerian nodes: the chosen components c return to where they were before
   * the step, x_c = x_start,c; the material flows through.
   */
  template <int dim>
  class FixedRule : public CopiedNodes<dim>
  {
  public:
    FixedRule();
  };

  /**
   * Lagrangian nodes, explicitly: x_c = x_lagrangian,c in the chosen
   * components. Useful to take nodes away from rules of later stages.
   */
  template <int dim>
  class MaterialRule : public CopiedNodes<dim>
  {
  public:
    MaterialRule();
  };
} // namespace alveolus

#endif
