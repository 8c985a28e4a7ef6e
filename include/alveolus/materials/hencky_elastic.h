// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_hencky_elastic_h
#define alveolus_materials_hencky_elastic_h

#include <alveolus/materials/elastic_material.h>

namespace alveolus
{
  /**
   * Linear elasticity between Kirchhoff stress and Hencky strain:
   * tau = lambda tr(h) I + 2 mu h, energy (lambda/2) (tr h)^2 + mu h : h
   * (Hencky 1928; Anand, J. Appl. Mech. 46 (1979) 78).
   */
  class HenckyElastic : public ElasticMaterial
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const unsigned int dim, const std::string &where) override;

    PrincipalResponse
    principal_response(const std::array<double, 3> &h) const override;

  private:
    double        young   = 19000.;
    double        poisson = 0.3;
    LameConstants lame;
  };
} // namespace alveolus

#endif
