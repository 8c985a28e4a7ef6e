// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/ligament_interface.h>

#include <deal.II/base/symmetric_tensor.h>

namespace alveolus
{
  using dealii::Tensor;

  void
  LigamentInterface::declare_parameters(dealii::ParameterHandler &prm)
  {
    using dealii::Patterns::Double;
    using dealii::Patterns::Selection;
    prm.add_parameter("Thickness",
                      thickness,
                      "Thickness h of the layer [mm].",
                      Double(0.));
    prm.add_parameter("Poisson's ratio",
                      poisson,
                      "Poisson's ratio nu [-], which turns the modulus into a "
                      "shear modulus.",
                      Double(-1., 0.5));
    input.declare(prm);
    prm.add_parameter(
      "Locking strain",
      locking_strain,
      "Engineering strain, of either sign and of shear, beyond "
      "which the layer is stiff: in compression the tooth meets "
      "the bone (-1 is no thickness left), in tension and shear "
      "the fibres are taut [-]; 0: never.",
      Double(0.));
    prm.add_parameter("Locking modulus",
                      locking_modulus,
                      "Tangent modulus beyond the locking strain [MPa].",
                      Double(0.));
    prm.add_parameter("Tangential stiffness",
                      tangential,
                      "table: shear modulus from the tension branch of the "
                      "table at the engineering shear; initial: from the "
                      "modulus at strain zero.",
                      Selection("table|initial"));
  }



  void
  LigamentInterface::initialize(const std::string &where,
                                const std::string &input_directory)
  {
    if (!(thickness > 0.))
      throw InputError(where + "/Thickness",
                       "found " + std::to_string(thickness),
                       "it must be positive [mm]");
    if (!(poisson > -1.))
      throw InputError(where + "/Poisson's ratio",
                       "found " + std::to_string(poisson),
                       "it must be larger than -1");
    const std::string name   = input.origin(where);
    const auto        points = input.points(where, input_directory);
    law                      = TangentTable(points, name);
    if (locking_strain > 0.)
      {
        // Inside the limits the table as it is, beyond them the stiff branches
        const double                           limit  = locking_strain;
        std::vector<std::pair<double, double>> locked = {
          {-limit, locking_modulus}, {-limit, law.modulus(-limit)}};
        for (const auto &point : points)
          if (std::abs(point.first) < limit)
            locked.push_back(point);
        locked.emplace_back(limit, law.modulus(limit));
        locked.emplace_back(limit, locking_modulus);
        law = TangentTable(locked, name);
      }
    shear_law = (tangential == "table")
                  ? law
                  : TangentTable({{0., law.modulus(0.)}}, name);
  }



  double
  LigamentInterface::normal_strain(const Tensor<1, 3> &jump,
                                   const Tensor<1, 3> &normal) const
  {
    return jump * normal / thickness;
  }



  double
  LigamentInterface::shear_strain(const Tensor<1, 3> &jump,
                                  const Tensor<1, 3> &normal) const
  {
    return (jump - (jump * normal) * normal).norm() / thickness;
  }



  void
  LigamentInterface::evaluate(const Tensor<1, 3> &jump,
                              const Tensor<1, 3> &normal,
                              Tensor<1, 3>       &traction,
                              Tensor<2, 3>       &tangent,
                              double             &energy) const
  {
    const double       opening          = jump * normal;
    const Tensor<1, 3> slip             = jump - opening * normal;
    const double       length           = slip.norm();
    const double       strain           = opening / thickness;
    const double       shear            = length / thickness;
    const double       to_shear_modulus = 0.5 / (1. + poisson);

    const Tensor<2, 3> nn = outer_product(normal, normal);
    const Tensor<2, 3> tangential_plane =
      Tensor<2, 3>(dealii::unit_symmetric_tensor<3>()) - nn;

    // Without slip there is no direction, and tangent and secant are the same.
    const double slope = to_shear_modulus * shear_law.modulus(shear);
    const double secant =
      shear > 0. ? to_shear_modulus * shear_law.stress(shear) / shear : slope;

    traction = law.stress(strain) * normal + secant / thickness * slip;
    tangent  = law.modulus(strain) / thickness * nn +
              secant / thickness * tangential_plane;
    if (length > 0.)
      {
        const Tensor<1, 3> direction = slip / length;
        tangent +=
          (slope - secant) / thickness * outer_product(direction, direction);
      }
    energy = thickness *
             (law.energy(strain) + to_shear_modulus * shear_law.energy(shear));
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::InterfaceLaw,
  alveolus::LigamentInterface,
  "ligament",
  "Periodontal ligament as a layer without volume, of `Thickness` h. Normal "
  "traction s(u_n/h) with ds/de the table `Tangent modulus` (or `Table file`) "
  "over the engineering strain e; tangential traction with the slope "
  "E_t(|u_t|/h)/(2(1+nu)), E_t the tension branch of the table (`Tangential "
  "stiffness` = table) or its value at zero (initial), nu = `Poisson's "
  "ratio`. `Tension branch` chooses whether the rupture at the end of the "
  "table takes part.")
