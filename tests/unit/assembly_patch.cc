// SPDX-License-Identifier: LGPL-2.1-or-later
// Assembled forces of distorted meshes: patch test, rigid rotations.
#include "unit_body.h"

#include <deal.II/physics/transformations.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** A linear displacement gives one stress everywhere, in equilibrium. */
  template <int dim>
  void
  check_patch(const std::string &type,
              const Settings    &settings,
              const unsigned int degree,
              const bool         mean_dilatation)
  {
    SCOPED_TRACE(type + ", dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree) +
                 (mean_dilatation ? ", mean dilatation" : ", full"));
    Body<dim> body(make_material(type, settings, dim),
                   degree,
                   dim == 2 ? 4 : 3,
                   mean_dilatation);
    body.distort(true);
    Prestrain prestrain;
    prestrain.strain  = 0.01;
    prestrain.density = 1.;
    prestrain.fabric  = 0.2;
    body.strain(prestrain, true);
    auto &state = body.state;

    Tensor<2, 3> f = Tensor<2, 3>(unit_symmetric_tensor<3>());
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        f[i][j] += body.random(0.05);
    const NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &x) {
        Point<dim> du;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            du[i] += (f[i][j] - (i == j)) * x[j];
        return du;
      });

    typename MechanicsAssembler<dim>::Conditions none;
    MechanicsAssembler<dim> assembler(state, body.regions, none);
    NodalVector             residual = state.configuration.make_vector();
    assembler.begin_step({0., 1.});
    const AssemblyResult result =
      assembler.assemble(increment, AssemblyTarget{residual});
    ASSERT_TRUE(result.good);

    // The material at one point, evaluated directly
    const unsigned int  size = state.history.layout(0).size;
    std::vector<double> record(size);
    MaterialResponse    response;
    body.material->evaluate(
      f, state.history.old_record(0, 0), record.data(), false, response);
    for (unsigned int c = 0; c < body.n_cells(); ++c)
      for (unsigned int q = 0; q < state.history.n_points; ++q)
        for (unsigned int i = 0; i < size; ++i)
          ASSERT_NEAR(state.history.trial_record(c, q)[i], record[i], 1e-13);

    // Force on the face x = 1 of x_n: first Piola-Kirchhoff stress times 1 mm^2
    const Tensor<2, 3> P =
      Tensor<2, 3>(response.stress) * transpose(invert(f)) /
      body.material->volume_ratio(state.history.old_record(0, 0));
    const NodalVector X = state.configuration.initial_positions();
    Tensor<1, dim>    right;
    double            largest = 0., scale = 0.;
    for (const NodeId node : state.nodes.relevant())
      {
        const Point<dim> force = state.nodes.get(residual, node);
        scale                  = std::max(scale, Tensor<1, dim>(force).norm());
        if (!body.at_boundary(state.nodes.get(X, node)))
          largest = std::max(largest, Tensor<1, dim>(force).norm());
      }
    // By virtual work with v_i = x: it vanishes on the face x = 0, and the
    // tractions of the other faces do none in sum.
    for (unsigned int i = 0; i < dim; ++i)
      {
        double work = 0.;
        for (const NodeId node : state.nodes.relevant())
          work += state.nodes.get(residual, node)[i] *
                  state.nodes.get(state.configuration.positions(), node)[0];
        right[i] = work;
        EXPECT_NEAR(right[i], P[i][0], 1e-12 * P.norm());
      }
    EXPECT_LE(largest, 1e-13 * scale);
  }



  template <int dim>
  Tensor<2, dim>
  rotation(const double angle)
  {
    const Tensor<2, 3> R =
      Physics::Transformations::Rotations::rotation_matrix_3d(
        dim == 2 ? Point<3>(0., 0., 1.)
                 : Point<3>(1. / std::sqrt(3.),
                            1. / std::sqrt(3.),
                            1. / std::sqrt(3.)),
        angle);
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = R[i][j];
    return result;
  }



  /**
   * A body turned by 360 degrees in twelve steps: forces of an unstressed one
   * and deviation of the co-rotated strain of a prestrained one.
   */
  template <int dim>
  void
  check_rotation(const std::string &type,
                 const Settings    &settings,
                 const double       young,
                 const Prestrain   &prestrain)
  {
    SCOPED_TRACE(type + ", dim " + std::to_string(dim));
    Body<dim> body(make_material(type, settings, dim), 1, 2);
    body.distort(false);
    body.strain(prestrain, true);
    auto      &state  = body.state;
    const auto before = state.history.old_values;
    const int  fabric = state.history.layout(0).offset("log fabric");
    Point<dim> centre;
    centre[0]              = 3.;
    const Tensor<2, dim> R = rotation<dim>(numbers::PI / 6.);
    typename MechanicsAssembler<dim>::Conditions none;
    MechanicsAssembler<dim> assembler(state, body.regions, none);
    NodalVector             residual = state.configuration.make_vector();
    double                  largest  = 0.;
    for (unsigned int step = 1; step <= 12; ++step)
      {
        const NodalVector increment =
          body.nodal([&](const Point<dim> &, const Point<dim> &x) {
            return Point<dim>(R * (x - centre) - (x - centre));
          });
        assembler.begin_step({0., 1.});
        ASSERT_TRUE(
          assembler.assemble(increment, AssemblyTarget{residual}).good);
        largest = std::max(largest, residual.linfty_norm());
        state.configuration.move(increment);
        state.history.commit();

        const Tensor<2, dim> turn = rotation<dim>(step * numbers::PI / 6.);
        Tensor<2, 3>         Q    = Tensor<2, 3>(unit_symmetric_tensor<3>());
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            Q[i][j] = turn[i][j];
        const auto turned = [&](const double *values) {
          return symmetrize(Q * Tensor<2, 3>(unpack(values, dim)) *
                            transpose(Q));
        };
        for (unsigned int c = 0; c < body.n_cells(); ++c)
          for (unsigned int q = 0; q < state.history.n_points; ++q)
            {
              const std::size_t first =
                state.history.old_record(c, q) - &state.history.old_values[0];
              ASSERT_LE((unpack(state.history.old_record(c, q), dim) -
                         turned(&before[first]))
                          .norm(),
                        1e-12);
              if (fabric >= 0)
                {
                  ASSERT_LE((unpack(state.history.old_record(c, q) + fabric,
                                    dim) -
                             turned(&before[first + fabric]))
                              .norm(),
                            1e-10);
                }
            }
      }
    if (prestrain.strain == 0.)
      {
        EXPECT_LE(largest, 1e-12 * young);
      }
  }
} // namespace



TEST(PatchTest, LinearDisplacementGivesOneStress)
{
  for (const bool mean_dilatation : {false, true})
    for (const unsigned int degree : {1, 2})
      {
        const Settings neo = {{"Shear modulus", "80"}, {"Bulk modulus", "400"}};
        check_patch<2>("neo-Hookean", neo, degree, mean_dilatation);
        check_patch<3>("neo-Hookean", neo, degree, mean_dilatation);
        check_patch<2>("remodelled bone", {}, degree, mean_dilatation);
        check_patch<3>("remodelled bone", {}, degree, mean_dilatation);
      }
}



TEST(RigidRotation, MakesNoStressAndTurnsWhatThereIs)
{
  const Settings hencky = {{"Young's modulus", "1000"}};
  check_rotation<2>("Hencky elastic", hencky, 1000., {});
  check_rotation<3>("Hencky elastic", hencky, 1000., {});
  Prestrain prestrain;
  prestrain.density = 0.9;
  prestrain.fabric  = 0.25;
  check_rotation<2>("remodelled bone", {}, 13750., prestrain);
  check_rotation<3>("remodelled bone", {}, 13750., prestrain);
  prestrain.strain = 0.003;
  check_rotation<2>("remodelled bone", {}, 13750., prestrain);
  check_rotation<3>("remodelled bone", {}, 13750., prestrain);
}
