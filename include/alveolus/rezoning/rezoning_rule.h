// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_rezoning_rule_h
#define alveolus_rezoning_rezoning_rule_h

#include <alveolus/base/registry.h>
#include <alveolus/mesh/nodes.h>

#include <deal.II/base/parameter_handler.h>

namespace alveolus
{
  /**
   * One rule for new node positions, acting on named sets. Rules run in the
   * order of their stages, within a stage in the order of the parameter file.
   * A node that no rule touches stays where the material took it. A rule is
   * geometry only: it knows nothing of physics.
   */
  template <int dim>
  class RezoningRule
  {
  public:
    enum class Stage
    {
      points,
      lines,
      surfaces,
      volumes
    };

    virtual ~RezoningRule() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    virtual Stage
    stage() const = 0;

    /**
     * Resolve the names and keep what refers to the mesh as it is now, e.g.
     * relative arc lengths at @p positions. Called at the start and after each
     * remesh (collective).
     * @param where path of the rule's subsection, for messages
     * @throws InputError
     */
    virtual void
    attach(const Nodes<dim>  &nodes,
           const NodalVector &positions,
           const std::string &where) = 0;

    /**
     * Write new positions of the rule's nodes into @p proposed (collective).
     * @param start      positions before the Lagrangian step [mm], ghosted
     * @param lagrangian positions after it, where the material is [mm], ghosted
     * @param proposed   in: what earlier rules proposed; out: with ghosts
     * updated
     */
    virtual void
    apply(const Nodes<dim>  &nodes,
          const NodalVector &start,
          const NodalVector &lagrangian,
          NodalVector       &proposed) const = 0;

    /** Nodes this rule sets, so that contradictory rules can be found. */
    virtual const std::vector<NodeId> &
    touched_nodes() const = 0;
  };
} // namespace alveolus

#endif
