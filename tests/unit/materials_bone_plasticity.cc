// SPDX-License-Identifier: LGPL-2.1-or-later
// Plastic flow of bone at a point: closed forms of a bar, hardening, the return
// to the yield surface, energy of states beyond it.
#include "bone_point.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



TEST(RemodelledBone, UniaxialElastoplasticBar)
{
  // ln(length ratio) = tau/E + (tau - sigma_Y)/h_p beyond yield, lateral strain
  // -nu tau/E - alpha/2; also with the stiffness of rho = 1.2 (scaled yield).
  for (const std::string density : {"1.3", "1.2"})
    {
      const auto material = make(
        "remodelled bone", {{"Initial density", density}}, 3, false, false);
      Sample point(*material, 3);
      EXPECT_EQ(point.layout.size, 7u); // neither density nor fabric
      const double ratio =
        as_bone(material).stiffness_ratio(std::stod(density));
      const double E = 13750. * ratio, sigma_Y = 200. * ratio,
                   h_p = 723.7 * ratio;
      double worst = 0., length = 0., lateral_total = 0.;
      for (unsigned int step = 0; step < 20; ++step)
        {
          length += 0.01;
          Tensor<2, 3> f = unit;
          f[0][0]        = std::exp(0.01);
          double lateral = -0.004;
          for (unsigned int i = 0; i < 20; ++i)
            {
              f[1][1] = f[2][2] = std::exp(lateral);
              const auto &r     = point.evaluate(f);
              lateral -= r.stress[1][1] /
                         (r.tangent[1][1][1][1] + r.tangent[2][2][1][1]);
            }
          lateral_total += lateral;
          point.commit();
          const double elastic_limit = sigma_Y / E;
          const double exact =
            length < elastic_limit
              ? E * length
              : (length + sigma_Y / h_p) / (1. / E + 1. / h_p);
          const double alpha = length - exact / E;
          worst =
            std::max(worst, std::abs(point.response.stress[0][0] / exact - 1.));
          EXPECT_NEAR(lateral_total, -0.3 * exact / E - 0.5 * alpha, 1e-12);
          EXPECT_NEAR(point.value("plastic strain"),
                      length < elastic_limit ? 0. : alpha,
                      1e-12);
        }
      std::cout << "bar, density " << density << ": " << worst << '\n';
      EXPECT_LT(worst, 1e-11);
    }
}

// Saturating hardening: tangents against differences on all paths, the return
// on the yield surface, and a flat law (no hardening at all).
TEST(RemodelledBone, VoceHardening)
{
  for (const std::string rate : {"16.93", "0"})
    for (const std::string law : {"isochoric", "effective"})
      for (const bool fabric : {false, true})
        {
          double       error = 0., yield = 0.;
          unsigned int n_plastic = 0;
          for (const unsigned int dim : {2, 3})
            for (unsigned int n = 0; n < 40; ++n)
              {
                const auto material = make("remodelled bone",
                                           {{"Undamaged density", "1.9"},
                                            {"Hardening", "Voce"},
                                            {"Saturation", "265"},
                                            {"Saturation rate", rate},
                                            {"Yield law", law},
                                            {"Yield exponent", "0"}},
                                           dim);
                Sample     point(*material, dim);
                randomize(point, 0.02, fabric);
                point.value("plastic strain") = 0.05;
                const auto f     = unit + random_velocity(dim, 0.15);
                error            = std::max(error, tangent_error(point, f));
                const auto   tau = point.evaluate(f).stress;
                const double old_alpha = 0.05;
                point.commit();
                const double alpha = point.value("plastic strain");
                if (alpha == old_alpha)
                  continue;
                ++n_plastic;
                const BonePoint state =
                  as_bone(material).point(point.old.data());
                const double surface =
                  200. + 265. * (1. - std::exp(-std::stod(rate) * alpha));
                const double q =
                  law == "isochoric"
                    ? von_mises(tau) /
                        as_bone(material).stiffness_ratio(state.density)
                    : von_mises(as_bone(material).effective_stress(
                        as_bone(material).remodelling_tensor(state),
                        state.elastic_strain));
                yield = std::max(yield, std::abs(q / surface - 1.));
              }
          EXPECT_GT(n_plastic, 40u);
          EXPECT_LT(error, 1e-7);
          EXPECT_LT(yield, 1e-10);
        }
}

TEST(RemodelledBone, ReturnIsOnTheYieldSurface)
{
  for (const std::string law : {"isochoric", "effective"})
    {
      double yield = 0., volume = 0., plastic_volume = 0.;
      for (unsigned int n = 0; n < 200; ++n)
        {
          const auto material = make("remodelled bone",
                                     {{"Undamaged density", "1.9"},
                                      {"Yield law", law},
                                      {"Yield exponent", "0"}},
                                     3);
          Sample     point(*material, 3);
          randomize(point, 0.05, true);
          const double h_n = trace(point.get("elastic strain"));
          const auto   f   = unit + random_velocity(3, 0.2);
          const auto   tau = point.evaluate(f).stress;
          point.commit();
          const double alpha = point.value("plastic strain");
          ASSERT_GT(alpha, 0.);
          const BonePoint state = as_bone(material).point(point.old.data());
          if (law == "isochoric")
            {
              const double ratio =
                as_bone(material).stiffness_ratio(state.density);
              yield  = std::max(yield,
                               std::abs(von_mises(tau) /
                                          (ratio * (200. + 723.7 * alpha)) -
                                        1.));
              volume = std::max(volume,
                                std::abs(trace(state.elastic_strain) - h_n -
                                         std::log(determinant(f))));
            }
          else
            {
              const auto H = as_bone(material).remodelling_tensor(state);
              yield =
                std::max(yield,
                         std::abs(von_mises(as_bone(material).effective_stress(
                                    H, state.elastic_strain)) /
                                    (200. + 723.7 * alpha) -
                                  1.));
              const double log_Jp = point.value("log plastic volume");
              plastic_volume      = std::max(plastic_volume, std::abs(log_Jp));
              volume              = std::max(volume,
                                std::abs(trace(state.elastic_strain) + log_Jp -
                                         h_n - std::log(determinant(f))));
            }
        }
      std::cout << law << ": off the yield surface " << yield
                << ", volume balance " << volume << ", largest ln J_p "
                << plastic_volume << '\n';
      EXPECT_LT(yield, 1e-10);
      EXPECT_LT(volume, 1e-13);
      if (law == "effective")
        {
          EXPECT_GT(plastic_volume, 1e-3);
        }
    }
}

// A record beyond the yield surface, as a transfer leaves it: its energy is
// that of its elastic strain, which flow takes down by more than the yield
// stress takes up (the stress falls to it on the way).
TEST(RemodelledBone, EnergyOfARecordBeyondTheYieldSurface)
{
  for (const std::string law : {"isochoric", "effective"})
    for (const bool fabric : {false, true})
      for (unsigned int n = 0; n < 20; ++n)
        {
          const auto material = make("remodelled bone",
                                     {{"Undamaged density", "1.9"},
                                      {"Yield law", law},
                                      {"Yield exponent", "0"}},
                                     3,
                                     true,
                                     fabric);
          Sample     point(*material, 3);
          randomize(point, 0.1, fabric);
          const double energy =
            as_bone(material).energy(as_bone(material).point(point.old.data()));
          point.response.no_flow     = true;
          point.response.dissipation = 0.;
          EXPECT_NEAR(point.evaluate(unit).energy, energy, 1e-12 * energy);
          EXPECT_EQ(point.response.dissipation, 0.);

          point.response.no_flow = false;
          const double left      = point.evaluate(unit).energy;
          const double work      = point.response.dissipation;
          ASSERT_GT(work, 0.);
          EXPECT_GT(energy - left, work);
        }
}
