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
      using Values = std::array<double, N>;

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
       * Rates, those of the fabric restricted to what its bounds admit.
       * @return true if the bounds act
       */
      bool
      rates(const Values &x, Values &dx) const
      {
        BonePoint p = point(x);
        // Stages of a step that will be rejected may leave the physical range.
        p.density    = std::clamp(p.density,
                               0.5 * bone.minimum_density(),
                               1.05 * bone.undamaged_density());
        bool limited = false;
        if constexpr (N == 7)
          limited = bone.limit_fabric(p.density, p.log_fabric);

        double stimulus = 0.;
        if (filtered)
          stimulus =
            *filtered *
            (energy_at_start > 0. ? bone.energy(p) / energy_at_start : 1.);
        else
          stimulus = law.stimulus(bone, p);
        RemodellingRates r = law.rates(bone, p, stimulus);

        if constexpr (N == 7)
          {
            // One-sided derivative of the projected state: where a bound acts,
            // the fabric slides along it.
            const double speed = r.log_fabric.norm();
            if (speed > 0.)
              {
                const double          dt   = 1e-6 / speed;
                SymmetricTensor<2, 3> next = p.log_fabric + dt * r.log_fabric;
                if (bone.limit_fabric(p.density + dt * r.density, next))
                  {
                    r.log_fabric = (next - p.log_fabric) / dt;
                    limited      = true;
                  }
              }
          }
        dx[0] = r.density;
        if constexpr (N == 7)
          for (unsigned int i = 0; i < 6; ++i)
            dx[i + 1] = r.log_fabric.access_raw_entry(i);
        return limited;
      }

      RemodellingReport
      integrate(Values &x, const double end, const double tolerance) const;

    private:
      const RemodellingLaw &law;
      const RemodelledBone &bone;
      const BonePoint       start;
      const double         *filtered;
      const double          energy_at_start;
    };



    template <std::size_t N>
    RemodellingReport
    PointProblem<N>::integrate(Values      &x,
                               const double end,
                               const double tolerance) const
    {
      using Stepper = odeint::runge_kutta_dopri5<Values>;
      Stepper single;
      auto    controlled =
        odeint::make_controlled(tolerance, tolerance, Stepper());
      const auto system = [this](const Values &y, Values &dy, double) {
        rates(y, dy);
      };

      RemodellingReport report;
      const double      lower = bone.minimum_density();
      const double      upper = bone.undamaged_density();
      x[0]                    = std::clamp(x[0], lower, upper);
      if constexpr (N == 7)
        {
          BonePoint p = point(x);
          if (bone.limit_fabric(p.density, p.log_fabric))
            {
              ++report.n_fabric_limited;
              x = values(p);
            }
        }

      Values dx{};
      rates(x, dx);
      double t = 0., dt = end;
      while (end - t > 1e-12 * end)
        {
          // At a bound, or in the lazy zone, a point of fixed strain stays.
          report.at_lower_bound = (x[0] <= lower && dx[0] <= 0.);
          report.at_upper_bound = (x[0] >= upper && dx[0] >= 0.);
          const bool resting =
            std::all_of(dx.begin(), dx.end(), [](const double v) {
              return v == 0.;
            });
          if (resting || report.at_lower_bound || report.at_upper_bound)
            break;

          const Values old = x, old_rates = dx;
          const double old_t = t;
          dt                 = std::min(dt, end - t);
          const double tried = dt;
          if (controlled.try_step(system, x, dx, t, dt) == odeint::fail)
            {
              if (dt < 1e-13 * end || !std::isfinite(dt))
                throw RunError(
                  "Remodelling",
                  "the integration stopped after " +
                    std::to_string(report.n_substeps) + " substeps at " +
                    std::to_string(t / end) + " of the time step, density " +
                    std::to_string(x[0]) + " g/cc, rate " +
                    std::to_string(dx[0]) + " g/cc/T",
                  "reduce the time step, or smooth the sign of the stimulus "
                  "by 'Pressure smoothing'");
              continue;
            }
          ++report.n_substeps;
          if (report.n_substeps > 100000)
            throw RunError("Remodelling",
                           "more than 100000 substeps at a point, density " +
                             std::to_string(x[0]) + " g/cc",
                           "reduce the time step");

          if (x[0] < lower || x[0] > upper)
            {
              // Shorten the step so that it ends at the bound.
              const double bound = x[0] < lower ? lower : upper;
              double       a = 0., value_a = old[0] - bound;
              double       b = tried, value_b = x[0] - bound;
              for (unsigned int i = 0;
                   i < 60 && std::abs(x[0] - bound) > 0.01 * tolerance;
                   ++i)
                {
                  // regula falsi, every third time bisection
                  double c = (i % 3 == 2) ? 0.5 * (a + b)
                                          : (a * value_b - b * value_a) /
                                              (value_b - value_a);
                  single.do_step(system, old, old_rates, old_t, x, dx, c);
                  if ((x[0] - bound) * value_b > 0.)
                    {
                      b       = c;
                      value_b = x[0] - bound;
                    }
                  else
                    {
                      a       = c;
                      value_a = x[0] - bound;
                    }
                  t = old_t + c;
                }
              x[0] = bound;
            }

          bool limited = false;
          if constexpr (N == 7)
            {
              BonePoint p = point(x);
              limited     = bone.limit_fabric(p.density, p.log_fabric);
              x           = values(p);
            }
          limited = rates(x, dx) || limited;
          if (limited)
            ++report.n_fabric_limited;
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
