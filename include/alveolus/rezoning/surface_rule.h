// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_surface_rule_h
#define alveolus_rezoning_surface_rule_h

#include <alveolus/rezoning/rezoning_rule.h>
#include <alveolus/rezoning/surface_patch.h>

namespace alveolus
{
  /**
   * Nodes inside surfaces of a body are smoothed on the surface they lie on:
   * harmonic displacement between the rim and the nodes that earlier rules set,
   * then, unless the surface is part of the mesh only, back onto the surface
   * through the Lagrangian positions (SurfacePatch).
   * Every process knows the surfaces; each component of the harmonic
   * displacement of each is solved for on one of them, and each finds the way
   * back onto the surface for as many nodes as the others. Three dimensions
   * only.
   */
  class SurfaceRule : public RezoningRule<3>
  {
  public:
    /** When the rule runs, see RezoningRule. */
    using Stage = typename RezoningRule<3>::Stage;

    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    /** Surfaces. @throws InputError if a name is unknown */
    Stage
    stage(const NamedSets<3> &names, const std::string &where) const override;
    /**
     * Find the surfaces and hold the nodes in @p taken (collective). @throws
     * InputError
     */
    void
    attach(const Nodes<3>         &nodes,
           const NodalVector      &positions,
           const std::set<NodeId> &taken,
           const std::string      &where) override;
    /** Move the nodes of the surfaces along them (collective). */
    void
    apply(const Nodes<3>    &nodes,
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
    std::vector<std::string> on;
    bool                     stay = true;
    /** Patches first, ..., last - 1 none of which holds what another frees. */
    struct Batch
    {
      unsigned int first, last;
    };

    std::vector<SurfacePatch> patches;
    /** Process, of each patch and component. */
    std::vector<std::array<unsigned int, 3>> solver;
    std::vector<Batch>                       batches;
    std::vector<NodeId>                      touched;
  };
} // namespace alveolus

#endif
