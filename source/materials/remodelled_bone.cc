// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/bone_tissue.h>
#include <alveolus/materials/remodelled_bone.h>

#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    /** What the registered hardening laws are, for the manual. */
    std::string
    hardening_texts()
    {
      std::string texts;
      for (const auto &entry : Registry<HardeningLaw>::entries())
        texts += (texts.empty() ? "" : " ") + entry.first + ": " +
                 entry.second.description;
      return texts;
    }
  } // namespace



  void
  RemodelledBone::set_remodelled(const bool density, const bool fabric)
  {
    density_remodelled = density;
    fabric_remodelled  = fabric;
  }



  void
  RemodelledBone::declare_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.add_parameter("Young's modulus",
                      young,
                      "Young's modulus E of undamaged bone [MPa].",
                      Double(0.));
    prm.add_parameter(
      "Poisson's ratio",
      poisson,
      "Poisson's ratio nu of undamaged bone [-], between -1 and "
      "0.5.",
      Double(-1., 0.5));
    prm.add_parameter("Plasticity",
                      plasticity,
                      "Whether the bone yields; if not, no plastic strain is "
                      "stored.");
    prm.add_parameter("Yield stress",
                      yield_stress,
                      "Yield stress sigma_Y of undamaged bone [MPa].",
                      Double(0.));
    prm.add_parameter("Hardening",
                      hardening_name,
                      "How the yield stress of undamaged bone grows with the "
                      "equivalent plastic strain alpha: " +
                        hardening_texts(),
                      dealii::Patterns::Selection(
                        Registry<HardeningLaw>::names("|")));
    for (const auto &entry : Registry<HardeningLaw>::entries())
      {
        auto &law = hardening_laws[entry.first];
        law       = entry.second.factory();
        law->declare_parameters(prm);
      }
    prm.add_parameter("Initial density",
                      rho_initial,
                      "Apparent density at the beginning [g/cc].",
                      Double(0.));
    prm.add_parameter("Undamaged density",
                      rho_undamaged,
                      "Apparent density rho_u [g/cc] at which the bone has the "
                      "given Young's modulus, and above which it does not "
                      "densify.",
                      Double(0.));
    prm.add_parameter("Full density",
                      rho_full,
                      "Density of bone without pores [g/cc].",
                      Double(0.));
    prm.add_parameter("Minimum density",
                      rho_min,
                      "Density at which resorption ends [g/cc].",
                      Double(0.));
    prm.add_parameter("Fabric bound",
                      fabric_bound,
                      "Bound r >= 1 of the eigenvalues of the fabric, which "
                      "stay between 1/r and r [-].",
                      Double(1.));
    prm.add_parameter("Yield law",
                      yield_law,
                      "isochoric: von Mises yield in the nominal stress, its "
                      "yield stress proportional to Young's modulus; "
                      "effective: in the effective stress.",
                      dealii::Patterns::Selection("isochoric|effective"));
    prm.add_parameter("Yield exponent",
                      exponent,
                      "Exponent m of E(rho)/E in the yield stress of the "
                      "effective law [-]: 0 is energy equivalence, 0.5 equals "
                      "the isochoric law as long as there is no fabric.",
                      Double(0., 2.));
  }



  void
  RemodelledBone::initialize(const unsigned int dim, const std::string &where)
  {
    this->dim = dim;
    lame      = LameConstants(young, poisson, where);
    effective = (yield_law == "effective");
    hardening = hardening_laws.at(hardening_name).get();
    if (std::isinf(yield_stress))
      plasticity = false;
    if (plasticity && !(yield_stress > 0.))
      throw InputError(where + "/Yield stress",
                       "found " + std::to_string(yield_stress),
                       "it must be positive [MPa], or set Plasticity = false");
    if (!(rho_min > 0. && rho_min < rho_undamaged))
      throw InputError(where + "/Minimum density",
                       "found " + std::to_string(rho_min),
                       "it must be positive and less than the undamaged "
                       "density " +
                         std::to_string(rho_undamaged) + " g/cc");
    if (rho_undamaged > rho_full)
      throw InputError(where + "/Undamaged density",
                       "found " + std::to_string(rho_undamaged),
                       "it must not exceed the full density " +
                         std::to_string(rho_full) + " g/cc");
    if (rho_initial < rho_min || rho_initial > rho_undamaged)
      throw InputError(where + "/Initial density",
                       "found " + std::to_string(rho_initial),
                       "it must lie between the minimum density " +
                         std::to_string(rho_min) +
                         " and the undamaged density " +
                         std::to_string(rho_undamaged) + " g/cc");
    reference_young = bone_tissue::young_modulus(rho_undamaged);
    initial_ratio   = stiffness_ratio(rho_initial);

    const HistoryLayout layout(history_fields(), dim);
    strain_offset  = layout.offset("elastic strain");
    alpha_offset   = layout.offset("plastic strain");
    density_offset = layout.offset("density");
    fabric_offset  = layout.offset("log fabric");
    volume_offset  = layout.offset("log plastic volume");
  }



  std::vector<HistoryField>
  RemodelledBone::history_fields() const
  {
    std::vector<HistoryField> fields;
    const auto scalar = [&](const std::string &name, const std::string &unit) {
      fields.emplace_back();
      fields.back().name = name;
      fields.back().unit = unit;
    };
    scalar("elastic strain", "");
    fields.back().shape = HistoryField::Shape::symmetric_tensor;
    if (plasticity)
      {
        scalar("plastic strain", "");
        fields.back().lower = 0.;
      }
    if (density_remodelled)
      {
        scalar("density", "g/cc");
        fields.back().lower = rho_min;
        fields.back().upper = rho_undamaged;
      }
    if (fabric_remodelled)
      {
        scalar("log fabric", "");
        fields.back().shape     = HistoryField::Shape::symmetric_tensor;
        fields.back().lower     = -std::log(fabric_bound);
        fields.back().upper     = std::log(fabric_bound);
        fields.back().traceless = true;
      }
    if (plasticity && yield_law == "effective")
      scalar("log plastic volume", "");
    return fields;
  }



  void
  RemodelledBone::initial_history(double *values) const
  {
    if (alpha_offset >= 0)
      values[alpha_offset] = 0.;
    if (volume_offset >= 0)
      values[volume_offset] = 0.;
    BonePoint start;
    start.density = rho_initial;
    store(start, values);
  }



  void
  RemodelledBone::evaluate(const Tensor<2, 3> &f,
                           const double       *old,
                           double             *trial,
                           const bool          need_tangent,
                           MaterialResponse   &response) const
  {
    const Increment increment(f, unpack(old + strain_offset, dim));

    double ratio = initial_ratio;
    if (density_offset >= 0)
      {
        trial[density_offset] = old[density_offset];
        ratio                 = stiffness_ratio(old[density_offset]);
      }
    if (fabric_offset >= 0)
      {
        const SymmetricTensor<2, 3> log_fabric =
          unpack(old + fabric_offset, dim);
        if (!is_zero(log_fabric))
          {
            evaluate_anisotropic(f,
                                 increment,
                                 ratio,
                                 log_fabric,
                                 old,
                                 trial,
                                 need_tangent,
                                 response);
            return;
          }
        pack(log_fabric, trial + fabric_offset, dim);
      }
    evaluate_isotropic(increment, ratio, old, trial, need_tangent, response);
  }



  void
  RemodelledBone::evaluate_isotropic(const Increment  &increment,
                                     const double      ratio,
                                     const double     *old,
                                     double           *trial,
                                     const bool        need_tangent,
                                     MaterialResponse &response) const
  {
    const auto  &h      = increment.principal;
    const double volume = h[0] + h[1] + h[2];
    const double mu     = ratio * lame.mu;
    const double bulk   = ratio * (lame.lambda + 2. / 3. * lame.mu);

    std::array<double, 3> dev{
      {h[0] - volume / 3., h[1] - volume / 3., h[2] - volume / 3.}};
    const double norm =
      std::sqrt(dev[0] * dev[0] + dev[1] * dev[1] + dev[2] * dev[2]);

    // Without fabric the effective law is the isochoric one (m = 1/2) with
    // another scale of the yield stress: both in nominal quantities here.
    double theta = 1.,
           dyad  = 0.; // C = bulk I(x)I + 2 mu (theta P + dyad n(x)n)
    std::array<double, 3> n{};
    if (alpha_offset >= 0)
      {
        const double alpha  = old[alpha_offset];
        trial[alpha_offset] = alpha;
        // the isochoric law needs neither power
        const double root  = effective ? std::sqrt(ratio) : 1.;
        const double scale = effective ? root * std::pow(ratio, exponent)
                                       : ratio; // of the nominal yield stress
        // d gamma in the nominal strain; alpha grows by d gamma times growth
        const double growth = effective ? root / std::pow(ratio, exponent) : 1.;
        const YieldStress yield{*hardening, yield_stress, alpha, scale, growth};
        const double      q = std::sqrt(1.5) * 2. * mu * norm;
        if (!response.no_flow && q > yield.value(0.))
          {
            const double dgamma = yield.radial_return(q, 3. * mu);
            const double slope  = yield.slope(dgamma);
            theta               = 1. - 3. * mu * dgamma / q;
            dyad                = (1. - theta) - 3. * mu / (3. * mu + slope);
            for (unsigned int a = 0; a < 3; ++a)
              {
                n[a] = dev[a] / norm;
                dev[a] *= theta;
              }
            trial[alpha_offset] += growth * dgamma;
            response.dissipation = yield.work(dgamma);
          }
      }
    if (volume_offset >= 0)
      trial[volume_offset] = old[volume_offset];

    PrincipalResponse     r;
    std::array<double, 3> elastic;
    for (unsigned int a = 0; a < 3; ++a)
      {
        elastic[a]  = dev[a] + volume / 3.;
        r.stress[a] = bulk * volume + 2. * mu * dev[a];
        r.energy += 0.5 * r.stress[a] * elastic[a];
        r.shear[a] = 2. * mu * theta;
        for (unsigned int b = 0; b < 3; ++b)
          r.normal[a][b] = bulk + 2. * mu *
                                    (theta * ((a == b ? 1. : 0.) - 1. / 3.) +
                                     dyad * n[a] * n[b]);
      }
    pack(compose(elastic, increment.b), trial + strain_offset, dim);
    isotropic_response(increment, r, need_tangent, response);
  }



  void
  RemodelledBone::evaluate_anisotropic(const Tensor<2, 3>          &f,
                                       const Increment             &increment,
                                       const double                 ratio,
                                       const SymmetricTensor<2, 3> &log_fabric,
                                       const double                *old,
                                       double                      *trial,
                                       const bool        need_tangent,
                                       MaterialResponse &response) const
  {
    // The fabric turns with the polar rotation of the increment.
    const Polar rotation = polar(f);
    Spectral    fabric   = spectral(log_fabric);
    for (auto &axis : fabric.vectors)
      axis = rotation.R * axis;
    pack(compose(fabric.values, fabric), trial + fabric_offset, dim);

    // Powers of H^2 = ratio^{1/2} T
    const double log_ratio = 0.5 * std::log(ratio);
    const auto   power     = [&](const double exponent) {
      std::array<double, 3> values;
      for (unsigned int a = 0; a < 3; ++a)
        values[a] = std::exp(exponent * (log_ratio + fabric.values[a]));
      return compose(values, fabric);
    };

    const Mandel6 h      = to_mandel(increment.strain());
    const double  alpha  = alpha_offset >= 0 ? old[alpha_offset] : 0.;
    Mandel6       strain = h, stress;
    Mandel66      C;
    double        growth = 0.; // of alpha
    if (effective && alpha_offset >= 0)
      {
        // Radial return in the effective space: closed form.
        const Mandel66 A       = congruence(power(0.5));
        const Mandel6  trial_h = A * h;
        const double   bulk    = lame.lambda + 2. / 3. * lame.mu;
        const double   volume  = trial_h[0] + trial_h[1] + trial_h[2];
        Mandel6        dev     = trial_h;
        for (unsigned int i = 0; i < 3; ++i)
          dev[i] -= volume / 3.;
        const double      norm  = std::sqrt(dot(dev, dev));
        const double      scale = std::pow(ratio, exponent);
        const YieldStress yield{
          *hardening, yield_stress, alpha, scale, 1. / scale};
        const double q     = std::sqrt(1.5) * 2. * lame.mu * norm;
        double       theta = 1., dyad = 0.;
        if (!response.no_flow && q > yield.value(0.))
          {
            const double dalpha  = yield.radial_return(q, 3. * lame.mu);
            const double slope   = yield.slope(dalpha);
            growth               = dalpha / scale;
            response.dissipation = yield.work(dalpha);
            theta                = 1. - 3. * lame.mu * dalpha / q;
            dyad = (1. - theta) - 3. * lame.mu / (3. * lame.mu + slope);
            Mandel6 plastic; // effective plastic strain increment
            for (unsigned int i = 0; i < 6; ++i)
              plastic[i] = (1. - theta) * dev[i];
            plastic = congruence(power(-0.5)) * plastic;
            for (unsigned int i = 0; i < 6; ++i)
              strain[i] -= plastic[i];
          }
        Mandel6 effective_stress;
        for (unsigned int i = 0; i < 6; ++i)
          effective_stress[i] =
            2. * lame.mu * theta * dev[i] + (i < 3 ? bulk * volume : 0.);
        stress = A * effective_stress;
        if (need_tangent)
          {
            Mandel66 effective_C;
            add_deviatoric_projection(effective_C, 2. * lame.mu * theta);
            if (growth > 0.)
              add_dyad(effective_C, 2. * lame.mu * dyad / (norm * norm), dev);
            for (unsigned int i = 0; i < 3; ++i)
              for (unsigned int j = 0; j < 3; ++j)
                effective_C[i][j] += bulk;
            C = A * effective_C * A;
          }
        trial[volume_offset] = old[volume_offset] + h[0] + h[1] + h[2] -
                               strain[0] - strain[1] - strain[2];
      }
    else
      {
        // C = lambda H^2 (x) H^2 + 2 mu (h -> H^2 h H^2)
        const auto H2 = power(1.);
        C             = congruence(H2);
        for (auto &row : C.rows)
          for (double &entry : row)
            entry *= 2. * lame.mu;
        add_dyad(C, lame.lambda, to_mandel(H2));
        stress = C * h;
        if (alpha_offset >= 0)
          {
            const YieldStress yield{*hardening, yield_stress, alpha, ratio};
            if (!response.no_flow &&
                von_mises(from_mandel(stress)) > yield.value(0.))
              {
                const auto inverse    = power(-1.);
                Mandel66   compliance = congruence(inverse);
                for (auto &row : compliance.rows)
                  for (double &entry : row)
                    entry *= 0.5 / lame.mu;
                add_dyad(compliance,
                         -0.5 * lame.lambda /
                           (lame.mu * (3. * lame.lambda + 2. * lame.mu)),
                         to_mandel(inverse));
                const AnisotropicReturn plastic =
                  anisotropic_return(C, compliance, h, yield, need_tangent);
                strain               = plastic.strain;
                stress               = plastic.stress;
                growth               = plastic.multiplier;
                response.dissipation = yield.work(growth);
                if (need_tangent)
                  C = plastic.tangent;
              }
          }
      }

    if (alpha_offset >= 0)
      trial[alpha_offset] = alpha + growth;
    pack(from_mandel(strain), trial + strain_offset, dim);
    response.stress = from_mandel(stress);
    response.energy = 0.5 * dot(stress, strain);
    if (need_tangent)
      structural_tangent(increment, rotation.V, C, response);
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Material,
  alveolus::RemodelledBone,
  "remodelled bone",
  "Elastoplastic bone with density-dependent stiffness. Remodelling tensor H^2 "
  "= (E(rho)/E)^{1/2} T, E(rho) = E L(rho)/L(rho_u), L = max(2014 rho^2.5, "
  "1763 rho^3.2); effective strain H h H, Kirchhoff stress tau = H (C : (H h "
  "H)) H with C from `Young's modulus` E and `Poisson's ratio`; rho_u is "
  "`Undamaged density`. Yield (`Yield law` = isochoric): sqrt(3/2)|dev tau| = "
  "(E(rho)/E)(sigma_Y + k(alpha)), sigma_Y = `Yield stress`, k by `Hardening`. "
  "Density and fabric T change by the remodelling law, within "
  "`Minimum density`, rho_u and `Fabric bound`.")
