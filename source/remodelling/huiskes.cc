// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remodelling/huiskes.h>

namespace alveolus
{
  void
  Huiskes::declare_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    prm.add_parameter("Rate",
                      rate,
                      "Rate constant B [(g/cc)^2/(MPa T)].",
                      Double(0.));
    prm.add_parameter("Reference energy",
                      reference,
                      "Energy per mass k at which nothing changes [MPa cc/g].",
                      Double(0.));
    prm.add_parameter(
      "Dead zone",
      dead_zone,
      "Half width s of the dead zone, relative to the reference "
      "energy [-].",
      Double(0., 1.));
  }



  void
  Huiskes::initialize(const std::string & /*where*/)
  {}



  double
  Huiskes::stimulus(const RemodelledBone &bone, const BonePoint &point) const
  {
    return bone.energy(point);
  }



  RemodellingRates
  Huiskes::rates(const RemodelledBone & /*bone*/,
                 const BonePoint &point,
                 const double     stimulus) const
  {
    const double     per_mass = stimulus / point.density;
    const double     upper    = (1. + dead_zone) * reference;
    const double     lower    = (1. - dead_zone) * reference;
    RemodellingRates rates;
    if (per_mass > upper)
      rates.density = rate * (per_mass - upper);
    else if (per_mass < lower)
      rates.density = rate * (per_mass - lower);
    return rates;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::RemodellingLaw,
  alveolus::Huiskes,
  "Huiskes",
  "Density rate B (S - (1+s) k) above and B (S - (1-s) k) below the dead zone, "
  "S = U/rho the elastic energy per mass; B is `Rate`, k `Reference energy`, s "
  "`Dead zone`. The fabric does not change.")
