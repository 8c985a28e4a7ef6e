// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The tooth in its block by the mesher: areas, lengths and names follow from
// the geometry that was asked for; a mesher that fails.
#include "mesh_source_bench.h"

#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
  std::string
  content(const std::string &path)
  {
    std::ifstream      file(path);
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
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
