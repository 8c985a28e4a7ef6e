// SPDX-License-Identifier: LGPL-2.1-or-later
// The part of RemodelledBone that concerns a state, not an increment.
#include <alveolus/materials/bone_tissue.h>
#include <alveolus/materials/remodelled_bone.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;

  double
  RemodelledBone::stiffness_ratio(const double density) const
  {
    return bone_tissue::young_modulus(density) / reference_young;
  }



  BonePoint
  RemodelledBone::point(const double *record) const
  {
    BonePoint p;
    p.elastic_strain = unpack(record + strain_offset, dim);
    p.density = density_offset >= 0 ? record[density_offset] : rho_initial;
    if (fabric_offset >= 0)
      p.log_fabric = unpack(record + fabric_offset, dim);
    return p;
  }



  void
  RemodelledBone::store(const BonePoint &point, double *record) const
  {
    pack(point.elastic_strain, record + strain_offset, dim);
    if (density_offset >= 0)
      record[density_offset] = point.density;
    if (fabric_offset >= 0)
      pack(point.log_fabric, record + fabric_offset, dim);
  }



  SymmetricTensor<2, 3>
  RemodelledBone::remodelling_tensor(const BonePoint &point) const
  {
    const double root4 = std::pow(stiffness_ratio(point.density), 0.25);
    if (is_zero(point.log_fabric))
      return root4 * dealii::unit_symmetric_tensor<3>();
    return tensor_function(point.log_fabric, [&](const double y) {
      return root4 * std::exp(0.5 * y);
    });
  }



  SymmetricTensor<2, 3>
  RemodelledBone::effective_stress(const SymmetricTensor<2, 3> &H,
                                   const SymmetricTensor<2, 3> &strain) const
  {
    const SymmetricTensor<2, 3> h = symmetric_product(H, strain, H);
    return lame.lambda * trace(h) * dealii::unit_symmetric_tensor<3>() +
           2. * lame.mu * h;
  }



  SymmetricTensor<2, 3>
  RemodelledBone::stress(const BonePoint &point) const
  {
    if (is_zero(point.log_fabric))
      return stiffness_ratio(point.density) *
             (lame.lambda * trace(point.elastic_strain) *
                dealii::unit_symmetric_tensor<3>() +
              2. * lame.mu * point.elastic_strain);
    const SymmetricTensor<2, 3> H = remodelling_tensor(point);
    return symmetric_product(H, effective_stress(H, point.elastic_strain), H);
  }



  double
  RemodelledBone::energy(const BonePoint &point) const
  {
    return 0.5 * (stress(point) * point.elastic_strain);
  }



  bool
  RemodelledBone::limit_fabric(const double           density,
                               SymmetricTensor<2, 3> &log_fabric) const
  {
    if (is_zero(log_fabric))
      return false;
    const double bound = std::log(fabric_bound);
    // A density beyond rho_u by round-off must not empty the set.
    const double upper =
      std::min(bound, std::max(0., -0.5 * std::log(stiffness_ratio(density))));
    const Spectral s       = spectral(log_fabric);
    const auto     limited = project_traceless(s.values, -bound, upper);
    double         change  = 0.;
    for (unsigned int a = 0; a < 3; ++a)
      change = std::max(change, std::abs(limited[a] - s.values[a]));
    if (change > 1e-15)
      log_fabric = compose(limited, s);
    return change > 1e-12;
  }



  unsigned int
  RemodelledBone::make_admissible(double *history) const
  {
    if (fabric_offset < 0)
      return 0;
    BonePoint p = point(history);
    if (!limit_fabric(p.density, p.log_fabric))
      return 0;
    pack(p.log_fabric, history + fabric_offset, dim);
    return 1;
  }



  std::vector<std::pair<std::string, std::string>>
  RemodelledBone::derived_names() const
  {
    return {{"damage", ""},
            {"stimulus", "MPa"},
            {"von Mises stress", "MPa"},
            {"pressure", "MPa"}};
  }



  std::vector<double>
  RemodelledBone::derived_values(const double *history) const
  {
    const BonePoint             p    = point(history);
    const SymmetricTensor<2, 3> tau  = stress(p);
    const double                tr   = trace(tau);
    const double                sign = tr > 0. ? 1. : (tr < 0. ? -1. : 0.);
    return {1. - std::sqrt(stiffness_ratio(p.density)) *
                   std::exp(spectral(p.log_fabric).values[2]),
            sign * energy(p),
            von_mises(tau),
            -tr / 3.};
  }
} // namespace alveolus
