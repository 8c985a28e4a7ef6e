// SPDX-License-Identifier: LGPL-2.1-or-later
// The ligament's table and interface law against independent integration.
#include <alveolus/base/errors.h>
#include <alveolus/materials/ligament_interface.h>

#include <deal.II/base/symmetric_tensor.h>

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
  const std::string table_file =
    ALVEOLUS_SOURCE_DIR "/prm/tables/ligament-table-2.csv";
  const std::string table_list =
    "-0.82: 13.5, -0.82: 8.5, -0.31: 8.5, -0.25: 0.68, 0: 0.068, 0.14: 1.35, "
    "0.14: 8.5, 0.63: 8.5, 0.63: 0.01";

  using Parameters = std::vector<std::pair<std::string, std::string>>;

  std::unique_ptr<InterfaceLaw>
  make(const Parameters &parameters)
  {
    auto             law = Registry<InterfaceLaw>::create("ligament", "Type");
    ParameterHandler prm;
    law->declare_parameters(prm);
    for (const auto &[key, value] : parameters)
      prm.set(key, value);
    law->initialize("Conditions/root");
    return law;
  }

  /** Table 2 of the paper, as its sentences say. */
  double
  printed_modulus(const double e)
  {
    if (e < -0.82)
      return 13.5;
    if (e < -0.31)
      return 8.5;
    if (e < -0.25)
      return 0.68 + (8.5 - 0.68) * (-0.25 - e) / 0.06;
    if (e < 0.)
      return 0.068 + (0.68 - 0.068) * (-e) / 0.25;
    if (e < 0.14)
      return 0.068 + (1.35 - 0.068) * e / 0.14;
    if (e < 0.63)
      return 8.5;
    return 0.01;
  }

  /** Stress and energy by the midpoint rule. */
  std::pair<double, double>
  integrate(const double e, const bool continued)
  {
    const unsigned int n      = 200000;
    const double       h      = e / n;
    double             stress = 0., energy = 0.;
    for (unsigned int i = 0; i < n; ++i)
      {
        const double x = (i + 0.5) * h;
        const double E = (continued && x > 0.63) ? 8.5 : printed_modulus(x);
        energy += h * (stress + 0.5 * h * E);
        stress += h * E;
      }
    return {stress, energy};
  }

  const Tensor<1, 3> normal = Tensor<1, 3>({2. / 3., -1. / 3., 2. / 3.});
  const Tensor<1, 3> slide =
    Tensor<1, 3>({1. / std::sqrt(2.), 0., -1. / std::sqrt(2.)});
} // namespace



TEST(Ligament, NormalTractionIsTheIntegratedTable)
{
  for (const bool continued : {false, true})
    {
      const auto law =
        make({{"Table file", table_file},
              {"Tension branch", continued ? "continued" : "as printed"}});
      double worst = 0.;
      for (const double e : {-1.1,
                             -0.9,
                             -0.82,
                             -0.5,
                             -0.3,
                             -0.25,
                             -0.1,
                             0.1,
                             0.3,
                             0.63,
                             0.8,
                             2.})
        {
          Tensor<1, 3> t;
          Tensor<2, 3> K;
          double       energy;
          const auto   jump = 0.2 * e * normal;
          EXPECT_NEAR(law->normal_strain(jump, normal), e, 1e-14);
          EXPECT_NEAR(law->shear_strain(jump, normal), 0., 1e-14);
          law->evaluate(jump, normal, t, K, energy);
          const auto [stress, W] = integrate(e, continued);
          worst                  = std::max(
            {worst, std::abs(t * normal - stress), std::abs(energy - 0.2 * W)});
          EXPECT_LT((t - stress * normal).norm(), 1e-4);
        }
      EXPECT_LT(worst, 1e-4); // what the midpoint rule leaves at the jumps
    }
  // by hand: 0.5 (0.068 + 1.35) 0.14 + 8.5 0.49 MPa at 63 % tension
  const TangentTable table(TangentTable::read(table_file, ""), "");
  EXPECT_NEAR(table.stress(0.63), 0.09926 + 4.165, 1e-14);
  EXPECT_NEAR(table.stress(-0.25), -0.5 * (0.068 + 0.68) * 0.25, 1e-14);
  EXPECT_EQ(table.modulus(0.), 0.068);
  EXPECT_EQ(table.modulus(0.7), 0.01);
  EXPECT_EQ(table.modulus(-0.9), 13.5);
}

TEST(Ligament, TangentialTraction)
{
  for (const std::string kind : {"table", "initial"})
    {
      const auto law =
        make({{"Tangent modulus", table_list}, {"Tangential stiffness", kind}});
      for (const double shear : {1e-9, 0.05, 0.3, 1.5})
        {
          Tensor<1, 3> t;
          Tensor<2, 3> K;
          double       energy;
          law->evaluate(0.2 * shear * slide, normal, t, K, energy);
          const auto [stress, W] =
            kind == "table"
              ? integrate(shear, true)
              : std::pair<double, double>{0.068 * shear, 0.034 * shear * shear};
          EXPECT_NEAR(t * slide, stress / 2.98, 1e-5);
          EXPECT_NEAR(t * normal, 0., 1e-15);
          EXPECT_NEAR(energy, 0.2 * W / 2.98, 1e-5);
          EXPECT_NEAR(slide * K * slide,
                      (kind == "table" ? printed_modulus(std::min(shear, 0.6))
                                       : 0.068) /
                        2.98 / 0.2,
                      1e-9);
        }
    }
}

TEST(Ligament, DerivesFromItsEnergy)
{
  std::mt19937                           generator(5);
  std::uniform_real_distribution<double> random(-0.3, 0.3);
  double                                 first = 0., second = 0.;
  const auto law = make({{"Tangent modulus", table_list}});
  for (unsigned int n = 0; n < 200; ++n)
    {
      const Tensor<1, 3> jump(
        {random(generator), random(generator), random(generator)});
      Tensor<1, 3> t, plus, minus;
      Tensor<2, 3> K, unused;
      double       energy, e_plus, e_minus;
      law->evaluate(jump, normal, t, K, energy);
      EXPECT_LT((K - transpose(K)).norm(), 1e-13);
      for (unsigned int i = 0; i < 3; ++i)
        {
          Tensor<1, 3> d;
          d[i] = 1e-6;
          law->evaluate(jump + d, normal, plus, unused, e_plus);
          law->evaluate(jump - d, normal, minus, unused, e_minus);
          first = std::max(first, std::abs((e_plus - e_minus) / 2e-6 - t[i]));
          // steps that cross a jump of the modulus are no derivative
          const auto strain = [&](const Tensor<1, 3> &j) {
            return std::pair<bool, bool>(law->normal_strain(j, normal) > 0.14,
                                         law->normal_strain(j, normal) < -0.82);
          };
          if (strain(jump + d) == strain(jump - d))
            for (unsigned int j = 0; j < 3; ++j)
              second =
                std::max(second,
                         std::abs((plus[j] - minus[j]) / 2e-6 - K[j][i]));
        }
    }
  std::cout << "traction from energy " << first << ", tangent from traction "
            << second << '\n';
  EXPECT_LT(first, 1e-7);
  EXPECT_LT(second, 1e-5);
  // no slip: tangent of the limit, not a division by zero
  Tensor<1, 3> t;
  Tensor<2, 3> K;
  double       energy;
  law->evaluate(Tensor<1, 3>(), normal, t, K, energy);
  EXPECT_EQ(t.norm(), 0.);
  EXPECT_NEAR(normal * K * normal, 0.068 / 0.2, 1e-15);
  EXPECT_NEAR(slide * K * slide, 0.068 / 2.98 / 0.2, 1e-15);
}

TEST(Ligament, BadTables)
{
  EXPECT_THROW(make({}), InputError);
  EXPECT_THROW(make({{"Table file", "/no/such/file.csv"}}), InputError);
  EXPECT_THROW(make(
                 {{"Table file", table_file}, {"Tangent modulus", table_list}}),
               InputError);
  for (const std::string list : {"0: 1, -1: 2",
                                 "0 1, 1: 2",
                                 "0: 1, 1: -2",
                                 "0: 1, 1: 2 x",
                                 "0: 1, 1: 2, 1: 3, 1: 4"})
    EXPECT_THROW(make({{"Tangent modulus", list}}), InputError) << list;
  EXPECT_THROW(make({{"Tangent modulus", "0: 1"}, {"Thickness", "0"}}),
               InputError);
  const std::string file = "ligament-bad-table.csv";
  std::ofstream(file) << "# comment\n0, 1\n0.5; 2\n";
  try
    {
      make({{"Table file", file}});
      FAIL();
    }
  catch (const InputError &error)
    {
      EXPECT_NE(std::string(error.what()).find(file + ":3"), std::string::npos)
        << error.what();
    }
  std::remove(file.c_str());
  // a table that starts away from zero is continued to it
  const TangentTable table(TangentTable::parse("-1: 4, 1: 2", ""), "");
  EXPECT_EQ(table.modulus(0.), 3.);
  EXPECT_NEAR(table.stress(-1.), -3.5, 1e-15);
}
