// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/elastic_material.h>
#include <alveolus/materials/ellipticity.h>

#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;

  void
  ElasticMaterial::initialize(const unsigned int dim,
                              const std::string & /*where*/)
  {
    this->dim = dim;
  }



  std::vector<HistoryField>
  ElasticMaterial::history_fields() const
  {
    HistoryField strain;
    strain.name  = "elastic strain";
    strain.shape = HistoryField::Shape::symmetric_tensor;
    return {strain};
  }



  void
  ElasticMaterial::initial_history(double *values) const
  {
    pack(SymmetricTensor<2, 3>(), values, dim);
  }



  void
  ElasticMaterial::evaluate(const dealii::Tensor<2, 3> &f,
                            const double               *old,
                            double                     *trial,
                            const bool                  need_tangent,
                            MaterialResponse           &response) const
  {
    const Increment increment(f, unpack(old, dim));
    pack(increment.strain(), trial, dim);
    isotropic_response(increment,
                       principal_response(increment.principal),
                       need_tangent,
                       response);
  }



  std::vector<std::pair<std::string, std::string>>
  ElasticMaterial::derived_names() const
  {
    return {{"von Mises stress", "MPa"}, {"pressure", "MPa"}};
  }



  std::vector<double>
  ElasticMaterial::derived_values(const double *history) const
  {
    const Spectral              s = spectral(unpack(history, dim));
    const SymmetricTensor<2, 3> stress =
      compose(principal_response(s.values).stress, s);
    return {von_mises(stress), -trace(stress) / 3.};
  }



  double
  ElasticMaterial::ellipticity(const double *history) const
  {
    const dealii::Tensor<2, 3> at_rest(dealii::unit_symmetric_tensor<3>());
    const Increment            increment(at_rest, unpack(history, dim));
    MaterialResponse           response;
    isotropic_response(increment,
                       principal_response(increment.principal),
                       true,
                       response);
    const double shear_modulus =
      0.5 * principal_response({{0., 0., 0.}}).shear[0];
    return least_acoustic_eigenvalue(response, increment.b, dim) /
           shear_modulus;
  }



  double
  von_mises(const SymmetricTensor<2, 3> &stress)
  {
    return std::sqrt(1.5) * deviator(stress).norm();
  }



  LameConstants::LameConstants(const double       young,
                               const double       poisson,
                               const std::string &where)
  {
    if (!(young > 0.))
      throw InputError(where + "/Young's modulus",
                       "found " + std::to_string(young),
                       "it must be positive [MPa]");
    if (!(poisson > -1. && poisson < 0.5))
      throw InputError(where + "/Poisson's ratio",
                       "found " + std::to_string(poisson),
                       "it must lie between -1 and 0.5, 0.5 excluded");
    mu     = 0.5 * young / (1. + poisson);
    lambda = 2. * mu * poisson / (1. - 2. * poisson);
  }
} // namespace alveolus
