// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_hencky_tabulated_h
#define alveolus_materials_hencky_tabulated_h

#include <alveolus/materials/elastic_material.h>
#include <alveolus/materials/table_input.h>

namespace alveolus
{
  /**
   * The soft reading of a uniaxial table (theory, section 4): the isochoric
   * response keeps the initial shear modulus, the volumetric one is constant or
   * takes the shape of the table. Energy per undeformed volume
   *
   *   W = mu0 dev h : dev h + U(J),   mu0 = E0/(2 (1 + nu)),  J = exp(tr h),
   *
   * with the total Hencky strain h and E0 the table's modulus at strain zero.
   *
   * constant:   U = (K/2) (ln J)^2, the mean Kirchhoff stress is K ln J.
   * tabulated:  U = (K/E0) W_t(J - 1), W_t the energy of the table: the mean
   *             Cauchy stress U'(J) = (K/E0) s(J - 1) and the bulk modulus
   *             U''(J) = (K/E0) E_t(J - 1) follow the table at the engineering
   *             strain of the volume, J - 1.
   *
   * K is given, or E0/(3 (1 - 2 nu)), and then U''(J) = E_t(J-1)/(3 (1 - 2
   * nu)). A uniaxial table says nothing of the volume: that the volume strain
   * takes the place of the uniaxial strain is our choice, for which a confined
   * test is K/E0 times as stiff as the table while mu0 is small against K.
   *
   * Like every energy quadratic in Hencky strain it is elliptic only for
   * moderate stretches: "ellipticity" (see ElasticMaterial) tells where.
   *
   * Not modelled: the table in shear and in the uniaxial test itself, which
   * follows only at small strain.
   */
  class HenckyTabulated : public ElasticMaterial
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

    /** Initial shear modulus mu0 [MPa]. */
    double
    shear_modulus() const
    {
      return mu;
    }

    /** Initial bulk modulus K [MPa]. */
    double
    bulk_modulus() const
    {
      return bulk;
    }

  private:
    double      poisson    = 0.49;
    double      given_bulk = 0.;
    std::string volumetric = "constant";
    TableInput  input      = {"as printed", 0.01};

    TangentTable table;
    bool         tabulated = false;
    double       mu = 0., bulk = 0., scale = 0.; ///< scale = K/E0
  };
} // namespace alveolus

#endif
