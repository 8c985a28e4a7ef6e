// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/hardening_law.h>

#include <cmath>

namespace alveolus
{
  using dealii::Patterns::Double;

  void
  LinearHardening::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter(
      "Hardening modulus",
      modulus,
      "Slope h_p of the yield stress of undamaged bone over the "
      "equivalent plastic strain [MPa].",
      Double(0.));
  }



  double
  LinearHardening::increase(const double alpha) const
  {
    return modulus * alpha;
  }



  double
  LinearHardening::slope(const double) const
  {
    return modulus;
  }



  void
  VoceHardening::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Saturation",
                      saturation,
                      "Voce: part Q of the increase of the yield stress that "
                      "saturates [MPa].",
                      Double(0.));
    prm.add_parameter("Saturation rate",
                      rate,
                      "Voce: rate b of this saturation over the equivalent "
                      "plastic strain [-].",
                      Double(0.));
    prm.add_parameter("Saturated modulus",
                      modulus,
                      "Voce: slope h that remains after saturation [MPa].",
                      Double(0.));
  }



  double
  VoceHardening::increase(const double alpha) const
  {
    return -saturation * std::expm1(-rate * alpha) + modulus * alpha;
  }



  double
  VoceHardening::slope(const double alpha) const
  {
    return saturation * rate * std::exp(-rate * alpha) + modulus;
  }



  double
  YieldStress::radial_return(const double q, const double stiffness) const
  {
    // q - stiffness d - value(d) falls with d; it is not positive at the upper
    // end, as the yield stress does not fall.
    double lower = 0., upper = (q - value(0.)) / stiffness, d = 0.;
    for (unsigned int iteration = 0; iteration < 100; ++iteration)
      {
        const double rest = q - stiffness * d - value(d);
        if (std::abs(rest) <= 1e-14 * q)
          return d;
        (rest > 0. ? lower : upper) = d;
        double next                 = d + rest / (stiffness + slope(d));
        if (!(next >= lower && next <= upper))
          next = 0.5 * (lower + upper);
        // Round-off stops the iteration as well as the tolerance does.
        if (std::abs(next - d) <= 1e-15 * d)
          return next;
        d = next;
      }
    throw RunError("Hardening",
                   "the plastic return did not converge: equivalent stress " +
                     std::to_string(q) + " MPa, yield stress " +
                     std::to_string(value(0.)) + " MPa",
                   "reduce the time step");
  }
} // namespace alveolus

ALVEOLUS_REGISTER(alveolus::HardeningLaw,
                  alveolus::LinearHardening,
                  "linear",
                  "k = h_p alpha with h_p = `Hardening modulus`.")
ALVEOLUS_REGISTER(
  alveolus::HardeningLaw,
  alveolus::VoceHardening,
  "Voce",
  "k = Q (1 - exp(-b alpha)) + h alpha with Q = `Saturation`, b = `Saturation "
  "rate`, h = `Saturated modulus`.")
