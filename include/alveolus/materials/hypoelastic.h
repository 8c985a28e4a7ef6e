// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_hypoelastic_h
#define alveolus_materials_hypoelastic_h

#include <alveolus/materials/increment.h>
#include <alveolus/materials/table_input.h>

namespace alveolus
{
  /**
   * The reading of a uniaxial table that incremental codes make of it: an
   * isotropic tangent with constant Poisson's ratio nu whose modulus is looked
   * up from the current strain. Kirchhoff stress tau and total Hencky strain h
   * are history; for the increment f with polar rotation R
   *
   *   tau_{n+1} = R tau_n R^T + M C(nu) : (h_{n+1} - R h_n R^T),
   *   h_{n+1} = (1/2) ln(f exp(2 h_n) f^T),
   *
   * C(nu) Hooke's tensor for a modulus of 1. It is objective (a rigid turn
   * rotates the stress), and Hencky's law exactly where the modulus is
   * constant, along any path. There is no energy: the work of the stress is
   * history too and stands for it.
   *
   * The modulus is looked up at logarithmic strains m, by the engineering
   * strain e = exp(m) - 1: a tensile one m+ and a compressive one m-, which
   * weigh (1 + L)/2 and (1 - L)/2 with the Lode parameter L = 3 sqrt(6) det(dev
   * h)/|dev h|^3, 1 in uniaxial tension, -1 in compression, 0 in shear:
   *
   *   largest principal: m+ and m- are the largest and the smallest principal
   *     h. (Taking the one of greater magnitude alone jumps from one branch of
   *     the table to the other in shear; a step may then have no solution, as a
   *     trial showed. The weights are ours.)
   *   volumetric: m+ = m- = tr h.
   *   equivalent: m+ = -m- = sqrt(3/2) |dev h|/(1 + nu), the axial strain of a
   *     uniaxial test.
   *
   * Conversion none: M = E_t(e), the table relates true stress and
   * logarithmic strain, and a uniaxial test gives int E_t/(1+e) de. uniaxial:
   * M = l (s + l E_t), l = 1 + e, by which the engineering stress of a uniaxial
   * test is the table; it may become negative far in compression.
   *
   * Modulus at beginning of step: of h_n, first order in the step. mean of
   * step: the mean of M between m_n and m_{n+1}, by which proportional paths
   * do not depend on the number of steps; its derivative is in the tangent,
   * which is not symmetric.
   */
  class Hypoelastic : public Material
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

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

  private:
    enum class Measure
    {
      largest_principal,
      volumetric,
      equivalent
    };

    /** The strains m+ and m-, and the Lode parameter. */
    struct Strain
    {
      double tensile = 0., compressive = 0., lode = 0.;
      /** Derivatives with respect to h. */
      dealii::SymmetricTensor<2, 3> d_tensile, d_compressive, d_lode;
    };
    Strain
    measure(const Spectral &b, const dealii::SymmetricTensor<2, 3> &h) const;

    /** Modulus M at the logarithmic strain m [MPa]. */
    double
    modulus(const double m) const;

    /** Integral of M from 0 to m [MPa]. */
    double
    integral(const double m) const;

    /**
     * Mean of M between two strains.
     * @param slope its derivative with respect to @p after
     */
    double
    mean(const double before, const double after, double &slope) const;

    /** Modulus for the increment, and its derivative with respect to h. */
    double
    step_modulus(const Strain                  &before,
                 const Strain                  &after,
                 dealii::SymmetricTensor<2, 3> &derivative) const;

    double      poisson      = 0.49;
    std::string measure_of   = "equivalent";
    std::string conversion   = "none";
    std::string modulus_at   = "mean of step";
    TableInput  input        = {"as printed", 0.01};
    Measure     kind         = Measure::equivalent;
    bool        converted    = false;
    bool        mean_of_step = true;

    unsigned int dim       = 0;
    unsigned int stress_at = 0, work_at = 0; ///< offsets in the record
    TangentTable table;
    /** Lame constants of C(nu), for a Young's modulus of 1. */
    double lambda = 0., mu = 0.;
  };
} // namespace alveolus

#endif
