// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// What the names of a mesh stand for, and the picture with them.
#include <alveolus/io/mesh_picture.h>
#include <alveolus/io/named_sizes.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;

namespace
{
  /** A box 3 x 2 (x 1), cells of the size 1/2, one of them refined. */
  template <int dim>
  Mesh<dim>
  box()
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    const Point<3>            far(3., 2., 1.);
    std::vector<unsigned int> n;
    Point<dim>                corner;
    for (unsigned int d = 0; d < dim; ++d)
      {
        n.push_back(std::lround(2. * far[d]));
        corner[d] = far[d];
      }
    GridGenerator::subdivided_hyper_rectangle(
      *mesh.triangulation, n, Point<dim>(), corner, true);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      {
        cell->set_material_id(cell->center()[0] > 2.);
        if constexpr (dim == 2)
          for (const unsigned int f : cell->face_indices())
            if (std::abs(cell->face(f)->center()[0] - 2.) < 1e-10)
              cell->face(f)->set_manifold_id(7);
      }
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() &&
          cell->center().distance(Point<dim>()) < 0.5)
        cell->set_refine_flag();
    mesh.triangulation->execute_coarsening_and_refinement();
    mesh.names.regions    = {{"soft & <weak>", {0}}, {"hard", {1}}};
    mesh.names.boundaries = {{"left", {0}}, {"ends", {0, 1}}, {"bottom", {2}}};
    if (dim == 2)
      mesh.names.curves = {{"left", {}}, {"between", {7}}};
    mesh.names.points = {{"corner", corner}};
    return mesh;
  }

  void
  expect_size(const std::vector<NamedSize> &list,
              const std::string            &name,
              const std::string            &kind,
              const unsigned int            n,
              const double                  size)
  {
    for (const NamedSize &entry : list)
      if (entry.name == name)
        {
          EXPECT_EQ(entry.kind, kind) << name;
          EXPECT_EQ(entry.n_members, n) << name;
          EXPECT_NEAR(entry.size, size, 1e-12) << name;
          return;
        }
    ADD_FAILURE() << name << " is missing";
  }

  std::size_t
  count(const std::string &text, const std::string &word)
  {
    std::size_t n = 0, at = 0;
    while ((at = text.find(word, at)) != std::string::npos)
      {
        ++n;
        ++at;
      }
    return n;
  }
} // namespace



TEST(Names, Sizes)
{
  const auto plane = named_sizes(box<2>());
  const auto solid = named_sizes(box<3>());
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    {
      EXPECT_TRUE(plane.empty() && solid.empty());
      return;
    }
  // The refined cell is at the origin.
  ASSERT_EQ(plane.size(), 7u);
  expect_size(plane, "soft & <weak>", "region", 16 + 3, 4.);
  expect_size(plane, "hard", "region", 8, 2.);
  expect_size(plane, "left", "boundary", 4 + 1, 2.);
  expect_size(plane, "ends", "boundary", 8 + 1, 4.);
  expect_size(plane, "bottom", "boundary", 6 + 1, 3.);
  expect_size(plane, "between", "curve", 4, 2.);
  expect_size(plane, "corner", "point", 1, 0.);
  ASSERT_EQ(solid.size(), 6u);
  expect_size(solid, "soft & <weak>", "region", 32 + 7, 4.);
  expect_size(solid, "left", "boundary", 8 + 3, 2.);
  expect_size(solid, "ends", "boundary", 16 + 3, 4.);
  expect_size(solid, "bottom", "boundary", 12 + 3, 3.);
}



// All cells, names once each, and nothing that breaks the XML.
TEST(Names, Picture)
{
  const std::string plane = mesh_picture(box<2>(), "A <box>");
  const std::string solid = mesh_picture(box<3>(), "A <box>");
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
    {
      EXPECT_TRUE(plane.empty() && solid.empty());
      return;
    }
  // A cell is a path closed by Z; in 3D the faces of the boundary: 2 (24 + 12
  // + 8), of which three belong to the refined cell
  EXPECT_EQ(count(plane, "Z"), 24u + 3u);
  EXPECT_EQ(count(solid, "Z"), 88u + 9u);
  for (const std::string &text : {plane, solid})
    {
      EXPECT_EQ(count(text, ">A &lt;box&gt;</text>"), 1u);
      EXPECT_EQ(count(text, ">left</text>"), 1u);
      EXPECT_EQ(count(text, ">ends</text>"), 1u);
      EXPECT_EQ(count(text, ">corner</text>"), 1u);
      EXPECT_EQ(count(text, "soft &amp; &lt;weak&gt;: "), 1u);
      EXPECT_EQ(count(text, "<box>"), 0u);
      EXPECT_EQ(count(text, "<text"), count(text, "</text>"));
      EXPECT_EQ(count(text, "nan"), 0u);
    }
  EXPECT_EQ(count(plane, ">between</text>"), 1u);
  EXPECT_EQ(count(plane, "stroke-dasharray"), 1u);
}
