// SPDX-License-Identifier: LGPL-2.1-or-later
// The ligament's readings of Table 2 as materials: each against the curve it
// promises (uniaxial, confined, simple shear), its tangent, its energy.
#include <alveolus/base/errors.h>
#include <alveolus/materials/hencky_tabulated.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
  const std::string table_file =
    ALVEOLUS_SOURCE_DIR "/prm/tables/ligament-table-2.csv";

  using Parameters = std::vector<std::pair<std::string, std::string>>;

  std::unique_ptr<Material>
  make(const std::string &name,
       const Parameters  &parameters,
       const unsigned int dim)
  {
    auto             material = Registry<Material>::create(name, "Type");
    ParameterHandler prm;
    material->declare_parameters(prm);
    for (const auto &[key, value] : parameters)
      prm.set(key, value);
    material->initialize(dim, "Materials/test");
    return material;
  }

  Parameters
  with_table(Parameters parameters)
  {
    parameters.emplace_back("Table file", table_file);
    return parameters;
  }

  /** The table as printed, jumps and all. */
  const TangentTable &
  printed()
  {
    static const TangentTable table(TangentTable::read(table_file, ""), "");
    return table;
  }

  /** A point with its history and everything evaluate() returns. */
  struct Sample
  {
    Sample(const Material &material, const unsigned int dim)
      : material(material)
      , layout(material.history_fields(), dim)
      , old(layout.size)
      , trial(layout.size)
    {
      material.initial_history(old.data());
    }

    void
    set(const std::string &field, const SymmetricTensor<2, 3> &t)
    {
      pack(t, &old[layout.offset(field)], layout.dim);
    }

    SymmetricTensor<2, 3>
    get(const std::string &field)
    {
      return unpack(&old[layout.offset(field)], layout.dim);
    }

    const MaterialResponse &
    evaluate(const Tensor<2, 3> &f, const bool need_tangent = true)
    {
      material.evaluate(f, old.data(), trial.data(), need_tangent, response);
      return response;
    }

    const MaterialResponse &
    commit(const Tensor<2, 3> &f)
    {
      evaluate(f);
      old = trial;
      return response;
    }

    const Material     &material;
    HistoryLayout       layout;
    std::vector<double> old, trial;
    MaterialResponse    response;
  };

  const Tensor<2, 3> unit(unit_symmetric_tensor<3>());

  Tensor<2, 3>
  stretch(const double x, const double y, const double z)
  {
    Tensor<2, 3> f;
    f[0][0] = x;
    f[1][1] = y;
    f[2][2] = z;
    return f;
  }

  Tensor<2, 3>
  rotation(const Tensor<1, 3> &axis, const double angle)
  {
    // Rodrigues
    Tensor<2, 3> W;
    const auto   n = axis / axis.norm();
    W[2][1]        = n[0];
    W[1][2]        = -n[0];
    W[0][2]        = n[1];
    W[2][0]        = -n[1];
    W[1][0]        = n[2];
    W[0][1]        = -n[2];
    return unit + std::sin(angle) * W + (1. - std::cos(angle)) * W * W;
  }

  class Random
  {
  public:
    double
    operator()(const double size)
    {
      return std::uniform_real_distribution<double>(-size, size)(generator);
    }

    /** Velocity gradient; in the plane for dim = 2. */
    Tensor<2, 3>
    velocity(const unsigned int dim, const double size)
    {
      Tensor<2, 3> l;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          l[i][j] = (*this)(size);
      return l;
    }

    SymmetricTensor<2, 3>
    symmetric(const unsigned int dim, const double size)
    {
      SymmetricTensor<2, 3> t;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          if (dim == 3 || i == j || (i < 2 && j < 2))
            t[i][j] = (*this)(size);
      return t;
    }

  private:
    std::mt19937 generator{11};
  };

  /**
   * Largest difference between tangent and central differences of the stress,
   * relative to the largest tangent entry. The modulus of a table has kinks:
   * the step is small, and states within it of a kink are to be avoided.
   */
  double
  tangent_error(Sample &point, const Tensor<2, 3> &f)
  {
    const MaterialResponse at    = point.evaluate(f);
    double                 error = 0., size = 0.;
    const double           step = 1e-6;
    for (unsigned int k = 0; k < point.layout.dim; ++k)
      for (unsigned int l = 0; l < point.layout.dim; ++l)
        {
          Tensor<2, 3> velocity;
          velocity[k][l]   = step;
          const auto plus  = point.evaluate(f + velocity * f, false).stress;
          const auto minus = point.evaluate(f - velocity * f, false).stress;
          error =
            std::max(error,
                     ((plus - minus) / (2. * step) - at.tangent[k][l]).norm());
          size = std::max(size, at.tangent[k][l].norm());
        }
    return error / size;
  }

  double
  energy_error(Sample &point, const Tensor<2, 3> &f)
  {
    const SymmetricTensor<2, 3> stress = point.evaluate(f).stress;
    double                      error  = 0.;
    const double                step   = 1e-5;
    for (unsigned int k = 0; k < point.layout.dim; ++k)
      for (unsigned int l = 0; l < point.layout.dim; ++l)
        {
          Tensor<2, 3> velocity;
          velocity[k][l]     = step;
          const double plus  = point.evaluate(f + velocity * f, false).energy;
          const double minus = point.evaluate(f - velocity * f, false).energy;
          error =
            std::max(error,
                     std::abs((plus - minus) / (2. * step) - stress[k][l]));
        }
    return error / stress.norm();
  }

  /**
   * Uniaxial test from the unloaded state to the axial stretch @p l in @p
   * n_steps equal steps: the lateral stretch follows from a free side.
   * @return engineering stress [MPa]
   */
  double
  uniaxial(const Material &material, const double l, const unsigned int n_steps)
  {
    Sample point(material, 3);
    double stress = 0.;
    for (unsigned int n = 1; n <= n_steps; ++n)
      {
        const double axial = std::pow(l, 1. / n_steps);
        double       y     = std::pow(axial, -0.49);
        for (unsigned int i = 0; i < 100; ++i)
          {
            const auto  &r        = point.evaluate(stretch(axial, y, y));
            const double residual = r.stress[1][1];
            const double slope  = r.tangent[1][1][1][1] + r.tangent[2][2][1][1];
            const double change = residual / slope;
            y *= std::exp(std::max(-0.05, std::min(0.05, -change)));
            if (std::abs(change) < 1e-15)
              break;
          }
        stress = point.commit(stretch(axial, y, y)).stress[0][0];
        // free to round-off of the bulk modulus
        EXPECT_LT(std::abs(point.response.stress[1][1]),
                  1e-14 * std::abs(point.response.tangent[1][1][1][1]));
      }
    return stress / l;
  }
} // namespace



TEST(TabulatedPressure, ModuliAtSmallStrain)
{
  // E0 = 0.068 MPa, nu = 0.49
  const auto material =
    make("Hencky with tabulated pressure", with_table({}), 3);
  Sample      point(*material, 3);
  const auto &r = point.evaluate(unit);
  EXPECT_NEAR(r.tangent[0][1][0][1], 0.068 / 2.98, 1e-15); // 0.0228
  EXPECT_NEAR((r.tangent[0][0][0][0] + 2. * r.tangent[0][0][1][1]) / 3.,
              0.068 / 0.06,
              1e-13);
  EXPECT_NEAR(uniaxial(*material, 1. + 1e-6, 1) / 1e-6, 0.068, 1e-6);
}



TEST(TabulatedPressure, Curves)
{
  const double mu = 0.068 / 2.98, K = 0.068 / 0.06;
  const auto   constant = make("Hencky with tabulated pressure",
                             with_table({{"Volumetric response", "constant"}}),
                             3);
  // strains outside the smoothing width about the jumps; jumps taken sharp
  const auto tabulated = make("Hencky with tabulated pressure",
                              with_table({{"Volumetric response", "tabulated"},
                                          {"Smoothing width", "0"}}),
                              3);
  for (const double e : {-0.5, -0.28, -0.1, 0.05, 0.2, 0.5, 0.8})
    {
      const double l = 1. + e;
      // Confined: mean stress from the volume, deviator 4/3 mu ln l
      {
        Sample point(*constant, 3);
        EXPECT_NEAR(point.evaluate(stretch(l, 1., 1.)).stress[0][0],
                    (K + 4. / 3. * mu) * std::log(l),
                    1e-14);
      }
      {
        Sample point(*tabulated, 3);
        EXPECT_NEAR(point.evaluate(stretch(l, 1., 1.)).stress[0][0],
                    K / 0.068 * l * printed().stress(e) +
                      4. / 3. * mu * std::log(l),
                    1e-12);
        // all-round: nothing but the table
        const double side = std::cbrt(l);
        const auto  &r    = point.evaluate(stretch(side, side, side));
        EXPECT_NEAR(trace(r.stress) / 3. / l,
                    printed().stress(e) / 0.06,
                    1e-12);
        EXPECT_NEAR(r.energy, printed().energy(e) / 0.06, 1e-12);
        EXPECT_LT(deviator(r.stress).norm(), 1e-12);
      }
    }
  // Simple shear by gamma = 2 sinh(a): principal Hencky strains a and -a
  for (const auto *material : {constant.get(), tabulated.get()})
    for (const unsigned int dim : {2, 3})
      for (const double gamma : {0.1, 1., 3.})
        {
          const auto same =
            make("Hencky with tabulated pressure", with_table({}), dim);
          Sample       point(dim == 2 ? *same : *material, dim);
          Tensor<2, 3> f = unit;
          f[0][1]        = gamma;
          const double a = std::asinh(gamma / 2.);
          // tau_12 = 2 mu a sin(2 phi), tan(2 phi) = 2/gamma
          EXPECT_NEAR(point.evaluate(f).stress[0][1],
                      2. * mu * a / std::sqrt(1. + gamma * gamma / 4.),
                      1e-14);
          EXPECT_NEAR(point.response.energy, 2. * mu * a * a, 1e-14);
        }
}



TEST(TabulatedPressure, TangentAndEnergy)
{
  Random random;
  double tangent = 0., energy = 0.;
  for (const std::string volumetric : {"constant", "tabulated"})
    for (const unsigned int dim : {2, 3})
      for (unsigned int n = 0; n < 40; ++n)
        {
          const auto material =
            make("Hencky with tabulated pressure",
                 with_table({{"Volumetric response", volumetric}}),
                 dim);
          Sample point(*material, dim);
          // tiny strains have nearly equal stretches; the tabulated modulus
          // has a kink there, which differences cannot see
          const double size =
            (n % 4 == 3 && volumetric == "constant") ? 1e-9 : 0.15;
          point.set("elastic strain", random.symmetric(dim, size));
          const auto f = unit + random.velocity(dim, size);
          tangent      = std::max(tangent, tangent_error(point, f));
          if (size > 0.1)
            energy = std::max(energy, energy_error(point, f));
        }
  std::cout << "tabulated pressure: tangent " << tangent
            << ", stress from energy " << energy << '\n';
  EXPECT_LT(tangent, 1e-7);
  EXPECT_LT(energy, 1e-7);
}



namespace
{
  /** g(l) by the series, summed to round-off on the table as printed. */
  double
  printed_g(const double l)
  {
    double sum = 0., y = std::log(l);
    for (unsigned int n = 0; n < 55; ++n, y *= -0.5)
      sum += std::exp(y) * printed().stress(std::expm1(y));
    return sum;
  }
} // namespace

// With s(l) = table: l s(l) = g(l) - g(l^-1/2), exactly what an incompressible
// uniaxial test gives. The errors at the strain of 63 % were computed apart
// (bisection for J with the series of 24 terms).
TEST(ValanisLandel, UniaxialIsTheTable)
{
  const auto law = [](const std::string &K) {
    return make("Valanis-Landel",
                with_table({{"Bulk modulus", K}, {"Smoothing width", "0"}}),
                3);
  };
  const auto error = [](const Material &material, const double e) {
    return uniaxial(material, 1. + e, 40) / printed().stress(e) - 1.;
  };
  const auto nearly_incompressible = law("1e6");
  for (const double e : {-0.9, -0.82, -0.5, -0.28, -0.1, 0.1, 0.3, 0.63})
    EXPECT_LT(std::abs(error(*nearly_incompressible, e)), 1e-5) << e;
  EXPECT_NEAR(error(*law("142"), 0.63), -0.0224, 5e-5);
  EXPECT_NEAR(error(*law("142"), 0.3), -0.0125, 5e-5);
  EXPECT_NEAR(error(*law("142"), -0.5), -0.0009, 5e-5);
  const std::string soft = std::to_string(0.068 / 0.06);
  EXPECT_NEAR(error(*law(soft), 0.63), -0.6905, 5e-5);
  EXPECT_NEAR(error(*law(soft), 0.2), -0.5483, 5e-5);
  // the shipped smoothing width costs little of it
  const auto shipped = make("Valanis-Landel", with_table({}), 3);
  EXPECT_NEAR(error(*shipped, 0.6), -0.0214, 3e-4);
  EXPECT_NEAR(uniaxial(*shipped, 1. + 1e-6, 1) / 1e-6, 0.068, 2e-5);
}



TEST(ValanisLandel, ConfinedAndSheared)
{
  const double K = 3.;
  for (const unsigned int dim : {2, 3})
    {
      const auto material =
        make("Valanis-Landel",
             with_table({{"Bulk modulus", "3"}, {"Smoothing width", "0"}}),
             dim);
      Sample point(*material, dim);
      // stretches l^{2/3} and l^{-1/3} = (l^{2/3})^{-1/2}: the table itself
      for (const double e : {-0.7, -0.3, -0.1, 0.1, 0.3, 0.8})
        {
          const double l = 1. + e, x = std::pow(l, 2. / 3.);
          EXPECT_NEAR(point.evaluate(stretch(l, 1., 1.)).stress[0][0],
                      2. / 3. * x * printed().stress(x - 1.) + K * std::log(l),
                      1e-10);
          EXPECT_NEAR(trace(point.response.stress),
                      3. * K * std::log(l),
                      1e-12);
        }
      for (const double gamma : {1e-4, 0.1, 0.3, 1.})
        {
          Tensor<2, 3> f = unit;
          f[0][1]        = gamma;
          const double a = std::asinh(gamma / 2.);
          EXPECT_NEAR(point.evaluate(f).stress[0][1],
                      0.5 * (printed_g(std::exp(a)) - printed_g(std::exp(-a))) /
                        std::sqrt(1. + gamma * gamma / 4.),
                      1e-11);
        }
      // initial shear modulus E0/3
      EXPECT_NEAR(point.evaluate(unit).tangent[0][1][0][1], 0.068 / 3., 1e-12);
    }
}



TEST(ValanisLandel, TangentAndEnergy)
{
  Random random;
  double tangent = 0., energy = 0.;
  for (const std::string K : {"0.1", "142"})
    for (const unsigned int dim : {2, 3})
      for (unsigned int n = 0; n < 40; ++n)
        {
          const auto material =
            make("Valanis-Landel", with_table({{"Bulk modulus", K}}), dim);
          Sample point(*material, dim);
          point.set("elastic strain", random.symmetric(dim, 0.15));
          const auto f = unit + random.velocity(dim, 0.15);
          tangent      = std::max(tangent, tangent_error(point, f));
          energy       = std::max(energy, energy_error(point, f));
        }
  std::cout << "Valanis-Landel: tangent " << tangent << ", stress from energy "
            << energy << '\n';
  EXPECT_LT(tangent, 1e-6);
  EXPECT_LT(energy, 1e-6);
  // equal and nearly equal stretches: the limit of the difference quotient
  const auto material =
    make("Valanis-Landel", with_table({{"Bulk modulus", "1"}}), 3);
  for (const double gap : {0., 1e-9, 1e-7, 1e-5})
    {
      Sample                point(*material, 3);
      SymmetricTensor<2, 3> h;
      h[0][0] = 0.1;
      h[1][1] = 0.1 + gap;
      h[2][2] = -0.25;
      point.set("elastic strain", h);
      EXPECT_LT(tangent_error(point, unit), 1e-6) << gap;
    }
}



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



TEST(Readings, JumpsAreSmoothedOverTheirWidth)
{
  const auto         points = TangentTable::read(table_file, "");
  const TangentTable smooth(TangentTable::without_jumps(points, 0.02, ""), "");
  // half-way between the lines met at -+ half the width
  const double slope = (1.35 - 0.068) / 0.14;
  EXPECT_NEAR(smooth.modulus(0.14), (1.35 - 0.01 * slope + 8.5) / 2., 1e-13);
  EXPECT_NEAR(smooth.modulus(0.63), (8.5 + 0.01) / 2., 1e-13);
  EXPECT_NEAR(smooth.modulus(-0.82), (8.5 + 13.5) / 2., 1e-13);
  for (const double e : {-0.9, -0.5, -0.28, -0.1, 0., 0.1, 0.2, 0.6, 0.7})
    {
      EXPECT_NEAR(smooth.modulus(e), printed().modulus(e), 1e-13);
      // what the line cuts off: slope width^2/8 before the jump at 0.14
      EXPECT_NEAR(smooth.stress(e),
                  printed().stress(e) - (e > 0.14 ? slope * 4e-4 / 8. : 0.),
                  1e-13);
    }
  // continuous everywhere
  for (double e = -1.; e < 1.; e += 1e-4)
    EXPECT_LT(std::abs(smooth.modulus(e + 1e-4) - smooth.modulus(e)), 0.05);
}



TEST(Readings, RigidTurns)
{
  for (const std::string law :
       {"Hencky with tabulated pressure", "Valanis-Landel", "hypoelastic"})
    {
      const auto material = make(law, with_table({}), 3);
      const auto turn     = rotation(Point<3>(1., 2., -0.5), numbers::PI / 18.);
      Sample     free(*material, 3), loaded(*material, 3);
      loaded.commit(stretch(1.2, 0.9, 0.95));
      const auto   stress    = loaded.response.stress;
      const double stiffness = loaded.response.tangent[0][0].norm();
      for (unsigned int n = 0; n < 36; ++n)
        {
          free.commit(turn);
          EXPECT_LT(free.response.stress.norm(), 1e-13 * stiffness);
          const auto before = loaded.response.stress;
          loaded.commit(turn);
          const Tensor<2, 3> expected =
            turn * Tensor<2, 3>(before) * transpose(turn);
          EXPECT_LT((Tensor<2, 3>(loaded.response.stress) - expected).norm(),
                    1e-13 * stiffness);
        }
      EXPECT_LT((loaded.response.stress - stress).norm(), 1e-12 * stiffness);
    }
}



TEST(Readings, BadInput)
{
  for (const std::string law :
       {"Hencky with tabulated pressure", "Valanis-Landel", "hypoelastic"})
    {
      EXPECT_THROW(make(law, {}, 2), InputError) << law;
      EXPECT_THROW(make(law, {{"Table file", "/no/such/file.csv"}}, 2),
                   InputError);
      for (const std::string list : {"0: 1, -1: 2",  // strain decreases
                                     "0: 1, 1: -2",  // negative modulus
                                     "-1: 1, 0: 0"}) // nothing at zero
        EXPECT_THROW(make(law, {{"Tangent modulus", list}}, 2), InputError)
          << law << ' ' << list;
      EXPECT_THROW(make(law, with_table({{"Smoothing width", "0.6"}}), 2),
                   InputError);
    }
  EXPECT_THROW(make("Hencky with tabulated pressure",
                    with_table({{"Poisson's ratio", "0.5"}}),
                    2),
               InputError);
  EXPECT_THROW(make("Valanis-Landel", with_table({{"Bulk modulus", "0"}}), 2),
               InputError);
}
