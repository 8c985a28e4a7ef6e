// SPDX-License-Identifier: LGPL-2.1-or-later
// Spectral helpers against definitions, finite differences and long double.
#include <alveolus/base/tensors.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
  std::mt19937 generator(7);

  double
  random_number()
  {
    return std::uniform_real_distribution<double>(-1., 1.)(generator);
  }

  SymmetricTensor<2, 3>
  random_symmetric()
  {
    SymmetricTensor<2, 3> t;
    for (unsigned int i = 0; i < 6; ++i)
      t.access_raw_entry(i) = random_number();
    return t;
  }

  Tensor<2, 3>
  random_gradient(const double size)
  {
    Tensor<2, 3> f(unit_symmetric_tensor<3>());
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = 0; j < 3; ++j)
        f[i][j] += size * random_number();
    return f;
  }
} // namespace

TEST(Tensors, SpectralOfAnySpacing)
{
  for (unsigned int n = 0; n < 2000; ++n)
    {
      // eigenvalues apart, nearly equal, equal, and of very different size
      const Polar           p   = polar(random_gradient(0.5));
      const double          gap = (n % 4 == 0)   ? 1.
                                  : (n % 4 == 1) ? 1e-7
                                  : (n % 4 == 2) ? 1e-15
                                                 : 0.;
      SymmetricTensor<2, 3> d;
      d[0][0]          = 1.;
      d[1][1]          = 1. + gap;
      d[2][2]          = (n % 3 == 0) ? 1e-8 : 1. - gap * random_number();
      const auto     A = rotate(p.R, d);
      const Spectral s = spectral(A);
      EXPECT_LT((compose(s.values, s) - A).norm(), 1e-14);
      EXPECT_GE(s.values[0], s.values[1]);
      EXPECT_GE(s.values[1], s.values[2]);
      for (unsigned int a = 0; a < 3; ++a)
        for (unsigned int b = 0; b < 3; ++b)
          EXPECT_NEAR(s.vectors[a] * s.vectors[b], a == b ? 1. : 0., 1e-14);
    }
}

TEST(Tensors, ExpAndLogAreInverse)
{
  for (unsigned int n = 0; n < 200; ++n)
    {
      const auto h = random_symmetric();
      EXPECT_LT((log(exp(h)) - h).norm(), 1e-13);
      // exp(h) by its series
      Tensor<2, 3> sum(unit_symmetric_tensor<3>()), term = sum;
      for (unsigned int k = 1; k < 40; ++k)
        {
          term = term * Tensor<2, 3>(h) / k;
          sum += term;
        }
      EXPECT_LT((sum - Tensor<2, 3>(exp(h))).norm(), 1e-13 * sum.norm());
    }
}

// Plane strain has closed forms of its own; turned out of the plane, the same
// tensor goes the general way.
TEST(Tensors, PlaneStrainEqualsTheGeneralWay)
{
  for (unsigned int n = 0; n < 400; ++n)
    {
      const double size = n % 2 == 0 ? 1. : (n % 3 == 0 ? 1e-9 : 0.05);
      auto         h    = size * random_symmetric();
      h[0][2] = h[1][2]    = 0.;
      const Tensor<2, 3> R = polar(random_gradient(0.5)).R;

      const Spectral s = spectral(h);
      ASSERT_LT(s.normal_axis, 3u);
      EXPECT_EQ(s.vectors[s.normal_axis][2], 1.);
      EXPECT_GE(s.values[0], s.values[1]);
      EXPECT_GE(s.values[1], s.values[2]);
      EXPECT_LT((compose(s.values, s) - h).norm(), 1e-15 * size);
      const Spectral turned = spectral(rotate(R, h));
      for (unsigned int a = 0; a < 3; ++a)
        EXPECT_NEAR(s.values[a], turned.values[a], 1e-14 * size);

      EXPECT_LT((exp(rotate(R, h)) - rotate(R, exp(h))).norm(), 2e-14);

      auto f  = random_gradient(0.4);
      f[0][2] = f[1][2] = f[2][0] = f[2][1] = 0.;
      if (determinant(f) > 0.1 && f[2][2] > 0.)
        {
          const Polar p = polar(f);
          EXPECT_LT((Tensor<2, 3>(p.V) * p.R - f).norm(), 1e-14);
          EXPECT_LT((rotate(R, p.V) - polar(R * f).V).norm(), 1e-13);
        }

      const auto    x      = random_symmetric();
      const Mandel6 mapped = congruence(h) * to_mandel(x);
      EXPECT_LT((from_mandel(mapped) - symmetric_product(h, x, h)).norm(),
                1e-15);
    }
}

TEST(Tensors, LogQuotientOfNearlyEqualArguments)
{
  for (const double gap : {1., 1e-2, 1e-5, 1e-7, 1.1e-8, 0.9e-8, 1e-12, 0.})
    {
      const double x = 1.3 * (1. + gap), y = 1.3;
      // the series 1/(2m) (1 + e^2/3 + e^4/5 + ...), e = (x-y)/(x+y), which
      // does not cancel
      const long double m      = 0.5L * (x + static_cast<long double>(y));
      const long double e      = 0.5L * (x - static_cast<long double>(y)) / m;
      long double       series = 0., power = 1.;
      for (unsigned int k = 0; k < 200; ++k, power *= e * e)
        series += power / (2 * k + 1);
      const double exact = series / (2 * m);
      EXPECT_NEAR(half_log_quotient(x, y) / exact, 1., 1e-15);
    }
  for (const double x : {1e-6, 0.99e-4, 1.01e-4, 0.1})
    EXPECT_NEAR(sinhc(x) / (std::sinh(static_cast<long double>(x)) / x),
                1.,
                1e-15);
}

TEST(Tensors, PolarRotationAndItsSpin)
{
  double worst = 0.;
  for (unsigned int n = 0; n < 100; ++n)
    {
      const auto f = random_gradient(0.4);
      if (determinant(f) < 0.1)
        continue;
      const Polar p = polar(f);
      EXPECT_LT((Tensor<2, 3>(p.V) * p.R - f).norm(), 1e-14);
      EXPECT_LT((p.R * transpose(p.R) -
                 Tensor<2, 3>(unit_symmetric_tensor<3>()))
                  .norm(),
                1e-13);
      EXPECT_NEAR(determinant(p.R), 1., 1e-13);
      const auto spin = polar_spin(p.V);
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          {
            const double eps = 1e-5;
            Tensor<2, 3> velocity;
            velocity[k][l]  = eps;
            const auto   R1 = polar(f + velocity * f).R;
            const auto   R0 = polar(f - velocity * f).R;
            const auto   dR = (R1 - R0) / (2. * eps) * transpose(p.R);
            Tensor<1, 3> w;
            w[0]  = dR[2][1];
            w[1]  = dR[0][2];
            w[2]  = dR[1][0];
            worst = std::max(worst, (w - spin[k][l]).norm());
          }
    }
  std::cout << "spin against differences: " << worst << '\n';
  EXPECT_LT(worst, 1e-8);
}

TEST(Tensors, MandelAlgebra)
{
  for (unsigned int n = 0; n < 100; ++n)
    {
      const auto A = random_symmetric(), B = random_symmetric();
      EXPECT_NEAR(dot(to_mandel(A), to_mandel(B)), A * B, 1e-14);
      EXPECT_LT((from_mandel(to_mandel(A)) - A).norm(), 1e-15);
      const Tensor<2, 3> BAB =
        Tensor<2, 3>(B) * Tensor<2, 3>(A) * Tensor<2, 3>(B);
      EXPECT_LT(
        (Tensor<2, 3>(from_mandel(congruence(B) * to_mandel(A))) - BAB).norm(),
        1e-14);
      EXPECT_LT((Tensor<2, 3>(symmetric_product(B, A, B)) - BAB).norm(), 1e-14);

      Tensor<1, 3> w;
      for (unsigned int i = 0; i < 3; ++i)
        w[i] = random_number();
      Tensor<2, 3> spin;
      spin[2][1] = w[0];
      spin[1][2] = -w[0];
      spin[0][2] = w[1];
      spin[2][0] = -w[1];
      spin[1][0] = w[2];
      spin[0][1] = -w[2];
      EXPECT_LT((Tensor<2, 3>(commutator(w, A)) - spin * Tensor<2, 3>(A) +
                 Tensor<2, 3>(A) * spin)
                  .norm(),
                1e-14);

      Mandel66 M = congruence(exp(A));
      add_dyad(M, 1., to_mandel(B));
      const Cholesky6 factor(M);
      ASSERT_TRUE(factor.valid());
      const Mandel66 unit = M * factor.inverse();
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int j = 0; j < 6; ++j)
          EXPECT_NEAR(unit[i][j], i == j ? 1. : 0., 1e-11);
    }
  Mandel66 indefinite;
  add_deviatoric_projection(indefinite, -1.);
  EXPECT_FALSE(Cholesky6(indefinite).valid());
}
