// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_state_h
#define alveolus_state_state_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/state/history_store.h>

#include <memory>

namespace alveolus
{
  /**
   * Everything that changes in time: mesh positions (in the configuration),
   * material displacement u, history, and the increment of the last accepted
   * step. Replaced as a whole when the mesh is replaced.
   */
  template <int dim>
  struct State
  {
    /**
     * The undeformed body.
     * @param degree of the elements
     * @param region_of_material region index by material id
     * @param layouts of the history, by region
     */
    State(const Mesh<dim>   &mesh,
          const unsigned int degree,
          const std::map<dealii::types::material_id, unsigned int>
                                           &region_of_material,
          const std::vector<HistoryLayout> &layouts)
      : configuration(mesh, degree)
      , nodes(configuration)
      , displacement(configuration.make_vector())
      , increment(configuration.make_vector())
      , history(*mesh.triangulation,
                region_of_material,
                layouts,
                dealii::Utilities::fixed_power<dim>(degree + 1))
    {}

    /**
     * Accept a Lagrangian step: the mesh follows the material by @p du
     * (ghosted), trial history becomes old. Time is the caller's.
     */
    void
    accept(const NodalVector &du)
    {
      configuration.move(du);
      displacement.zero_out_ghost_values();
      displacement += du;
      displacement.update_ghost_values();
      increment.zero_out_ghost_values();
      increment = du;
      increment.update_ghost_values();
      history.commit();
    }

    Configuration<dim> configuration;  ///< the mesh, where it is now
    Nodes<dim>         nodes;          ///< its nodes and their sets
    NodalVector        displacement;   ///< u of the material at the nodes [mm]
    NodalVector        increment;      ///< du of the last accepted step [mm]
    HistoryStore<dim>  history;        ///< of the quadrature points
    double             time      = 0.; ///< [T]
    double             last_step = 0.; ///< length of the last step [T]
  };
} // namespace alveolus

#endif
