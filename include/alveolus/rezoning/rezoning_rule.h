// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_rezoning_rule_h
#define alveolus_rezoning_rezoning_rule_h

#include <alveolus/base/registry.h>
#include <alveolus/mesh/nodes.h>

#include <deal.II/base/parameter_handler.h>

#include <bitset>
#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  /** What came of a rezoning. */
  struct RezoningReport
  {
    /** Part of the proposed motion taken: 1 unless cut back. */
    double fraction         = 1.;
    bool   cut_back         = false; ///< whether a part only was taken
    double smallest_quality = 0.;    ///< scaled Jacobian after rezoning
    double largest_motion   = 0.;    ///< from the Lagrangian positions [mm]
    /** Sweeps of iterative rules, all together. */
    unsigned int sweeps = 0;
    /** Iterative rules that stopped at their largest number of sweeps. */
    unsigned int unconverged_rules = 0;
  };

  /**
   * One rule for new node positions, acting on named sets. Rules run in the
   * order of their stages, within a stage in the order of the parameter file.
   * A node that no rule touches stays where the material took it. A node
   * belongs to the first rule that touches it: rules of later stages leave it
   * alone and build on its new position. A rule is geometry only: it knows
   * nothing of physics.
   */
  template <int dim>
  class RezoningRule
  {
  public:
    /** When a rule runs: what it moves, from points to volumes. */
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

    /**
     * When the rule runs; may depend on the kind of the sets it names.
     * @param where path of the rule's subsection, for messages
     * @throws InputError if a name is unknown
     */
    virtual Stage
    stage(const NamedSets<dim> &names, const std::string &where) const = 0;

    /**
     * Resolve the names and keep what refers to the mesh as it is now, e.g.
     * relative arc lengths at @p positions. Called at the start and after each
     * remesh (collective).
     * @param taken nodes that rules of earlier stages set, the same on every
     *        process; this rule must not move them
     * @param where path of the rule's subsection, for messages
     * @throws InputError
     */
    virtual void
    attach(const Nodes<dim>       &nodes,
           const NodalVector      &positions,
           const std::set<NodeId> &taken,
           const std::string      &where) = 0;

    /**
     * Write new positions of the rule's nodes into @p proposed (collective).
     * @param start      positions before the Lagrangian step [mm], ghosted
     * @param lagrangian positions after it, where the material is [mm], ghosted
     * @param proposed   in: what earlier rules proposed; out: with ghosts
     * updated
     * @param report     where iterative rules count their sweeps
     */
    virtual void
    apply(const Nodes<dim>  &nodes,
          const NodalVector &start,
          const NodalVector &lagrangian,
          NodalVector       &proposed,
          RezoningReport    &report) const = 0;

    /** Whether the cells of its regions must form lattices. */
    virtual bool
    needs_lattices() const
    {
      return false;
    }

    /**
     * Nodes this rule sets, without those taken by earlier stages; on each
     * process at least its own ones.
     */
    virtual const std::vector<NodeId> &
    touched_nodes() const = 0;

    /**
     * Components it sets of these nodes: two rules of one stage may share a
     * node if they share no component.
     */
    virtual std::bitset<dim>
    touched_components() const
    {
      return std::bitset<dim>().set();
    }
  };
} // namespace alveolus

#endif
