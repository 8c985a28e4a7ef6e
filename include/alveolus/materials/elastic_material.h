// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_elastic_material_h
#define alveolus_materials_elastic_material_h

#include <alveolus/materials/increment.h>

namespace alveolus
{
  /**
   * Common part of the isotropic hyperelastic laws. They carry their total
   * Hencky strain h, b = exp(2 h), as history ("elastic strain"), so that only
   * the current mesh has to be good. A law supplies its principal Kirchhoff
   * stresses as functions of the principal values of h.
   *
   * Derived quantities: "von Mises stress" and "pressure" (positive in
   * compression) of the Kirchhoff stress [MPa].
   */
  class ElasticMaterial : public Material
  {
  public:
    void
    initialize(const unsigned int dim, const std::string &where) override;

    std::vector<HistoryField>
    history_fields() const override;

    void
    initial_history(double *values) const override;

    void
    evaluate(const dealii::Tensor<2, 3> &f,
             const double               *old,
             double                     *trial,
             const bool                  need_tangent,
             MaterialResponse           &response) const override;

    std::vector<std::pair<std::string, std::string>>
    derived_names() const override;

    std::vector<double>
    derived_values(const double *history) const override;

    /** Response in the principal axes for the principal Hencky strains. */
    virtual PrincipalResponse
    principal_response(const std::array<double, 3> &h) const = 0;

  protected:
    /**
     * Least eigenvalue of the acoustic tensor at a record (see
     * least_acoustic_eigenvalue()) relative to the initial shear modulus [-]:
     * laws that may lose ellipticity report it as derived quantity
     * "ellipticity". 1 for the undeformed material, not positive where
     * ellipticity is lost.
     */
    double
    ellipticity(const double *history) const;

    unsigned int dim = 0; ///< of space: 2 is plane strain
  };

  /** Von Mises equivalent sqrt(3/2) |dev tau| of a stress. */
  double
  von_mises(const dealii::SymmetricTensor<2, 3> &stress);

  /**
   * Lame constant and shear modulus.
   * @throws InputError unless E > 0 and -1 < nu < 1/2
   */
  struct LameConstants
  {
    LameConstants() = default;
    /**
     * From Young's modulus [MPa] and Poisson's ratio [-]. @throws InputError
     * naming @p where unless E > 0 and -1 < nu < 1/2
     */
    LameConstants(const double       young,
                  const double       poisson,
                  const std::string &where);
    double lambda = 0.; ///< [MPa]
    double mu     = 0.; ///< shear modulus [MPa]
  };
} // namespace alveolus

#endif
