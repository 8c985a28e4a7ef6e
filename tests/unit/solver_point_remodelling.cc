// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// mpirun=3
// Remodelling shared among processes: that all get the same work, and every
// point the same density and fabric as when its own process integrates it.
#include <alveolus/base/work_sharing.h>
#include <alveolus/solver/point_remodelling.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <numeric>
#include <random>

using namespace dealii;
using namespace alveolus;



TEST(WorkSharing, AllGetTheMean)
{
  std::mt19937                           generator(1);
  std::uniform_real_distribution<double> random(0., 1.);
  for (unsigned int n = 1; n < 40; ++n)
    {
      std::vector<double> work(n);
      for (double &w : work)
        w = std::pow(random(generator), 4);
      const double mean = std::accumulate(work.begin(), work.end(), 0.) / n;
      const std::vector<double> before = work;
      const auto                gifts  = balance_work(work);
      EXPECT_LT(gifts.size(), std::max(n, 1u));
      for (const WorkGift &gift : gifts)
        {
          EXPECT_GT(gift.work, 0.);
          EXPECT_GT(before[gift.from], mean);
          EXPECT_LT(before[gift.to], mean);
          work[gift.from] -= gift.work;
          work[gift.to] += gift.work;
        }
      if (*std::max_element(before.begin(), before.end()) > 1.05 * mean)
        for (const double w : work)
          EXPECT_NEAR(w, mean, 1e-14 * n);
      else
        EXPECT_TRUE(gifts.empty());
    }
}



TEST(WorkSharing, LittleIsNotWorthAMessage)
{
  EXPECT_TRUE(balance_work({0., 0., 0.}).empty());
  EXPECT_TRUE(balance_work({1., 1.09}).empty());
  EXPECT_EQ(balance_work({1., 1.2}).size(), 1u);
  EXPECT_TRUE(balance_work({1., 1.2}, 0.1001).empty());
}



TEST(WorkSharing, ItemsMakeUpTheGifts)
{
  const std::vector<double>   costs = {3., 0., 1., 2., 2., 5.};
  const std::vector<WorkGift> gifts = {{0, 1, 9.}, {2, 1, 3.5}, {2, 3, 3.}};
  const auto                  given = items_to_give(costs, gifts, 2);
  ASSERT_EQ(given.size(), 2u);
  EXPECT_EQ(given.at(1), (std::vector<unsigned int>{0, 1, 2}));
  EXPECT_EQ(given.at(3), (std::vector<unsigned int>{3, 4}));
  EXPECT_TRUE(items_to_give(costs, gifts, 1).empty());
}



/** Bone in a square: loaded in the lower half, at rest in the upper one. */
class SharedRemodelling : public ::testing::TestWithParam<bool>
{
protected:
  SharedRemodelling()
  {
    ParameterHandler of_bone, of_law;
    bone.declare_parameters(of_bone);
    bone.set_remodelled(true, true);
    bone.initialize(2, "Materials/bone");
    law = Registry<RemodellingLaw>::create("mechanostat", "Type");
    law->declare_parameters(of_law);
    law->initialize("Remodelling");

    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
    GridGenerator::hyper_cube(*mesh.triangulation, 0., 1.);
    mesh.triangulation->refine_global(6);
    mesh.names.regions["bone"] = {0};
    state                      = std::make_unique<State<2>>(
      mesh,
      1,
      std::map<types::material_id, unsigned int>{{0, 0}},
      std::vector<HistoryLayout>{HistoryLayout(bone.history_fields(), 2)});
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cells.push_back(cell->active_cell_index());
          for (unsigned int q = 0; q < state->history.n_points; ++q)
            {
              double *record = state->history.trial_record(cells.back(), q);
              bone.initial_history(record);
              BonePoint    point = bone.point(record);
              const double load  = std::max(0., 0.5 - cell->center()[1]);
              point.elastic_strain[0][0] = -0.01 * load;
              point.elastic_strain[0][1] = 0.01 * load * cell->center()[0];
              bone.store(point, record);
            }
        }
  }

  RemodelledBone                  bone;
  std::unique_ptr<RemodellingLaw> law;
  Mesh<2>                         mesh;
  std::unique_ptr<State<2>>       state;
  std::vector<unsigned int>       cells;
};



TEST_P(SharedRemodelling, IsThatOfEachPointToTheLastBit)
{
  constexpr double   dt        = 3.;
  constexpr double   tolerance = 1e-10;
  HistoryStore<2>   &history   = state->history;
  const unsigned int n_points  = history.n_points;
  const auto         initial   = history.trial_values;

  std::vector<double> stimulus;
  if (GetParam())
    for (const unsigned int c : cells)
      for (unsigned int q = 0; q < n_points; ++q)
        stimulus.push_back(
          1.5 * law->stimulus(bone, bone.point(history.trial_record(c, q))));
  const LocalIntegrator integrator(*law, bone, tolerance);
  double                largest = 0.;
  unsigned int          n_moved = 0;
  for (unsigned int c = 0; c < cells.size(); ++c)
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const double change =
          integrator
            .advance(history.trial_record(cells[c], q),
                     dt,
                     GetParam() ? &stimulus[c * n_points + q] : nullptr)
            .density_change;
        largest = std::max(largest, std::abs(change));
        n_moved += change != 0.;
      }
  const auto expected  = history.trial_values;
  history.trial_values = initial;

  const std::vector<RegionRemodelling> laws = {{law.get(), &bone}};
  const RemodellingSummary             summary =
    PointRemodelling<2>(*state, laws, cells, tolerance)
      .advance(dt, GetParam() ? &stimulus : nullptr);
  for (const unsigned int c : cells)
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const double *record = history.trial_record(c, q);
        const double *alone =
          expected.data() + (record - history.trial_values.data());
        for (unsigned int i = 0; i < history.layout(0).size; ++i)
          ASSERT_EQ(record[i], alone[i]) << "cell " << c << ", point " << q;
      }
  EXPECT_EQ(summary.failure, "");
  EXPECT_EQ(summary.largest_density_change,
            Utilities::MPI::max(largest, MPI_COMM_WORLD));

  // The scene is what it was made for, and the work of one half is shared.
  n_moved = Utilities::MPI::sum(n_moved, MPI_COMM_WORLD);
  EXPECT_GT(n_moved, 64u * 32u); // of 64 x 64 x 4
  EXPECT_LT(n_moved, 64u * 64u * 2u + 1u);
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    EXPECT_GT(summary.n_shared, 32u);
  else
    EXPECT_EQ(summary.n_shared, 0u);
}

INSTANTIATE_TEST_SUITE_P(OwnAndFiltered, SharedRemodelling, ::testing::Bool());
