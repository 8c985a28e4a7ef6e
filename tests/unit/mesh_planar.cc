// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Plane bodies filled with quads: areas, nodes and counts follow from the
// geometry; quads that are optimised.
#include "plane_bodies.h"

#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  double
  area_of(const MeshDescription<2> &mesh, const std::string &region)
  {
    double area = 0.;
    for (const auto &cell : mesh.cells)
      if (mesh.regions.at(region).count(cell.tag) != 0)
        area += polygon_area({mesh.vertices[cell.vertices[0]],
                              mesh.vertices[cell.vertices[1]],
                              mesh.vertices[cell.vertices[3]],
                              mesh.vertices[cell.vertices[2]]});
    return area;
  }

  /** Edges and the number of their cells. */
  std::map<std::set<unsigned int>, unsigned int>
  edges(const MeshDescription<2> &mesh)
  {
    std::map<std::set<unsigned int>, unsigned int> result;
    for (const auto &cell : mesh.cells)
      {
        const auto &v = cell.vertices;
        for (const auto &edge : {std::set<unsigned int>{v[0], v[1]},
                                 {v[1], v[3]},
                                 {v[3], v[2]},
                                 {v[2], v[0]}})
          ++result[edge];
      }
    return result;
  }

  PlanarCurve
  curve(PlanarGeometry    &geometry,
        const unsigned int begin,
        const unsigned int end,
        const Points      &nodes,
        const std::string &name)
  {
    PlanarCurve result;
    result.begin = begin;
    result.end   = end;
    result.nodes = nodes;
    result.tag   = geometry.curves.size() + 1;
    geometry.curve_names[name].insert(result.tag);
    return result;
  }

  Points
  straight(const Point<2> &a, const Point<2> &b, const unsigned int n)
  {
    Points nodes;
    for (unsigned int i = 0; i <= n; ++i)
      nodes.push_back(a + (b - a) * (double(i) / n));
    nodes.front() = a;
    nodes.back()  = b;
    return nodes;
  }
} // namespace



// Transfinite interpolation reproduces a lattice that is an affine map.
TEST(AreaMesh, StructuredLattice)
{
  const auto map = [](const double x, const double y) {
    return Point<2>(2. * x + 0.3 * y, 0.5 * x + y);
  };
  const Point<2> a = map(0, 0), b = map(3, 0), c = map(3, 2), d = map(0, 2);
  const std::array<Points, 4> sides{{straight(a, b, 3),
                                     straight(b, c, 2),
                                     straight(c, d, 3),
                                     straight(d, a, 2)}};
  const AreaMesh              mesh = mesh_structured_area(sides);
  ASSERT_EQ(mesh.quads.size(), 6u);
  ASSERT_EQ(mesh.vertices.size(), 12u);
  EXPECT_NEAR(mesh.vertices[10].distance(map(1, 1)), 0., 1e-14);
  EXPECT_NEAR(mesh.vertices[11].distance(map(2, 1)), 0., 1e-14);
  const double sine =
    (2. * 1. - 0.5 * 0.3) / (std::hypot(2., 0.5) * std::hypot(0.3, 1.));
  EXPECT_NEAR(mesh.quality, sine, 1e-14);
}



// A square with the nodes of its edges anywhere and a hole, beside a structured
// strip: both have the nodes asked for, and nothing is lost between them.
TEST(PlanarMesher, KeepsBoundaryNodes)
{
  PlanarGeometry geometry;
  geometry.points = {
    {0., 0.}, {4., 0.}, {4., 4.}, {0., 4.}, {6., 0.}, {6., 4.}, {2.5, 2.}};
  const auto &p     = geometry.points;
  Points      right = straight(p[1], p[2], 12);
  for (unsigned int i = 1; i < 12; ++i)
    right[i] += Point<2>(0.05 * std::sin(2. * i), 0.08 * std::cos(3. * i));
  Points circle;
  for (unsigned int i = 0; i <= 16; ++i)
    circle.emplace_back(2. + 0.5 * std::cos(2. * numbers::PI * i / 16),
                        2. + 0.5 * std::sin(2. * numbers::PI * i / 16));
  circle.front() = circle.back() = p[6];
  const auto add                 = [&](const unsigned int begin,
                       const unsigned int end,
                       const Points      &nodes,
                       const std::string &name) {
    geometry.curves.push_back(curve(geometry, begin, end, nodes, name));
  };
  add(0, 1, straight(p[0], p[1], 8), "bottom");
  add(1, 2, right, "middle");
  add(2, 3, straight(p[2], p[3], 6), "top");
  add(3, 0, straight(p[3], p[0], 10), "left");
  add(1, 4, straight(p[1], p[4], 3), "bottom");
  add(4, 5, straight(p[4], p[5], 12), "right");
  add(2, 5, straight(p[2], p[5], 3), "top");
  add(6, 6, circle, "hole");
  geometry.point_names["corner"] = p[4];
  geometry.point_names["node"]   = right[5];

  PlanarArea body;
  body.name         = "body";
  body.tag          = 7;
  body.largest_size = 0.5;
  body.loops = {{{0, false}, {1, false}, {2, false}, {3, false}}, {{7, false}}};
  PlanarArea strip;
  strip.name            = "strip";
  strip.tag             = 9;
  strip.structured      = true;
  strip.loops           = {{{4, false}, {5, false}, {6, true}, {1, true}}};
  geometry.areas        = {body, strip};
  geometry.region_names = {{"body", {7}}, {"strip", {9}}, {"all", {7, 9}}};

  PlanarMeshReport         report;
  const MeshDescription<2> mesh = mesh_of(geometry, report);
  EXPECT_EQ(n_cells(mesh, "strip"), 36u);
  EXPECT_GT(report.smallest_scaled_jacobian, 0.4);
  EXPECT_DOUBLE_EQ(report.smallest_scaled_jacobian,
                   smallest_scaled_jacobian(mesh));

  circle.pop_back();
  EXPECT_NEAR(area_of(mesh, "all"), 24. - polygon_area(circle), 1e-12);
  Points outline = straight(p[0], p[1], 1);
  outline.insert(outline.end(), right.begin() + 1, right.end());
  outline.push_back(p[3]);
  EXPECT_NEAR(area_of(mesh, "body"),
              polygon_area(outline) - polygon_area(circle),
              1e-12);

  // Every segment of a curve is an edge of one cell, or of two between areas.
  const auto  all        = edges(mesh);
  std::size_t n_boundary = 0;
  for (const auto &edge : all)
    n_boundary += edge.second == 1;
  EXPECT_EQ(n_boundary, 8u + 6u + 10u + 3u + 12u + 3u + 16u);
  for (const auto &line : mesh.lines)
    EXPECT_EQ(all.at({line.vertices[0], line.vertices[1]}),
              mesh.curves.at("middle").count(line.tag) + 1u);
  EXPECT_EQ(mesh.lines.size(), n_boundary + 12u);
  for (const Point<2> &node : right)
    EXPECT_EQ(std::count(mesh.vertices.begin(), mesh.vertices.end(), node), 1);
  EXPECT_EQ(mesh.vertices[mesh.points.at("corner")], p[4]);
  EXPECT_EQ(mesh.vertices[mesh.points.at("node")], right[5]);

  // The same input gives the same mesh.
  const MeshDescription<2> again = mesh_of(geometry, report);
  EXPECT_EQ(again.vertices, mesh.vertices);

  geometry.curves[2].nodes = straight(p[2], p[3], 5);
  expect_words(message<RunError>([&] { mesh_of(geometry, report); }),
               {"body", "odd number"});
}



// A kite with 170 degrees at b in the middle of a boundary: divided, b has two
// cells. All outer vertices fixed, the 50 degrees at a and at c are shared by
// two cells, so that the sine of 25 degrees is the best there is.
TEST(QuadOptimiser, FlatCornerIsDivided)
{
  const double      a        = 85. * numbers::PI / 180.;
  Points            vertices = {{-1., 1. / std::tan(a)},
                                {0., 0.},
                                {1., 1. / std::tan(a)},
                                {0., 1. + 1. / std::tan(a)}};
  const double      area     = polygon_area(vertices);
  std::vector<Quad> quads    = {{{0, 1, 3, 2}}};
  std::vector<bool> fixed(4, true);
  EXPECT_NEAR(scaled_jacobian(vertices, quads[0]), std::sin(2. * a), 1e-12);
  EXPECT_EQ(divide_flat_corners(vertices, quads, fixed, 0.5), 1u);
  ASSERT_EQ(quads.size(), 5u);
  ASSERT_EQ(vertices.size(), 8u);
  const double quality  = optimise_quads(vertices, quads, fixed, 1., 5, 500);
  const double possible = std::sin(25. * numbers::PI / 180.);
  EXPECT_GT(quality, 0.9 * possible);
  EXPECT_LT(quality, possible + 1e-12);
  double       sum = 0.;
  unsigned int n   = 0;
  for (const Quad &q : quads)
    {
      sum += polygon_area(
        {vertices[q[0]], vertices[q[1]], vertices[q[3]], vertices[q[2]]});
      n += std::count(q.begin(), q.end(), 1u);
    }
  EXPECT_NEAR(sum, area, 1e-14);
  EXPECT_EQ(n, 2u);
}



// Moving one vertex of four equal cells back to the middle makes all of them
// squares.
TEST(QuadOptimiser, FindsTheSquare)
{
  Points vertices;
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x)
      vertices.emplace_back(x, y);
  vertices[4]                   = Point<2>(1.9, 0.3);
  const std::vector<Quad> quads = {{{0, 1, 3, 4}},
                                   {{1, 2, 4, 5}},
                                   {{3, 4, 6, 7}},
                                   {{4, 5, 7, 8}}};
  std::vector<bool>       fixed(9, true);
  fixed[4] = false;
  EXPECT_GT(optimise_quads(vertices, quads, fixed, 1., 0, 200), 0.99);
  EXPECT_NEAR(vertices[4].distance(Point<2>(1., 1.)), 0., 0.01);
}
