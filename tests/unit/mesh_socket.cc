// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The tooth in its socket: distances, areas, names and counts follow from the
// outlines.
#include "plane_bodies.h"

#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/outline_input.h>
#include <alveolus/mesh/socket_geometry.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  std::string
  shipped(const std::string &name)
  {
    std::ifstream file(std::string(ALVEOLUS_SOURCE_DIR) + "/meshes/" + name);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
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
} // namespace



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
