// SPDX-License-Identifier: LGPL-2.1-or-later
// Load stiffness of pressure and interface against differences of forces;
// resultants.
#include "dense_system.h"
#include "unit_body.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** Relative deviation of a condition's matrix from force differences. */
  template <int dim>
  double
  stiffness_error(const State<dim> &state,
                  Condition<dim>   &condition,
                  NodalVector      &increment)
  {
    const unsigned int n = state.configuration.dof_handler.n_dofs();
    DenseSystem        system(n);
    NodalVector        forces = state.configuration.make_vector();
    forces                    = 0.;
    condition.add_forces(state, increment, AssemblyTarget{forces, &system});
    const auto evaluate = [&]() {
      NodalVector result = state.configuration.make_vector();
      result             = 0.;
      condition.add_forces(state, increment, AssemblyTarget{result});
      return result;
    };
    double largest = 0.;
    for (unsigned int b = 0; b < n; ++b)
      {
        const double h = 1e-6, middle = increment(b);
        increment(b)        = middle + h;
        const NodalVector p = evaluate();
        increment(b)        = middle - h;
        const NodalVector m = evaluate();
        increment(b)        = middle;
        for (unsigned int a = 0; a < n; ++a)
          largest =
            std::max(largest,
                     std::abs(system.matrix(a, b) - (p(a) - m(a)) / (2. * h)));
      }
    return largest / system.matrix.linfty_norm();
  }



  template <int dim>
  void
  check_pressure(const unsigned int degree)
  {
    SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree));
    Body<dim> body(make_material("Hencky elastic", {}, dim),
                   degree,
                   dim == 2 ? 2 : 1);
    body.distort(false);
    auto &state = body.state;
    auto  pressure =
      make<Condition<dim>>("pressure", {{"On", "all"}, {"Function", "3*t"}});
    pressure->attach(state, "Conditions / pressure");
    pressure->begin_step(state, {0., 2.});
    NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &) {
        Point<dim> du;
        for (unsigned int d = 0; d < dim; ++d)
          du[d] = body.random(0.05 / degree);
        return du;
      });
    EXPECT_LE(stiffness_error(state, *pressure, increment), 1e-8);

    // Pressure on a closed surface has no resultant; its work in v = x is
    // p dim V of the deformed body, with the sign of a load from outside.
    NodalVector forces = state.configuration.make_vector();
    forces             = 0.;
    pressure->add_forces(state, increment, AssemblyTarget{forces});
    StepGeometry<dim> geometry(state.configuration);
    const NodalVector x_n = state.configuration.positions();
    Tensor<1, dim>    resultant;
    double            work = 0.;
    for (const NodeId node : state.nodes.relevant())
      {
        resultant += state.nodes.get(forces, node);
        const Tensor<1, dim> x =
          state.nodes.get(x_n, node) +
          Tensor<1, dim>(state.nodes.get(increment, node));
        work += x * Tensor<1, dim>(state.nodes.get(forces, node));
      }
    state.configuration.move(increment);
    geometry.update();
    double volume = 0.;
    for (unsigned int c = 0; c < body.n_cells(); ++c)
      for (unsigned int q = 0; q < geometry.n_points; ++q)
        volume += geometry.weights(c)[q];
    EXPECT_LE(resultant.norm(), 1e-13);
    EXPECT_NEAR(work, 6. * dim * volume, 1e-12);
  }



  template <int dim>
  void
  check_interface(const unsigned int degree)
  {
    SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree));
    Body<dim> body(make_material("Hencky elastic", {}, dim),
                   degree,
                   dim == 2 ? 2 : 1);
    body.distort(false);
    auto         &state = body.state;
    InterfaceLaws laws;
    laws["layer"] = make<InterfaceLaw>(
      "ligament",
      {{"Thickness", "0.2"},
       {"Table file", ALVEOLUS_SOURCE_DIR "/prm/tables/ligament-table-2.csv"}});
    laws["layer"]->initialize("Interfaces / layer", "/");
    auto tooth = make<Condition<dim>>(
      "rigid body",
      {{"On", "right"},
       {"Motion", dim == 2 ? "0.03*t; 0.02*t" : "0.03*t; 0.02*t; -0.01*t"},
       {"Rotation", "2*t"},
       {"Centre", "1, 0.5, 0.5"},
       {"Attachment", "layer"}});
    tooth->choose_interface_law(laws, "Conditions / tooth");
    tooth->attach(state, "Conditions / tooth");
    for (double &jump : tooth->face_history()->old_values)
      jump = body.random(0.03);
    tooth->begin_step(state, {1., 2.});
    NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &) {
        Point<dim> du;
        for (unsigned int d = 0; d < dim; ++d)
          du[d] = body.random(0.01);
        return du;
      });
    EXPECT_LE(stiffness_error(state, *tooth, increment), 1e-7);

    // What the body exerts is what the boundary receives.
    NodalVector forces = state.configuration.make_vector();
    forces             = 0.;
    tooth->add_forces(state, increment, AssemblyTarget{forces});
    Tensor<1, dim> received;
    for (const NodeId node : state.nodes.relevant())
      received -= Tensor<1, dim>(state.nodes.get(forces, node));
    const auto recorded = tooth->record(state, forces);
    ASSERT_EQ(recorded[1].first, "force x [N]");
    for (unsigned int d = 0; d < dim; ++d)
      EXPECT_NEAR(recorded[1 + d].second, received[d], 1e-13);
    EXPECT_GT(received.norm(), 1e-4);
  }
} // namespace



TEST(Pressure, LoadStiffnessIsTheDerivative)
{
  for (const unsigned int degree : {1, 2})
    {
      check_pressure<2>(degree);
      check_pressure<3>(degree);
    }
}



TEST(Interface, MatrixIsTheDerivative)
{
  for (const unsigned int degree : {1, 2})
    {
      check_interface<2>(degree);
      check_interface<3>(degree);
    }
}
