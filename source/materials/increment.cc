// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/increment.h>

#include <cmath>
#include <string>

namespace alveolus
{
  using dealii::SymmetricTensor;
  using dealii::Tensor;

  namespace
  {
    constexpr double root2 = 1.41421356237309504880;

    /** 3x3x(3x3) quantities: six Mandel rows, nine velocity gradients. */
    using Matrix69 = std::array<std::array<double, 9>, 6>;

    /** Pairs (a, b) of different axes and the third one. */
    constexpr unsigned int pairs[3][3] = {{0, 1, 2}, {0, 2, 1}, {1, 2, 0}};

    /** v_a (x) v_a or v_a (x) v_b + v_b (x) v_a in Mandel components. */
    Mandel6
    mode(const Spectral &s, const unsigned int a, const unsigned int b)
    {
      const auto  &v = s.vectors[a];
      const auto  &w = s.vectors[b];
      const double c = (a == b) ? 0.5 : 1.;
      return {{2. * c * v[0] * w[0],
               2. * c * v[1] * w[1],
               2. * c * v[2] * w[2],
               c * root2 * (v[0] * w[1] + v[1] * w[0]),
               c * root2 * (v[0] * w[2] + v[2] * w[0]),
               c * root2 * (v[1] * w[2] + v[2] * w[1])}};
    }

    /** Component 3k+l: factor_ab v_a[k] v_b[l] + factor_ba v_b[k] v_a[l]. */
    std::array<double, 9>
    gradient(const Spectral    &s,
             const unsigned int a,
             const unsigned int b,
             const double       factor_ab,
             const double       factor_ba)
    {
      const auto           &v = s.vectors[a];
      const auto           &w = s.vectors[b];
      std::array<double, 9> g;
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          g[3 * k + l] = factor_ab * v[k] * w[l] + factor_ba * w[k] * v[l];
      return g;
    }

    void
    add_product(Matrix69                    &matrix,
                const Mandel6               &rows,
                const std::array<double, 9> &columns)
    {
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int j = 0; j < 9; ++j)
          matrix[i][j] += rows[i] * columns[j];
    }

    /**
     * dh_ab = shear_ab l_ab + shear_ba l_ba in the eigenbasis, for a pair of
     * different axes: the row of l in the basis of velocity gradients.
     */
    std::array<double, 9>
    strain_gradient(const Increment   &increment,
                    const unsigned int a,
                    const unsigned int b,
                    const double       factor)
    {
      const auto  &B = increment.b.values;
      const double G = factor * half_log_quotient(B[a], B[b]);
      return gradient(increment.b, a, b, G * B[b], G * B[a]);
    }

    /** dh as a linear map of the velocity gradient. */
    Matrix69
    strain_derivative(const Increment &increment)
    {
      Matrix69 P{};
      for (unsigned int a = 0; a < 3; ++a)
        add_product(P,
                    mode(increment.b, a, a),
                    gradient(increment.b, a, a, 1., 0.));
      for (const auto &[a, b, c] : pairs)
        add_product(P,
                    mode(increment.b, a, b),
                    strain_gradient(increment, a, b, 1.));
      return P;
    }

    Matrix69
    product(const Mandel66 &C, const Matrix69 &P)
    {
      Matrix69 T{};
      for (unsigned int i = 0; i < 6; ++i)
        for (unsigned int k = 0; k < 6; ++k)
          for (unsigned int j = 0; j < 9; ++j)
            T[i][j] += C[i][k] * P[k][j];
      return T;
    }

    void
    store(const Matrix69 &T, MaterialResponse &response)
    {
      for (unsigned int k = 0; k < 3; ++k)
        for (unsigned int l = 0; l < 3; ++l)
          {
            auto              &t = response.tangent[k][l];
            const unsigned int j = 3 * k + l;
            t[0][0]              = T[0][j];
            t[1][1]              = T[1][j];
            t[2][2]              = T[2][j];
            t[0][1]              = T[3][j] / root2;
            t[0][2]              = T[4][j] / root2;
            t[1][2]              = T[5][j] / root2;
          }
    }
    /** Directions of the velocity gradient that occur in plane strain: xx, xy,
     * yx, yy, zz. */
    using Matrix45 = std::array<std::array<double, 5>, 4>;

    /**
     * dh in Mandel components xx, yy, zz, xy as a linear map of these
     * directions: of the three pairs of axes only the one in the plane turns.
     */
    Matrix45
    strain_derivative_in_plane(const Increment &increment)
    {
      const unsigned int z = increment.b.normal_axis;
      const unsigned int p = z == 0 ? 1 : 0, r = z == 2 ? 1 : 2;
      const double       c = increment.b.vectors[p][0];
      const double       s = increment.b.vectors[p][1];
      const double B_p = increment.b.values[p], B_r = increment.b.values[r];
      const double G  = half_log_quotient(B_p, B_r);
      const double cc = c * c, ss = s * s, cs = c * s;
      const double G_pr = G * B_r, G_rp = G * B_p;

      // Axes p = (c, s) and r = (-s, c), whose sign cancels
      const double p_p[4]     = {cc, cs, cs, ss};
      const double r_r[4]     = {ss, -cs, -cs, cc};
      const double turning[4] = {-(G_pr + G_rp) * cs,
                                 G_pr * cc - G_rp * ss,
                                 G_rp * cc - G_pr * ss,
                                 (G_pr + G_rp) * cs};
      Matrix45     P{};
      for (unsigned int j = 0; j < 4; ++j)
        {
          P[0][j] = cc * p_p[j] + ss * r_r[j] - 2. * cs * turning[j];
          P[1][j] = ss * p_p[j] + cc * r_r[j] + 2. * cs * turning[j];
          P[3][j] = root2 * (cs * (p_p[j] - r_r[j]) + (cc - ss) * turning[j]);
        }
      P[2][4] = 1.;
      return P;
    }

    /** T = C P, and what turns with the spin of the plane, see
     * structural_tangent(). */
    void
    structural_tangent_in_plane(const Increment             &increment,
                                const SymmetricTensor<2, 3> *V,
                                const Mandel66              &C,
                                MaterialResponse            &response)
    {
      const Matrix45 P = strain_derivative_in_plane(increment);
      Matrix45       T{};
      for (unsigned int i = 0; i < 4; ++i)
        for (unsigned int k = 0; k < 4; ++k)
          for (unsigned int j = 0; j < 5; ++j)
            T[i][j] += C[i][k] * P[k][j];

      if (V != nullptr)
        {
          // Omega A - A Omega for the spin about z, in Mandel components
          const auto turned = [](const SymmetricTensor<2, 3> &A) {
            return std::array<double, 4>{
              {-2. * A[0][1], 2. * A[0][1], 0., root2 * (A[0][0] - A[1][1])}};
          };
          const auto   stress  = turned(response.stress);
          const auto   strain  = turned(increment.strain());
          const double factor  = 1. / ((*V)[0][0] + (*V)[1][1]);
          const double spin[4] = {-(*V)[0][1] * factor,
                                  -(*V)[1][1] * factor,
                                  (*V)[0][0] * factor,
                                  (*V)[0][1] * factor};
          for (unsigned int i = 0; i < 4; ++i)
            {
              const double change = stress[i] - C[i][0] * strain[0] -
                                    C[i][1] * strain[1] - C[i][3] * strain[3];
              for (unsigned int j = 0; j < 4; ++j)
                T[i][j] += change * spin[j];
            }
        }
      const auto store_at = [&](SymmetricTensor<2, 3> &t,
                                const unsigned int     j) {
        t[0][0] = T[0][j];
        t[1][1] = T[1][j];
        t[2][2] = T[2][j];
        t[0][1] = T[3][j] / root2;
      };
      store_at(response.tangent[0][0], 0);
      store_at(response.tangent[0][1], 1);
      store_at(response.tangent[1][0], 2);
      store_at(response.tangent[1][1], 3);
      store_at(response.tangent[2][2], 4);
    }

    bool
    is_plane(const Increment &increment, const MaterialResponse &response)
    {
      return response.plane_strain && increment.b.normal_axis < 3;
    }

    /**
     * The tangent of an isotropic law for velocity gradients in the plane and
     * along its normal, from the same spectral formula: of the three pairs of
     * axes only the one in the plane has a shear.
     */
    void
    isotropic_tangent_in_plane(const Increment         &increment,
                               const PrincipalResponse &principal,
                               MaterialResponse        &response)
    {
      const unsigned int z = increment.b.normal_axis;
      const unsigned int p = z == 0 ? 1 : 0, r = z == 2 ? 1 : 2;
      const double       c = increment.b.vectors[p][0];
      const double       s = increment.b.vectors[p][1];
      const double B_p = increment.b.values[p], B_r = increment.b.values[r];
      const double G  = principal.shear[z] * half_log_quotient(B_p, B_r);
      const double cc = c * c, ss = s * s, cs = c * s;

      // Components xx, yy, zz, xy of the change of stress by a stretch along
      // each axis, and of the shear of the two in the plane
      const auto along = [&](const unsigned int axis) {
        const double &first  = principal.normal[p][axis];
        const double &second = principal.normal[r][axis];
        return std::array<double, 4>{{first * cc + second * ss,
                                      first * ss + second * cc,
                                      principal.normal[z][axis],
                                      (first - second) * cs}};
      };
      const std::array<double, 4> one = along(p), two = along(r),
                                  three = along(z);
      // v_r = (-s, c) up to a sign, which cancels
      const double shear[4]  = {-2. * cs, 2. * cs, 0., cc - ss};
      const double first[4]  = {cc, cs, cs, ss};
      const double second[4] = {ss, -cs, -cs, cc};
      const double G_pr = G * B_r, G_rp = G * B_p;
      const double turning[4] = {-(G_pr + G_rp) * cs,
                                 G_pr * cc - G_rp * ss,
                                 G_rp * cc - G_pr * ss,
                                 (G_pr + G_rp) * cs};
      for (unsigned int k = 0; k < 2; ++k)
        for (unsigned int l = 0; l < 2; ++l)
          {
            const unsigned int j         = 2 * k + l;
            auto              &t         = response.tangent[k][l];
            const auto         component = [&](const unsigned int i) {
              return one[i] * first[j] + two[i] * second[j] +
                     shear[i] * turning[j];
            };
            t[0][0] = component(0);
            t[1][1] = component(1);
            t[2][2] = component(2);
            t[0][1] = component(3);
          }
      auto &t = response.tangent[2][2];
      t[0][0] = three[0];
      t[1][1] = three[1];
      t[2][2] = three[2];
      t[0][1] = three[3];
    }
  } // namespace



  Increment::Increment(const Tensor<2, 3>          &f,
                       const SymmetricTensor<2, 3> &elastic_strain)
  {
    const double det = determinant(f);
    if (!(det > 0.) || !std::isfinite(det))
      throw RunError("Material",
                     "the determinant of the deformation increment is " +
                       std::to_string(det),
                     "it must be positive; reduce the time step");

    // b = F F^T with F = f exp(h_n)
    const Tensor<2, 3>    F = f * Tensor<2, 3>(exp(elastic_strain));
    SymmetricTensor<2, 3> b_trial;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        b_trial[i][j] = F[i] * F[j];
    b = spectral(b_trial);
    if (!(b.values[2] > 0.) || !std::isfinite(b.values[0]))
      throw RunError("Material",
                     "the elastic strain has principal stretches^2 " +
                       std::to_string(b.values[0]) + " ... " +
                       std::to_string(b.values[2]),
                     "they must be positive and finite; reduce the time step");
    for (unsigned int a = 0; a < 3; ++a)
      principal[a] = 0.5 * std::log(b.values[a]);
  }



  void
  isotropic_response(const Increment         &increment,
                     const PrincipalResponse &principal,
                     const bool               need_tangent,
                     MaterialResponse        &response)
  {
    response.stress = compose(principal.stress, increment.b);
    response.energy = principal.energy;
    if (!need_tangent)
      return;
    if (is_plane(increment, response))
      {
        isotropic_tangent_in_plane(increment, principal, response);
        return;
      }

    Matrix69               T{};
    std::array<Mandel6, 3> axes;
    for (unsigned int a = 0; a < 3; ++a)
      axes[a] = mode(increment.b, a, a);
    for (unsigned int b = 0; b < 3; ++b)
      {
        Mandel6 column;
        for (unsigned int i = 0; i < 6; ++i)
          column[i] = principal.normal[0][b] * axes[0][i] +
                      principal.normal[1][b] * axes[1][i] +
                      principal.normal[2][b] * axes[2][i];
        add_product(T, column, gradient(increment.b, b, b, 1., 0.));
      }
    for (const auto &[a, b, c] : pairs)
      add_product(T,
                  mode(increment.b, a, b),
                  strain_gradient(increment, a, b, principal.shear[c]));
    store(T, response);
  }



  void
  general_tangent(const Increment  &increment,
                  const Mandel66   &C,
                  MaterialResponse &response)
  {
    if (is_plane(increment, response))
      structural_tangent_in_plane(increment, nullptr, C, response);
    else
      store(product(C, strain_derivative(increment)), response);
  }



  void
  structural_tangent(const Increment             &increment,
                     const SymmetricTensor<2, 3> &V,
                     const Mandel66              &C,
                     MaterialResponse            &response)
  {
    if (is_plane(increment, response))
      {
        structural_tangent_in_plane(increment, &V, C, response);
        return;
      }
    Matrix69   T    = product(C, strain_derivative(increment));
    const auto spin = polar_spin(V);

    const SymmetricTensor<2, 3> h = increment.strain();
    for (unsigned int m = 0; m < 3; ++m)
      {
        Tensor<1, 3> axis;
        axis[m]              = 1.;
        Mandel6       turned = to_mandel(commutator(axis, response.stress));
        const Mandel6 strain = C * to_mandel(commutator(axis, h));
        for (unsigned int i = 0; i < 6; ++i)
          turned[i] -= strain[i];
        std::array<double, 9> w;
        for (unsigned int k = 0; k < 3; ++k)
          for (unsigned int l = 0; l < 3; ++l)
            w[3 * k + l] = spin[k][l][m];
        add_product(T, turned, w);
      }
    store(T, response);
  }
} // namespace alveolus
