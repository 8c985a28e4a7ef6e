// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/hencky_tabulated.h>

#include <cmath>

namespace alveolus
{
  void
  HenckyTabulated::declare_parameters(dealii::ParameterHandler &prm)
  {
    input.declare(prm);
    prm.add_parameter("Poisson's ratio",
                      poisson,
                      "Poisson's ratio nu [-] of the initial response, between "
                      "-1 and 0.5.",
                      dealii::Patterns::Double(-1., 0.5));
    prm.add_parameter("Bulk modulus",
                      given_bulk,
                      "Initial bulk modulus K [MPa]; 0: K = E0/(3 (1 - 2 nu)).",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Volumetric response",
                      volumetric,
                      "constant: mean Kirchhoff stress K ln J; tabulated: mean "
                      "Cauchy stress (K/E0) s(J - 1), s the stress of the "
                      "table.",
                      dealii::Patterns::Selection("constant|tabulated"));
  }



  void
  HenckyTabulated::initialize(const unsigned int dim, const std::string &where)
  {
    ElasticMaterial::initialize(dim, where);
    table               = input.table(where);
    const double  young = table.modulus(0.);
    LameConstants lame(young, poisson, where);
    mu        = lame.mu;
    bulk      = given_bulk > 0. ? given_bulk : lame.lambda + 2. / 3. * lame.mu;
    scale     = bulk / young;
    tabulated = (volumetric == "tabulated");
  }



  PrincipalResponse
  HenckyTabulated::principal_response(const std::array<double, 3> &h) const
  {
    PrincipalResponse r;
    const double      log_J = h[0] + h[1] + h[2];
    // mean Kirchhoff stress and its derivative with respect to ln J
    double mean, slope;
    if (tabulated)
      {
        const double strain = std::expm1(log_J), J = strain + 1.;
        const double cauchy = scale * table.stress(strain);
        mean                = J * cauchy;
        slope               = mean + J * J * scale * table.modulus(strain);
        r.energy            = scale * table.energy(strain);
      }
    else
      {
        mean     = bulk * log_J;
        slope    = bulk;
        r.energy = 0.5 * bulk * log_J * log_J;
      }
    for (unsigned int a = 0; a < 3; ++a)
      {
        const double deviator = h[a] - log_J / 3.;
        r.stress[a]           = mean + 2. * mu * deviator;
        r.energy += mu * deviator * deviator;
        r.shear[a] = 2. * mu;
        for (unsigned int b = 0; b < 3; ++b)
          r.normal[a][b] = slope + 2. * mu * ((a == b ? 1. : 0.) - 1. / 3.);
      }
    return r;
  }



  std::vector<std::pair<std::string, std::string>>
  HenckyTabulated::derived_names() const
  {
    auto names = ElasticMaterial::derived_names();
    names.emplace_back("ellipticity", "");
    return names;
  }



  std::vector<double>
  HenckyTabulated::derived_values(const double *history) const
  {
    auto values = ElasticMaterial::derived_values(history);
    values.push_back(ellipticity(history));
    return values;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::HenckyTabulated,
  "Hencky with tabulated pressure",
  "Soft reading of a uniaxial table of tangent moduli (`Table file` or "
  "`Tangent modulus`): energy mu0 dev h : dev h + U(J) with the Hencky strain "
  "h, mu0 = E0/(2(1+nu)), E0 the modulus at strain zero, nu = `Poisson's "
  "ratio`. `Volumetric response` constant: U = (K/2) (ln J)^2; tabulated: U = "
  "(K/E0) W_t(J-1) with W_t the energy of the table, so that the mean Cauchy "
  "stress is (K/E0) s(J-1) and the bulk modulus (K/E0) E_t(J-1). K is `Bulk "
  "modulus`, or E0/(3(1-2nu)), which makes that E_t(J-1)/(3(1-2nu)). The "
  "table's stiffening never enters the shear. Derived quantity "
  "`ellipticity`: least eigenvalue of the acoustic tensor over mu0.")
