// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Meshes from files, GridGenerator and the mesher: areas, lengths and names
// follow from the geometry that was asked for.
#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/msh_reader.h>

#include <deal.II/base/parameter_handler.h>

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Settings = std::map<std::string, std::string>;

  bool
  is_root()
  {
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** A folder for this number of processes, so that runs may coincide. */
  std::string
  folder()
  {
    const std::string name =
      "mesh_sources." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    if (is_root())
      std::filesystem::create_directories(name);
    MPI_Barrier(MPI_COMM_WORLD);
    return name;
  }

  void
  write(const std::string &name, const std::string &text)
  {
    const std::string path = folder() + "/" + name;
    if (is_root())
      std::ofstream(path) << text;
    MPI_Barrier(MPI_COMM_WORLD);
  }

  std::string
  content(const std::string &path)
  {
    std::ifstream      file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
  }

  template <int dim>
  Mesh<dim>
  make(const std::string &type,
       const Settings    &settings,
       const std::string &input_directory = folder())
  {
    const auto source = Registry<MeshSource<dim>>::create(type, "Mesh / Type");
    ParameterHandler prm;
    source->declare_parameters(prm);
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    return source->create(MPI_COMM_WORLD, input_directory, folder());
  }

  /** what() of the user error that making the mesh ends with. */
  template <class Error, int dim>
  std::string
  message(const std::string &type, const Settings &settings)
  {
    try
      {
        make<dim>(type, settings);
      }
    catch (const Error &error)
      {
        return error.what();
      }
    catch (const std::exception &error)
      {
        return std::string("wrong type of error: ") + error.what();
      }
    return "no error";
  }

  template <int dim>
  std::string
  message_of_text(const std::string &text)
  {
    write("wrong.msh", text);
    return message<InputError, dim>("file", {{"File name", "wrong.msh"}});
  }

  void
  expect_words(const std::string &text, const std::vector<std::string> &words)
  {
    for (const std::string &word : words)
      EXPECT_NE(text.find(word), std::string::npos)
        << "no '" << word << "' in: " << text;
  }

  template <int dim>
  double
  measure(const Mesh<dim> &mesh, const std::string &region)
  {
    const auto &ids    = mesh.names.region(region, "test");
    double      result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) != 0)
        result += cell->measure();
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  /** Length of a curve in 2D; an inner line is seen from two cells. */
  double
  length(const Mesh<2> &mesh, const std::string &curve)
  {
    double result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (mesh.names.is_on_curve(face, curve))
            result += face->measure() * (face->at_boundary() ? 1. : 0.5);
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  template <int dim>
  double
  boundary_measure(const Mesh<dim> &mesh, const std::string &name)
  {
    const auto &ids    = mesh.names.boundary(name, "test");
    double      result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && ids.count(face->boundary_id()) != 0)
            result += face->measure();
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  double
  smallest_corner(const Mesh<2> &mesh)
  {
    double smallest = 1.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int v : {0, 1, 2, 3})
          {
            // Anticlockwise neighbours of the vertices 0, 1, 3, 2.
            constexpr unsigned int next[] = {1, 3, 0, 2}, last[] = {2, 0, 3, 1};
            const Tensor<1, 2>     a = cell->vertex(next[v]) - cell->vertex(v);
            const Tensor<1, 2>     b = cell->vertex(last[v]) - cell->vertex(v);
            smallest =
              std::min(smallest,
                       (a[0] * b[1] - a[1] * b[0]) / (a.norm() * b.norm()));
          }
    return Utilities::MPI::min(smallest, MPI_COMM_WORLD);
  }

  /** Replace the only occurrence of @p old. */
  std::string
  with(std::string text, const std::string &old, const std::string &replacement)
  {
    const std::size_t position = text.find(old);
    EXPECT_NE(position, std::string::npos) << old;
    if (position != std::string::npos)
      text.replace(position, old.size(), replacement);
    return text;
  }

  /**
   * Two squares [0,1]x[0,1] ("soft") and [1,2]x[0,1] ("hard"), both "body",
   * with the curves "bottom" (two entities), "start" (its first half), the
   * inner curve "middle" and the point P at (1, 0). The second cell is
   * clockwise; node 10 is unused.
   */
  const std::string version_2 = R"($MeshFormat
2.2 0 8
$EndMeshFormat
$PhysicalNames
7
0 1 "P"
1 2 "bottom"
1 3 "start"
1 4 "middle"
2 5 "soft"
2 6 "hard"
2 7 "body"
$EndPhysicalNames
$Nodes
7
1 0 0 0
2 1 0 0
3 2 0 0
4 0 1 0
5 1 1 0
6 2 1 0
10 7 7 0
$EndNodes
$Elements
9
1 15 2 1 1 2
2 1 2 2 1 1 2
3 1 2 3 1 2 1
4 1 2 2 2 2 3
5 1 2 4 3 2 5
6 3 2 5 1 1 2 5 4
7 3 2 7 1 1 2 5 4
8 3 2 6 2 2 5 6 3
9 3 2 7 2 2 5 6 3
$EndElements
)";

  /** The same mesh in format 4.1, nodes in other blocks and order. */
  const std::string version_4 = R"($MeshFormat
4.1 0 8
$EndMeshFormat
$PhysicalNames
7
0 1 "P"
1 2 "bottom"
1 3 "start"
1 4 "middle"
2 5 "soft"
2 6 "hard"
2 7 "body"
$EndPhysicalNames
$Entities
1 3 2 0
1 1 0 0 1 1
1 0 0 0 1 0 0 2 2 3 2 1 -2
2 1 0 0 2 0 0 1 2 2 1 -2
3 1 0 0 1 1 0 1 4 2 1 -2
1 0 0 0 1 1 0 2 5 7 1 1
2 1 0 0 2 1 0 2 6 7 1 2
$EndEntities
$Nodes
2 7 1 10
1 1 0 2
10
2
7 7 0
1 0 0
2 1 0 5
1
3
4
5
6
0 0 0
2 0 0
0 1 0
1 1 0
2 1 0
$EndNodes
$Elements
6 6 1 6
0 1 15 1
1 2
1 1 1 1
2 1 2
1 2 1 1
3 2 3
1 3 1 1
4 2 5
2 1 3 1
5 1 2 5 4
2 2 3 1
6 2 5 6 3
$EndElements
)";

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



TEST(FileSource, WrongFormats)
{
  expect_words(message<InputError, 2>("file", {{"File name", "none.msh"}}),
               {"Mesh / file / File name", "none.msh", "cannot read"});
  expect_words(message<InputError, 2>("file", {}),
               {"Mesh / file / File name", "no file name"});
  expect_words(message<InputError, 2>("file", {{"File name", "."}}),
               {"is a folder"});
  expect_words(message_of_text<2>(""), {"wrong.msh", "$MeshFormat"});
  expect_words(message_of_text<2>("*NODE\n1, 0., 0.\n"),
               {"wrong.msh, line 1", "outside any section"});
  expect_words(message_of_text<2>(with(version_2, "2.2 0", "2.1 0")),
               {"wrong.msh, line 2", "version 2.1", "4.1 or 2.2"});
  expect_words(message_of_text<2>(with(version_4, "4.1 0", "4.0 0")),
               {"line 2", "version 4.0"});
  expect_words(message_of_text<2>(with(version_4, "4.1 0", "4.1 1")),
               {"line 2", "binary", "Mesh.Binary = 0"});
}



namespace
{
  /** what() of the InputError by which @p text is refused, else "". */
  std::string
  refusal(const std::string &text)
  {
    try
      {
        MeshDescription<2> mesh = read_msh<2>(text, "text");
        check_description(mesh);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }
} // namespace



TEST(MshReader, TruncatedEverywhere)
{
  for (const std::string &text : {version_2, version_4})
    for (std::size_t end = 0; end + 2 < text.size(); ++end)
      {
        const std::string found = refusal(text.substr(0, end));
        EXPECT_EQ(found.substr(0, 4), "text") << "at " << end << ": " << found;
        if (end > 0 && text[end - 1] == '\n')
          {
            EXPECT_NE(found.find("truncated"), std::string::npos) << found;
          }
      }
}



// Damaged files are refused by InputError or still make a valid mesh; any other
// exception, crash or hang fails the test.
TEST(MshReader, Mutations)
{
  std::mt19937      random(1);
  const std::string letters   = "0123456789 -.e$\n\t\"xN";
  unsigned int      n_refused = 0;
  for (unsigned int i = 0; i < 4000; ++i)
    {
      std::string text = i % 2 == 0 ? version_2 : version_4;
      for (unsigned int n = 1 + random() % 3; n > 0; --n)
        {
          const std::size_t at = random() % text.size();
          switch (random() % 4)
            {
              case 0:
                text[at] = letters[random() % letters.size()];
                break;
              case 1:
                text.insert(at, 1, letters[random() % letters.size()]);
                break;
              case 2:
                text.erase(at, 1 + random() % 12);
                break;
              default:
                text.insert(at, text.substr(random() % text.size(), 20));
            }
        }
      const std::string found = refusal(text);
      n_refused += !found.empty();
      EXPECT_EQ(found.substr(0, 4), found.empty() ? "" : "text") << found;
    }
  EXPECT_GT(n_refused, 2000u);
}



TEST(FileSource, InconsistentSections)
{
  const auto in_2 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_2, old, replacement));
  };
  const auto in_4 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_4, old, replacement));
  };
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 55 4"),
               {"line 31", "element 6", "unknown node 55"});
  expect_words(in_4("5 1 2 5 4", "5 1 2 55 4"),
               {"line 53", "element 5", "unknown node 55"});
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 5"),
               {"line 31", "the line ends before a node number"});
  expect_words(in_2("6 3 2 5 1 1 2 5 4", "6 3 2 5 1 1 2 5 4 3"),
               {"line 31", "'3' is more than"});
  expect_words(in_2("2 1 0 0\n", "2 1 x 0\n"),
               {"line 17", "'x' is not a coordinate"});
  expect_words(in_2("2 1 0 0\n", "2 nan 0 0\n"),
               {"line 17", "not a finite number"});
  expect_words(in_2("2 1 0 0\n", "2 1e999 0 0\n"), {"line 17"});
  expect_words(in_2("2 1 0 0\n", "1 1 0 0\n"),
               {"line 17", "node 1 was already given on line 16"});
  expect_words(in_2("2 1 0 0\n", "2 1 0 0.5\n"),
               {"line 17", "node 2 lies outside the plane"});
  expect_words(in_2("\n7\n1 0 0 0", "\n8\n1 0 0 0"),
               {"line 23", "$EndNodes", "fewer lines"});
  expect_words(in_2("\n7\n1 0 0 0", "\n6\n1 0 0 0"), {"line 22", "more lines"});
  expect_words(in_2("\n7\n1 0 0 0", "\n-7\n1 0 0 0"), {"negative"});
  expect_words(in_2("\n7\n1 0 0 0", "\n99999999999999999\n1 0 0 0"),
               {"line 23", "fewer lines"});
  expect_words(in_2("1 2 \"bottom\"", "1 2 bottom"),
               {"line 7", "quotation marks"});
  expect_words(in_2("1 3 \"start\"", "1 2 \"start\""),
               {"line 8", "a second name for group 2"});
  expect_words(in_2("9 3 2 7 2 2 5 6 3", "9 99 2 7 2 2 5 6 3"),
               {"line 34", "element 9", "type 99"});
  expect_words(in_4("2 7 1 10", "2 8 1 10"),
               {"8 nodes are announced, 7 are given"});
  expect_words(in_4("6 6 1 6", "6 7 1 6"),
               {"7 elements are announced, 6 are given"});
  expect_words(in_4("1 1 1 1\n2 1 2", "2 1 1 1\n2 1 2"),
               {"line 46", "lines on an entity of dimension 2"});
  expect_words(in_4("2 2 3 1", "2 9 3 1"), {"entity 9", "$Entities"});
  expect_words(message_of_text<2>(version_2 + "$Nodes\n0\n$EndNodes\n"),
               {"a second section $Nodes"});
  expect_words(message_of_text<2>(version_2 + "$NodeData\n0\n"),
               {"$NodeData", "has no end"});
}



TEST(FileSource, UnusableMeshes)
{
  const auto in_2 = [](const std::string &old, const std::string &replacement) {
    return message_of_text<2>(with(version_2, old, replacement));
  };
  const std::string second = "8 3 2 6 2 2 5 6 3\n9 3 2 7 2 2 5 6 3\n";
  expect_words(in_2(second, "17 2 2 6 2 2 5 6\n18 2 2 6 2 2 6 3\n"),
               {"wrong.msh",
                "a mesh with a triangle: 2 triangles, first one element 17 at "
                "line 33",
                "recombine"});
  expect_words(in_2(second, "8 16 2 6 2 2 3 6 5 1 4 10 1\n9 3 2 7 2 2 5 6 3\n"),
               {"a quadratic quad", "Mesh.ElementOrder = 1"});
  expect_words(in_2(second, "8 5 2 6 2 1 2 3 4 5 6 1 2\n9 15 1 0 1\n"),
               {"three-dimensional"});
  expect_words(message_of_text<3>(version_2), {"no cells", "hexahedra"});
  expect_words(in_2(second, "8 3 0 2 5 6 3\n9 3 0 2 5 6 3\n"),
               {"line 33",
                "1 cells without a region, first one element 8",
                "Physical group"});
  expect_words(in_2(second, "8 3 2 6 2 2 5 3 6\n9 3 2 7 2 2 5 3 6\n"),
               {"line 33", "element 8 is inverted or flat at node"});
  expect_words(in_2("3 2 0 0\n", "3 1.2 0.6 0\n"),
               {"element 8 is inverted or flat at node 3 (1.2, 0.6)"});
  expect_words(in_2("6 2 1 0\n", "6 2 0 0\n"), {"element 8", "flat"});
  expect_words(in_2("1 15 2 1 1 2", "1 15 2 1 1 10"),
               {"'P' (node 10) is no corner of any cell"});
  expect_words(in_2("5 1 2 4 3 2 5", "5 1 2 4 3 2 10"),
               {"line 30", "line 5 has a node that belongs to no cell"});
  expect_words(in_2("5 1 2 4 3 2 5", "5 1 2 4 3 1 5"),
               {"line 30", "from node 1 to node 5 is no edge"});
  expect_words(in_2("2 1 2 2 1 1 2", "2 15 2 1 1 3"),
               {"line 27", "a second node for the point 'P'"});
  // A third cell on the same side of the middle as the second one.
  expect_words(message_of_text<2>(with(with(version_2, "10 7 7 0", "10 3 2 0"),
                                       "9 3 2 7 2 2 5 6 3",
                                       "9 3 2 7 2 2 5 10 3")),
               {"line 34", "elements 8 and 9 overlap", "nodes"});
  // The second cell has nodes of its own at (1,0), (1,1): not connected.
  const std::string apart =
    with(with(with(with(version_2, "10 7 7 0", "10 1 0 0\n11 1 1 0"),
                   "\n7\n1 0 0 0",
                   "\n8\n1 0 0 0"),
              "8 3 2 6 2 2 5 6 3",
              "8 3 2 6 2 10 11 6 3"),
         "9 3 2 7 2 2 5 6 3",
         "9 3 2 7 2 10 11 6 3");
  const std::string connected_lines =
    with(apart, "4 1 2 2 2 2 3", "4 1 2 2 2 10 3");
  expect_words(message_of_text<2>(connected_lines),
               {"nodes 2 and 10 lie at the same place (1, 0)", "Coherence"});
  expect_words(make<2>("file",
                       {{"File name", "wrong.msh"},
                        {"Allow touching parts", "true"}})
                 .description,
               {"2 separate parts"});
  // Now its left edge is longer than that of the first: a node hangs on it.
  expect_words(message_of_text<2>(with(connected_lines,
                                       "10 1 0 0\n11 1 1 0",
                                       "10 1 -0.5 0\n11 1 1.5 0")),
               {"node 2 (1, 0) hangs on the edge between nodes 10 and 11"});
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



TEST(GridGeneratorSource, Rectangle)
{
  const auto mesh = make<2>("grid generator",
                            {{"Function", "subdivided_hyper_rectangle"},
                             {"Arguments", "3, 2 : 0, 0 : 3, 1 : true"},
                             {"Refinements", "1"},
                             {"Boundary names", "left: 0, ends: 0, ends: 1"},
                             {"Region names", "body: 3"},
                             {"Point names", "A: 0, 0; B: 3, 0.25"}});
  EXPECT_EQ(mesh.triangulation->n_global_active_cells(), 24u);
  EXPECT_NEAR(measure(mesh, "body"), 3., 1e-14);
  EXPECT_NEAR(boundary_measure(mesh, "left"), 1., 1e-14);
  EXPECT_NEAR(boundary_measure(mesh, "ends"), 2., 1e-14);
  EXPECT_NEAR(length(mesh, "boundary 2"), 3., 1e-14);
  EXPECT_NEAR(length(mesh, "ends"), 2., 1e-14);
  EXPECT_EQ(mesh.names.boundaries.size(), 4u);
  EXPECT_NEAR(mesh.names.point("B", "").distance(Point<2>(3, 0.25)), 0, 1e-15);
  // Flat manifolds only: manifold ids alone tell the curves, as promised.
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    for (const auto &face : cell->face_iterators())
      EXPECT_EQ(face->manifold_id(),
                face->at_boundary() ? face->boundary_id()
                                    : numbers::flat_manifold_id);
}



// The manifold of a ring must survive: refined, its length tends to 2 pi r.
TEST(GridGeneratorSource, Ring)
{
  double last_error = 1.;
  for (const char *refinements : {"1", "2", "3"})
    {
      const auto   mesh  = make<2>("grid generator",
                                {{"Function", "hyper_shell"},
                                    {"Arguments", "0, 0 : 1 : 2 : 8 : true"},
                                    {"Refinements", refinements},
                                    {"Boundary names", "hole: 0, rim: 1"}});
      const double error = 2. * numbers::PI * 2. - length(mesh, "rim");
      EXPECT_GT(error, 0.);
      EXPECT_NEAR(length(mesh, "hole") * 2., length(mesh, "rim"), 1e-12);
      if (refinements[0] != '1')
        {
          EXPECT_NEAR(last_error / error, 4., 0.1);
        }
      last_error = error;
    }
}



TEST(GridGeneratorSource, Cube)
{
  const auto mesh =
    make<3>("grid generator",
            {{"Refinements", "1"}, {"Point names", "M: 0.5, 0.5, 0.5"}});
  EXPECT_NEAR(measure(mesh, "region 0"), 1., 1e-14);
  for (unsigned int face = 0; face < 6; ++face)
    EXPECT_NEAR(boundary_measure(mesh, "boundary " + std::to_string(face)),
                1.,
                1e-14);
}



TEST(GridGeneratorSource, Errors)
{
  const auto error = [](const Settings &settings) {
    return message<InputError, 2>("grid generator", settings);
  };
  expect_words(error({{"Function", "hyper_kube"}}),
               {"Mesh / grid generator", "hyper_kube"});
  expect_words(error({{"Arguments", "0 : 1"}}),
               {"Mesh / grid generator", "'hyper_cube' of '0 : 1'"});
  expect_words(error({{"Arguments", "0 : one : true"}}),
               {"Mesh / grid generator", "one"});
  expect_words(error({{"Boundary names", "left: 0, far: 7"}}),
               {"Mesh / grid generator / Boundary names",
                "id '7' for the name 'far'",
                "ids are: 0, 1, 2, 3"});
  expect_words(error({{"Boundary names", "left"}}),
               {"Boundary names", "'left' is no pair"});
  expect_words(error({{"Region names", "body: one"}}),
               {"Region names", "'one'"});
  expect_words(error({{"Point names", "A: 0"}}),
               {"Point names", "'0' of point 'A' are not 2 coordinates"});
  expect_words(error({{"Point names", "A: 0.4, 0.1"}}),
               {"Point names", "no vertex at point 'A'", "(0 0)"});
}



namespace
{
  /** Nodes of the root from the left to the right, on every process. */
  std::vector<Point<2>>
  root_nodes(const Mesh<2> &mesh)
  {
    std::vector<std::pair<double, double>> mine;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (mesh.names.is_on_curve(face, "root"))
            for (const unsigned int v : {0, 1})
              mine.emplace_back(face->vertex(v)[0], face->vertex(v)[1]);
    std::set<std::pair<double, double>> all;
    for (const auto &some : Utilities::MPI::all_gather(MPI_COMM_WORLD, mine))
      all.insert(some.begin(), some.end());
    std::vector<Point<2>> result;
    for (const auto &[x, y] : all)
      result.emplace_back(x, y);
    return result;
  }

  struct Block
  {
    double half_width = 3.5, depth = 16., bone = 49., height = 40.;
    double margin = 10.;
  };

  void
  check_tooth_in_block(const Mesh<2> &mesh, const Block &block)
  {
    // Every node on the ellipse; the bone's area is that of the block without
    // the polygon through them, which is nearly the half-ellipse.
    const auto   nodes   = root_nodes(mesh);
    const double ellipse = 0.5 * numbers::PI * block.half_width * block.depth;
    double       polygon = 0.;
    for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        EXPECT_NEAR(std::pow(nodes[i][0] / block.half_width, 2) +
                      std::pow(nodes[i][1] / block.depth, 2),
                    1.,
                    1e-8);
        if (i > 0)
          polygon -= 0.5 * (nodes[i][0] - nodes[i - 1][0]) *
                     (nodes[i][1] + nodes[i - 1][1]);
      }
    EXPECT_LT(polygon, ellipse);
    EXPECT_GT(polygon, (1. - 16. / (nodes.size() * nodes.size())) * ellipse);

    const double lateral = block.bone - block.margin;
    const double centre  = 2. * (block.half_width + block.margin);
    EXPECT_NEAR(measure(mesh, "left"), lateral * block.height, 1e-7);
    EXPECT_NEAR(measure(mesh, "right"), lateral * block.height, 1e-7);
    EXPECT_NEAR(measure(mesh, "centre"), centre * block.height - polygon, 1e-7);

    const std::map<std::string, double> lengths = {
      {"AB", lateral},
      {"BC", block.margin},
      {"DE", block.margin},
      {"EF", lateral},
      {"AG", block.height},
      {"BH", block.height},
      {"GH", lateral},
      {"HI", block.margin},
      {"IJ", 2. * block.half_width},
      {"JK", block.margin},
      {"KL", lateral},
      {"EK", block.height},
      {"FL", block.height},
      {"top", 2. * block.bone},
      {"base", 2. * (block.bone + block.half_width)},
      {"left end", block.height},
      {"right end", block.height}};
    for (const auto &[curve, expected] : lengths)
      EXPECT_NEAR(length(mesh, curve), expected, 1e-8) << curve;
    for (const std::string name : {"top", "base", "left end", "right end"})
      EXPECT_NEAR(boundary_measure(mesh, name), lengths.at(name), 1e-8) << name;
    EXPECT_NEAR(boundary_measure(mesh, "root"), length(mesh, "root"), 1e-12);
    EXPECT_EQ(mesh.names.boundaries.count("BH"), 0u);

    const double xc = block.half_width, xb = xc + block.margin,
                 xa   = xc + block.bone;
    const double x[6] = {-xa, -xb, -xc, xc, xb, xa};
    for (unsigned int i = 0; i < 12; ++i)
      EXPECT_NEAR(mesh.names.point(std::string(1, 'A' + i), "test")
                    .distance(Point<2>(x[i % 6], i < 6 ? 0. : -block.height)),
                  0.,
                  1e-12);
  }

  std::size_t
  n_cells(const Mesh<2> &mesh)
  {
    return mesh.triangulation->n_global_active_cells();
  }
} // namespace



TEST(ToothInBlock, Default)
{
  const auto mesh = make<2>("tooth in block", {});
  check_tooth_in_block(mesh, Block());
  EXPECT_NEAR(n_cells(mesh), 1004., 20.);
  EXPECT_GT(smallest_corner(mesh), 0.6);
  // Finer at the apex than at the margin.
  const auto nodes = root_nodes(mesh);
  EXPECT_GT(nodes[0].distance(nodes[1]),
            2.5 *
              nodes[nodes.size() / 2].distance(nodes[nodes.size() / 2 - 1]));

  // The same input gives the same mesh, byte for byte.
  const std::string name = folder() + "/tooth-in-block.msh";
  const std::string once = content(name);
  EXPECT_GT(once.size(), 10000u);
  make<2>("tooth in block", {});
  EXPECT_EQ(once, content(name));
}



TEST(ToothInBlock, OtherParameters)
{
  for (const double density : {0.25, 0.5, 2., 4.})
    {
      SCOPED_TRACE("density " + std::to_string(density));
      const auto mesh =
        make<2>("tooth in block", {{"Mesh density", std::to_string(density)}});
      check_tooth_in_block(mesh, Block());
      EXPECT_NEAR(n_cells(mesh) / (1004. * density), 1., 0.1);
      EXPECT_GT(smallest_corner(mesh), 0.5);
    }
  for (const double bone : {30., 80.})
    {
      Block block;
      block.bone = bone;
      const auto mesh =
        make<2>("tooth in block", {{"Bone width", std::to_string(bone)}});
      check_tooth_in_block(mesh, block);
      EXPECT_GT(smallest_corner(mesh), 0.6);
    }
  Block block;
  block.half_width = 3.;
  block.depth      = 3.; // a half circle
  block.bone       = 20.;
  block.height     = 12.;
  block.margin     = 5.;
  const auto mesh  = make<2>("tooth in block",
                            {{"Root half width", "3"},
                              {"Root depth", "3"},
                              {"Bone width", "20"},
                              {"Bone height", "12"},
                              {"Centre margin", "5"},
                              {"Mesh density", "4"}});
  check_tooth_in_block(mesh, block);
  EXPECT_GT(smallest_corner(mesh), 0.5);
}



TEST(ToothInBlock, ShippedMeshes)
{
  const std::string meshes = std::string(ALVEOLUS_SOURCE_DIR) + "/meshes";
  const auto fine = make<2>("file", {{"File name", "academic.msh"}}, meshes);
  check_tooth_in_block(fine, Block());
  EXPECT_EQ(n_cells(fine), 1004u);
  EXPECT_GT(smallest_corner(fine), 0.7);

  const auto coarse =
    make<2>("file", {{"File name", "academic-coarse.msh"}}, meshes);
  check_tooth_in_block(coarse, Block());
  EXPECT_NEAR(n_cells(coarse), 300., 50.);
  EXPECT_GT(smallest_corner(coarse), 0.6);
}



// The same mesh as gmsh itself writes it in format 2.2, and in binary.
TEST(ToothInBlock, ConvertedByGmsh)
{
  const auto convert = [](const std::string              &name,
                          const std::vector<std::string> &options) {
    const std::string        result    = folder() + "/" + name;
    std::vector<std::string> arguments = {"gmsh",
                                          std::string(ALVEOLUS_SOURCE_DIR) +
                                            "/meshes/academic-coarse.msh",
                                          "-save",
                                          "-o",
                                          result};
    arguments.insert(arguments.end(), options.begin(), options.end());
    if (is_root())
      {
        EXPECT_TRUE(run_process(arguments, 60.).succeeded());
      }
    MPI_Barrier(MPI_COMM_WORLD);
  };
  convert("22.msh", {"-format", "msh22"});
  check_tooth_in_block(make<2>("file", {{"File name", "22.msh"}}), Block());
  convert("binary.msh", {"-format", "msh41", "-bin"});
  expect_words(message<InputError, 2>("file", {{"File name", "binary.msh"}}),
               {"binary.msh, line 2", "a binary mesh"});
}



TEST(ToothInBlock, WrongParameters)
{
  expect_words(message<InputError, 2>("tooth in block", {{"Root depth", "40"}}),
               {"Mesh / tooth in block / Root depth", "deeper"});
  expect_words(message<InputError, 2>("tooth in block",
                                      {{"Centre margin", "60"}}),
               {"Mesh / tooth in block / Centre margin", "wider"});
}



TEST(ToothInBlock, MesherFails)
{
  // The environment names the mesher; no parameter can.
  const auto with = [](const std::string &program) {
    setenv("ALVEOLUS_MESHER", program.c_str(), 1);
    const std::string said = message<RunError, 2>("tooth in block", {});
    unsetenv("ALVEOLUS_MESHER");
    return said;
  };
  setenv("ALVEOLUS_MESHER", "no-such-gmsh", 1);
  expect_words(message<InputError, 2>("tooth in block", {}),
               {"Mesh / tooth in block",
                "the mesher 'no-such-gmsh' could not be started",
                "No such file",
                "install gmsh"});
  expect_words(with("/bin/false"), {"'/bin/false' ended with exit code 1"});
  expect_words(with("/bin/true"), {"'/bin/true' ended without a mesh"});

  const auto script = [](const std::string &name, const std::string &text) {
    write(name, "#!/bin/sh\n" + text + "\n");
    const std::string path =
      std::filesystem::absolute(folder() + "/" + name).string();
    if (is_root())
      std::filesystem::permissions(path, std::filesystem::perms::owner_all);
    MPI_Barrier(MPI_COMM_WORLD);
    return path;
  };
  expect_words(with(script("crash", "echo the last words >&2; kill -SEGV $$")),
               {"crashed by signal 11", "the last words"});
  const auto begin = std::chrono::steady_clock::now();
  setenv("ALVEOLUS_MESHER", script("hang", "sleep 100").c_str(), 1);
  expect_words(message<RunError, 2>("tooth in block",
                                    {{"Mesher time limit", "0.3"}}),
               {"did not end within its time limit", "Mesher time limit"});
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                          begin)
              .count(),
            20.);
  // A mesher that writes triangles (the last argument is the mesh's name).
  setenv("ALVEOLUS_MESHER",
         script("triangles",
                "for last; do :; done\ncat > \"$last\" <<END\n"
                "$(printf '$MeshFormat\\n2.2 0 8\\n$EndMeshFormat\\n$Nodes\\n3"
                "\\n1 0 0 0\\n2 1 0 0\\n3 0 1 0\\n$EndNodes\\n$Elements\\n1\\n"
                "1 2 2 1 1 1 2 3\\n$EndElements')\nEND")
           .c_str(),
         1);
  expect_words(message<InputError, 2>("tooth in block", {}),
               {"no mesh of quads",
                "a mesh with a triangle: 1 triangle, first one"});
  unsetenv("ALVEOLUS_MESHER");
}
