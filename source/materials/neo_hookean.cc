// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/neo_hookean.h>

namespace alveolus
{
  void
  NeoHookean::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Shear modulus",
                      shear,
                      "Shear modulus mu [MPa].",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Poisson's ratio",
                      poisson,
                      "Poisson's ratio nu [-] of the initial response, between "
                      "-1 and 0.5; not used if a bulk modulus is given.",
                      dealii::Patterns::Double(-1., 0.5));
    prm.add_parameter("Bulk modulus",
                      given_bulk,
                      "Bulk modulus kappa [MPa]; 0: from Poisson's ratio, "
                      "kappa = 2 mu (1 + nu)/(3 (1 - 2 nu)).",
                      dealii::Patterns::Double(0.));
  }



  void
  NeoHookean::initialize(const unsigned int dim, const std::string &where)
  {
    if (!(shear > 0.))
      throw InputError(where + "/Shear modulus",
                       "found " + std::to_string(shear),
                       "it must be positive [MPa]");
    c1   = 0.5 * shear;
    c2   = 0.;
    bulk = given_bulk;
    if (given_bulk == 0.)
      {
        const LameConstants lame(2. * shear * (1. + poisson), poisson, where);
        bulk = lame.lambda + 2. / 3. * lame.mu;
      }
    MooneyRivlin::initialize(dim, where);
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::NeoHookean,
  "neo-Hookean",
  "Compressible hyperelastic solid with the energy (mu/2) (I1 - 3) + (kappa/4) "
  "(J^2 - 2 ln J - 1), I1 the trace of J^{-2/3} b; mu is `Shear modulus`, "
  "kappa `Bulk modulus` or follows from `Poisson's ratio`.")
