// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remodelling_huiskes_h
#define alveolus_remodelling_huiskes_h

#include <alveolus/remodelling/remodelling_law.h>

namespace alveolus
{
  /**
   * Adaptation of the density alone, driven by the energy per mass S = U/rho
   * (Huiskes et al., J. Biomech. 20 (1987) 1135; Weinans, Huiskes and
   * Grootenboer, J. Biomech. 25 (1992) 1425):
   *     rho' = B (S - (1+s) k)  for S > (1+s) k,
   *     rho' = B (S - (1-s) k)  for S < (1-s) k,  0 in the dead zone between,
   * U the elastic energy density without sign.
   */
  class Huiskes : public RemodellingLaw
  {
  public:
    /**
     * Adds `Rate`, `Reference energy`, `Dead zone` and the other constants with
     * their units.
     */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const std::string &where) override;

    bool
    changes_fabric() const override
    {
      return false;
    }

    double
    stimulus(const RemodelledBone &bone, const BonePoint &point) const override;

    RemodellingRates
    rates(const RemodelledBone &bone,
          const BonePoint      &point,
          const double          stimulus) const override;

  private:
    double rate      = 1.;
    double reference = 0.004;
    double dead_zone = 0.1;
  };
} // namespace alveolus

#endif
