// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Meshes from GridGenerator: areas, lengths and names follow from the geometry
// that was asked for.
#include "mesh_source_bench.h"

#include <alveolus/base/errors.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



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
