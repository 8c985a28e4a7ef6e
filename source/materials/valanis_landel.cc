// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/valanis_landel.h>

#include <cmath>

namespace alveolus
{
  void
  ValanisLandel::declare_parameters(dealii::ParameterHandler &prm)
  {
    input.declare(prm);
    prm.add_parameter("Bulk modulus",
                      bulk,
                      "Bulk modulus K [MPa]. The uniaxial table holds for an "
                      "incompressible material: K far above E0/(3 (1 - 2 nu)).",
                      dealii::Patterns::Double(0.));
    prm.add_parameter("Terms",
                      n_terms,
                      "Terms of the series g(l); its error falls like 2^-n.",
                      dealii::Patterns::Integer(20, 60));
  }



  void
  ValanisLandel::initialize(const unsigned int dim, const std::string &where)
  {
    ElasticMaterial::initialize(dim, where);
    table = input.table(where);
    if (!(bulk > 0.))
      throw InputError(where + "/Bulk modulus",
                       "found " + std::to_string(bulk),
                       "it must be positive [MPa]");
  }



  ValanisLandel::Term
  ValanisLandel::series(const double h) const
  {
    Term   result;
    double power = 1.; // (-1/2)^n
    for (unsigned int n = 0; n < n_terms; ++n)
      {
        const double strain = std::expm1(power * h), x = strain + 1.;
        const double stress = table.stress(strain);
        result.energy += table.energy(strain) / power;
        result.g += x * stress;
        result.slope += power * x * (stress + x * table.modulus(strain));
        power *= -0.5;
      }
    return result;
  }



  PrincipalResponse
  ValanisLandel::principal_response(const std::array<double, 3> &h) const
  {
    PrincipalResponse   r;
    const double        log_J = h[0] + h[1] + h[2];
    std::array<Term, 3> terms;
    for (unsigned int a = 0; a < 3; ++a)
      terms[a] = series(h[a] - log_J / 3.);
    const double mean = (terms[0].g + terms[1].g + terms[2].g) / 3.;
    const double mean_slope =
      (terms[0].slope + terms[1].slope + terms[2].slope) / 9.;
    r.energy = 0.5 * bulk * log_J * log_J;
    for (unsigned int a = 0; a < 3; ++a)
      {
        r.energy += terms[a].energy;
        r.stress[a] = terms[a].g - mean + bulk * log_J;
        for (unsigned int b = 0; b < 3; ++b)
          r.normal[a][b] = (a == b ? terms[a].slope : 0.) -
                           (terms[a].slope + terms[b].slope) / 3. + mean_slope +
                           bulk;
        // For nearly equal stretches the quotient is all round-off.
        const unsigned int b = (a + 1) % 3, c = (a + 2) % 3;
        const double       difference = h[b] - h[c];
        r.shear[a]                    = std::abs(difference) < 1e-6
                                          ? 0.5 * (terms[b].slope + terms[c].slope)
                                          : (terms[b].g - terms[c].g) / difference;
      }
    return r;
  }



  std::vector<std::pair<std::string, std::string>>
  ValanisLandel::derived_names() const
  {
    auto names = ElasticMaterial::derived_names();
    names.emplace_back("ellipticity", "");
    return names;
  }



  std::vector<double>
  ValanisLandel::derived_values(const double *history) const
  {
    auto values = ElasticMaterial::derived_values(history);
    values.push_back(ellipticity(history));
    return values;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::ValanisLandel,
  "Valanis-Landel",
  "Hyperelastic reading of a uniaxial table of tangent moduli (`Table file` or "
  "`Tangent modulus`): energy sum w(l_a) + (K/2) (ln J)^2 with the isochoric "
  "principal stretches l_a and K = `Bulk modulus`. l w'(l) = g(l) = sum_n x_n "
  "s(x_n), x_n = l^((-1/2)^n), n < `Terms`, s the engineering stress of the "
  "table, whose jumps are smoothed over `Smoothing width`. Its uniaxial test "
  "is the table as far as K lets it: with the ligament of Mengoni et al. it is "
  "2 % off at 63 % tension for K = 142 MPa, the bulk modulus of the branch of "
  "8.5 MPa at Poisson's ratio 0.49, and 69 % for 1.13 MPa, that of E0. It "
  "stiffens in shear. Derived quantity `ellipticity`: least eigenvalue of the "
  "acoustic tensor over the initial shear modulus E0/3; not positive where the "
  "law is not elliptic and the deformation may localise.")
