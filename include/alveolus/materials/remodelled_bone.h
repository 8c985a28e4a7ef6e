// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_remodelled_bone_h
#define alveolus_materials_remodelled_bone_h

#include <alveolus/materials/elastic_material.h>
#include <alveolus/materials/hardening_law.h>

#include <map>
#include <memory>

namespace alveolus
{
  /** The state of bone at a point, as remodelling sees it. */
  struct BonePoint
  {
    dealii::SymmetricTensor<2, 3> elastic_strain; ///< Hencky strain h
    double                        density = 0.;   ///< apparent density [g/cc]
    dealii::SymmetricTensor<2, 3> log_fabric;     ///< log T, trace 0
  };

  /**
   * Elastoplastic bone whose stiffness follows apparent density rho and fabric
   * T (det T = 1) as a continuum damage D = I - H^2 with the remodelling tensor
   * H^2 = (E(rho)/E)^{1/2} T (Doblare and Garcia, J. Biomech. 35 (2002) 1).
   *
   * Energy equivalence with the undamaged bone (E, nu): effective strain H h H,
   * effective stress C : (H h H), Kirchhoff stress tau = H (C : (H h H)) H,
   * energy (1/2) h : tau. E(rho) = E L(rho)/L(rho_u) with the density law L of
   * bone_tissue and rho_u the undamaged density, at which H = I.
   *
   * J2 plasticity with isotropic hardening k(alpha), linear or another
   * registered HardeningLaw, in one of two variants:
   *  - "isochoric": in the nominal stress, f = sqrt(3/2) |dev tau| -
   *    (E(rho)/E) (sigma_Y + k(alpha)), flow along d f/d tau;
   *  - "effective": in the effective stress, with the yield stress (E(rho)/E)^m
   *    (sigma_Y + k(alpha)) and d alpha = (E(rho)/E)^{-m} times the effective
   *    equivalent plastic strain. Its flow changes the volume once there is a
   *    fabric; ln J_p is recorded.
   *
   * Density and fabric are frozen in the material frame during an increment:
   * the fabric turns with the polar rotation R of f, H = R H_n R^T, also within
   * the Newton iterations (a Jaumann-like spin: under large shear the fabric
   * does not follow material fibres). The tangent is that of the whole update.
   * Energy counts elastic strain only, not hardening.
   *
   * Derived quantities: "damage", the largest eigenvalue of I - H^2;
   * "stimulus", sign(tr tau) times the energy [MPa]; "von Mises stress" and
   * "pressure" (positive in compression) of tau [MPa].
   */
  class RemodelledBone : public Material
  {
  public:
    /**
     * Say what remodelling will change, before initialize(): a density or
     * fabric that nobody changes is not stored.
     */
    void
    set_remodelled(const bool density, const bool fabric);

    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const unsigned int dim, const std::string &where) override;

    std::vector<HistoryField>
    history_fields() const override;

    void
    initial_history(double *values) const override;

    /** @throws RunError if the plastic return does not converge */
    void
    evaluate(const dealii::Tensor<2, 3> &f,
             const double               *old,
             double                     *trial,
             const bool                  need_tangent,
             MaterialResponse           &response) const override;

    /** Also counts the plastic volume change of the effective law. */
    double
    volume_ratio(const double *history) const override
    {
      return Material::volume_ratio(history) *
             (volume_offset < 0 ? 1. : std::exp(history[volume_offset]));
    }

    /** Project the fabric, see limit_fabric(). Nothing else is touched. */
    unsigned int
    make_admissible(double *history) const override;

    std::vector<std::pair<std::string, std::string>>
    derived_names() const override;

    std::vector<double>
    derived_values(const double *history) const override;

    /** State of a record; density and fabric that are not stored: initial. */
    BonePoint
    point(const double *record) const;

    /** Write what the record stores of @p point. */
    void
    store(const BonePoint &point, double *record) const;

    /** E(rho)/E. */
    double
    stiffness_ratio(const double density) const;

    /** H. */
    dealii::SymmetricTensor<2, 3>
    remodelling_tensor(const BonePoint &point) const;

    /** Kirchhoff stress [MPa]. */
    dealii::SymmetricTensor<2, 3>
    stress(const BonePoint &point) const;

    /** Stored energy [MPa]. */
    double
    energy(const BonePoint &point) const;

    /** Effective stress C : (H h H) [MPa] for a given H. */
    dealii::SymmetricTensor<2, 3>
    effective_stress(const dealii::SymmetricTensor<2, 3> &H,
                     const dealii::SymmetricTensor<2, 3> &strain) const;

    /**
     * Project the eigenvalues of @p log_fabric onto [-ln r, min(ln r, -(1/2)
     * ln(E(rho)/E))] with trace zero (nearest point in the Euclidean norm), so
     * that no direction becomes stiffer than undamaged bone.
     * @return true if more than round-off had to be changed
     */
    bool
    limit_fabric(const double                   density,
                 dealii::SymmetricTensor<2, 3> &log_fabric) const;

    /** True if the records hold a density. */
    bool
    stores_density() const
    {
      return density_remodelled;
    }
    /** True if the records hold a fabric. */
    bool
    stores_fabric() const
    {
      return fabric_remodelled;
    }

    /** Smallest density that resorption leaves [g/cc]. */
    double
    minimum_density() const
    {
      return rho_min;
    }
    /** rho_u, the largest density that formation reaches [g/cc]. */
    double
    undamaged_density() const
    {
      return rho_undamaged;
    }
    /** Density of bone without pores [g/cc]. */
    double
    full_density() const
    {
      return rho_full;
    }

  private:
    void
    evaluate_isotropic(const Increment  &increment,
                       const double      ratio,
                       const double     *old,
                       double           *trial,
                       const bool        need_tangent,
                       MaterialResponse &response) const;

    void
    evaluate_anisotropic(const dealii::Tensor<2, 3>          &f,
                         const Increment                     &increment,
                         const double                         ratio,
                         const dealii::SymmetricTensor<2, 3> &log_fabric,
                         const double                        *old,
                         double                              *trial,
                         const bool                           need_tangent,
                         MaterialResponse                    &response) const;

    double young         = 13750.;
    double poisson       = 0.3;
    bool   plasticity    = true;
    double yield_stress  = 200.;
    double rho_initial   = 1.3;
    double rho_undamaged = 1.3;
    double rho_full      = 1.9;
    double rho_min       = 0.3;
    double fabric_bound  = 3.;
    double exponent      = 0.5;

    std::string yield_law      = "isochoric";
    std::string hardening_name = "linear";
    /** All registered laws, as each declares its parameters. */
    std::map<std::string, std::shared_ptr<HardeningLaw>> hardening_laws;

    bool density_remodelled = false;
    bool fabric_remodelled  = false;

    // derived by initialize()
    unsigned int        dim = 0;
    LameConstants       lame;
    const HardeningLaw *hardening       = nullptr; ///< the one in use
    bool                effective       = false;
    double              reference_young = 1.; ///< L(rho_u)
    double              initial_ratio   = 1.; ///< E(rho_initial)/E
    /** Offsets in the record, -1 for fields that are not stored. */
    int strain_offset = -1, alpha_offset = -1, density_offset = -1,
        fabric_offset = -1, volume_offset = -1;
  };

  /**
   * The point nearest to @p y with entries in [lower, upper] and sum zero,
   * clip(y - mu) with mu found exactly on the piecewise linear sum; lower <= 0
   * <= upper.
   */
  std::array<double, 3>
  project_traceless(const std::array<double, 3> &y,
                    const double                 lower,
                    const double                 upper);

  /** What the return of a plastic law leaves, see anisotropic_return(). */
  struct AnisotropicReturn
  {
    Mandel6  strain;          ///< elastic strain after the return
    Mandel6  stress;          ///< Kirchhoff stress
    double   multiplier = 0.; ///< increment of alpha
    Mandel66 tangent;         ///< d stress/d trial strain
  };

  /**
   * Return of a trial strain onto the von Mises yield surface sqrt(3/2) |dev
   * tau| = yield(multiplier) for tau = C : h with any elasticity C: h = h_trial
   * - multiplier (3/2) dev tau/q. The scalar equation for the multiplier is
   * solved by Newton's method within a bracket; isotropic C and linear
   * hardening take one iteration.
   * @param C, compliance stiffness and its inverse
   * @param yield  yield stress (> 0) during the increment
   * @throws RunError if the iteration does not converge
   */
  AnisotropicReturn
  anisotropic_return(const Mandel66    &C,
                     const Mandel66    &compliance,
                     const Mandel6     &trial_strain,
                     const YieldStress &yield,
                     const bool         need_tangent);
} // namespace alveolus

#endif
