// SPDX-License-Identifier: LGPL-2.1-or-later
// That Newton's method ends at round-off with the error of the mesh is checked
// by scene/extremes (Poisson's ratio 0.499999, contrast 1e6).
#include <alveolus/solver/round_off.h>
#include <alveolus/state/state.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <limits>

using namespace dealii;
using namespace alveolus;



TEST(RoundOff, DisplacementsAreThatPartOfTheCell)
{
  Mesh<2> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(*mesh.triangulation, 0., 8.);
  mesh.triangulation->refine_global(3); // cells of 1 mm
  const State<2>    state(mesh, 1, {{0, 0}}, {HistoryLayout({}, 2)});
  const NodalVector u          = round_off_displacement(state.configuration);
  unsigned int      n_positive = 0;
  for (const auto i : state.configuration.locally_owned)
    {
      EXPECT_EQ(std::abs(u(i)), std::numeric_limits<double>::epsilon());
      n_positive += u(i) > 0.;
    }
  // Both signs, or cells would only be moved
  EXPECT_GT(n_positive, 0.3 * u.size());
  EXPECT_LT(n_positive, 0.7 * u.size());
}



TEST(RoundOff, StagnatesAfterThreeIterationsThatBringLessThanHalf)
{
  EXPECT_FALSE(stagnates({1., 1., 1.}, 0));
  EXPECT_TRUE(stagnates({1., 1., 0.9, 0.8}, 0));
  EXPECT_FALSE(stagnates({1., 1., 0.9, 0.4}, 0));
  EXPECT_FALSE(stagnates({1., 1e-2, 1e-4, 1e-8}, 0));
  EXPECT_TRUE(stagnates({1., 1e-8, 2e-8, 1e-8, 3e-8}, 0));
  // Counted from the last augmentation on
  EXPECT_FALSE(stagnates({1e-8, 2e-8, 1e-8, 3e-8}, 1));
}
