// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_model_h
#define alveolus_driver_model_h

#include <alveolus/mesh/quality.h>
#include <alveolus/scene/scene.h>
#include <alveolus/transfer/face_transfer.h>
#include <alveolus/transfer/nodal_transfer.h>
#include <alveolus/transfer/reference_map.h>
#include <alveolus/transfer/swept_transfer.h>
#include <alveolus/transfer/trace_projection.h>

#include <deal.II/base/timer.h>

#include <functional>
#include <memory>
#include <set>
#include <vector>

namespace alveolus
{
  /**
   * Everything that depends on the mesh: mesh, state, and the scene's objects
   * attached to them. Start and remesh make it in the same way; a remesh
   * replaces it as a whole, so that a candidate that fails leaves the old model
   * untouched. Whatever the scene does not ask for is a null pointer.
   */
  template <int dim>
  class Model
  {
  public:
    /**
     * @param scene its conditions, rules and recorders are attached to this
     *        mesh, so every model has a scene of its own
     * @param positions where the nodes are now; empty: where the mesh has them
     * @throws InputError
     */
    Model(std::shared_ptr<Scene<dim>> scene,
          Mesh<dim>                   mesh,
          dealii::TimerOutput        &timer,
          const std::function<NodalVector(const Configuration<dim> &)>
            &positions = {});

    Model(const Model &) = delete;
    Model &
    operator=(const Model &) = delete;

    /**
     * After a transfer: project the trace of the strain where mean dilatation
     * is on, bring the old records back into their admissible sets, and make
     * strains from the reference map where regions ask for it.
     * @return number of values that had to be limited, over all processes
     * @throws RunError if the reference map is not invertible
     */
    unsigned int
    make_history_admissible();

    /** Quality of the mesh as it is now. */
    QualitySummary<dim>
    quality() const
    {
      return mesh_quality(state->configuration,
                          state->configuration.positions());
    }

    /** Area (volume) of each region of the scene now [mm^dim] (collective). */
    std::vector<double>
    measures() const;

    /** What the user asked for; shared by all models of a run. */
    std::shared_ptr<Scene<dim>> scene;
    /** The mesh and its names. */
    Mesh<dim> mesh;
    /** By index of the history. */
    std::vector<Region> regions;
    /** By region; null pointers where there is none. */
    std::vector<RegionRemodelling> remodelling;
    /** All that a step changes. */
    std::unique_ptr<State<dim>> state;
    /** The positions it was made with, which rules and maps remember, too [mm];
     * null: those of the mesh. */
    std::unique_ptr<NodalVector> attached_at;
    /** Loads, supports, contacts, layers. */
    typename MechanicsAssembler<dim>::Conditions conditions;
    /** Solves an increment. */
    std::unique_ptr<Equilibrium<dim>> equilibrium;
    /** Equilibrium and remodelling. */
    std::unique_ptr<StaggeredStep<dim>> staggered_step;

    // Present only where the scene rezones:
    std::unique_ptr<Rezoner<dim>> rezoner; ///< moves nodes
    /** History, on sub-cells. */
    std::unique_ptr<SweptTransfer<dim>> swept_transfer;
    /** Displacement of the nodes. */
    std::unique_ptr<NodalTransfer<dim>> nodal_transfer;
    /** History of layers on boundaries. */
    std::unique_ptr<FaceTransfer<dim>> face_transfer;

    // Present only where history is transferred and some region asks for it:
    /** Where the material began. */
    std::unique_ptr<ReferenceMap<dim>> reference_map;

  private:
    void
    make_state();
    void
    make_reference_map();
    void
    make_rezoning();

    // Present only where history is transferred and some region asks for it:
    std::unique_ptr<SubCells<dim>>        sub_cells;
    std::unique_ptr<TraceProjection<dim>> trace_projection;
    std::set<unsigned int>                projected_regions;
  };
} // namespace alveolus

#endif
