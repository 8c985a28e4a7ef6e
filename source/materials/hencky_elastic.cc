// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/hencky_elastic.h>

namespace alveolus
{
  void
  HenckyElastic::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Young's modulus",
                      young,
                      "Young's modulus E [MPa].",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Poisson's ratio",
                      poisson,
                      "Poisson's ratio nu [-], between -1 and 0.5.",
                      dealii::Patterns::Double(-1., 0.5));
  }



  void
  HenckyElastic::initialize(const unsigned int dim, const std::string &where)
  {
    ElasticMaterial::initialize(dim, where);
    lame = LameConstants(young, poisson, where);
  }



  PrincipalResponse
  HenckyElastic::principal_response(const std::array<double, 3> &h) const
  {
    PrincipalResponse r;
    const double      volumetric = lame.lambda * (h[0] + h[1] + h[2]);
    for (unsigned int a = 0; a < 3; ++a)
      {
        r.stress[a] = volumetric + 2. * lame.mu * h[a];
        r.energy += 0.5 * r.stress[a] * h[a];
        r.shear[a] = 2. * lame.mu;
        for (unsigned int b = 0; b < 3; ++b)
          r.normal[a][b] = lame.lambda + (a == b ? 2. * lame.mu : 0.);
      }
    return r;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::HenckyElastic,
  "Hencky elastic",
  "Linear isotropic elasticity between the Kirchhoff stress tau and the "
  "logarithmic strain h = (1/2) ln b: tau = lambda tr(h) I + 2 mu h with mu = "
  "E/(2(1+nu)) and lambda = 2 mu nu/(1-2 nu); E is `Young's modulus`, nu "
  "`Poisson's ratio`. Good for moderate strains and any rotation.")
