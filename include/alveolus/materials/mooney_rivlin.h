// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_mooney_rivlin_h
#define alveolus_materials_mooney_rivlin_h

#include <alveolus/materials/elastic_material.h>

namespace alveolus
{
  /**
   * Energy c1 (I1 - 3) + c2 (I2 - 3) + (kappa/4) (J^2 - 2 ln J - 1) with the
   * invariants of the isochoric left Cauchy-Green tensor J^{-2/3} b (Mooney
   * 1940, Rivlin 1948; volumetric part of Simo and Miehe, Comput. Methods Appl.
   * Mech. Eng. 98 (1992) 41). Initial shear modulus 2 (c1 + c2), bulk modulus
   * kappa.
   */
  class MooneyRivlin : public ElasticMaterial
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const unsigned int dim, const std::string &where) override;

    PrincipalResponse
    principal_response(const std::array<double, 3> &h) const override;

  protected:
    double c1   = 1.;    ///< first constant [MPa]
    double c2   = 0.25;  ///< second constant [MPa]
    double bulk = 1000.; ///< bulk modulus [MPa]
  };
} // namespace alveolus

#endif
