// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_strain_extremes_h
#define alveolus_io_strain_extremes_h

#include <alveolus/io/recorder.h>

namespace alveolus
{
  /**
   * Extremes over the quadrature points of named regions of the principal
   * values h of the elastic Hencky strain (of an elastic law: the total one;
   * all three, also in plane strain), of the engineering strain exp(h) - 1, and
   * of the volume ratio exp(tr h).
   */
  template <int dim>
  class StrainExtremes : public Recorder<dim>
  {
  public:
    /** Adds `On`, regions of the mesh. */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string                          on;
    std::set<dealii::types::material_id> ids;
  };
} // namespace alveolus

#endif
