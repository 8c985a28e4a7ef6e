// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact at a corner that both bodies share: a wedge that closes, a sharp
// crest, a block squeezed against a wall.
#include "contact_bodies.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** A wall with a soft block grown onto its lower half; rim at y = 0. */
  Blocks
  wall_and_block(const double width, const unsigned int n_x)
  {
    Blocks blocks;
    blocks.add("soft", n_x, 8, Point<2>(0., -1.), Point<2>(width, 0.));
    blocks.add("wall", 1, 16, Point<2>(-0.5, -1.), Point<2>(0., 1.));
    blocks.weld();
    return blocks;
  }
} // namespace



// The rim of a soft block turns about the corner that it shares with the wall:
// nothing happens until the angle between rim and wall is closed; then the
// moment about the corner is that of the pressure e r sin(a) on the length 1.
TEST(Contact, WedgeClosesAtItsCorner)
{
  Bodies      bodies(wall_and_block(1., 4).build(), {1., 1.}, 0.3, 1);
  auto       &state   = *bodies.state;
  auto       &contact = bodies.add("contact",
                             {{"On", "soft top"},
                                    {"Against", "wall right"},
                                    {"Stiffness", "30"},
                                    {"Search distance", "0.6"}});
  NodalVector forces  = state.configuration.make_vector();
  const auto  rim     = state.nodes.boundary("soft top", "test");
  double      was     = 90.;
  // Degrees between rim and wall; more than 90 is below the horizontal.
  for (const double angle : {120., 175., 80., 30., 5., 0.01, -0.5, -2., 10.})
    {
      const double a         = angle * numbers::PI / 180.;
      NodalVector  increment = state.configuration.make_vector();
      const auto   X         = state.configuration.initial_positions();
      for (const NodeId node : rim)
        {
          const double r = state.nodes.get(X, node)[0];
          state.nodes.set(increment,
                          node,
                          Point<2>(r * std::sin(a), r * std::cos(a)) -
                            Tensor<1, 2>(state.nodes.get(
                              state.configuration.positions(), node)));
        }
      forces = 0.;
      contact.begin_step(state, {0., 1.});
      contact.add_forces(state, increment, AssemblyTarget{forces});
      if (angle > 0.)
        {
          EXPECT_EQ(forces.linfty_norm(), 0.) << was << " to " << angle;
        }
      else
        {
          double moment = 0.; // of the rim's forces on the wall
          for (const NodeId node : rim)
            {
              const double   r = state.nodes.get(X, node)[0];
              const Point<2> f = state.nodes.get(forces, node);
              moment += r * (std::sin(a) * f[1] - std::cos(a) * f[0]);
            }
          EXPECT_NEAR(moment, -30. * std::sin(a) * std::cos(a) / 3., 1e-12)
            << angle;
          EXPECT_NEAR(bodies.recorded(contact, "length [mm]"), 1., 0.1);
          EXPECT_NEAR(bodies.recorded(contact, "penetration of lines [mm]"),
                      -std::sin(a),
                      1e-12);
        }
      state.accept(increment);
      was = angle;
    }
}



// The edge of a soft body that sinks away from a corner it shares with a hard
// one, up to where the wedge of material between them is narrower than a right
// angle and its points lie behind the outer slope: no contact.
TEST(Contact, NoneOverASharpCrest)
{
  Blocks blocks;
  blocks.add("bone", 4, 4, Point<2>(-1., -1.), Point<2>(0., 0.));
  blocks.add("soft", 4, 4, Point<2>(0., -1.), Point<2>(1., 0.));
  blocks.weld();
  Bodies      bodies(blocks.build(), {1., 1.}, 0.3, 1);
  auto       &state   = *bodies.state;
  auto       &contact = bodies.add("contact",
                             {{"On", "soft top"},
                                    {"Against", "bone top"},
                                    {"Search distance", "0.6"}});
  NodalVector forces  = state.configuration.make_vector();
  const auto  X       = state.configuration.initial_positions();
  // Degrees between bone top and soft top through the space above them
  for (const double angle : {200., 240., 265., 275., 290., 305., 280.})
    {
      const double a         = (180. - angle) * numbers::PI / 180.;
      NodalVector  increment = state.configuration.make_vector();
      for (const NodeId node : state.nodes.boundary("soft top", "test"))
        {
          const double r = state.nodes.get(X, node)[0];
          state.nodes.set(increment,
                          node,
                          Point<2>(r * std::cos(a), r * std::sin(a)) -
                            Tensor<1, 2>(state.nodes.get(
                              state.configuration.positions(), node)));
        }
      forces = 0.;
      contact.begin_step(state, {0., 1.});
      contact.add_forces(state, increment, AssemblyTarget{forces});
      EXPECT_EQ(forces.linfty_norm(), 0.) << angle;
      EXPECT_FALSE(contact.augment(state, increment));
      EXPECT_EQ(bodies.recorded(contact, "penetration of lines [mm]"), 0.);
      EXPECT_EQ(bodies.recorded(contact, "penetration of opposite nodes [mm]"),
                0.);
      state.accept(increment);
    }
}



// The same corner in equilibrium: the wall goes down and squeezes the block,
// which rolls its rim onto it, with and without friction. Without contact it
// goes through the wall.
TEST(Contact, SqueezedBlockLeansAgainstTheWall)
{
  const auto squeeze = [](const unsigned int degree,
                          const Settings    &settings,
                          const double       limit) {
    Bodies bodies(wall_and_block(0.5, 8 / degree).build(),
                  {0.07, 100.},
                  0.4,
                  degree);
    bodies.add("displacement", {{"On", "soft right"}});
    bodies.add("displacement",
               {{"On", "wall left"}, {"Function", "0.2*t; -0.55*t"}});
    Settings all = {{"On", "soft top"},
                    {"Against", "wall right"},
                    {"Stiffness", "300"}};
    all.insert(all.end(), settings.begin(), settings.end());
    auto &contact = bodies.add("contact", all);
    bodies.start();
    unsigned int n_iterations = 0, n_augmentations = 0;
    for (unsigned int i = 1; i <= 20; ++i)
      {
        bodies.step(0.05 * i);
        n_iterations += bodies.report.n_iterations;
        n_augmentations += bodies.report.n_augmentations;
        for (const std::string side : {"penetration of lines [mm]",
                                       "penetration of opposite nodes [mm]"})
          EXPECT_LE(bodies.recorded(contact, side), limit) << i;
      }
    const double length = bodies.recorded(contact, "length [mm]");
    const double x      = bodies.recorded(contact, "force x [N]");
    const double y      = bodies.recorded(contact, "force y [N]");
    std::cout << "Squeezed block, degree " << degree << ": length " << length
              << " mm, force " << x << ", " << y << " N/mm, penetration "
              << bodies.recorded(contact, "penetration of lines [mm]") << ", "
              << bodies.recorded(contact, "penetration of opposite nodes [mm]")
              << " mm; " << n_iterations << " iterations, " << n_augmentations
              << " augmentations in 20 steps" << std::endl;
    return std::array<double, 3>{
      {length,
       std::abs(y / x),
       bodies.recorded(contact, "penetration of lines [mm]")}};
  };
  for (const unsigned int degree : {1, 2})
    {
      const auto smooth = squeeze(degree, {}, 2e-3);
      EXPECT_GT(smooth[0], 0.1);
      EXPECT_LT(smooth[1], 0.02); // the wall stays nearly upright
      const auto rough = squeeze(degree, {{"Friction", "sticking"}}, 2e-3);
      EXPECT_GT(rough[0], 0.1);
      EXPECT_GT(rough[1], 0.05);
    }
  // A tolerance that nothing exceeds, and hardly any stiffness, is no contact.
  EXPECT_GT(squeeze(1,
                    {{"Stiffness", "1e-9"}, {"Penetration tolerance", "10"}},
                    1.)[2],
            0.03);
}
