// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Meshes from files: both formats and what other programs write give the areas,
// lengths and names of the geometry; unknown names.
#include "mesh_source_bench.h"
#include "two_squares.h"

#include <alveolus/base/errors.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  void
  check_two_squares(const Mesh<2> &mesh)
  {
    EXPECT_NEAR(measure(mesh, "soft"), 1., 1e-14);
    EXPECT_NEAR(measure(mesh, "hard"), 1., 1e-14);
    EXPECT_NEAR(measure(mesh, "body"), 2., 1e-14);
    EXPECT_NEAR(length(mesh, "bottom"), 2., 1e-14);
    EXPECT_NEAR(length(mesh, "start"), 1., 1e-14);
    EXPECT_NEAR(length(mesh, "middle"), 1., 1e-14);
    EXPECT_NEAR(boundary_measure(mesh, "bottom"), 2., 1e-14);
    EXPECT_NEAR(boundary_measure(mesh, "start"), 1., 1e-14);
    EXPECT_EQ(mesh.names.boundaries.count("middle"), 0u);
    EXPECT_NEAR(mesh.names.point("P", "test").distance(Point<2>(1, 0)),
                0.,
                1e-15);
    EXPECT_EQ(mesh.names.points.size(), 1u);
    EXPECT_EQ(mesh.names.curves.size(), 3u);
    EXPECT_EQ(mesh.names.regions.size(), 3u);
    // The unused node is gone, unnamed boundary faces have the id 0.
    double unnamed = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && face->boundary_id() == 0)
            unnamed += face->measure();
    EXPECT_NEAR(Utilities::MPI::sum(unnamed, MPI_COMM_WORLD), 4., 1e-14);
  }
} // namespace



TEST(FileSource, TwoSquaresInBothFormats)
{
  write("two.msh", version_2);
  write("four.msh", version_4);
  for (const char *name : {"two.msh", "four.msh"})
    for (const char *refinements : {"0", "2"})
      {
        SCOPED_TRACE(std::string(name) + ", refinements " + refinements);
        const auto mesh =
          make<2>("file", {{"File name", name}, {"Refinements", refinements}});
        EXPECT_EQ(mesh.triangulation->n_global_active_cells(),
                  refinements[0] == '0' ? 2u : 32u);
        check_two_squares(mesh);
        expect_words(mesh.description,
                     {"2 cells",
                      "1 unused nodes dropped",
                      "1 cells of negative orientation turned"});
      }
}



// A converter that writes no entities: one entity number 0 for everything.
TEST(FileSource, GroupsWithoutEntities)
{
  std::string text = version_2;
  for (const auto &[old, replacement] :
       std::vector<std::pair<std::string, std::string>>{
         {"2 1 2 2 1 1 2\n", "2 1 2 2 0 1 2\n"},
         {"3 1 2 3 1 2 1\n", "3 1 2 3 0 2 1\n"},
         {"4 1 2 2 2 2 3\n", "4 1 2 2 0 2 3\n"},
         {"5 1 2 4 3 2 5\n", "5 1 1 4 2 5\n"},
         {"6 3 2 5 1 ", "6 3 2 5 0 "},
         {"7 3 2 7 1 ", "7 3 2 7 0 "},
         {"8 3 2 6 2 ", "8 3 2 6 0 "},
         {"9 3 2 7 2 ", "9 3 2 7 0 "}})
    text = with(text, old, replacement);
  write("zero.msh", text);
  check_two_squares(make<2>("file", {{"File name", "zero.msh"}}));
}



TEST(FileSource, LineEndsOfWindowsAndComments)
{
  std::string text = "$Comments\nby hand\n$EndComments\n" + version_2 +
                     "$NodeData\n1\n\"x\"\n$EndNodeData\n";
  for (std::size_t i = 0; (i = text.find('\n', i)) != std::string::npos; i += 2)
    text.insert(i, "\r");
  write("windows.msh", text);
  check_two_squares(make<2>("file", {{"File name", "windows.msh"}}));
}



// Two cubes on [0,2]x[0,1]x[0,1], the second one with the wrong orientation.
TEST(FileSource, TwoCubes)
{
  write("cubes.msh", R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
6
0 1 "P"
1 2 "rim"
1 3 "inner"
2 4 "wall"
3 5 "body"
2 6 "between"
$EndPhysicalNames
$Nodes
12
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
7 0 0 1
8 1 0 1
9 2 0 1
10 0 1 1
11 1 1 1
12 2 1 1
$EndNodes
$Elements
9
1 15 2 1 1 1
2 1 2 2 7 1 2
3 1 2 2 7 2 3
4 1 2 3 8 2 8
5 3 2 4 9 1 2 8 7
6 3 2 4 9 2 3 9 8
7 3 2 6 11 2 5 11 8
8 5 2 5 1 1 2 5 4 7 8 11 10
9 5 2 5 1 8 9 12 11 2 3 6 5
$EndElements
)");
  for (const unsigned int refinements : {0, 1})
    {
      const auto mesh = make<3>("file",
                                {{"File name", "cubes.msh"},
                                 {"Refinements", std::to_string(refinements)}});
      EXPECT_NEAR(measure(mesh, "body"), 2., 1e-14);
      EXPECT_NEAR(boundary_measure(mesh, "wall"), 2., 1e-14);
      EXPECT_EQ(mesh.names.boundaries.count("between"), 0u);
      EXPECT_EQ(mesh.names.point("P", "test").norm(), 0.);

      // Lines of owned cells by their midpoints, which no two lines share.
      std::map<std::string, std::set<std::pair<double, double>>> midpoints;
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int l : cell->line_indices())
            for (const std::string curve : {"rim", "inner"})
              if (mesh.names.is_on_curve(cell->line(l), curve))
                {
                  const Point<3> middle = cell->line(l)->center();
                  EXPECT_EQ(middle[1], 0.);
                  EXPECT_EQ(curve == "rim" ? middle[2] : middle[0] - 1., 0.);
                  midpoints[curve].emplace(middle[0], middle[2]);
                }
      for (const auto &[curve, n] :
           std::map<std::string, unsigned int>{{"rim", 2}, {"inner", 1}})
        {
          std::set<std::pair<double, double>> all;
          for (const auto &some : Utilities::MPI::all_gather(
                 MPI_COMM_WORLD,
                 std::vector<std::pair<double, double>>(
                   midpoints[curve].begin(), midpoints[curve].end())))
            all.insert(some.begin(), some.end());
          EXPECT_EQ(all.size(), n << refinements);
        }
    }
  expect_words(message<InputError, 2>("file", {{"File name", "cubes.msh"}}),
               {"cubes.msh", "three-dimensional mesh in a two-dimensional"});
}



TEST(NamedSets, UnknownNamesListTheKnownOnes)
{
  write("two.msh", version_2);
  const auto  mesh  = make<2>("file", {{"File name", "two.msh"}});
  const auto &names = mesh.names;
  const auto  error = [](const auto &call) -> std::string {
    try
      {
        call();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "no error";
  };
  const std::string where = "Rezoning / straight AB / On";
  EXPECT_EQ(error([&] { names.curve("AB", where); }),
            where +
              ": the mesh has no curve 'AB'; known are: bottom, middle, "
              "start");
  EXPECT_EQ(error([&] { names.boundary("middle", where); }),
            where +
              ": the mesh has no boundary 'middle'; known are: bottom, "
              "start");
  EXPECT_EQ(error([&] { names.point("Q", where); }),
            where + ": the mesh has no point 'Q'; known are: P");
  EXPECT_EQ(error([&] { names.region("Body", where); }),
            where +
              ": the mesh has no region 'Body'; known are: body, hard, "
              "soft");
  EXPECT_EQ(error([&] { NamedSets<3>().point("Q", where); }),
            where +
              ": the mesh has no point 'Q'; it has no named point at all");
}
