// SPDX-License-Identifier: LGPL-2.1-or-later
// Sections of closed surfaces: of an ellipsoid, whose sections are ellipses,
// and of what is no closed surface.
#include <alveolus/base/errors.h>
#include <alveolus/geometry/plane_section.h>

#include <deal.II/base/numbers.h>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Facet = std::array<Point<3>, 3>;

  const Point<3> axes(3., 2., 5.); // semi-axes [mm]

  /** An ellipsoid around @p centre, 8 n^2 facets with corners on it. */
  std::vector<Facet>
  ellipsoid(const unsigned int n, const Point<3> &centre = Point<3>())
  {
    const auto point = [&](const double i, const double j) {
      // Octahedron divided into n, i + j <= n, then pushed onto the sphere
      Tensor<1, 3> p = Point<3>(i, j, n - i - j);
      p /= p.norm();
      return Point<3>(p);
    };
    std::vector<Facet> facets;
    for (unsigned int octant = 0; octant < 8; ++octant)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; i + j < n; ++j)
          for (unsigned int half = 0; half < (i + j + 1 < n ? 2u : 1u); ++half)
            {
              Facet facet =
                half == 0
                  ? Facet{{point(i, j), point(i + 1, j), point(i, j + 1)}}
                  : Facet{
                      {point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)}};
              unsigned int mirrors = 0;
              for (unsigned int d = 0; d < 3; ++d)
                if ((octant >> d & 1) != 0)
                  {
                    ++mirrors;
                    for (Point<3> &p : facet)
                      p[d] = -p[d];
                  }
              if (mirrors % 2 == 1)
                std::swap(facet[1], facet[2]);
              for (Point<3> &p : facet)
                for (unsigned int d = 0; d < 3; ++d)
                  p[d] = p[d] * axes[d] + centre[d] + 0.; // no -0
              facets.push_back(facet);
            }
    return facets;
  }

  std::string
  text_of(const std::vector<Facet> &facets)
  {
    std::ostringstream text;
    text.precision(9);
    text << "solid test\n";
    for (const Facet &facet : facets)
      {
        text << "facet normal 0 0 0\nouter loop\n";
        for (const Point<3> &p : facet)
          text << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        text << "endloop\nendfacet\n";
      }
    text << "endsolid test\n";
    return text.str();
  }

  std::string
  binary_of(const std::vector<Facet> &facets)
  {
    std::string         bytes(80, ' ');
    const std::uint32_t n = facets.size();
    bytes.append(reinterpret_cast<const char *>(&n), 4);
    for (const Facet &facet : facets)
      {
        bytes.append(12, '\0');
        for (const Point<3> &p : facet)
          for (unsigned int d = 0; d < 3; ++d)
            {
              const float x = p[d];
              bytes.append(reinterpret_cast<const char *>(&x), 4);
            }
        bytes.append(2, '\0');
      }
    return bytes;
  }

  SectionPlane
  plane(const Point<3>     &origin = Point<3>(),
        const Tensor<1, 3> &normal = Point<3>(1., 0., 0.),
        const Tensor<1, 3> &up     = Point<3>(0., 0., 1.))
  {
    return {origin, normal, up};
  }

  Outline
  cut(const std::string  &content,
      const SectionPlane &plane,
      const unsigned int  loop = 0,
      const double        unit = 1.)
  {
    return cut_surface(content, "body.stl", unit, plane, loop, "Tooth loop");
  }

  void
  expect_refused(const std::string              &content,
                 const SectionPlane             &plane,
                 const unsigned int              loop,
                 const std::vector<std::string> &words)
  {
    try
      {
        cut(content, plane, loop);
        ADD_FAILURE() << "accepted, instead of " << words[0];
      }
    catch (const InputError &error)
      {
        for (const std::string &word : words)
          EXPECT_NE(std::string(error.what()).find(word), std::string::npos)
            << error.what();
      }
  }
} // namespace

#define NEEDS_CGAL         \
  if (!can_cut_surfaces()) \
  GTEST_SKIP() << "built without CGAL"



// x = 1.3 cuts the ellipsoid in the ellipse (y/2)^2 + (z/5)^2 = 1 - (1.3/3)^2.
// Seen against the normal with z up, y is to the right of it. The polygon's
// area is short of the ellipse's in second order of the facets' size.
TEST(Section, Ellipsoid)
{
  NEEDS_CGAL;
  const double        s     = 1. - 1.3 * 1.3 / 9.;
  const double        exact = numbers::PI * 2. * 5. * s;
  std::vector<double> errors;
  for (const unsigned int n : {8, 16, 32})
    {
      const Outline outline =
        cut(text_of(ellipsoid(n)), plane(Point<3>(1.3, 0., 0.)));
      errors.push_back(exact - signed_area(outline.points));
      EXPECT_NEAR(centroid_of(outline.points).norm(), 0., 1e-6);
      for (const Point<2> &p : outline.points)
        EXPECT_LT(std::pow(p[0] / 2., 2) + std::pow(p[1] / 5., 2), s + 1e-6);
    }
  EXPECT_GT(errors[0], 0.);
  EXPECT_LT(errors[2], 0.005 * exact);
  for (unsigned int i = 1; i < errors.size(); ++i)
    {
      const double order = std::log2(errors[i - 1] / errors[i]);
      RecordProperty("order_" + std::to_string(i), std::to_string(order));
      EXPECT_GT(order, 1.8);
      EXPECT_LT(order, 2.2);
    }
}



// Text and binary are the same up to the float's digits, whatever the unit,
// where the body is, and how its facets are turned.
TEST(Section, FormatsUnitsAndAxes)
{
  NEEDS_CGAL;
  const auto    facets   = ellipsoid(12);
  const auto    at       = plane(Point<3>(0.4, 0., 0.));
  const Outline expected = cut(text_of(facets), at);
  const double  area     = signed_area(expected.points);
  EXPECT_GT(area, 0.);
  const Outline binary = cut(binary_of(facets), at);
  EXPECT_EQ(binary.points.size(), expected.points.size());
  EXPECT_NEAR(signed_area(binary.points), area, 1e-5 * area);

  auto turned = facets;
  for (std::size_t i = 0; i < turned.size(); i += 3)
    std::swap(turned[i][0], turned[i][1]);
  EXPECT_NEAR(signed_area(cut(text_of(turned), at).points), area, 1e-6 * area);

  // In m, away from the origin: the centre is at (2, 1) from the plane's.
  auto far = ellipsoid(12, Point<3>(100., 50., -20.));
  for (Facet &facet : far)
    for (Point<3> &p : facet)
      p *= 1e-3;
  const Outline shifted =
    cut(text_of(far), plane(Point<3>(100.4, 48., -21.)), 0, 1e3);
  EXPECT_NEAR(signed_area(shifted.points), area, 1e-5 * area);
  EXPECT_NEAR(centroid_of(shifted.points).distance(Point<2>(2., 1.)), 0., 1e-4);

  // An oblique plane through the centre; seen against its normal (0, 3, 4)/5
  // with (0, -4, 3)/5 up, x is to the right.
  const Tensor<1, 3> normal = Point<3>(0., 0.6, 0.8);
  const Tensor<1, 3> up     = Point<3>(0., -0.8, 0.6);
  const Outline      oblique =
    cut(text_of(ellipsoid(32)), plane(Point<3>(), normal, up));
  const double along = 1. / std::sqrt(0.64 / 4. + 0.36 / 25.);
  double       right = 0., top = 0.;
  for (const Point<2> &p : oblique.points)
    {
      right = std::max(right, p[0]);
      top   = std::max(top, p[1]);
    }
  EXPECT_NEAR(right, 3., 0.01);
  EXPECT_NEAR(top, along, 0.01);
}



TEST(Section, SeveralLoops)
{
  NEEDS_CGAL;
  // Two ellipsoids 10 apart in y, the second one cut nearer to its pole
  auto two = ellipsoid(10);
  for (const Facet &facet : ellipsoid(10, Point<3>(1.5, 10., 0.)))
    two.push_back(facet);
  const auto text = text_of(two);
  const auto at   = plane(Point<3>(0.1, 0., 0.));
  expect_refused(text,
                 at,
                 0,
                 {"Tooth loop", "2 loops", "1:", "2:", "mm^2 around (10"});
  expect_refused(text, at, 3, {"Tooth loop", "no loop 3"});
  const Outline first = cut(text, at, 1), second = cut(text, at, 2);
  EXPECT_GT(signed_area(first.points), signed_area(second.points));
  EXPECT_NEAR(centroid_of(first.points).norm(), 0., 1e-5);
  EXPECT_NEAR(centroid_of(second.points).distance(Point<2>(10., 0.)), 0., 1e-5);
}



TEST(Section, Refused)
{
  NEEDS_CGAL;
  const auto facets = ellipsoid(6);
  const auto text   = text_of(facets);
  expect_refused(text,
                 plane(Point<3>(4., 0., 0.)),
                 0,
                 {"body.stl", "misses", "from -7 to -1 mm", "Section origin"});
  auto open = facets;
  open.pop_back();
  expect_refused(text_of(open), plane(), 0, {"not closed", "3 edges", "("});
  expect_refused("", plane(), 0, {"no STL file"});
  expect_refused("x,y\n0,0\n1,0\n", plane(), 0, {"no STL file"});
  const auto binary = binary_of(facets);
  expect_refused(binary.substr(0, binary.size() - 70),
                 plane(Point<3>(0.1, 0., 0.)),
                 0,
                 {"body.stl"});
  // Three facets at an edge
  auto fin = facets;
  fin.push_back({{facets[0][0], facets[0][1], Point<3>(9., 9., 9.)}});
  expect_refused(text_of(fin), plane(), 0, {"body.stl", "surface"});
}
