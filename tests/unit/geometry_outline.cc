// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Divisions of lines by size, outlines from files and the smooth curves through
// them: lengths, normals, labels; files that cannot be meant.
#include "plane_bodies.h"

#include <alveolus/base/errors.h>
#include <alveolus/geometry/grading.h>
#include <alveolus/geometry/outline.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



TEST(Grading, EquallySpaced)
{
  const auto s = graded_division(3., [](double) { return 0.5; });
  ASSERT_EQ(s.size(), 7u);
  for (unsigned int i = 0; i < s.size(); ++i)
    EXPECT_NEAR(s[i], 0.5 * i, 1e-12);
}



// A size a + g s makes n segments with n >= ln(1 + g L/a)/g and divisions at
// a/g ((1 + g L/a)^(i/n) - 1), each by the same factor longer than the last.
TEST(Grading, GrowsGeometrically)
{
  const double a = 0.1, g = 0.25, length = 4.;
  const auto   s = graded_division(length, [=](double x) { return a + g * x; });
  const double ratio = 1. + g * length / a;
  unsigned int n     = std::ceil(std::log(ratio) / g);
  n += n % 2;
  ASSERT_EQ(s.size(), n + 1u);
  for (unsigned int i = 0; i <= n; ++i)
    EXPECT_NEAR(s[i], a / g * (std::pow(ratio, double(i) / n) - 1.), 1e-5);
}



TEST(Outline, ReadsAndTurns)
{
  // A clockwise square with midpoints; the upper line is labelled.
  const Outline outline = read_outline(
    "# comment\nx,y,piece\n0,0\n0,1\n0,2,up\n"
    "1,2,up\n2,2\n2,1\n2,0\n1,0\n0,0\n",
    "square");
  ASSERT_EQ(outline.points.size(), 8u);
  EXPECT_DOUBLE_EQ(polygon_area(outline.points), 4.);
  for (std::size_t i = 0; i < 8; ++i)
    {
      const Point<2> &a = outline.points[i], &b = outline.points[(i + 1) % 8];
      EXPECT_EQ(outline.labels[i] == "up", a[1] == 2. && b[1] == 2.);
    }

  const SmoothOutline smooth(outline, 0.5);
  EXPECT_EQ(smooth.corners().size(), 4u);
  EXPECT_NEAR(smooth.length(), 8., 1e-13);
  EXPECT_EQ(smooth.label_starts().size(), 2u);
  for (const double s : {0.3, 2.7, 5.1, 7.9})
    {
      const Point<2> p = smooth.point(s);
      EXPECT_EQ(smooth.label(s), p[1] == 2. ? "up" : "");
      EXPECT_NEAR(smooth.normal(s) * (p - Point<2>(1., 1.)), 1., 1e-13);
    }
}



TEST(Outline, CircleWithoutCorners)
{
  const Outline circle = read_outline(ring(1., 2., 3., 3., 100), "circle");
  const SmoothOutline smooth(circle, 0.5);
  EXPECT_TRUE(smooth.corners().empty());
  EXPECT_NEAR(smooth.length(), 6. * numbers::PI, 1e-5);
  for (const double s : {0., 1., 5., 12.})
    {
      EXPECT_NEAR(smooth.point(s).distance(Point<2>(1., 2.)), 3., 1e-6);
      EXPECT_NEAR(smooth.normal(s) * (smooth.point(s) - Point<2>(1., 2.)),
                  3.,
                  1e-6);
    }
  const Outline turned = circle.placed(0.5 * numbers::PI, Point<2>(10., 0.));
  EXPECT_NEAR(turned.points[0].distance(Point<2>(8., 4.)), 0., 1e-14);
}



// What people's files look like; the outline is the same.
TEST(Outline, AcceptsWhatIsClear)
{
  const std::string plain =
    "0,0,a\n1,0,a\n2,0,b\n2,1,b\n2,2,c\n1,2,c\n"
    "0,2,d\n0,1,d\n";
  const Outline expected = read_outline(plain, "plain");
  EXPECT_TRUE(expected.remarks.empty());
  const auto expect_same = [&](const std::string &text,
                               const std::string &remark,
                               const bool         labelled = true,
                               const double       unit     = 1.) {
    const Outline outline = read_outline(text, "variant", unit);
    ASSERT_EQ(outline.points.size(), 8u) << text;
    for (std::size_t i = 0; i < 8; ++i)
      {
        EXPECT_NEAR(outline.points[i].distance(expected.points[i]), 0., 1e-6);
        EXPECT_EQ(outline.labels[i], labelled ? expected.labels[i] : "");
      }
    ASSERT_EQ(outline.remarks.size(), remark.empty() ? 0u : 1u) << text;
    if (!remark.empty())
      {
        EXPECT_NE(outline.remarks[0].find(remark), std::string::npos)
          << outline.remarks[0];
      }
  };
  expect_same(plain + "0,0\n", "first point is repeated");
  expect_same(plain + "1e-8,0\n", "first point is repeated");
  expect_same("0,0,z\n" + plain, "1 repeated point");
  expect_same(
    "0,0,a\n1,0,z\n1,1e-9,a\n2,0,b\n2,1,b\n2,2,c\n1,2,c\n0,2,d\n"
    "0,1,d\n",
    "1 repeated point");
  expect_same(
    "\xef\xbb\xbfx;y;piece\r\n0,0;0;a\r\n1,0;0;a\r\n2;0;b\r\n2;1;b"
    "\r\n2;2;c\r\n1;2;c\r\n0;2;d\r\n0;1;d\r\n",
    "");
  expect_same(
    "0 0 7.5\n1 0 7.5\n2 0 7.5\n2 1 7.5\n2 2 7.5\n1 2 7.5\n0 2 7.5\n"
    "0 1 7.5\n",
    "third numbers",
    false);
  expect_same(
    "0,0\n.001,0\n.002,0\n.002,.001\n.002,.002\n.001,.002\n0,.002\n"
    "0,.001\n",
    "",
    false,
    1000.);
  // Clockwise from the corner 2, 1: the labels stay with their lines.
  const Outline turned =
    read_outline("2,1,b\n2,0,a\n1,0,a\n0,0,d\n0,1,d\n0,2,c\n1,2,c\n2,2,b\n",
                 "clockwise");
  ASSERT_EQ(turned.remarks.size(), 1u);
  for (std::size_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < 8; ++k)
      if (turned.points[i] == expected.points[k])
        {
          EXPECT_EQ(turned.labels[i], expected.labels[k]);
        }
  // Area and centroid of a rectangle far from the origin
  const Points rectangle = {{101., 50.}, {105., 50.}, {105., 52.}, {101., 52.}};
  EXPECT_DOUBLE_EQ(signed_area(rectangle), 8.);
  EXPECT_NEAR(centroid_of(rectangle).distance(Point<2>(103., 51.)), 0., 1e-13);
}



TEST(Outline, BadFiles)
{
  const auto read = [](const std::string &text) {
    return message<InputError>([&] { read_outline(text, "ring.csv"); });
  };
  expect_words(read("0,0\n1,0\n1,1\n"), {"ring.csv", "3 points", "at least"});
  expect_words(read("x,y\n0,0\n1,a\n"), {"ring.csv, line 3", "coordinate"});
  expect_words(read("0,0\n1\n"), {"ring.csv, line 2", "line ends"});
  // Depth that varies; lengths in m or in micrometres
  expect_words(read("0,0,5\n1,0,5\n2,0,6\n"),
               {"ring.csv, line 3", "third number", "STL"});
  for (const double size : {0.003, 3000.})
    expect_words(read(ring(0., 0., size, size, 20)),
                 {"ring.csv", "mm in size", "`Outline unit`"});
  // An eight
  expect_words(read("0,0\n1,0\n2,0\n3,1\n3,2\n2,2\n1,-1\n0,-1\n"),
               {"crosses or touches itself", "line"});
  // A line that goes back on itself
  expect_words(read("0,0\n1,0\n2,0\n3,0\n2.5,0\n3,2\n2,2\n1,1\n0,1\n"),
               {"crosses or touches itself"});
}
