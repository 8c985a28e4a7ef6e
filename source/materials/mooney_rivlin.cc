// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/mooney_rivlin.h>

#include <cmath>

namespace alveolus
{
  void
  MooneyRivlin::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("First constant",
                      c1,
                      "Factor c1 of the first invariant [MPa].",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Second constant",
                      c2,
                      "Factor c2 of the second invariant [MPa].",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Bulk modulus",
                      bulk,
                      "Bulk modulus kappa [MPa].",
                      dealii::Patterns::Double(0.));
  }



  void
  MooneyRivlin::initialize(const unsigned int dim, const std::string &where)
  {
    ElasticMaterial::initialize(dim, where);
    if (!(c1 + c2 > 0.))
      throw InputError(where + "/First constant",
                       "c1 + c2 is " + std::to_string(c1 + c2),
                       "it must be positive [MPa]");
    if (!(bulk > 0.))
      throw InputError(where + "/Bulk modulus",
                       "found " + std::to_string(bulk),
                       "it must be positive [MPa]");
  }



  PrincipalResponse
  MooneyRivlin::principal_response(const std::array<double, 3> &h) const
  {
    PrincipalResponse r;
    const double      log_J = h[0] + h[1] + h[2];
    const double      J2_1  = std::expm1(2. * log_J); // J^2 - 1
    r.energy                = 0.25 * bulk * (J2_1 - 2. * log_J);
    for (unsigned int a = 0; a < 3; ++a)
      {
        r.stress[a] = 0.5 * bulk * J2_1;
        r.shear[a]  = 0.;
        for (unsigned int b = 0; b < 3; ++b)
          r.normal[a][b] = bulk * (J2_1 + 1.);
      }

    // sign = 1: b; sign = -1: its inverse, whose trace is the second invariant
    const auto add = [&](const double c, const double sign) {
      if (c == 0.)
        return;
      std::array<double, 3> e; // eigenvalue - 1, exact for small strains
      for (unsigned int a = 0; a < 3; ++a)
        e[a] = std::expm1(2. * sign * (h[a] - log_J / 3.));
      const double mean = (e[0] + e[1] + e[2]) / 3.;
      r.energy += 3. * c * mean;
      for (unsigned int a = 0; a < 3; ++a)
        {
          r.stress[a] += 2. * c * sign * (e[a] - mean);
          for (unsigned int b = 0; b < 3; ++b)
            r.normal[a][b] +=
              4. * c *
              ((a == b ? e[a] + 1. : 0.) - (e[a] + e[b] - mean + 1.) / 3.);
          const unsigned int b = (a + 1) % 3, other = (a + 2) % 3;
          r.shear[other] +=
            4. * c * std::sqrt((e[a] + 1.) * (e[b] + 1.)) * sinhc(h[a] - h[b]);
        }
    };
    add(c1, 1.);
    add(c2, -1.);
    return r;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::MooneyRivlin,
  "Mooney-Rivlin",
  "Hyperelastic rubber with the energy c1 (I1 - 3) + c2 (I2 - 3) + (kappa/4) "
  "(J^2 - 2 ln J - 1), I1 and I2 the invariants of J^{-2/3} b; c1 is `First "
  "constant`, c2 `Second constant`, kappa `Bulk modulus`. The initial shear "
  "modulus is 2 (c1 + c2).")
