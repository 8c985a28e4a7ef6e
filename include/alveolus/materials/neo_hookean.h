// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_neo_hookean_h
#define alveolus_materials_neo_hookean_h

#include <alveolus/materials/mooney_rivlin.h>

namespace alveolus
{
  /**
   * Compressible neo-Hookean solid: (mu/2) (I1 - 3) + (kappa/4) (J^2 - 2 ln J -
   * 1) with I1 the trace of J^{-2/3} b, as in deal.II's step-44 and the code
   * gallery's "Quasi-Static Finite-Strain Compressible Elasticity". It is the
   * Mooney-Rivlin law with c1 = mu/2, c2 = 0.
   */
  class NeoHookean : public MooneyRivlin
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const unsigned int dim, const std::string &where) override;

  private:
    double shear      = 1.;
    double poisson    = 0.3;
    double given_bulk = 0.;
  };
} // namespace alveolus

#endif
