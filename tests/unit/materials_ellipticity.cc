// SPDX-License-Identifier: LGPL-2.1-or-later
// Where the ligament's laws lose ellipticity: against differences of the energy
// and a shear at which it is known.
#include "ligament_point.h"

#include <gtest/gtest.h>

#include <limits>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /**
   * Least second derivative of the energy along (I + t m (x) n) F over unit
   * vectors m and n in the plane of v and w: the definition of strong
   * ellipticity, by brute force.
   */
  double
  least_rank_one_curvature(Sample             &point,
                           const Tensor<1, 3> &v,
                           const Tensor<1, 3> &w)
  {
    const unsigned int n      = 90;
    const double       step   = 1e-4;
    const double       middle = point.evaluate(unit, false).energy;
    double             least  = std::numeric_limits<double>::max();
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        {
          const double a = numbers::PI * i / n, b = numbers::PI * j / n;
          const auto   L     = outer_product(std::cos(a) * v + std::sin(a) * w,
                                       std::cos(b) * v + std::sin(b) * w);
          const double plus  = point.evaluate(unit + step * L, false).energy;
          const double minus = point.evaluate(unit - step * L, false).energy;
          least = std::min(least, (plus - 2. * middle + minus) / step / step);
        }
    return least;
  }

  double
  derived(const Material &material, Sample &point, const std::string &name)
  {
    const auto names = material.derived_names();
    for (unsigned int i = 0; i < names.size(); ++i)
      if (names[i].first == name)
        return material.derived_values(point.old.data())[i];
    ADD_FAILURE() << "no derived quantity " << name;
    return 0.;
  }
} // namespace

TEST(Ellipticity, AgainstRankOneDifferencesOfTheEnergy)
{
  struct Case
  {
    std::string name;
    Parameters  parameters;
    double      mu;
  };
  const std::vector<Case> cases = {
    {"Valanis-Landel", {{"Bulk modulus", "10"}}, 0.068 / 3.},
    {"Hencky with tabulated pressure", {}, 0.068 / 2.98}};
  for (const auto &[name, parameters, mu] : cases)
    {
      const auto material = make(name, with_table(parameters), 2);
      // stretch in the plane of plane strain at constant volume, turned
      for (const double h : {0., 0.05, 0.3, 0.6, 1.2})
        {
          Sample     point(*material, 2);
          const auto R = rotation(Point<3>(0., 0., 1.), 0.4);
          const auto U = stretch(std::exp(h), std::exp(-h), 1.);
          point.commit(R * U);
          const double found = derived(*material, point, "ellipticity") * mu;
          const double brute = least_rank_one_curvature(point,
                                                        Point<3>(1., 0., 0.),
                                                        Point<3>(0., 1., 0.));
          std::cout << name << " h " << h << ": least acoustic eigenvalue "
                    << found / mu << " mu0, by differences " << brute / mu
                    << '\n';
          if (h == 0.)
            {
              EXPECT_NEAR(found / mu, 1., 1e-9);
            }
          // the grid of directions (2 degrees) misses the minimum by little
          EXPECT_LT(found, brute + 1e-4 * (mu + std::abs(brute)));
          EXPECT_GT(found, brute - 0.02 * (mu + std::abs(brute)));
        }
      // In three dimensions the minimum over the principal planes includes it
      const auto solid = make(name, with_table(parameters), 3);
      Sample     point(*solid, 3), plane(*material, 2);
      point.commit(stretch(1.3, 1., 1. / 1.3));
      plane.commit(stretch(1.3, 1. / 1.3, 1.));
      EXPECT_LE(derived(*solid, point, "ellipticity"),
                derived(*material, plane, "ellipticity") + 1e-9);
    }
}



TEST(Ellipticity, HenckyEnergyLosesItAtAKnownShear)
{
  // At constant volume in the plane (stretches e^h, e^-h) the shear response
  // on a principal plane, B_b (tau_a - tau_b)/(B_a - B_b), stays positive; in
  // simple shear by gamma tau_12 = 2 mu a/cosh a, sinh a = gamma/2, has its
  // maximum where a tanh a = 1: beyond, the law is not elliptic.
  const double a = 1.19967864025773;
  EXPECT_NEAR(a * std::tanh(a), 1., 1e-13);
  const auto material =
    make("Hencky with tabulated pressure", with_table({}), 2);
  for (const double h : {0.999 * a, 1.001 * a})
    {
      Sample       point(*material, 2);
      Tensor<2, 3> f = unit;
      f[0][1]        = 2. * std::sinh(h);
      point.commit(f);
      // direction of the shear itself
      const double step = 1e-4;
      Tensor<2, 3> L;
      L[0][1]            = step;
      const double plus  = point.evaluate(unit + L, false).energy;
      const double minus = point.evaluate(unit - L, false).energy;
      const double curvature =
        plus + minus - 2. * point.evaluate(unit, false).energy;
      EXPECT_EQ(curvature > 0., h < a);
      if (h > a)
        {
          EXPECT_LT(derived(*material, point, "ellipticity"), 0.);
        }
    }
}
