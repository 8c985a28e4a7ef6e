// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_rezoner_h
#define alveolus_rezoning_rezoner_h

#include <alveolus/rezoning/rezoning_rule.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /** What came of a rezoning. */
  struct RezoningReport
  {
    /** Part of the proposed motion taken: 1 unless cut back. */
    double fraction         = 1.;
    bool   cut_back         = false;
    double smallest_quality = 0.; ///< scaled Jacobian after rezoning
    double largest_motion   = 0.; ///< from the Lagrangian positions [mm]
  };

  /**
   * Runs the rules (points, lines, surfaces, volumes) and returns new node
   * positions that keep every vertex Jacobian and every quadrature point
   * Jacobian positive: a proposal that would invert a cell is halved towards
   * the Lagrangian mesh until it does not, which is reported.
   */
  template <int dim>
  class Rezoner
  {
  public:
    /** Take over a rule with the path of its subsection (for messages). */
    void
    add(std::unique_ptr<RezoningRule<dim>> rule, const std::string &where);

    bool
    empty() const
    {
      return rules.empty();
    }

    /** Attach all rules, sort them by stage, find contradictions. */
    void
    attach(const Nodes<dim> &nodes, const NodalVector &positions);

    /**
     * New positions for the step start -> lagrangian (nodal vectors, ghosted).
     */
    NodalVector
    propose(const Nodes<dim>  &nodes,
            const NodalVector &start,
            const NodalVector &lagrangian,
            RezoningReport    &report) const;

  private:
    std::vector<std::pair<std::string, std::unique_ptr<RezoningRule<dim>>>>
      rules;
  };
} // namespace alveolus

#endif
