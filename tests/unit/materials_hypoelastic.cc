// SPDX-License-Identifier: LGPL-2.1-or-later
// The ligament's modulus of Table 2 as a hypoelastic law: the curves that each
// measure of strain dictates, Hencky's law at a constant modulus, the tangent.
#include "ligament_point.h"

#include <gtest/gtest.h>

#include <algorithm>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  const std::vector<std::string> measures = {"equivalent",
                                             "largest principal",
                                             "volumetric"};

  std::unique_ptr<Material>
  hypoelastic(Parameters parameters, const unsigned int dim = 3)
  {
    parameters.emplace_back("Smoothing width", "0");
    return make("hypoelastic", with_table(std::move(parameters)), dim);
  }

  /** int E(e)/(1+e) de of the table by Simpson's rule between its points. */
  double
  logarithmic_stress(const double e)
  {
    double              sum  = 0.;
    std::vector<double> ends = {0., e};
    for (const double kink : {-0.82, -0.31, -0.25, 0.14, 0.63})
      if (kink * e > 0. && std::abs(kink) < std::abs(e))
        ends.push_back(kink);
    std::sort(ends.begin(), ends.end());
    for (unsigned int i = 0; i + 1 < ends.size(); ++i)
      {
        const unsigned int n = 200;
        const double       d = (ends[i + 1] - ends[i]) / n;
        const auto         E = [&](const double x) {
          // a jump belongs to neither side: a hair inside
          const double inside =
            ends[i] + std::max(1e-13, x) - (x > n * d - 1e-12 ? 1e-13 : 0.);
          return printed().modulus(inside) / (1. + inside);
        };
        for (unsigned int k = 0; k < n; ++k)
          sum += d / 6. * (E(k * d) + 4. * E((k + 0.5) * d) + E((k + 1) * d));
      }
    return e < 0. ? -sum : sum;
  }
} // namespace

TEST(Hypoelastic, LogarithmicStressIntegratesTheTable)
{
  for (const double e : {-0.9, -0.5, -0.28, -0.1, 0.1, 0.14, 0.3, 0.63, 1.5})
    EXPECT_NEAR(printed().logarithmic_stress(e), logarithmic_stress(e), 1e-9)
      << e;
}



TEST(Hypoelastic, Uniaxial)
{
  for (const double e : {-0.7, -0.3, -0.1, 0.1, 0.3, 0.63})
    for (const unsigned int n : {1, 7})
      for (const std::string measure : {"equivalent", "largest principal"})
        {
          // mean of step: any number of steps gives the curve
          const auto plain = hypoelastic({{"Strain measure", measure}});
          EXPECT_NEAR(uniaxial(*plain, 1. + e, n) * (1. + e),
                      logarithmic_stress(e),
                      1e-8)
            << measure << ' ' << e;
          const auto converted = hypoelastic(
            {{"Strain measure", measure}, {"Conversion", "uniaxial"}});
          EXPECT_NEAR(uniaxial(*converted, 1. + e, n),
                      printed().stress(e),
                      1e-8)
            << measure << ' ' << e;
        }
  // the volume strain of a uniaxial test is (1 - 2 nu) h: 50 times smaller
  const auto   volumetric = hypoelastic({{"Strain measure", "volumetric"}});
  const double h          = std::log(1.3);
  EXPECT_NEAR(uniaxial(*volumetric, 1.3, 3) * 1.3,
              50. * logarithmic_stress(std::expm1(0.02 * h)),
              1e-9);
  // modulus at the beginning of the step: first order
  const auto lagging = hypoelastic({{"Modulus at", "beginning of step"}});
  std::vector<double> errors;
  for (const unsigned int n : {40, 80, 160})
    errors.push_back(uniaxial(*lagging, 1.12, n) * 1.12 -
                     logarithmic_stress(0.12));
  std::cout << "hypoelastic, explicit: " << errors[0] << ' ' << errors[1] << ' '
            << errors[2] << '\n';
  EXPECT_NEAR(errors[0] / errors[1], 2., 0.05);
  EXPECT_NEAR(errors[1] / errors[2], 2., 0.05);
}



TEST(Hypoelastic, ConfinedAndSheared)
{
  const double nu = 0.49, confined = (1. - nu) / ((1. + nu) * (1. - 2. * nu));
  for (const unsigned int dim : {2, 3})
    for (const double e : {-0.5, -0.1, 0.1, 0.5})
      {
        const double l = 1. + e, h = std::log(l);
        for (const std::string measure : {"largest principal", "volumetric"})
          {
            const auto material =
              hypoelastic({{"Strain measure", measure}}, dim);
            Sample       point(*material, dim);
            const double r = std::pow(l, 1. / 3.);
            for (unsigned int n = 0; n < 3; ++n)
              point.commit(stretch(r, 1., 1.));
            EXPECT_NEAR(point.response.stress[0][0],
                        confined * logarithmic_stress(e),
                        2e-7);
          }
        // sqrt(3/2) |dev h| = h
        const auto equivalent =
          hypoelastic({{"Strain measure", "equivalent"}}, dim);
        Sample point(*equivalent, dim);
        EXPECT_NEAR(point.evaluate(stretch(l, 1., 1.)).stress[0][0],
                    confined * (1. + nu) *
                      logarithmic_stress(std::expm1(h / (1. + nu))),
                    2e-7);
      }
  for (const double gamma : {0.1, 0.6})
    {
      Tensor<2, 3> f = unit;
      f[0][1]        = gamma;
      const double a = std::asinh(gamma / 2.), cosh = std::cosh(a);
      const double mu = 0.5 / (1. + nu);
      // the volume stays: the modulus does
      const auto volumetric =
        hypoelastic({{"Strain measure", "volumetric"}}, 2);
      Sample soft(*volumetric, 2);
      EXPECT_NEAR(soft.evaluate(f).stress[0][1],
                  2. * mu * 0.068 * a / cosh,
                  1e-12);
      // principal strains a and -a, half of either branch
      const auto principal =
        hypoelastic({{"Strain measure", "largest principal"}}, 2);
      Sample sheared(*principal, 2);
      EXPECT_NEAR(sheared.evaluate(f).stress[0][1],
                  2. * mu * a / cosh *
                    (logarithmic_stress(std::expm1(a)) -
                     logarithmic_stress(std::expm1(-a))) /
                    (2. * a),
                  1e-8);
      // equivalent sqrt(3) a/(1 + nu), half of either branch
      const auto   equivalent = hypoelastic({}, 2);
      const double m          = std::sqrt(3.) * a / (1. + nu);
      Sample       stiff(*equivalent, 2);
      EXPECT_NEAR(stiff.evaluate(f).stress[0][1],
                  2. * mu * a / cosh *
                    (logarithmic_stress(std::expm1(m)) -
                     logarithmic_stress(std::expm1(-m))) /
                    (2. * m),
                  1e-8);
    }
}



// A constant modulus makes it Hencky's law along any path, so that no closed
// path leaves stress or work behind.
TEST(Hypoelastic, ConstantModulusIsHenckyElastic)
{
  Random random;
  for (const unsigned int dim : {2, 3})
    {
      const auto law =
        make("hypoelastic",
             {{"Tangent modulus", "0: 2"}, {"Poisson's ratio", "0.3"}},
             dim);
      const auto hencky =
        make("Hencky elastic",
             {{"Young's modulus", "2"}, {"Poisson's ratio", "0.3"}},
             dim);
      Sample       point(*law, dim), reference(*hencky, dim);
      Tensor<2, 3> total = unit;
      for (unsigned int n = 0; n < 30; ++n)
        {
          const auto f = unit + random.velocity(dim, 0.2);
          total        = f * total;
          point.commit(f);
          reference.commit(f);
          EXPECT_LT((point.response.stress - reference.response.stress).norm(),
                    1e-12);
          double worst = 0.;
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int l = 0; l < dim; ++l)
              worst = std::max(worst,
                               (point.response.tangent[k][l] -
                                reference.response.tangent[k][l])
                                 .norm());
          EXPECT_LT(worst, 1e-11);
          EXPECT_NEAR(point.material.volume_ratio(point.old.data()),
                      determinant(total),
                      1e-11 * determinant(total));
        }
      point.commit(invert(total));
      EXPECT_LT(point.response.stress.norm(), 1e-10);
      EXPECT_NEAR(point.response.energy, 0., 1e-10);
    }
}



TEST(Hypoelastic, Tangent)
{
  Random random;
  for (const auto &measure : measures)
    for (const std::string conversion : {"none", "uniaxial"})
      for (const std::string at : {"mean of step", "beginning of step"})
        {
          double worst = 0.;
          for (const unsigned int dim : {2, 3})
            for (unsigned int n = 0; n < 20; ++n)
              {
                const auto material =
                  make("hypoelastic",
                       with_table({{"Strain measure", measure},
                                   {"Conversion", conversion},
                                   {"Modulus at", at}}),
                       dim);
                Sample point(*material, dim);
                point.set("elastic strain", random.symmetric(dim, 0.2));
                point.set("stress", random.symmetric(dim, 0.2));
                worst =
                  std::max(worst,
                           tangent_error(point,
                                         rotation(Point<3>(0., 0., 1.),
                                                  random(0.3)) *
                                           (unit + random.velocity(dim, 0.1))));
              }
          std::cout << "hypoelastic, " << measure << ", " << conversion << ", "
                    << at << ": tangent " << worst << '\n';
          EXPECT_LT(worst, 1e-7);
        }
}
