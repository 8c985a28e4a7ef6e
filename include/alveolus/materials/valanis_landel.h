// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_valanis_landel_h
#define alveolus_materials_valanis_landel_h

#include <alveolus/materials/elastic_material.h>
#include <alveolus/materials/table_input.h>

namespace alveolus
{
  /**
   * The hyperelastic reading of a uniaxial table: the energy (per undeformed
   * volume; Valanis and Landel, J. Appl. Phys. 38 (1967) 2997)
   *
   *   W = sum_a w(l_a) + (K/2) (ln J)^2,   l_a = J^{-1/3} lambda_a,
   *
   * whose uniaxial test is the table if the material is incompressible: with
   * g(l) = l w'(l) and the engineering stress s, l s(l) = g(l) - g(l^{-1/2}),
   * hence the series used for tabulated rubbers (Kolling, Du Bois, Benson and
   * Feng, Comput. Mech. 40 (2007) 885)
   *
   *   g(l) = sum_{n>=0} x_n s(x_n),   x_n = l^{(-1/2)^n},
   *   w(l) = sum_{n>=0} (-2)^n W_t(x_n - 1),
   *
   * W_t the energy of the table; the second line is its exact integral. Terms
   * fall like 2^-n. Principal Kirchhoff stress g(l_a) - (1/3) sum g(l_b) +
   * K ln J; the initial shear modulus is mu0 = E0/3.
   *
   * K must be far above E0/(3 (1 - 2 nu)) = 1.13 MPa (nu = 0.49) for the table
   * to hold: where the tangent modulus is 8.5 MPa, K = 1.13 MPa lets the volume
   * grow instead of the stress (69 % too soft at 63 %). The default 142 MPa =
   * 8.5 MPa/(3 (1 - 2 * 0.49)) belongs to the stiffest branch in tension.
   *
   * The table's jumps are smoothed over a width, so that the tangent is
   * continuous. The energy is not elliptic everywhere (the jump at 14 %, the
   * rupture at 63 %): the derived quantity "ellipticity" (see ElasticMaterial)
   * tells where.
   */
  class ValanisLandel : public ElasticMaterial
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const unsigned int dim, const std::string &where) override;

    PrincipalResponse
    principal_response(const std::array<double, 3> &h) const override;

    std::vector<std::pair<std::string, std::string>>
    derived_names() const override;

    std::vector<double>
    derived_values(const double *history) const override;

  private:
    /** The series at l = exp(h). */
    struct Term
    {
      double energy = 0.; ///< w(l) [MPa]
      double g      = 0.; ///< dw/dh = g(l) [MPa]
      double slope  = 0.; ///< dg/dh [MPa]
    };
    Term
    series(const double h) const;

    double       bulk    = 142.;
    unsigned int n_terms = 40;
    TableInput   input   = {"as printed", 0.01};
    TangentTable table;
  };
} // namespace alveolus

#endif
