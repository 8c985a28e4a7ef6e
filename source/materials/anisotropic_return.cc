// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/remodelled_bone.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alveolus
{
  namespace
  {
    Mandel6
    deviator(const Mandel6 &a)
    {
      Mandel6      result = a;
      const double mean   = (a[0] + a[1] + a[2]) / 3.;
      for (unsigned int i = 0; i < 3; ++i)
        result[i] -= mean;
      return result;
    }
  } // namespace



  AnisotropicReturn
  anisotropic_return(const Mandel66    &C,
                     const Mandel66    &compliance,
                     const Mandel6     &trial_strain,
                     const YieldStress &yield,
                     const bool         need_tangent)
  {
    AnisotropicReturn result;
    result.strain = trial_strain;
    result.stress = C * trial_strain;
    Mandel6 dev   = deviator(result.stress);
    double  q     = std::sqrt(1.5 * dot(dev, dev));
    if (q <= yield.value(0.))
      {
        result.tangent = C;
        return result;
      }

    // Unknown: the multiplier g. At the yield surface q = y(g), so tau =
    // (C^{-1} + lambda P)^{-1} h_trial with lambda = 3 g/(2 y(g)). F(g) =
    // y(g)/q(lambda(g)) - 1 grows with g, and linearly for isotropic C.
    double lower = 0., upper = std::numeric_limits<double>::infinity();
    double g = 0., y = yield.value(0.), slope = yield.slope(0.);
    // dq/dlambda = -(2 q/3) N : M : N with N = (3/2) dev tau/q; at g = 0, M = C
    Mandel6 N;
    for (unsigned int i = 0; i < 6; ++i)
      N[i] = 1.5 * dev[i] / q;
    double NMN       = dot(N, C * N);
    bool   converged = false;
    for (unsigned int iteration = 0; iteration < 60; ++iteration)
      {
        const double F = y / q - 1.;
        if (std::abs(F) < 1e-14)
          {
            converged = true;
            break;
          }
        (F < 0. ? lower : upper) = g;
        const double dlambda     = 1.5 * (y - g * slope) / (y * y);
        const double dF   = slope / q + y / q * (2. / 3.) * NMN * dlambda;
        double       next = g - F / dF;
        if (!(next > lower && next < upper))
          next = std::isfinite(upper) ? 0.5 * (lower + upper) : 2. * g;
        // Round-off stops the iteration as well as the tolerance does.
        if (std::abs(next - g) <= 1e-15 * g)
          {
            converged = std::abs(F) < 1e-11;
            break;
          }
        g     = next;
        y     = yield.value(g);
        slope = yield.slope(g);

        Mandel66 matrix = compliance;
        add_deviatoric_projection(matrix, 1.5 * g / y);
        const Cholesky6 factor(matrix);
        if (!factor.valid())
          break;
        result.stress = factor.solve(trial_strain);
        dev           = deviator(result.stress);
        q             = std::sqrt(1.5 * dot(dev, dev));
        for (unsigned int i = 0; i < 6; ++i)
          N[i] = 1.5 * dev[i] / q;
        NMN = dot(N, factor.solve(N));
      }
    if (!converged)
      throw RunError("Remodelled bone",
                     "the plastic return did not converge: equivalent stress " +
                       std::to_string(q) + " MPa, yield stress " +
                       std::to_string(y) + " MPa, plastic increment " +
                       std::to_string(g),
                     "reduce the time step");

    result.multiplier = g;
    for (unsigned int i = 0; i < 6; ++i)
      result.strain[i] -= g * N[i];

    if (need_tangent)
      {
        // dN = (3/(2q)) (P - (2/3) N (x) N) dtau; consistent linearisation of
        // h + g N(tau) = h_trial and of the yield condition.
        Mandel66 matrix = compliance;
        add_deviatoric_projection(matrix, 1.5 * g / q);
        add_dyad(matrix, -g / q, N);
        result.tangent     = Cholesky6(matrix).inverse();
        const Mandel6 flow = result.tangent * N;
        add_dyad(result.tangent, -1. / (dot(N, flow) + slope), flow);
      }
    return result;
  }



  std::array<double, 3>
  project_traceless(const std::array<double, 3> &y,
                    const double                 lower,
                    const double                 upper)
  {
    const auto clipped = [&](const double mu) {
      std::array<double, 3> z;
      for (unsigned int i = 0; i < 3; ++i)
        z[i] = std::min(std::max(y[i] - mu, lower), upper);
      return z;
    };
    const auto sum = [&](const double mu) {
      const auto z = clipped(mu);
      return z[0] + z[1] + z[2];
    };

    // The sum falls with mu and is linear between the six kinks.
    std::array<double, 6> kinks;
    for (unsigned int i = 0; i < 3; ++i)
      {
        kinks[i]     = y[i] - upper;
        kinks[i + 3] = y[i] - lower;
      }
    std::sort(kinks.begin(), kinks.end());
    double left = kinks[0], right = kinks[5];
    for (const double kink : kinks)
      if (sum(kink) >= 0.)
        left = kink;
      else
        {
          right = kink;
          break;
        }
    const double sum_left = sum(left), sum_right = sum(right);
    const double mu = sum_left > sum_right ? left + (right - left) * sum_left /
                                                      (sum_left - sum_right)
                                           : left;
    return clipped(mu);
  }
} // namespace alveolus
