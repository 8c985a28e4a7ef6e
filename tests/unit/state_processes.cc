// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// State on several processes: records of ghosts, sums to the last bit.
#include "swept_problem.h"

#include <alveolus/state/reproducible_sum.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

// Ghost records are those of the owners.
TEST(HistoryStore, Ghosts)
{
  Problem<3> s(1, &cube<3>);
  for (const auto &cell : s.mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned())
      for (unsigned int q = 0; q < 8; ++q)
        s.store->old_record(cell->active_cell_index(), q)[3] =
          cell->center()[0] + 10. * cell->center()[1] +
          100. * cell->center()[2] + 1000. * q;
  s.store->update_ghosts();
  unsigned int n_ghosts = 0;
  for (const auto &cell : s.mesh.triangulation->active_cell_iterators())
    if (cell->is_ghost())
      {
        ++n_ghosts;
        for (unsigned int q = 0; q < 8; ++q)
          EXPECT_EQ(s.store->old_record(cell->active_cell_index(), q)[3],
                    cell->center()[0] + 10. * cell->center()[1] +
                      100. * cell->center()[2] + 1000. * q);
      }
  EXPECT_EQ(n_ghosts > 0, Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1);
  s.store->trial_values.assign(s.store->trial_values.size(), 3.);
  s.store->commit();
  EXPECT_EQ(s.store->old_record(s.transfer->subcells().owned_cells()[0], 1)[2],
            3.);
}

TEST(ReproducibleSum, OrderDoesNotMatter)
{
  const unsigned int  rank = Utilities::MPI::this_mpi_process(MPI_COMM_WORLD);
  const unsigned int  n    = Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD);
  std::vector<double> forward, backward;
  for (unsigned int i = 0; i < 1000; ++i)
    {
      const double v = noise(Point<2>(i, 0.), 3) * std::pow(10., i % 12);
      if (i % n == rank)
        forward.push_back(v);
      if (i % n == n - 1 - rank)
        backward.insert(backward.begin(), v);
    }
  const double sum = reproducible_sum(forward, MPI_COMM_WORLD);
  EXPECT_EQ(sum, reproducible_sum(backward, MPI_COMM_WORLD));
  // Cancellation to the last bit: 1e20 + 1 - 1e20 = 1.
  std::vector<double> cancelling;
  if (rank == 0)
    cancelling = {1e20, 1.};
  if (rank == n - 1)
    cancelling.push_back(-1e20);
  EXPECT_EQ(reproducible_sum(cancelling, MPI_COMM_WORLD), 1.);
  EXPECT_EQ(reproducible_sum({}, MPI_COMM_WORLD), 0.);
  EXPECT_TRUE(std::isnan(reproducible_sum({1., std::nan("")}, MPI_COMM_WORLD)));
}
