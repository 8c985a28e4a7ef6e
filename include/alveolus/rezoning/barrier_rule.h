// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_barrier_rule_h
#define alveolus_rezoning_barrier_rule_h

#include <alveolus/rezoning/mesh_energy.h>
#include <alveolus/rezoning/rezoning_rule.h>

#include <memory>

namespace alveolus
{
  /**
   * Smoothing that cannot invert a valid mesh: the nodes inside the regions go
   * where the MeshEnergy, which is infinite for an invalid cell, is smallest.
   * One sparse nonlinear problem for all of them, solved by minimise(), so that
   * the result depends on the number of processes within the tolerance only.
   *
   * Moved are the nodes inside each region, i.e. neither at the boundary nor
   * shared with another region, that no rule of an earlier stage sets; for
   * degree 2 all nodes, not the vertices only. The mesh of attach() and its
   * affine images are kept with `Shapes` = initial.
   *
   * If what earlier rules did to the boundary makes the mesh invalid, while it
   * was valid with the Lagrangian positions, the boundary goes there in stages:
   * the nodes inside along the tangent of the minimum, then a few iterations.
   * If a stage below 1/64 of the way would be needed, or if the Lagrangian mesh
   * is invalid already, the nodes are left as they are and the rule counts as
   * unconverged: untangling is not what it is made for.
   */
  template <int dim>
  class BarrierRule : public RezoningRule<dim>
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
    /**
     * Take the mesh from @p lagrangian to the boundary of @p proposed in
     * stages; the result is valid unless false is returned.
     */
    bool
    approach(const NodalVector &lagrangian,
             const NodalVector &proposed,
             NodalVector       &x,
             RezoningReport    &report) const;

    std::vector<std::string> on;
    std::string              shapes             = "initial";
    double                   size_weight        = 0.;
    double                   tolerance          = 1e-4;
    unsigned int             largest_iterations = 50;

    std::vector<NodeId>               touched;
    NodalVector                       is_free; ///< 1 at what may move
    dealii::AffineConstraints<double> constraints;
    std::unique_ptr<MeshEnergy<dim>>  energy; ///< null: nothing to move
    std::unique_ptr<LinearSystem>     system;
  };
} // namespace alveolus

#endif
