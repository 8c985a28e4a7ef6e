// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact in equilibrium: the patch test on meshes that do not match, steps
// that are given up, a sliding body, rough contact against a tied body, Hertz'
// line contact.
#include "contact_bodies.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  /** Two blocks of 3 mm on rollers, 3 lines against 5, under a pressure. */
  std::unique_ptr<Bodies>
  stacked_blocks(const unsigned int         degree,
                 const std::vector<double> &young,
                 const Settings            &settings)
  {
    Blocks blocks;
    blocks.add("lower", 3, 2, Point<2>(0., 0.), Point<2>(3., 1.));
    blocks.add("upper", 5, 2, Point<2>(0., 1.), Point<2>(3., 2.));
    auto bodies = std::make_unique<Bodies>(blocks.build(), young, 0.3, degree);
    bodies->add("displacement",
                {{"On", "lower left, upper left"}, {"Components", "x"}});
    bodies->add("displacement", {{"On", "lower bottom"}, {"Components", "y"}});
    bodies->add("pressure", {{"On", "upper top"}, {"Function", "min(t, 1)"}});
    Settings all = {{"On", "upper bottom"},
                    {"Against", "lower top"},
                    {"Stiffness", "100"}};
    all.insert(all.end(), settings.begin(), settings.end());
    bodies->add("contact", all);
    bodies->start();
    return bodies;
  }



  /** Largest difference of strain between the points of a region. */
  double
  nonuniformity(Bodies &bodies, const unsigned int region)
  {
    double             largest = 0.;
    const auto        &history = bodies.state->history;
    const unsigned int size    = history.layout(region).size;
    const double      *first   = nullptr;
    for (unsigned int c = 0; c < bodies.mesh.triangulation->n_active_cells();
         ++c)
      if (history.region(c) == region)
        for (unsigned int q = 0; q < history.n_points; ++q)
          {
            const double *record = history.old_record(c, q);
            if (first == nullptr)
              first = record;
            for (unsigned int i = 0; i < size; ++i)
              largest = std::max(largest, std::abs(record[i] - first[i]));
          }
    return largest;
  }
} // namespace



// The contact patch test: a pressure goes through lines that do not match
// without any disturbance, with straight and with curved lines, with and
// without augmentation. Penetration is the pressure over the stiffness where
// nothing is augmented, below the tolerance where it is.
TEST(Contact, PatchTest)
{
  for (const unsigned int degree : {1, 2})
    for (const bool augmented : {false, true})
      {
        SCOPED_TRACE("degree " + std::to_string(degree) +
                     (augmented ? ", augmented" : ", penalty"));
        const auto bodies =
          stacked_blocks(degree,
                         {10., 10.},
                         {{"Penetration tolerance", augmented ? "1e-9" : "1"}});
        const auto &contact = *bodies->conditions.back();
        bodies->step(1.);
        for (const unsigned int region : {0, 1})
          EXPECT_LE(nonuniformity(*bodies, region), 1e-11);
        // The pressure acts on the deformed width.
        const double width = bodies->recorded(contact, "length [mm]");
        EXPECT_GT(width, 3.01);
        EXPECT_NEAR(bodies->recorded(contact, "force y [N]"), width, 1e-10);
        EXPECT_NEAR(bodies->recorded(contact, "greatest pressure [MPa]"),
                    1.,
                    1e-10);
        for (const std::string side : {"penetration of lines [mm]",
                                       "penetration of opposite nodes [mm]"})
          {
            const double penetration = bodies->recorded(contact, side);
            if (augmented)
              EXPECT_LE(penetration, 1e-9);
            else // p is counted per line of x_n
              EXPECT_NEAR(penetration, 0.01 * width / 3., 1e-10);
          }
        EXPECT_EQ(bodies->recorded(contact, "augmentations") > 0., augmented);
      }
}



// An attempt that is given up leaves no trace.
TEST(Contact, RejectedStepsLeaveNoTrace)
{
  std::vector<NodalVector> results;
  for (const bool detour : {false, true})
    {
      const auto bodies =
        stacked_blocks(1, {10., 10.}, {{"Penetration tolerance", "1e-6"}});
      bodies->step(0.3);
      if (detour)
        {
          EXPECT_EQ(bodies->attempt(0.9), "");
        }
      bodies->step(0.6);
      results.push_back(bodies->state->displacement);
    }
  results[0] -= results[1];
  EXPECT_EQ(results[0].linfty_norm(), 0.);
}



// Matrix entries beyond the cells' follow the contact where it goes.
TEST(Contact, MatrixFollowsASlidingBody)
{
  Blocks blocks;
  blocks.add("rail", 20, 1, Point<2>(0., 0.), Point<2>(20., 1.));
  blocks.add("slider", 6, 1, [](const double s, const double t) {
    const double x = 2. * s - 1.;
    return Point<2>(2. + x, 1. + (1. - t) * 0.3 * x * x + t);
  });
  Bodies bodies(blocks.build(), {10., 10.}, 0.3, 1);
  bodies.add("displacement", {{"On", "rail bottom"}});
  bodies.add("displacement",
             {{"On", "slider top"}, {"Function", "t; -0.1*min(t, 1)"}});
  auto &contact = bodies.add("contact",
                             {{"On", "slider bottom"},
                              {"Against", "rail top"},
                              {"Stiffness", "5000"},
                              {"Search distance", "0.6"}});
  bodies.start();
  const unsigned int revision = contact.couplings_revision();
  double             force    = 0.;
  for (unsigned int i = 1; i <= 60; ++i)
    {
      bodies.step(0.25 * i);
      if (i == 12)
        force = bodies.recorded(contact, "force y [N]");
      EXPECT_LE(bodies.recorded(contact, "penetration of lines [mm]"), 1.01e-3);
      EXPECT_LE(bodies.recorded(contact, "penetration of opposite nodes [mm]"),
                1.01e-3);
    }
  EXPECT_GT(contact.couplings_revision(), revision + 5);
  EXPECT_GT(force, 0.5);
  // The rail is the same everywhere but at its ends: 12 lines on.
  EXPECT_NEAR(bodies.recorded(contact, "force y [N]") / force, 1., 1e-2);
}



// Rough contact under pressure is a welded joint; multipliers of both
// directions make it one to within the tolerance.
TEST(Contact, StickingUnderPressureIsWelded)
{
  std::vector<double> tips;
  for (const bool welded : {true, false})
    {
      Blocks blocks;
      blocks.add("lower", 6, 2, Point<2>(-0.5, 0.), Point<2>(2.5, 1.));
      blocks.add("upper", 4, 2, Point<2>(0., 1.), Point<2>(2., 2.));
      if (welded)
        blocks.weld();
      Bodies bodies(blocks.build(), {20., 10.}, 0.3, 1);
      bodies.add("displacement", {{"On", "lower bottom"}});
      bodies.add("displacement",
                 {{"On", "upper top"},
                  {"Function", "0.05*max(t - 1, 0); -0.1*min(t, 1)"}});
      Condition<2> *contact = nullptr;
      if (!welded)
        contact = &bodies.add("contact",
                              {{"On", "upper bottom"},
                               {"Against", "lower top"},
                               {"Stiffness", "300"},
                               {"Augmentations", "60"},
                               {"Friction", "sticking"},
                               {"Penetration tolerance", "1e-7"}});
      bodies.start();
      // The first touch is without friction: let it be a light one.
      for (const double t : {1e-4, 1., 1.5, 2.})
        bodies.step(t);
      double tip = 0.;
      for (const NodeId node : bodies.state->nodes.relevant())
        if (bodies.state->nodes
              .get(bodies.state->configuration.initial_positions(), node)
              .distance(Point<2>(2., 1.)) < 1e-9)
          tip = bodies.state->nodes.get(bodies.state->displacement, node)[0];
      tips.push_back(tip);
      if (contact != nullptr)
        {
          EXPECT_LT(bodies.recorded(*contact, "force x [N]"), -0.1);
          EXPECT_NEAR(bodies.recorded(*contact, "length [mm]"), 2., 0.1);
        }
    }
  EXPECT_GT(tips[0], 0.01);
  EXPECT_NEAR(tips[0], tips[1], 3e-6);
}



namespace
{
  struct HertzErrors
  {
    double pressure, width, centre;
  };

  /**
   * A stiff cylinder on an elastic block, half of it: relative errors of the
   * greatest pressure, half-width and centre of pressure against Hertz' at the
   * force of the solution (K. L. Johnson, Contact Mechanics, 1985, section
   * 4.2): b^2 = 4 P R/(pi E*), p = 2 P/(pi b) (1 - x^2/b^2)^(1/2).
   */
  HertzErrors
  hertz(const unsigned int n, const unsigned int degree)
  {
    const double R = 100., E = 1000., nu = 0.3, hard = 1e3;
    // Two thirds of the lines are equal ones, the others grow outwards.
    const auto graded =
      [](const double s, const double fine, const double all) {
        return s < 2. / 3. ? fine * 1.5 * s
                           : fine * std::pow(all / fine, 3. * (s - 2. / 3.));
      };
    Blocks blocks;
    blocks.add("block", n, n, [=](const double s, const double t) {
      return Point<2>(graded(s, 0.8, 20.), -graded(1. - t, 0.8, 20.));
    });
    blocks.add("cylinder", n, n / 2, [=](const double s, const double t) {
      const double angle = graded(s, 1., 4.) / R;
      const double r     = R - graded(t, 0.8, 8.);
      return Point<2>(r * std::sin(angle), R - r * std::cos(angle));
    });
    Bodies bodies(blocks.build(), {E, hard * E}, nu, degree);
    bodies.add("displacement",
               {{"On", "block left, cylinder left, block right"},
                {"Components", "x"}});
    bodies.add("displacement", {{"On", "block bottom"}, {"Components", "y"}});
    bodies.add("displacement",
               {{"On", "cylinder top"},
                {"Components", "y"},
                {"Function", "-0.0035*t"}});
    auto &contact = bodies.add("contact",
                               {{"On", "block top"},
                                {"Against", "cylinder bottom"},
                                {"Stiffness", "1e5"},
                                {"Search distance", "0.2"},
                                {"Penetration tolerance", "1e-7"}});
    bodies.start();
    // Round-off of the stiff cylinder stops Newton's method at 1e-9.
    bodies.parameters.tolerance = 1e-8;
    for (unsigned int i = 1; i <= 4; ++i)
      bodies.step(0.25 * i);

    const double P = -2. * bodies.recorded(contact, "force y [N]");
    const double stiffness =
      E / (1. - nu * nu) / (1. + 1. / hard); // E*, of both bodies
    const double b = std::sqrt(4. * P * R / (numbers::PI * stiffness));
    HertzErrors  errors{bodies.recorded(contact, "greatest pressure [MPa]") /
                           (2. * P / (numbers::PI * b)) -
                         1.,
                       bodies.recorded(contact, "length [mm]") / b - 1.,
                       bodies.recorded(contact, "centre x [mm]") /
                           (4. * b / (3. * numbers::PI)) -
                         1.};
    std::cout << "Hertz, " << n << " lines, degree " << degree << ": P = " << P
              << " N, b = " << b << " mm = " << b * n / 1.2
              << " lines; relative errors: pressure " << errors.pressure
              << ", width " << errors.width << ", centre " << errors.centre
              << "; " << bodies.report.n_iterations << " iterations, "
              << bodies.report.n_augmentations << " augmentations" << std::endl;
    return errors;
  }
} // namespace



// Half the width of contact is 8 and 16 lines of the block: the ends of contact
// are known to a fraction of one, pressures and their centre better.
TEST(Contact, HertzLineContact)
{
  const HertzErrors coarse = hertz(24, 1), fine = hertz(48, 1),
                    quadratic = hertz(24, 2);
  for (const auto &errors : {coarse, fine, quadratic})
    {
      EXPECT_LT(std::abs(errors.pressure), 0.01);
      EXPECT_LT(std::abs(errors.width), 0.03);
      EXPECT_LT(std::abs(errors.centre), 0.01);
    }
  EXPECT_LT(std::abs(fine.pressure), 0.6 * std::abs(coarse.pressure));
  EXPECT_LT(std::abs(fine.centre), 0.6 * std::abs(coarse.centre));
}
