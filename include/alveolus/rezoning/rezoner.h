// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_rezoner_h
#define alveolus_rezoning_rezoner_h

#include <alveolus/mesh/hanging_nodes.h>
#include <alveolus/rezoning/rezoning_rule.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * Runs the rules (points, lines, surfaces, volumes) and returns new node
   * positions that keep every vertex Jacobian and every quadrature point
   * Jacobian positive: a proposal that would invert a cell is halved towards
   * the Lagrangian mesh until it does not, at most 8 times; then the Lagrangian
   * mesh is kept as it is. Both are reported.
   *
   * A node belongs to the first rule, by stage, that touches it. Two rules of
   * one stage that set the same component of the same node contradict each
   * other. After every rule hanging nodes are put back into the middle of what
   * they hang on. Within a stage a rule builds on what the rules above it
   * proposed.
   */
  template <int dim>
  class Rezoner
  {
  public:
    /** Take over a rule with the path of its subsection (for messages). */
    void
    add(std::unique_ptr<RezoningRule<dim>> rule, const std::string &where);

    /** Whether there are no rules. */
    bool
    empty() const
    {
      return rules.empty();
    }

    /**
     * Sort the rules by stage, attach them to the mesh at @p positions, and
     * find contradictions (collective). Called at the start and after each
     * remesh.
     * @throws InputError that names both rules and a place, or from a rule
     */
    void
    attach(const Nodes<dim> &nodes, const NodalVector &positions);

    /**
     * New positions for the step start -> lagrangian (nodal vectors, ghosted;
     * collective).
     */
    NodalVector
    propose(const Nodes<dim>  &nodes,
            const NodalVector &start,
            const NodalVector &lagrangian,
            RezoningReport    &report) const;

  private:
    std::vector<std::pair<std::string, std::unique_ptr<RezoningRule<dim>>>>
                                       rules;
    std::unique_ptr<HangingNodes<dim>> hanging; ///< since attach()
  };
} // namespace alveolus

#endif
