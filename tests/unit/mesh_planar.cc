// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Plane bodies filled with quads, outlines, and the tooth in its socket: areas,
// distances and counts follow from the geometry.
#include <alveolus/base/errors.h>
#include <alveolus/geometry/grading.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/outline_input.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/mesh/socket_geometry.h>

#include <deal.II/base/numbers.h>
#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Points = std::vector<Point<2>>;

  std::string
  folder()
  {
    const std::string name =
      "mesh_planar." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::filesystem::create_directories(name);
    MPI_Barrier(MPI_COMM_WORLD);
    return name;
  }

  void
  write(const std::string &name, const std::string &text)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::ofstream(folder() + "/" + name) << text;
    else
      folder();
    MPI_Barrier(MPI_COMM_WORLD);
  }

  std::string
  shipped(const std::string &name)
  {
    std::ifstream file(std::string(ALVEOLUS_SOURCE_DIR) + "/meshes/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  template <class Error, class Function>
  std::string
  message(const Function &function)
  {
    try
      {
        function();
      }
    catch (const Error &error)
      {
        return error.what();
      }
    return "no error";
  }

  void
  expect_words(const std::string &text, const std::vector<std::string> &words)
  {
    for (const std::string &word : words)
      EXPECT_NE(text.find(word), std::string::npos)
        << "no '" << word << "' in: " << text;
  }

  double
  polygon_area(const Points &p)
  {
    double area = 0.;
    for (std::size_t i = 0; i < p.size(); ++i)
      {
        const Point<2> &a = p[i], &b = p[(i + 1) % p.size()];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
    return area;
  }

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

  std::size_t
  n_cells(const MeshDescription<2> &mesh, const std::string &region)
  {
    std::size_t n = 0;
    for (const auto &cell : mesh.cells)
      n += mesh.regions.at(region).count(cell.tag);
    return n;
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

  MeshDescription<2>
  mesh_of(const PlanarGeometry &geometry, PlanarMeshReport &report)
  {
    return mesh_planar_geometry(geometry,
                                PlanarMesher(),
                                {"planar", folder(), "test", MPI_COMM_WORLD},
                                report);
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

  PlanarGeometry
  incisor(const SocketSettings &settings = SocketSettings())
  {
    return socket_geometry(read_outline(shipped("incisor-tooth.csv"), "tooth"),
                           read_outline(shipped("incisor-bone.csv"), "bone"),
                           settings,
                           "test");
  }

  const PlanarCurve &
  named(const PlanarGeometry &geometry, const std::string &name)
  {
    for (const PlanarCurve &curve : geometry.curves)
      if (geometry.curve_names.at(name).count(curve.tag) != 0)
        return curve;
    throw std::logic_error(name);
  }

  /** A closed ring of points on an ellipse, as text. */
  std::string
  ring(const double       x,
       const double       y,
       const double       a,
       const double       b,
       const unsigned int n,
       const int          direction = 1)
  {
    std::ostringstream text;
    text.precision(17);
    for (unsigned int i = 0; i < n; ++i)
      {
        const double angle = direction * 2. * numbers::PI * i / n;
        text << x + a * std::cos(angle) << ", " << y + b * std::sin(angle)
             << "\n";
      }
    return text.str();
  }
} // namespace



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



TEST(Socket, OffsetIsTheThickness)
{
  const PlanarGeometry geometry = incisor();
  const Points        &root     = named(geometry, "root").nodes,
               &socket          = named(geometry, "socket").nodes;
  ASSERT_EQ(root.size(), 251u);
  ASSERT_EQ(socket.size(), 251u);
  const SmoothOutline tooth(read_outline(shipped("incisor-tooth.csv"), "tooth"),
                            0.7);
  Points              dense;
  for (unsigned int i = 0; i < 100000; ++i)
    dense.push_back(tooth.point(tooth.length() * i / 100000));
  for (unsigned int i = 0; i < root.size(); ++i)
    {
      EXPECT_NEAR(root[i].distance(socket[i]), 0.2, 1e-12);
      if (i % 25 == 0)
        {
          double nearest = 1.;
          for (const Point<2> &p : dense)
            nearest = std::min(nearest, p.distance(socket[i]));
          EXPECT_NEAR(nearest, 0.2, 1e-6);
        }
    }
  // Equal arc lengths: chords differ by the curvature only.
  for (unsigned int i = 1; i < root.size(); ++i)
    EXPECT_NEAR(root[i].distance(root[i - 1]) / root[1].distance(root[0]),
                1.,
                2e-3);
  EXPECT_EQ(named(geometry, "rim labial").n_segments(), 4u);
}



// A parallel strip of thickness t along a curve of length L whose tangent turns
// by w has the area t L + t^2 w/2; chords make an error of second order.
TEST(Socket, AreaOfTheLigament)
{
  double errors[2];
  for (const unsigned int k : {1u, 2u})
    {
      SocketSettings settings;
      settings.n_along *= k;
      const PlanarGeometry geometry = incisor(settings);
      const Points        &root     = named(geometry, "root").nodes;
      const Points        &socket   = named(geometry, "socket").nodes;
      Points               strip    = socket;
      strip.insert(strip.end(), root.rbegin(), root.rend());

      const CubicSpline<2> fine(root);
      const Tensor<1, 2>   first = socket.front() - root.front(),
                         last    = socket.back() - root.back();
      // Normals turn from -x by way of -y to +x.
      double turn =
        std::atan2(last[1], last[0]) - std::atan2(first[1], first[0]);
      if (turn < 0.)
        turn += 2. * numbers::PI;
      EXPECT_NEAR(turn, numbers::PI, 0.1);
      errors[k - 1] = 0.2 * fine.length() + 0.02 * turn - polygon_area(strip);
    }
  EXPECT_GT(errors[0], 0.);
  EXPECT_NEAR(errors[0] / errors[1], 4., 0.1);
  EXPECT_LT(errors[1], 1e-3 * 0.2 * 24.);
}



TEST(Socket, ShippedIncisor)
{
  PlanarMeshReport         report;
  const PlanarGeometry     geometry = incisor();
  const MeshDescription<2> mesh     = mesh_of(geometry, report);
  EXPECT_EQ(n_cells(mesh, "ligament"), 1000u);
  EXPECT_NEAR(n_cells(mesh, "bone"), 1820., 180.);
  EXPECT_NEAR(n_cells(mesh, "tooth"), 2294., 230.);
  EXPECT_GE(smallest_scaled_jacobian(mesh), 0.4);
  EXPECT_EQ(mesh.curves.size(), 13u);

  // Each line lies between the regions it should.
  std::map<std::set<unsigned int>, std::multiset<std::string>> sides;
  for (const auto &region : mesh.regions)
    for (const auto &cell : mesh.cells)
      if (region.second.count(cell.tag) != 0)
        {
          const auto &v = cell.vertices;
          for (const auto &edge : {std::set<unsigned int>{v[0], v[1]},
                                   {v[1], v[3]},
                                   {v[3], v[2]},
                                   {v[2], v[0]}})
            sides[edge].insert(region.first);
        }
  const std::map<std::string, std::multiset<std::string>> expected = {
    {"root", {"ligament", "tooth"}},
    {"socket", {"bone", "ligament"}},
    {"rim labial", {"ligament"}},
    {"rim lingual", {"ligament"}},
    {"neck labial", {"tooth"}},
    {"neck lingual", {"tooth"}},
    {"crown labial", {"tooth"}},
    {"crown lingual", {"tooth"}},
    {"incisal edge", {"tooth"}},
    {"crest labial", {"bone"}},
    {"crest lingual", {"bone"}},
    {"bone surface", {"bone"}},
    {"bone base", {"bone"}}};
  std::map<std::string, unsigned int> n_lines;
  for (const auto &entry : expected)
    for (const auto &line : mesh.lines)
      if (mesh.curves.at(entry.first).count(line.tag) != 0)
        {
          ++n_lines[entry.first];
          EXPECT_EQ(sides.at({line.vertices[0], line.vertices[1]}),
                    entry.second);
        }
  EXPECT_EQ(n_lines["root"], 250u);
  EXPECT_EQ(n_lines["rim labial"], 4u);
  std::size_t n_boundary = 0, n_named = 0;
  for (const auto &edge : sides)
    n_boundary += edge.second.size() == 1;
  for (const auto &entry : n_lines)
    n_named += entry.second;
  EXPECT_EQ(n_named, n_boundary + 500u);

  const auto at = [&](const std::string &name) {
    return mesh.vertices[mesh.points.at(name)];
  };
  EXPECT_NEAR(at("tip").distance(Point<2>(0., 21.5)), 0., 0.05);
  EXPECT_NEAR(at("apex").distance(Point<2>(0., 0.)), 0., 0.05);
  EXPECT_NEAR(at("margin root labial").distance(at("margin socket labial")),
              0.2,
              1e-12);
  EXPECT_LT(at("margin socket labial")[0], at("margin root labial")[0]);
  EXPECT_GT(at("margin socket lingual")[0], at("margin root lingual")[0]);
  // The crest is 1.75 mm below the cervix at 12.5 mm.
  EXPECT_NEAR(at("margin socket labial")[1], 10.75, 0.01);
}



// Without labels names follow from heights and lengths.
TEST(Socket, OutlinesWithoutLabels)
{
  SocketSettings settings;
  settings.n_along      = 40;
  settings.n_across     = 2;
  settings.crown_height = 3.;
  const PlanarGeometry geometry =
    socket_geometry(read_outline(ring(0., 0., 2., 8., 200, -1), "tooth"),
                    read_outline(ring(0., -7., 8., 8., 200), "bone"),
                    settings,
                    "test");
  EXPECT_EQ(geometry.curve_names.size(), 13u);
  const double margin = geometry.point_names.at("margin root labial")[1];
  EXPECT_NEAR(named(geometry, "crown labial").nodes.front()[1],
              8. - settings.incisal_height,
              1e-9);
  EXPECT_NEAR(named(geometry, "crown labial").nodes.back()[1],
              margin + 3.,
              1e-9);
  EXPECT_NEAR(named(geometry, "bone base").nodes.front()[1],
              -15. + settings.base_height,
              1e-4);
  EXPECT_NEAR(geometry.point_names.at("tip").distance(Point<2>(0., 8.)),
              0.,
              1e-6);
  EXPECT_NEAR(geometry.point_names.at("apex")[1], -8., 0.05);
}



TEST(Socket, BadInput)
{
  const Outline tooth = read_outline(shipped("incisor-tooth.csv"), "tooth");
  const Outline bone  = read_outline(shipped("incisor-bone.csv"), "bone");
  const auto    make = [&](const Outline &t, const Outline &b, const double d) {
    SocketSettings settings;
    settings.thickness = d;
    return message<InputError>(
      [&] { socket_geometry(t, b, settings, "Mesh / tooth in socket"); });
  };
  // The plates are about 1.4 mm thick.
  EXPECT_EQ(make(tooth, bone, 1.), "no error");
  expect_words(make(tooth, bone, 1.3), {"only", "mm thick", "Least bone"});
  // A deep notch in the plate
  std::ostringstream notched;
  for (unsigned int i = 0; i < 400; ++i)
    {
      const double angle = 2. * numbers::PI * i / 400;
      const double r = 9. - 8. * std::exp(-std::pow((angle - 0.35) / 0.1, 2));
      notched << r * std::cos(angle) << ", " << -7. + r * std::sin(angle)
              << "\n";
    }
  expect_words(make(read_outline(ring(0., 0., 2., 8., 200), "tooth"),
                    read_outline(notched.str(), "bone"),
                    0.2),
               {"leaves the bone at several places", "Ligament thickness"});
  expect_words(make(read_outline(ring(0., -5., 1., 3., 50), "tooth"),
                    bone,
                    0.2),
               {"do not cross", "inside", "Tooth shift"});
  Tensor<1, 2> shift;
  shift[1] = 20.;
  expect_words(make(tooth.placed(0., shift), bone, 0.2),
               {"do not cross", "outside"});
  // A hollow in the root narrower than twice the ligament
  std::string kidney;
  for (unsigned int i = 0; i < 200; ++i)
    {
      const double angle = 2. * numbers::PI * i / 200;
      kidney +=
        std::to_string(
          (2. - 1.7 * std::exp(-30. * std::pow(std::sin(angle) + 0.4, 2)) *
                  (std::cos(angle) > 0.)) *
          std::cos(angle)) +
        ", " + std::to_string(8. * std::sin(angle)) + "\n";
    }
  expect_words(make(read_outline(kidney, "tooth"),
                    read_outline(ring(0., -7., 12., 12., 200), "bone"),
                    1.5),
               {"overlaps itself", "Ligament thickness"});
}



TEST(Socket, Source)
{
  write("tooth.csv", shipped("incisor-tooth.csv"));
  write("bone.csv", shipped("incisor-bone.csv"));
  const auto make = [](const std::map<std::string, std::string> &settings) {
    const auto source =
      Registry<MeshSource<2>>::create("tooth in socket", "Mesh / Type");
    ParameterHandler prm;
    source->declare_parameters(prm);
    prm.set("Tooth outline file", "tooth.csv");
    prm.set("Bone outline file", "bone.csv");
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    return source->create(MPI_COMM_WORLD, folder(), folder());
  };
  const Mesh<2> mesh = make(
    {{"Elements along ligament", "60"}, {"Elements across ligament", "2"}});
  EXPECT_EQ(mesh.names.boundaries.size(), 11u);
  EXPECT_EQ(mesh.names.curves.size(), 13u);
  EXPECT_EQ(mesh.names.points.size(), 6u);
  unsigned int n_ligament = 0;
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned())
      n_ligament +=
        mesh.names.regions.at("ligament").count(cell->material_id());
  EXPECT_EQ(Utilities::MPI::sum(n_ligament, MPI_COMM_WORLD), 120u);

  expect_words(message<InputError>([&] {
                 make({{"Elements along ligament", "61"}});
               }),
               {"Elements along ligament", "odd"});
  expect_words(message<InputError>([&] {
                 make({{"Bone outline file", "none.csv"}});
               }),
               {"Bone outline file", "none.csv"});
  expect_words(
    message<InputError>([&] {
      make({{"Elements along ligament", "60"}, {"Least quality", "0.99"}});
    }),
    {"Least quality", "smallest scaled Jacobian", "bone:"});
}



// Prisms of the outlines, in cm, cut across: the same body as from the points.
TEST(Socket, FromSurfaces)
{
  if (!can_cut_surfaces())
    GTEST_SKIP() << "built without CGAL";
  for (const std::string name : {"tooth", "bone"})
    {
      const Outline outline =
        read_outline(shipped("incisor-" + name + ".csv"), name);
      const Point<2>     centre = centroid_of(outline.points);
      std::ostringstream points, stl;
      points.precision(10);
      stl.precision(10);
      const auto facet = [&stl](const std::array<Point<3>, 3> &corners) {
        stl << "facet normal 0 0 0\nouter loop\n";
        for (const Point<3> &p : corners)
          stl << "vertex " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
        stl << "endloop\nendfacet\n";
      };
      const auto place = [](const double x, const Point<2> &p) {
        return Point<3>(x, 0.1 * p[0], 0.1 * p[1]);
      };
      stl << "solid " << name << '\n';
      const std::size_t n = outline.points.size();
      for (std::size_t i = 0; i < n; ++i)
        {
          const Point<2> &a = outline.points[i],
                         &b = outline.points[(i + 1) % n];
          points << a[0] << ',' << a[1] << '\n';
          facet({{place(-1, a), place(-1, b), place(1, b)}});
          facet({{place(-1, a), place(1, b), place(1, a)}});
          facet({{place(-1, b), place(-1, a), place(-1, centre)}});
          facet({{place(1, a), place(1, b), place(1, centre)}});
        }
      stl << "endsolid\n";
      write(name + "-plain.csv", points.str());
      write(name + ".STL", stl.str());
    }
  std::map<std::string, double> areas[2];
  for (const bool surface : {false, true})
    {
      const auto source =
        Registry<MeshSource<2>>::create("tooth in socket", "Mesh / Type");
      ParameterHandler prm;
      source->declare_parameters(prm);
      for (const std::string name : {"tooth", "bone"})
        prm.set((name == "tooth" ? "Tooth" : "Bone") +
                  std::string(" outline file"),
                name + (surface ? ".STL" : "-plain.csv"));
      prm.set("Elements along ligament", "60");
      prm.set("Elements across ligament", "2");
      if (surface)
        {
          prm.set("Outline unit", "cm");
          prm.set("Section origin", "0.123, 0, 0");
        }
      const Mesh<2> mesh = source->create(MPI_COMM_WORLD, folder(), folder());
      for (const auto &region : mesh.names.regions)
        {
          double area = 0.;
          for (const auto &cell : mesh.triangulation->active_cell_iterators())
            if (cell->is_locally_owned() &&
                region.second.count(cell->material_id()) > 0)
              area += cell->measure();
          areas[surface][region.first] =
            Utilities::MPI::sum(area, MPI_COMM_WORLD);
        }
    }
  // The loop has points on the diagonals of the prism's sides, too: the
  // splines through them differ a little.
  for (const auto &region : areas[0])
    EXPECT_NEAR(areas[1][region.first] / region.second, 1., 2e-3)
      << region.first;
}
