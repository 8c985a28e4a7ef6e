// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_rigid_motion_h
#define alveolus_io_rigid_motion_h

#include <alveolus/io/recorder.h>

namespace alveolus
{
  /**
   * The rigid motion that fits the displacement of named regions best: x = x_c
   * + R (X - X_c) with the least int |x - x_c - R (X - X_c)|^2 dv over the
   * current volume, X = x - u where the material came from (Kabsch, Acta Cryst.
   * A32 (1976) 922). The integral makes it independent of the mesh's density. R
   * is the polar rotation of int (x - x_c) (X - X_c)^T dv.
   *
   * Records the displacement x_c - X_c of the centroid [mm], the rotation
   * [degrees] (2D: anticlockwise; 3D: rotation vector), in 2D the centre of
   * rotation, the place [mm] X with x(X) = X (not a number without rotation),
   * and the root mean square of the rest [mm].
   */
  template <int dim>
  class RigidMotion : public Recorder<dim>
  {
  public:
    /** Adds `On`, regions of the mesh that move together. */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string                          on;
    std::string                          where;
    std::set<dealii::types::material_id> ids;
  };

  /** Union of the material ids of a comma separated list. @throws InputError */
  template <int dim>
  std::set<dealii::types::material_id>
  region_ids(const NamedSets<dim> &names,
             const std::string    &list,
             const std::string    &where);
} // namespace alveolus

#endif
