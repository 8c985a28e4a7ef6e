// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/elastic_material.h>

namespace alveolus
{
  /**
   * Elastic solid that stiffens with its distortion: the energy is
   * (kappa/2) (tr h)^2 + mu e (1 + a e), with h the Hencky strain and
   * e = dev h : dev h, hence tau = kappa tr(h) I + 2 mu (1 + 2 a e) dev h.
   */
  class StiffeningElastic : public ElasticMaterial
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Shear modulus",
                        mu,
                        "Shear modulus mu at small strain [MPa].",
                        dealii::Patterns::Double(1e-9));
      prm.add_parameter("Bulk modulus",
                        kappa,
                        "Bulk modulus kappa [MPa].",
                        dealii::Patterns::Double(1e-9));
      prm.add_parameter("Stiffening",
                        a,
                        "Growth a of the shear modulus with dev h : dev h [-].",
                        dealii::Patterns::Double(0.));
    }

    PrincipalResponse
    principal_response(const std::array<double, 3> &h) const override
    {
      const double          trace = h[0] + h[1] + h[2];
      std::array<double, 3> deviator;
      double                e = 0.;
      for (unsigned int i = 0; i < 3; ++i)
        {
          deviator[i] = h[i] - trace / 3.;
          e += deviator[i] * deviator[i];
        }
      const double secant = 2. * mu * (1. + 2. * a * e);

      PrincipalResponse r;
      r.energy = 0.5 * kappa * trace * trace + mu * e * (1. + a * e);
      for (unsigned int i = 0; i < 3; ++i)
        {
          r.stress[i] = kappa * trace + secant * deviator[i];
          r.shear[i]  = secant; // (tau_j - tau_k) / (h_j - h_k)
          for (unsigned int j = 0; j < 3; ++j)
            r.normal[i][j] = kappa + secant * ((i == j ? 1. : 0.) - 1. / 3.) +
                             8. * mu * a * deviator[i] * deviator[j];
        }
      return r;
    }

  private:
    double mu = 1., kappa = 1., a = 0.;
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::StiffeningElastic,
  "stiffening elastic",
  "Elastic solid that stiffens with its distortion: tau = kappa tr(h) I + "
  "2 mu (1 + 2 a dev h : dev h) dev h with the Hencky strain h; mu is `Shear "
  "modulus`, kappa `Bulk modulus` [MPa], a `Stiffening` [-].")
