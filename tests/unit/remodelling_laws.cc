// SPDX-License-Identifier: LGPL-2.1-or-later
// Remodelling at a point: rates against the formulae, time integration against
// quadrature and fixed small steps, bounds.
#include <alveolus/remodelling/local_integrator.h>

#include <gtest/gtest.h>

#include <chrono>
#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Parameters = std::vector<std::pair<std::string, std::string>>;

  std::unique_ptr<RemodelledBone>
  make_bone(const Parameters  &parameters,
            const unsigned int dim    = 3,
            const bool         fabric = true)
  {
    auto             bone = std::make_unique<RemodelledBone>();
    ParameterHandler prm;
    bone->declare_parameters(prm);
    for (const auto &[key, value] : parameters)
      prm.set(key, value);
    bone->set_remodelled(true, fabric);
    bone->initialize(dim, "Materials/bone");
    return bone;
  }

  std::unique_ptr<RemodellingLaw>
  make_law(const std::string &name, const Parameters &parameters)
  {
    auto             law = Registry<RemodellingLaw>::create(name, "Type");
    ParameterHandler prm;
    law->declare_parameters(prm);
    for (const auto &[key, value] : parameters)
      prm.set(key, value);
    law->initialize("Remodelling");
    return law;
  }

  std::vector<double>
  make_record(const RemodelledBone &bone,
              const BonePoint      &point,
              const unsigned int    dim = 3)
  {
    std::vector<double> record(HistoryLayout(bone.history_fields(), dim).size);
    bone.initial_history(record.data());
    bone.store(point, record.data());
    return record;
  }

  std::mt19937 generator(3);

  double
  random_number()
  {
    return std::uniform_real_distribution<double>(-1., 1.)(generator);
  }

  SymmetricTensor<2, 3>
  random_symmetric(const double size)
  {
    SymmetricTensor<2, 3> t;
    for (unsigned int i = 0; i < 6; ++i)
      t.access_raw_entry(i) = size * random_number();
    return t;
  }

  // The density law written once more, from theory.md.
  double
  L(const double rho)
  {
    return std::max(2014. * std::pow(rho, 2.5), 1763. * std::pow(rho, 3.2));
  }

  double
  S_v(const double n)
  {
    return 32.3 * n - 93.9 * n * n + 134. * std::pow(n, 3) -
           101. * std::pow(n, 4) + 28.8 * std::pow(n, 5);
  }

  /** Uniaxial strain e: trace and energy of undamaged bone are known. */
  BonePoint
  uniaxial(const double strain, const double density)
  {
    BonePoint p;
    p.elastic_strain[0][0] = strain;
    p.density              = density;
    return p;
  }

  /** Integral of 1/rate from a to b, by Simpson's rule. */
  double
  travel_time(const std::function<double(double)> &rate,
              const double                         a,
              const double                         b)
  {
    const unsigned int n   = 2000;
    const double       h   = (b - a) / n;
    double             sum = 1. / rate(a) + 1. / rate(b);
    for (unsigned int i = 1; i < n; ++i)
      sum += (i % 2 ? 4. : 2.) / rate(a + i * h);
    return sum * h / 3.;
  }
} // namespace



TEST(Mechanostat, DensityAgainstQuadratureOnBothBranches)
{
  // rho_u = 1.9 so that the bone can form; signed stimulus, lazy zone 0.1 MPa
  const double modulus =
    13750. * (1. - 0.3) / ((1. + 0.3) * (1. - 2. * 0.3)); // confined
  const auto bone = make_bone({{"Undamaged density", "1.9"}}, 3, false);
  const auto law  = make_law("mechanostat", {{"Degree of anisotropy", "0"}});
  EXPECT_FALSE(law->changes_fabric());
  const LocalIntegrator integrator(*law, *bone, 1e-9);

  struct Case
  {
    double strain, density, time;
  };
  double worst = 0.;
  for (const Case c : {Case{0.02, 0.6, 10.},    // formation, low density
                       Case{0.015, 1.25, 5.},   // formation, high density
                       Case{-0.02, 1.15, 2.},   // resorption, low density
                       Case{-0.015, 1.7, 5.},   // resorption, high density
                       Case{-0.015, 1.3, 20.}}) // across the crossing
    {
      const double psi  = 0.5 * modulus * c.strain * c.strain;
      const auto   rate = [&](const double rho) {
        const double U = (c.strain > 0. ? 1. : -1.) * psi * L(rho) / L(1.9);
        const double surface = U > 0.1    ? 5e-3 * (U - 0.1)
                                 : U < -0.1 ? -1e-2 * (-0.1 - U)
                                            : 0.;
        return S_v(1. - rho / 1.9) * 1.9 * surface;
      };
      auto         record = make_record(*bone, uniaxial(c.strain, c.density));
      const auto   report = integrator.advance(record.data(), c.time);
      const double rho    = bone->point(record.data()).density;
      EXPECT_NEAR(report.density_change, rho - c.density, 1e-15);
      EXPECT_GT(std::abs(rho - c.density), 0.015);
      EXPECT_FALSE(report.at_lower_bound || report.at_upper_bound);
      // Simpson's rule on either side of the kink of L
      const double crossing = std::pow(2014. / 1763., 1. / 0.7);
      double       time     = 0.;
      if ((c.density - crossing) * (rho - crossing) < 0.)
        time = travel_time(rate, c.density, crossing) +
               travel_time(rate, crossing, rho);
      else
        time = travel_time(rate, c.density, rho);
      std::cout << "density " << c.density << " -> " << rho << ", time off by "
                << time / c.time - 1. << ", " << report.n_substeps
                << " substeps\n";
      worst = std::max(worst, std::abs(time / c.time - 1.));
    }
  EXPECT_LT(worst, 1e-7);
}

TEST(Mechanostat, LazyZoneAndItsEdge)
{
  const double modulus = 13750. * 0.7 / (1.3 * 0.4);
  for (const std::string kind : {"half width", "full width"})
    {
      const auto   bone  = make_bone({{"Undamaged density", "1.9"}}, 3, false);
      const auto   law   = make_law("mechanostat", {{"Lazy zone", kind}});
      const double edge  = (kind == "half width") ? 0.1 : 0.05;
      const double psi_1 = 0.5 * modulus * L(1.3) / L(1.9); // for strain 1
      for (const double sign : {1., -1.})
        {
          const auto inside =
            uniaxial(sign * std::sqrt(0.999 * edge / psi_1), 1.3);
          EXPECT_NEAR(law->stimulus(*bone, inside), sign * 0.999 * edge, 1e-12);
          auto                  record = make_record(*bone, inside);
          const auto            before = record;
          const LocalIntegrator integrator(*law, *bone, 1e-8);
          EXPECT_EQ(integrator.advance(record.data(), 100.).n_substeps, 0u);
          EXPECT_EQ(record, before);

          const auto outside =
            uniaxial(sign * std::sqrt(1.001 * edge / psi_1), 1.3);
          const double U    = law->stimulus(*bone, outside);
          const double rate = law->rates(*bone, outside, U).density;
          EXPECT_NEAR(rate,
                      S_v(1. - 1.3 / 1.9) * 1.9 * (sign > 0. ? 5e-3 : 1e-2) *
                        (U - sign * edge),
                      1e-14);
          EXPECT_GT(sign * rate, 0.);
        }
      // Pressed bone is resorbed until its energy reaches the lazy zone.
      auto record = make_record(*bone, uniaxial(-0.01, 1.3));
      LocalIntegrator(*law, *bone, 1e-9).advance(record.data(), 1e6);
      EXPECT_NEAR(law->stimulus(*bone, bone->point(record.data())),
                  -edge,
                  1e-5);
    }
}

TEST(Mechanostat, SignOfTheStimulus)
{
  const auto bone  = make_bone({});
  const auto state = uniaxial(-0.01, 1.1);
  const auto U     = make_law("mechanostat", {})->stimulus(*bone, state);
  EXPECT_NEAR(U, -bone->energy(state), 1e-15);
  EXPECT_EQ(
    make_law("mechanostat", {{"Stimulus", "unsigned"}})->stimulus(*bone, state),
    -U);
  const double p = trace(bone->stress(state)) / 3.;
  EXPECT_NEAR(make_law("mechanostat", {{"Pressure smoothing", "50"}})
                ->stimulus(*bone, state),
              std::tanh(p / 50.) * bone->energy(state),
              1e-14);
}

TEST(Mechanostat, FabricRatesFollowTheFormula)
{
  const auto bone = make_bone({{"Undamaged density", "1.9"}});
  for (const double omega : {0.4, 1.})
    for (unsigned int n = 0; n < 50; ++n)
      {
        const auto law =
          make_law("mechanostat",
                   {{"Degree of anisotropy", Utilities::to_string(omega)}});
        BonePoint p;
        p.elastic_strain = random_symmetric(0.02);
        p.density        = 1.1 + 0.4 * random_number();
        p.log_fabric     = deviator(random_symmetric(0.4));
        // Y = dPsi/dH by differences of (1/2) h~ : C : h~
        const auto H      = bone->remodelling_tensor(p);
        const auto energy = [&](const SymmetricTensor<2, 3> &K) {
          return 0.5 * (bone->effective_stress(K, p.elastic_strain) *
                        symmetric_product(K, p.elastic_strain, K));
        };
        EXPECT_NEAR(energy(H), bone->energy(p), 1e-12 * energy(H));
        SymmetricTensor<2, 3> Y;
        for (unsigned int i = 0; i < 3; ++i)
          for (unsigned int j = i; j < 3; ++j)
            {
              SymmetricTensor<2, 3> d;
              d[i][j] = 1e-5;
              Y[i][j] =
                (energy(H + d) - energy(H - d)) / 2e-5 / (i == j ? 1. : 2.);
            }
        const auto positive =
          tensor_function(Y, [](const double y) { return std::max(y, 0.); });
        auto N = ((1. - omega) / 3. + 0.01) * unit_symmetric_tensor<3>() +
                 omega / trace(positive) * positive;
        const double U = law->stimulus(*bone, p);
        const auto   r = law->rates(*bone, p, U);
        if (std::abs(U) <= 0.1)
          {
            EXPECT_EQ(r.log_fabric.norm(), 0.);
            continue;
          }
        if (U < 0.)
          N = invert(N);
        const auto w =
          tensor_function(H, [](const double x) { return 1. / std::sqrt(x); });
        auto A = symmetric_product(w, N, w);
        A /= trace(A);
        const double beta     = p.density > 1.2094 ? 3.2 : 2.5;
        const auto   expected = 1.5 * beta * r.density / p.density *
                              (A - 1. / 3. * unit_symmetric_tensor<3>());
        EXPECT_LT((r.log_fabric - expected).norm(), 1e-5 * expected.norm());
        EXPECT_NEAR(trace(r.log_fabric), 0., 1e-15);
      }
  // guard: no positive part, no direction
  BonePoint zero;
  zero.density = 1.;
  EXPECT_LT(
    make_law("mechanostat", {})->rates(*bone, zero, -1.).log_fabric.norm(),
    1e-15);
}

TEST(LocalIntegrator, DensityBoundsAreMetAndReported)
{
  const auto law = make_law("mechanostat", {{"Degree of anisotropy", "0"}});
  for (const bool fabric : {false, true})
    {
      const auto            bone = make_bone({}, 3, fabric);
      const LocalIntegrator integrator(*law, *bone, 1e-8);
      auto                  up     = make_record(*bone, uniaxial(0.02, 0.8));
      auto                  report = integrator.advance(up.data(), 1e4);
      EXPECT_EQ(bone->point(up.data()).density, 1.3);
      EXPECT_TRUE(report.at_upper_bound);
      EXPECT_NEAR(report.density_change, 0.5, 1e-12);
      // nothing more happens there
      report = integrator.advance(up.data(), 1.);
      EXPECT_TRUE(report.at_upper_bound);
      EXPECT_EQ(report.n_substeps, 0u);

      auto down = make_record(*bone, uniaxial(-0.2, 0.8));
      report    = integrator.advance(down.data(), 1e4);
      EXPECT_EQ(bone->point(down.data()).density, 0.3);
      EXPECT_TRUE(report.at_lower_bound);
      EXPECT_FALSE(report.at_upper_bound);
    }
}

TEST(LocalIntegrator, RefusesNotANumber)
{
  const auto   law    = make_law("mechanostat", {});
  const auto   bone   = make_bone({});
  auto         record = make_record(*bone, uniaxial(-0.01, 1.1));
  const double nan    = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(
    LocalIntegrator(*law, *bone, 1e-6).advance(record.data(), 1., &nan),
    RunError);
  record[0] = nan;
  EXPECT_THROW(LocalIntegrator(*law, *bone, 1e-6).advance(record.data(), 1.),
               RunError);
}

TEST(LocalIntegrator, FilteredStimulusScalesWithTheEnergy)
{
  // A filtered stimulus equal to the point's own one changes nothing.
  const auto law  = make_law("mechanostat", {});
  const auto bone = make_bone({{"Undamaged density", "1.9"}});
  for (unsigned int n = 0; n < 10; ++n)
    {
      BonePoint p;
      p.elastic_strain = random_symmetric(0.01);
      // far from tr tau = 0 the sign does not change
      p.elastic_strain += (n % 2 ? 0.03 : -0.03) * unit_symmetric_tensor<3>();
      p.density                    = 1.1;
      auto                  record = make_record(*bone, p), filtered = record;
      const double          U = law->stimulus(*bone, p);
      const LocalIntegrator integrator(*law, *bone, 1e-9);
      integrator.advance(record.data(), 0.5);
      integrator.advance(filtered.data(), 0.5, &U);
      for (unsigned int i = 0; i < record.size(); ++i)
        EXPECT_NEAR(record[i], filtered[i], 1e-9);
      const double twice = 2. * U;
      auto         more  = make_record(*bone, p);
      integrator.advance(more.data(), 0.5, &twice);
      EXPECT_GT(std::abs(bone->point(more.data()).density - 1.1),
                1.5 * std::abs(bone->point(record.data()).density - 1.1));
    }
}

namespace
{
  /**
   * Classical Runge-Kutta steps with projection after each of many small steps.
   */
  void
  small_steps(const RemodellingLaw &law,
              const RemodelledBone &bone,
              BonePoint            &p,
              const double          time,
              const unsigned int    steps)
  {
    const double dt    = time / steps;
    const auto   rates = [&](const RemodellingRates &r, const double h) {
      BonePoint q = p;
      q.density += h * r.density;
      q.log_fabric += h * r.log_fabric;
      return law.rates(bone, q, law.stimulus(bone, q));
    };
    for (unsigned int i = 0; i < steps; ++i)
      {
        const auto   k1 = rates({}, 0.);
        const auto   k2 = rates(k1, 0.5 * dt);
        const auto   k3 = rates(k2, 0.5 * dt);
        const auto   k4 = rates(k3, dt);
        const double change =
          dt / 6. *
          (k1.density + 2. * k2.density + 2. * k3.density + k4.density);
        const double next = p.density + change;
        const double kept =
          std::clamp(next, bone.minimum_density(), bone.undamaged_density());
        // at a bound of the density the point stops
        const double share = (next == kept) ? 1. : (kept - p.density) / change;
        p.density          = kept;
        p.log_fabric += share * dt / 6. *
                        (k1.log_fabric + 2. * k2.log_fabric +
                         2. * k3.log_fabric + k4.log_fabric);
        bone.limit_fabric(p.density, p.log_fabric);
        if (share < 1.)
          break;
      }
  }
} // namespace

TEST(LocalIntegrator, AnisotropicAgainstSmallSteps)
{
  const auto law = make_law("mechanostat", {});
  for (const std::string undamaged : {"1.3", "1.9"})
    {
      std::map<double, double> worst;
      double                   free = 0., largest = 0.;
      unsigned int             limited = 0, unlimited = 0;
      const auto bone = make_bone({{"Undamaged density", undamaged}});
      for (unsigned int n = 0; n < 16; ++n)
        {
          BonePoint p;
          p.elastic_strain = random_symmetric(0.008);
          p.elastic_strain +=
            (n % 4 < 2 ? 0.012 : -0.012) * unit_symmetric_tensor<3>();
          p.density = 1.25;
          if (n % 2)
            {
              p.density    = 0.9;
              p.log_fabric = deviator(random_symmetric(0.8));
              bone->limit_fabric(p.density, p.log_fabric);
            }
          const double    time  = 4.;
          const BonePoint start = p;
          small_steps(*law, *bone, p, time, 4000);
          largest = std::max(largest, p.log_fabric.norm());
          for (const double tolerance : {1e-6, 1e-8})
            {
              auto       record = make_record(*bone, start);
              const auto report = LocalIntegrator(*law, *bone, tolerance)
                                    .advance(record.data(), time);
              const BonePoint result = bone->point(record.data());
              const double    error  = std::abs(result.density - p.density) +
                                   (result.log_fabric - p.log_fabric).norm();
              // the fabric is only first order where it slides along a bound
              if (report.n_fabric_limited > 0)
                {
                  worst[tolerance] = std::max(worst[tolerance], error);
                  ++limited;
                }
              else if (tolerance == 1e-8)
                {
                  free = std::max(free, error);
                  ++unlimited;
                }
              // admissible: never stiffer than undamaged bone
              const auto H = spectral(bone->remodelling_tensor(result));
              EXPECT_LE(H.values[0], 1. + 1e-12);
              EXPECT_NEAR(trace(result.log_fabric), 0., 1e-12);
            }
        }
      std::cout << "undamaged density " << undamaged << ": off by " << free
                << " inside the bounds (" << unlimited << "), along them "
                << worst[1e-6] << " and " << worst[1e-8] << " (" << limited
                << "), largest fabric " << largest << '\n';
      EXPECT_LT(free, 5e-5); // of the small steps, across the kink of E(rho)
      EXPECT_LT(worst[1e-6], 3e-2);
      EXPECT_LT(worst[1e-8], 3e-3);
      EXPECT_GT(largest, 0.5);
      EXPECT_GE(unlimited, undamaged == "1.9" ? 3u : 0u);
      EXPECT_GT(limited, 4u);
    }
}

TEST(LocalIntegrator, AnyStateComesThrough)
{
  // long steps, random states, both stimuli: bounds hold, nothing gets stuck
  unsigned int failed = 0, substeps = 0, worst = 0, to_and_fro = 0;
  for (const std::string kind : {"signed", "unsigned"})
    for (const std::string undamaged : {"1.3", "1.9"})
      {
        const auto law  = make_law("mechanostat", {{"Stimulus", kind}});
        const auto bone = make_bone({{"Undamaged density", undamaged}});
        const LocalIntegrator integrator(*law, *bone, 1e-6);
        for (unsigned int n = 0; n < 200; ++n)
          {
            BonePoint p;
            p.elastic_strain = random_symmetric(n % 2 ? 0.02 : 0.1);
            p.density        = 0.8 + 0.5 * random_number();
            p.log_fabric     = deviator(random_symmetric(0.5));
            bone->limit_fabric(p.density, p.log_fabric);
            auto record = make_record(*bone, p);
            try
              {
                const auto report = integrator.advance(record.data(), 10.);
                substeps += report.n_substeps;
                worst = std::max(worst, report.n_substeps);
                to_and_fro += report.at_reversal;
              }
            catch (const RunError &error)
              {
                if (failed == 0)
                  std::cout << error.what() << '\n';
                ++failed;
              }
            const auto result = bone->point(record.data());
            EXPECT_GE(result.density, 0.3);
            EXPECT_LE(result.density, bone->undamaged_density());
            SymmetricTensor<2, 3> T = result.log_fabric;
            EXPECT_FALSE(bone->limit_fabric(result.density, T));
          }
      }
  std::cout << failed << " of 800 failed, " << to_and_fro
            << " at rest at a reversal, " << substeps / 800.
            << " substeps on average, at most " << worst << '\n';
  EXPECT_EQ(failed, 0u);
}

TEST(LocalIntegrator, RestsWhereTheSmoothedSignDoes)
{
  const auto abrupt = make_law("mechanostat", {});
  const auto smooth = make_law("mechanostat", {{"Pressure smoothing", "0.01"}});
  const auto bone   = make_bone({});
  unsigned int resting = 0;
  double       worst   = 0.;
  for (unsigned int n = 0; n < 200; ++n)
    {
      BonePoint p;
      p.elastic_strain = random_symmetric(0.012);
      p.density        = 0.8 + 0.4 * random_number();
      p.log_fabric     = deviator(random_symmetric(0.5));
      bone->limit_fabric(p.density, p.log_fabric);
      auto a = make_record(*bone, p), b = a;
      if (!LocalIntegrator(*abrupt, *bone, 1e-7)
             .advance(a.data(), 50.)
             .at_reversal)
        continue;
      ++resting;
      const auto at_rest = bone->point(a.data());
      EXPECT_LT(std::abs(trace(bone->stress(at_rest))),
                1e-6 * bone->stress(at_rest).norm());
      LocalIntegrator(*smooth, *bone, 1e-7).advance(b.data(), 50.);
      const auto other = bone->point(b.data());
      worst            = std::max(worst,
                       std::abs(at_rest.density - other.density) +
                         (at_rest.log_fabric - other.log_fabric).norm());
    }
  std::cout << resting << " at rest, off the smoothed ones by " << worst
            << '\n';
  EXPECT_GT(resting, 5u);
  EXPECT_LT(worst, 0.02);
}

TEST(Huiskes, DensityAgainstQuadrature)
{
  const double modulus = 13750. * 0.7 / (1.3 * 0.4);
  const auto   bone    = make_bone({{"Undamaged density", "1.9"}}, 2, false);
  const auto   law     = make_law("Huiskes",
                            {{"Rate", "0.05"},
                                   {"Reference energy", "0.3"},
                                   {"Dead zone", "0.2"}});
  EXPECT_FALSE(law->changes_fabric());
  for (const double strain : {0.02, 0.006})
    {
      const double psi  = 0.5 * modulus * strain * strain;
      const auto   rate = [&](const double rho) {
        const double S = psi * L(rho) / L(1.9) / rho;
        return 0.05 * (S > 0.36 ? S - 0.36 : S < 0.24 ? S - 0.24 : 0.);
      };
      auto record = make_record(*bone, uniaxial(strain, 1.1), 2);
      LocalIntegrator(*law, *bone, 1e-9).advance(record.data(), 2.);
      const double rho = bone->point(record.data()).density;
      EXPECT_GT(std::abs(rho - 1.1), 0.01);
      EXPECT_NEAR(travel_time(rate, 1.1, rho), 2., 2e-7);
    }
  // in the dead zone nothing happens
  const double strain = std::sqrt(2. * 0.3 * 1.1 * L(1.9) / L(1.1) / modulus);
  auto         record = make_record(*bone, uniaxial(strain, 1.1), 2);
  EXPECT_EQ(
    LocalIntegrator(*law, *bone, 1e-9).advance(record.data(), 2.).n_substeps,
    0u);
}

TEST(LocalIntegrator, CostOfAdvance)
{
  for (const bool fabric : {false, true})
    {
      const auto            bone = make_bone({}, 2, fabric);
      const auto            law  = make_law("mechanostat", {});
      const LocalIntegrator integrator(*law, *bone, 1e-6);
      const auto            start = make_record(*bone, uniaxial(-0.01, 1.2), 2);
      const auto            begin = std::chrono::steady_clock::now();
      const unsigned int    n     = 2000;
      unsigned int          substeps = 0;
      for (unsigned int i = 0; i < n; ++i)
        {
          auto record = start;
          substeps += integrator.advance(record.data(), 1.).n_substeps;
        }
      const std::chrono::duration<double> seconds =
        std::chrono::steady_clock::now() - begin;
      std::cout << (fabric ? "with" : "without")
                << " fabric: " << 1e6 * seconds.count() / n << " microseconds, "
                << substeps / n << " substeps\n";
      EXPECT_LT(seconds.count() / n, 1e-2);
    }
}
