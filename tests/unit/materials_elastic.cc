// SPDX-License-Identifier: LGPL-2.1-or-later
// Elastic laws at a point: tangents against differences of the stress, stress
// against differences of the energy, closed forms; rigid rotation, of bone,
// too.
#include "bone_point.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  const std::vector<std::pair<std::string, Parameters>> elastic_laws = {
    {"Hencky elastic", {{"Young's modulus", "100"}}},
    {"neo-Hookean", {{"Shear modulus", "40"}, {"Poisson's ratio", "0.3"}}},
    {"neo-Hookean", {{"Shear modulus", "40"}, {"Bulk modulus", "4000"}}},
    {"Mooney-Rivlin",
     {{"First constant", "15"},
      {"Second constant", "5"},
      {"Bulk modulus", "90"}}}};
} // namespace



TEST(ElasticLaws, TangentAndEnergy)
{
  double tangent = 0., energy = 0.;
  for (const auto &[name, parameters] : elastic_laws)
    for (const unsigned int dim : {2, 3})
      for (unsigned int n = 0; n < 20; ++n)
        {
          const auto material = make(name, parameters, dim);
          Sample     point(*material, dim);
          // moderate and tiny strains: the latter have nearly equal stretches
          const double size = (n % 4 == 3) ? 1e-9 : 0.3;
          point.set("elastic strain", random_symmetric(dim, size));
          const auto f = unit + random_velocity(dim, size);
          tangent      = std::max(tangent, tangent_error(point, f));
          if (size > 0.1)
            energy = std::max(energy, energy_error(point, f));
        }
  std::cout << "elastic: tangent " << tangent << ", stress from energy "
            << energy << '\n';
  EXPECT_LT(tangent, 1e-8);
  EXPECT_LT(energy, 1e-7);
}

TEST(ElasticLaws, AgreeWithInvariantForms)
{
  // stresses written with tensors instead of principal values
  for (unsigned int n = 0; n < 20; ++n)
    {
      const auto   h = random_symmetric(3, 0.3);
      const auto   f = unit + random_velocity(3, 0.2);
      const auto   b = symmetrize(f * Tensor<2, 3>(exp(2. * h)) * transpose(f));
      const double J = std::sqrt(determinant(b));
      const auto   bb       = std::pow(J, -2. / 3.) * b;
      const auto   I        = unit_symmetric_tensor<3>();
      const auto   material = make("Mooney-Rivlin",
                                 {{"First constant", "15"},
                                    {"Second constant", "5"},
                                    {"Bulk modulus", "90"}},
                                 3);
      Sample       point(*material, 3);
      point.set("elastic strain", h);
      const auto                 &response = point.evaluate(f);
      const SymmetricTensor<2, 3> expected = 45. * (J * J - 1.) * I +
                                             30. * deviator(bb) -
                                             10. * deviator(invert(bb));
      EXPECT_LT((response.stress - expected).norm(), 1e-11);
      EXPECT_NEAR(response.energy,
                  22.5 * (J * J - 1. - 2. * std::log(J)) +
                    15. * (trace(bb) - 3.) + 5. * (trace(invert(bb)) - 3.),
                  1e-12);
    }
  // neo-Hookean from Poisson's ratio: initial Young's modulus 2 mu (1 + nu)
  const auto material =
    make("neo-Hookean",
         {{"Shear modulus", "40"}, {"Poisson's ratio", "0.3"}},
         3);
  Sample       point(*material, 3);
  const auto  &r      = point.evaluate(unit);
  const double lambda = r.tangent[0][0][1][1], mu = r.tangent[0][1][0][1];
  EXPECT_NEAR(mu, 40., 1e-12);
  EXPECT_NEAR(mu * (3. * lambda + 2. * mu) / (lambda + mu), 104., 1e-11);
}

TEST(RemodelledBone, RigidRotationUnstressed)
{
  std::vector<std::pair<std::string, Parameters>> laws = elastic_laws;
  laws.emplace_back("remodelled bone", matrix);
  for (const auto &[name, parameters] : laws)
    {
      const auto material = make(name, parameters, 3);
      Sample     point(*material, 3);
      if (name == "remodelled bone")
        point.set("log fabric", deviator(random_symmetric(3, 0.5)));
      const auto stiffness = point.evaluate(unit).tangent[0][0].norm();
      double     worst     = 0.;
      for (unsigned int n = 0; n < 36; ++n)
        {
          point.evaluate(rotation(Point<3>(1., 2., -0.5), numbers::PI / 18.));
          worst = std::max(worst, point.response.stress.norm() / stiffness);
          point.commit();
        }
      std::cout << name << ": stress after rotation " << worst << " of E\n";
      EXPECT_LT(worst, 1e-12);
    }
}
