// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remodelling/local_integrator.h>

#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using dealii::SymmetricTensor;
  namespace odeint = boost::numeric::odeint;

  namespace
  {
    /**
     * The equations at one point. N = 1: density; N = 7: density and the six
     * components of the fabric.
     */
    template <std::size_t N>
    class PointProblem
    {
    public:
      using Values  = std::array<double, N>;
      using Stepper = odeint::runge_kutta_dopri5<Values>;

      PointProblem(const RemodellingLaw &law,
                   const RemodelledBone &bone,
                   const BonePoint      &start,
                   const double         *filtered)
        : law(law)
        , bone(bone)
        , start(start)
        , filtered(filtered)
        , energy_at_start(filtered ? bone.energy(start) : 0.)
      {}

      BonePoint
      point(const Values &x) const
      {
        BonePoint p = start;
        p.density   = x[0];
        if constexpr (N == 7)
          for (unsigned int i = 0; i < 6; ++i)
            p.log_fabric.access_raw_entry(i) = x[i + 1];
        return p;
      }

      Values
      values(const BonePoint &p) const
      {
        Values x;
        x[0] = p.density;
        if constexpr (N == 7)
          for (unsigned int i = 0; i < 6; ++i)
            x[i + 1] = p.log_fabric.access_raw_entry(i);
        return x;
      }

      /**
       * Rates at the admissible state next to @p x: a continuous function also
       * where the bounds of the fabric act.
       */
      void
      rates(const Values &x, Values &dx) const
      {
        BonePoint p = point(x);
        // Stages of a step that will be rejected may leave the physical range.
        p.density = std::clamp(p.density,
                               0.5 * bone.minimum_density(),
                               1.05 * bone.undamaged_density());
        if constexpr (N == 7)
          bone.limit_fabric(p.density, p.log_fabric);

        double stimulus = 0.;
        if (filtered)
          stimulus =
            *filtered *
            (energy_at_start > 0. ? bone.energy(p) / energy_at_start : 1.);
        else
          stimulus = law.stimulus(bone, p);
        // Not a number would look like the lazy zone.
        if (!std::isfinite(stimulus))
          throw RunError("Remodelling",
                         "the stimulus is " + std::to_string(stimulus) +
                           " at density " + std::to_string(x[0]) + " g/cc",
                         "look for the first step with irregular stresses");
        const RemodellingRates r = law.rates(bone, p, stimulus);
        dx[0]                    = r.density;
        formation_seen           = formation_seen || r.density > 0.;
        resorption_seen          = resorption_seen || r.density < 0.;
        if constexpr (N == 7)
          for (unsigned int i = 0; i < 6; ++i)
            dx[i + 1] = r.log_fabric.access_raw_entry(i);
      }

      /** Project the fabric; true if it had to be changed. */
      bool
      limit_fabric(Values &x) const;

      /**
       * Repeat a substep from @p old, which has crossed a bound of the density,
       * so short that it ends at the bound.
       * @return its length
       */
      double
      stop_at_bound(const Values &old,
                    const Values &old_rates,
                    const double  step,
                    const double  bound,
                    const double  tolerance,
                    Values       &x) const;

      /**
       * After a substep that has met rates of both signs: look for a jump
       * between them, on the way to its end @p x or straight on from its
       * beginning.
       * @return true if there is one; @p x is then the point before it
       */
      bool
      find_reversal(const Values &old,
                    const Values &old_rates,
                    const double  step,
                    Values       &x) const;

      RemodellingReport
      integrate(Values &x, const double end, const double tolerance) const;

    private:
      const RemodellingLaw &law;
      const RemodelledBone &bone;
      const BonePoint       start;
      const double         *filtered;
      const double          energy_at_start;
      /** Signs of the density rate that the current substep has met. */
      mutable bool formation_seen = false, resorption_seen = false;
    };



    template <std::size_t N>
    bool
    PointProblem<N>::limit_fabric(Values &x) const
    {
      if constexpr (N == 7)
        {
          BonePoint p = point(x);
          if (bone.limit_fabric(p.density, p.log_fabric))
            {
              x = values(p);
              return true;
            }
        }
      return false;
    }



    template <std::size_t N>
    double
    PointProblem<N>::stop_at_bound(const Values &old,
                                   const Values &old_rates,
                                   const double  step,
                                   const double  bound,
                                   const double  tolerance,
                                   Values       &x) const
    {
      Stepper    stepper;
      const auto system = [this](const Values &y, Values &dy, double) {
        rates(y, dy);
      };
      Values rates_at_end;
      double a = 0., value_a = old[0] - bound;
      double b = step, value_b = x[0] - bound;
      double c = step;
      for (unsigned int i = 0;
           i < 60 && std::abs(x[0] - bound) > 0.01 * tolerance;
           ++i)
        {
          // regula falsi, every third time bisection
          c = (i % 3 == 2) ? 0.5 * (a + b)
                           : (a * value_b - b * value_a) / (value_b - value_a);
          stepper.do_step(system, old, old_rates, 0., x, rates_at_end, c);
          const double value                         = x[0] - bound;
          (value * value_b > 0. ? b : a)             = c;
          (value * value_b > 0. ? value_b : value_a) = value;
        }
      x[0] = bound;
      return c;
    }



    template <std::size_t N>
    bool
    PointProblem<N>::find_reversal(const Values &old,
                                   const Values &old_rates,
                                   const double  step,
                                   Values       &x) const
    {
      Values straight;
      for (std::size_t i = 0; i < N; ++i)
        straight[i] = old[i] + step * old_rates[i];
      for (Values other : {x, straight})
        {
          Values here = old, here_rates = old_rates, other_rates;
          rates(other, other_rates);
          if (here_rates[0] * other_rates[0] >= 0.)
            continue;
          const double change = std::abs(here_rates[0] - other_rates[0]);
          for (unsigned int n = 0; n < 20; ++n)
            {
              Values between, between_rates;
              for (std::size_t i = 0; i < N; ++i)
                between[i] = 0.5 * (here[i] + other[i]);
              rates(between, between_rates);
              const bool same       = between_rates[0] * here_rates[0] > 0.;
              (same ? here : other) = between;
              (same ? here_rates : other_rates) = between_rates;
            }
          // A continuous change of sign is no matter for us.
          if (std::abs(here_rates[0] - other_rates[0]) > 0.1 * change)
            {
              x = here;
              return true;
            }
        }
      return false;
    }



    template <std::size_t N>
    RemodellingReport
    PointProblem<N>::integrate(Values      &x,
                               const double end,
                               const double tolerance) const
    {
      auto controlled =
        odeint::make_controlled(tolerance, tolerance, Stepper());
      const auto system = [this](const Values &y, Values &dy, double) {
        rates(y, dy);
      };
      const auto norm = [](const Values &v, const std::size_t first) {
        double sum = 0.;
        for (std::size_t i = first; i < N; ++i)
          sum += v[i] * v[i];
        return std::sqrt(sum);
      };

      RemodellingReport report;
      const double      lower = bone.minimum_density();
      const double      upper = bone.undamaged_density();
      x[0]                    = std::clamp(x[0], lower, upper);
      if (limit_fabric(x))
        ++report.n_fabric_limited;

      // Along a bound the fabric leaves the admissible set during a substep and
      // is brought back after it: an error of first order that error control
      // does not see, so the way is kept short.
      const double way_along_bound = std::min(0.1, 30. * std::sqrt(tolerance));

      Values dx{};
      rates(x, dx);
      double t = 0., dt = end;
      while (end - t > 1e-12 * end)
        {
          // Nothing depends on time: a point at a bound of the density, or in
          // the lazy zone, stays there.
          if (norm(dx, 0) == 0. || (x[0] <= lower && dx[0] <= 0.) ||
              (x[0] >= upper && dx[0] >= 0.))
            break;
          if (report.n_substeps > 100000 || !(dt > 1e-13 * end) ||
              !std::isfinite(norm(dx, 0)))
            throw RunError("Remodelling",
                           "the integration stopped after " +
                             std::to_string(report.n_substeps) +
                             " substeps at the fraction " +
                             std::to_string(t / end) +
                             " of the time step, density " +
                             std::to_string(x[0]) + " g/cc, rate " +
                             std::to_string(dx[0]) + " g/cc/T",
                           "reduce the time step");

          dt               = std::min(dt, end - t);
          const Values old = x, old_rates = dx;
          const double old_t = t;
          const double tried = dt;
          formation_seen     = dx[0] > 0.;
          resorption_seen    = dx[0] < 0.;
          if (controlled.try_step(system, x, dx, t, dt) == odeint::fail)
            continue;
          if (formation_seen && resorption_seen)
            {
              double way = 0.;
              for (std::size_t i = 0; i < N; ++i)
                way = std::max(way, std::abs(x[i] - old[i]));
              if (way > 1000. * tolerance)
                {
                  // Too long a step to find where the sign changes.
                  x  = old;
                  dx = old_rates;
                  t  = old_t;
                  dt = 0.2 * tried;
                  continue;
                }
              if (find_reversal(old, old_rates, tried, x))
                {
                  limit_fabric(x);
                  report.at_reversal = true;
                  break;
                }
            }
          ++report.n_substeps;

          if (x[0] < lower || x[0] > upper)
            t = old_t + stop_at_bound(old,
                                      old_rates,
                                      tried,
                                      x[0] < lower ? lower : upper,
                                      tolerance,
                                      x);
          const bool limited = limit_fabric(x);
          rates(x, dx);
          if (limited)
            {
              ++report.n_fabric_limited;
              const double speed = norm(dx, 1);
              if (dt * speed > way_along_bound)
                dt = way_along_bound / speed;
            }
        }
      report.at_lower_bound = x[0] <= lower;
      report.at_upper_bound = x[0] >= upper;
      return report;
    }
  } // namespace



  LocalIntegrator::LocalIntegrator(const RemodellingLaw &law,
                                   const RemodelledBone &bone,
                                   const double          tolerance)
    : law(law)
    , bone(bone)
    , tolerance(tolerance)
  {
    if (!(tolerance > 0.))
      throw InputError("Remodelling/Tolerance",
                       "found " + std::to_string(tolerance),
                       "it must be positive, such as 1e-6");
    if (!bone.stores_density())
      throw InputError("Remodelling",
                       "the bone of this region does not store its density",
                       "let set_remodelled() precede initialize()");
  }



  RemodellingReport
  LocalIntegrator::advance(double       *record,
                           const double  dt,
                           const double *filtered_stimulus) const
  {
    BonePoint         p       = bone.point(record);
    const double      density = p.density;
    RemodellingReport report;
    const auto        run = [&](auto problem) {
      auto x = problem.values(p);
      report = problem.integrate(x, dt, tolerance);
      p      = problem.point(x);
    };
    if (bone.stores_fabric() && law.changes_fabric())
      run(PointProblem<7>(law, bone, p, filtered_stimulus));
    else
      run(PointProblem<1>(law, bone, p, filtered_stimulus));
    report.density_change = p.density - density;
    bone.store(p, record);
    return report;
  }
} // namespace alveolus
