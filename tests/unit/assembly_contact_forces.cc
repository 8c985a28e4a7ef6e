// SPDX-License-Identifier: LGPL-2.1-or-later
// Forces of contact without a solver: the matrix against differences, balance,
// no attraction, multipliers on another mesh.
#include "contact_bodies.h"
#include "dense_system.h"

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** A block with a kinked top and a soft one pressed into it, 3 to 2 lines. */
  std::unique_ptr<Bodies>
  pressed_blocks(const unsigned int degree)
  {
    Blocks blocks;
    blocks.add("hard", 3, 1, [](const double s, const double t) {
      return Point<2>(3. * s, t * (1. + 0.03 * std::sin(5. * s)));
    });
    blocks.add("soft", 2, 1, [](const double s, const double t) {
      return Point<2>(0.4 + 2. * s, 1.04 + t + 0.02 * std::cos(3. * s));
    });
    return std::make_unique<Bodies>(blocks.build(),
                                    std::vector<double>{100., 1.},
                                    0.3,
                                    degree);
  }



  /** Relative deviation of a condition's matrix from force differences. */
  double
  stiffness_error(const State<2> &state,
                  Condition<2>   &condition,
                  NodalVector    &increment)
  {
    const unsigned int n = state.configuration.dof_handler.n_dofs();
    DenseSystem        system(n);
    NodalVector        forces = state.configuration.make_vector();
    condition.add_forces(state, increment, AssemblyTarget{forces, &system});
    const auto evaluate = [&]() {
      NodalVector result = state.configuration.make_vector();
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
    EXPECT_GT(system.matrix.linfty_norm(), 1.);
    return largest / system.matrix.linfty_norm();
  }
} // namespace



// With multipliers from a former step, in the middle of a step: the matrix is
// the derivative; forces and moments of both sides add to zero.
TEST(Contact, MatrixIsTheDerivativeAndForcesAreInBalance)
{
  for (const unsigned int degree : {1, 2})
    for (const std::string friction : {"none", "sticking"})
      {
        SCOPED_TRACE("degree " + std::to_string(degree) + ", " + friction);
        const auto bodies  = pressed_blocks(degree);
        auto      &state   = *bodies->state;
        auto      &contact = bodies->add("contact",
                                    {{"On", "soft bottom"},
                                          {"Against", "hard top"},
                                          {"Stiffness", "20"},
                                          {"Penetration tolerance", "1e-3"},
                                          {"Search distance", "0.8"},
                                          {"Friction", friction}});
        contact.begin_step(state, {0., 1.});
        NodalVector first  = bodies->nodal("soft", [](const Point<2> &) {
          return Point<2>(0.02, -0.12);
        });
        NodalVector forces = state.configuration.make_vector();
        contact.add_forces(state, first, AssemblyTarget{forces});
        EXPECT_TRUE(contact.augment(state, first));
        contact.add_forces(state, first, AssemblyTarget{forces});
        state.accept(first);
        contact.commit();

        contact.begin_step(state, {1., 2.});
        std::mt19937                           generator(4711);
        std::uniform_real_distribution<double> random(-0.01, 0.01);
        NodalVector second = bodies->nodal("soft", [&](const Point<2> &) {
          return Point<2>(0.05 + random(generator), 0.02 + random(generator));
        });
        second += bodies->nodal("hard", [&](const Point<2> &) {
          return Point<2>(random(generator), random(generator));
        });
        EXPECT_LE(stiffness_error(state, contact, second), 1e-7);

        forces = 0.;
        contact.add_forces(state, second, AssemblyTarget{forces});
        const NodalVector x = state.configuration.positions();
        Tensor<1, 2>      sum;
        double            moment = 0., scale = 0.;
        for (const NodeId node : state.nodes.relevant())
          {
            const Point<2>     f = state.nodes.get(forces, node);
            const Tensor<1, 2> arm =
              state.nodes.get(x, node) +
              Tensor<1, 2>(state.nodes.get(second, node));
            sum += Tensor<1, 2>(f);
            moment += arm[0] * f[1] - arm[1] * f[0];
            scale += Tensor<1, 2>(f).norm();
          }
        EXPECT_GT(scale, 1.);
        EXPECT_LE(sum.norm(), 1e-14 * scale);
        EXPECT_LE(std::abs(moment), 1e-14 * scale);
      }
}



// Bodies that part: no force at all, whatever the multipliers
TEST(Contact, DoesNotAttract)
{
  const auto  bodies  = pressed_blocks(1);
  auto       &state   = *bodies->state;
  auto       &contact = bodies->add("contact",
                              {{"On", "soft bottom"},
                                     {"Against", "hard top"},
                                     {"Stiffness", "20"},
                                     {"Search distance", "0.8"}});
  NodalVector forces  = state.configuration.make_vector();
  for (const double lift : {-0.1, 0.2})
    {
      const NodalVector increment =
        bodies->nodal("soft",
                      [&](const Point<2> &) { return Point<2>(0., lift); });
      contact.begin_step(state, {0., 1.});
      forces = 0.;
      contact.add_forces(state, increment, AssemblyTarget{forces});
      if (lift < 0.)
        EXPECT_GT(forces.linfty_norm(), 0.1);
      else
        EXPECT_EQ(forces.linfty_norm(), 0.);
      state.accept(increment);
      contact.commit();
    }
}



// Multipliers are functions of the place on the outline: another mesh of it
// gets the same forces.
TEST(Contact, MultipliersPassToAnotherMesh)
{
  const auto make_bodies = [](const unsigned int n) {
    Blocks blocks;
    blocks.add("lower", 3, 1, Point<2>(0., 0.), Point<2>(3., 1.));
    blocks.add("upper", n, 1, Point<2>(0., 1.), Point<2>(3., 2.));
    return std::make_unique<Bodies>(blocks.build(),
                                    std::vector<double>{1., 1.},
                                    0.3,
                                    1);
  };
  const Settings settings = {{"On", "upper bottom"},
                             {"Against", "lower top"},
                             {"Stiffness", "10"}};
  const auto     coarse = make_bodies(3), fine = make_bodies(7);
  auto          &old = coarse->add("contact", settings);
  auto          &now = fine->add("contact", settings);

  // Turn the underside of the upper block into the lower one, by 0.1 x.
  NodalVector increment = coarse->state->configuration.make_vector();
  for (const NodeId node :
       coarse->state->nodes.boundary("upper bottom", "test"))
    coarse->state->nodes.set(
      increment,
      node,
      Point<2>(0.,
               -0.1 *
                 coarse->state->nodes.get(
                   coarse->state->configuration.initial_positions(), node)[0]));
  NodalVector forces = coarse->state->configuration.make_vector();
  old.begin_step(*coarse->state, {0., 1.});
  old.add_forces(*coarse->state, increment, AssemblyTarget{forces});
  EXPECT_NEAR(coarse->recorded(old, "force y [N]"), 4.5, 1e-12);
  EXPECT_NEAR(coarse->recorded(old, "centre x [mm]"), 2., 1e-12);
  old.commit();

  // On the fine mesh, just touching: the pressure x/sqrt(1.01) of the line
  // that has become longer, and no more.
  now.take_over(old);
  forces    = fine->state->configuration.make_vector();
  increment = forces;
  now.begin_step(*fine->state, {1., 2.});
  now.add_forces(*fine->state, increment, AssemblyTarget{forces});
  EXPECT_NEAR(fine->recorded(now, "force y [N]"), 4.5 / std::sqrt(1.01), 1e-12);
  EXPECT_NEAR(fine->recorded(now, "centre x [mm]"), 2., 1e-12);
}
