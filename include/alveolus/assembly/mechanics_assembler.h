// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_mechanics_assembler_h
#define alveolus_assembly_mechanics_assembler_h

#include <alveolus/assembly/cell_kernel.h>
#include <alveolus/assembly/condition.h>
#include <alveolus/state/state.h>

#include <memory>
#include <string>
#include <vector>

namespace alveolus
{
  /** What an assembly found, over all processes. */
  struct AssemblyResult
  {
    bool        good = true; ///< whether forces are complete
    std::string reason;      ///< why not, with the place [mm]
    /** Sum of |internal force| over all dofs of all cells [N (per mm)]. */
    double force_scale = 0.;
    double energy      = 0.; ///< stored energy [mJ (per mm)]
    /** The same with the weights of the moved mesh, see CellKernel. */
    double energy_moved = 0.;
    double dissipation  = 0.; ///< plastic work of the increment [mJ (per mm)]
  };

  /**
   * Assembles the residual (internal minus external forces) and the tangent of
   * the Lagrangian phase for an increment du on x_n: the loop over cells (in
   * threads) and over conditions. It writes the trial history, nothing else.
   */
  template <int dim>
  class MechanicsAssembler
  {
  public:
    /** All conditions of the scene, in its order. */
    using Conditions = std::vector<std::unique_ptr<Condition<dim>>>;

    /**
     * @param regions by index, as in the history
     * @param conditions add their forces to those of the cells; all must
     *        outlive this object
     */
    MechanicsAssembler(State<dim>                &state,
                       const std::vector<Region> &regions,
                       Conditions                &conditions);

    /** Take the mesh x_n of a new step. */
    void
    begin_step(const Interval &interval);

    /**
     * @param increment du, ghosted [mm]
     * @param target    residual (zeroed here) and, where wanted, the matrix
     * If result.good is false, residual and matrix are incomplete.
     */
    AssemblyResult
    assemble(const NodalVector &increment, const AssemblyTarget &target);

    /** Internal forces alone of the last assembly, per dof [N (per mm)]. */
    NodalVector internal_forces;

    /** From now on every assembly leaves moved_weight(). */
    void
    keep_moved_weights();

    /** Of the last assembly, see CellKernel; for owned cells [mm^dim]. */
    double
    moved_weight(const unsigned int cell, const unsigned int point) const
    {
      return moved_weights[cell * geometry.n_points + point];
    }

    /** Gradients and weights of the mesh x_n. */
    const StepGeometry<dim> &
    step_geometry() const
    {
      return geometry;
    }

  private:
    struct Scratch;
    struct Copy;

    /** Where a cell is now, for messages [mm]. */
    std::string
    place_of(const unsigned int slot) const;

    State<dim>                &state;
    const std::vector<Region> &regions;
    Conditions                &conditions;
    StepGeometry<dim>          geometry;
    std::vector<double>        moved_weights; ///< empty unless asked for
    std::vector<unsigned int>  cells;         ///< active indices of owned cells
    std::vector<unsigned int>  local_dofs; ///< of these cells, in a NodalVector
  };
} // namespace alveolus

#endif
