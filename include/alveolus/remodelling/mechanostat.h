// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remodelling_mechanostat_h
#define alveolus_remodelling_mechanostat_h

#include <alveolus/remodelling/remodelling_law.h>

namespace alveolus
{
  /**
   * Mechanostat with a lazy zone (Doblare and Garcia, J. Biomech. 35 (2002) 1;
   * Mengoni and Ponthot 2015). With U the stimulus, U0 its homeostatic level, w
   * the half width of the lazy zone, the bone surface moves at
   *     r' =  c_f (U - (U0 + w))    formation,  U > U0 + w
   *     r' = -c_r ((U0 - w) - U)    resorption, U < U0 - w
   * and the density at rho' = k S_v(n) rho_full r', n = 1 - rho/rho_full.
   *
   * Stimulus: U = s Psi, "signed" with s = sign(tr tau) or, for a positive
   * pressure p0, s = tanh(tr tau/(3 p0)); "unsigned" with s = 1. (The signed
   * stimulus is our reading of the law: bone forms under tension and is
   * resorbed under pressure.)
   *
   * Fabric, for a degree of anisotropy omega > 0: with Y = tau~ H h + h H tau~
   * (tau~ the effective stress), Y+ its positive part, J = ((1-omega)/3 + eps)
   * I
   * + omega Y+/tr Y+ and N = J in formation, J^{-1} in resorption,
   *     A = H^{-1/2} N H^{-1/2}/tr(...),
   *     (log T)' = (3/2) beta (rho'/rho) (A - I/3).
   */
  class Mechanostat : public RemodellingLaw
  {
  public:
    /**
     * Adds the stimulus with its lazy zone, the rates of formation and
     * resorption, the available surface, and the anisotropy.
     */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const std::string &where) override;

    bool
    changes_fabric() const override
    {
      return anisotropy > 0.;
    }

    double
    stimulus(const RemodelledBone &bone, const BonePoint &point) const override;

    RemodellingRates
    rates(const RemodelledBone &bone,
          const BonePoint      &point,
          const double          stimulus) const override;

  private:
    double      homeostatic   = 0.;
    double      width         = 0.1;
    double      formation     = 5e-3;
    double      resorption    = 1e-2;
    double      availability  = 1.;
    double      pressure      = 0.;
    double      anisotropy    = 1.;
    double      offset        = 0.01;
    std::string width_means   = "half width";
    std::string stimulus_kind = "signed";
    double      half_width    = 0.1; ///< derived by initialize()
  };
} // namespace alveolus

#endif
