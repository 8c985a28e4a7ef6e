// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/bone_tissue.h>
#include <alveolus/remodelling/mechanostat.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;

  void
  Mechanostat::declare_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::Selection;
    prm.add_parameter("Homeostatic stimulus",
                      homeostatic,
                      "Stimulus U0 at which nothing changes [MPa].",
                      Double());
    prm.add_parameter("Width of the lazy zone",
                      width,
                      "Width of the range of stimuli around U0 without "
                      "remodelling [MPa].",
                      Double(0.));
    prm.add_parameter("Lazy zone",
                      width_means,
                      "half width: the zone is U0 - width ... U0 + width; full "
                      "width: U0 - width/2 ... U0 + width/2.",
                      Selection("half width|full width"));
    prm.add_parameter("Formation rate",
                      formation,
                      "Rate constant c_f of the surface [mm/(MPa T)].",
                      Double(0.));
    prm.add_parameter("Resorption rate",
                      resorption,
                      "Rate constant c_r of the surface [mm/(MPa T)].",
                      Double(0.));
    prm.add_parameter("Surface availability",
                      availability,
                      "Fraction k of the surface that remodels [-].",
                      Double(0., 1.));
    prm.add_parameter("Stimulus",
                      stimulus_kind,
                      "signed: energy with the sign of the trace of the "
                      "stress; unsigned: energy.",
                      Selection("signed|unsigned"));
    prm.add_parameter("Pressure smoothing",
                      pressure,
                      "Pressure p0 over which the sign changes smoothly "
                      "[MPa]; 0: abruptly.",
                      Double(0.));
    prm.add_parameter("Degree of anisotropy",
                      anisotropy,
                      "omega between 0 (density only) and 1 [-].",
                      Double(0., 1.));
    prm.add_parameter("Anisotropy offset",
                      offset,
                      "Small positive eps that keeps the direction tensor "
                      "regular [-].",
                      Double(0.));
  }



  void
  Mechanostat::initialize(const std::string &where)
  {
    if (anisotropy > 0. && !(offset > 0.))
      throw InputError(where + "/Anisotropy offset",
                       "found " + std::to_string(offset),
                       "it must be positive, such as 0.01");
    if (!(availability > 0.))
      throw InputError(where + "/Surface availability",
                       "found " + std::to_string(availability),
                       "it must be positive; without remodelling law nothing "
                       "remodels");
    half_width = (width_means == "half width") ? width : 0.5 * width;
  }



  double
  Mechanostat::stimulus(const RemodelledBone &bone,
                        const BonePoint      &point) const
  {
    const SymmetricTensor<2, 3> tau    = bone.stress(point);
    const double                energy = 0.5 * (tau * point.elastic_strain);
    if (stimulus_kind == "unsigned")
      return energy;
    const double tr = trace(tau);
    if (pressure > 0.)
      return std::tanh(tr / (3. * pressure)) * energy;
    // 0 * energy: not a number stays what it is
    return tr > 0. ? energy : (tr < 0. ? -energy : 0. * energy);
  }



  RemodellingRates
  Mechanostat::rates(const RemodelledBone &bone,
                     const BonePoint      &point,
                     const double          stimulus) const
  {
    RemodellingRates rates;
    double           surface = 0.; // velocity [mm/T]
    if (stimulus > homeostatic + half_width)
      surface = formation * (stimulus - (homeostatic + half_width));
    else if (stimulus < homeostatic - half_width)
      surface = -resorption * ((homeostatic - half_width) - stimulus);
    if (surface == 0.)
      return rates;

    const double full = bone.full_density();
    rates.density     = availability * full * surface *
                    bone_tissue::specific_surface(1. - point.density / full);
    if (anisotropy == 0. || rates.density == 0.)
      return rates;

    const SymmetricTensor<2, 3> H = bone.remodelling_tensor(point);
    const SymmetricTensor<2, 3> tau =
      bone.effective_stress(H, point.elastic_strain);
    // Y = tau~ H h + h H tau~ = 2 sym(tau~ H h)
    Spectral Y = spectral(2. * symmetric_product(tau, H, point.elastic_strain));
    double   positive = 0.;
    for (double &y : Y.values)
      {
        y = std::max(y, 0.);
        positive += y;
      }
    const bool            forms = surface > 0.;
    std::array<double, 3> direction;
    for (unsigned int a = 0; a < 3; ++a)
      {
        // no direction at all without a positive part
        const double share = positive > 0. ? Y.values[a] / positive : 1. / 3.;
        const double J = (1. - anisotropy) / 3. + offset + anisotropy * share;
        direction[a]   = forms ? J : 1. / J;
      }
    const SymmetricTensor<2, 3> weight =
      tensor_function(H, [](const double x) { return 1. / std::sqrt(x); });
    SymmetricTensor<2, 3> A =
      symmetric_product(weight, compose(direction, Y), weight);
    A /= trace(A);
    rates.log_fabric = 1.5 * bone_tissue::stiffness_exponent(point.density) *
                       (rates.density / point.density) * deviator(A);
    return rates;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::RemodellingLaw,
  alveolus::Mechanostat,
  "mechanostat",
  "Density rate k S_v(n) rho_full r', n = 1 - rho/rho_full, k `Surface "
  "availability`. r' = c_f (U - U0 - w) for U > U0 + w (`Formation rate` c_f), "
  "-c_r (U0 - w - U) for U < U0 - w (`Resorption rate` c_r), 0 in the lazy zone "
  "(`Width of the lazy zone` w, `Homeostatic stimulus` U0). U is the energy "
  "density, signed by the trace of the stress or not (`Stimulus`). `Degree of "
  "anisotropy` omega > 0 turns and sharpens the fabric.")
