// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_hardening_law_h
#define alveolus_materials_hardening_law_h

#include <alveolus/base/registry.h>

#include <deal.II/base/parameter_handler.h>

#include <string>

namespace alveolus
{
  /**
   * Isotropic hardening: the yield stress is sigma_Y + k(alpha) of the
   * equivalent plastic strain alpha >= 0, with k(0) = 0 and k' >= 0.
   * Implementations are registered; a material that yields declares the
   * parameters of all of them in its own subsection, so that their names have
   * to differ.
   */
  class HardeningLaw
  {
  public:
    virtual ~HardeningLaw() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** k(alpha) [MPa]. */
    virtual double
    increase(const double alpha) const = 0;

    /** dk/dalpha [MPa]. */
    virtual double
    slope(const double alpha) const = 0;
  };

  /** k = h_p alpha. */
  class LinearHardening : public HardeningLaw
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    double
    increase(const double alpha) const override;
    double
    slope(const double alpha) const override;

  private:
    double modulus = 723.7; ///< h_p [MPa]
  };

  /**
   * Saturation with a linear part, k = Q (1 - exp(-b alpha)) + h alpha
   * (E. Voce, J. Inst. Metals 74 (1948) 537; with h, J. C. Simo, Comput.
   * Methods Appl. Mech. Eng. 68 (1988) 1).
   */
  class VoceHardening : public HardeningLaw
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    double
    increase(const double alpha) const override;
    double
    slope(const double alpha) const override;

  private:
    double saturation = 0.; ///< Q [MPa]
    double rate       = 0.; ///< b [-]
    double modulus    = 0.; ///< h [MPa]
  };

  /**
   * The yield stress during one increment d of plastic strain from alpha on:
   * scale (sigma_Y + k(alpha + growth d)).
   */
  struct YieldStress
  {
    const HardeningLaw &law;         ///< for intact bone
    double              initial;     ///< sigma_Y [MPa]
    double              alpha;       ///< at the start [-]
    double              scale  = 1.; ///< of the yield stress [-]
    double              growth = 1.; ///< of alpha per increment [-]

    /** Yield stress at the plastic strain @p d [MPa]. */
    double
    value(const double d) const
    {
      return scale * (initial + law.increase(alpha + growth * d));
    }

    /** Its derivative in d. */
    double
    slope(const double d) const
    {
      return scale * growth * law.slope(alpha + growth * d);
    }

    /** Plastic work of the increment, its integral from 0 to d (Simpson). */
    double
    work(const double d) const
    {
      return d / 6. * (value(0.) + 4. * value(0.5 * d) + value(d));
    }

    /**
     * Radial return: the d > 0 with q - stiffness d = value(d), where q >
     * value(0). Newton's method within a bracket; linear hardening takes one
     * iteration.
     * @throws RunError if the iteration does not converge
     */
    double
    radial_return(const double q, const double stiffness) const;
  };
} // namespace alveolus

#endif
