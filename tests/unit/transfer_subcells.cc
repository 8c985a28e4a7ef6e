// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Sub-cells and what their faces sweep: neighbours of any orientation, volumes,
// centroids and moments.
#include "swept_problem.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

// Neighbours that see their common face turned or mirrored: a wrong pair of
// sub-cells there would break the conservation law, which throws.
template <int dim>
void
any_orientation(
  const std::function<void(parallel::distributed::Triangulation<dim> &)> &grid)
{
  for (const unsigned int degree : {1, 2})
    {
      Problem<dim> s(degree, grid);
      s.fill_noise();
      const NodalVector    x = s.moved([](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = 0.03 * noise(p, d);
        return m;
      });
      const TransferReport report =
        s.transfer->transfer(*s.store, s.configuration->positions(), x);
      EXPECT_LT(report.geometric_conservation_error, 1e-14);
      EXPECT_NEAR(report.error(), 0., 1e-14 * report.content_before);
    }
}

TEST(SubCells, AnyOrientation)
{
  for (unsigned int turn = 0; turn < 4; ++turn)
    any_orientation<2>([=](parallel::distributed::Triangulation<2> &t) {
      GridGenerator::non_standard_orientation_mesh(t, turn);
    });
  for (unsigned int i = 0; i < 16; ++i)
    any_orientation<3>([=](parallel::distributed::Triangulation<3> &t) {
      GridGenerator::non_standard_orientation_mesh(
        t, i & 1, i & 2, i & 4, i & 8);
    });
}

// Volumes and centroids against deal.II's own mapping and the divergence
// theorem; first moments obey the same conservation law as volumes.
template <int dim>
void
geometry(const unsigned int degree)
{
  Problem<dim>         s(degree, &ball<dim>);
  const SubCells<dim> &cells = s.transfer->subcells();
  const NodalVector    x_0   = s.configuration->positions();
  const NodalVector    x_1   = s.moved([degree](const Point<dim> &p) {
    Tensor<1, dim> m;
    for (unsigned int d = 0; d < dim; ++d)
      m[d] = 0.03 / (degree * degree) * noise(p, d) + 0.1;
    return m;
  });

  std::vector<double> volume, volume_0, swept;
  cells.volumes(x_1, volume);
  s.configuration->set_positions(x_1);
  FEValues<dim> fe_values(s.configuration->mapping(),
                          s.configuration->fe,
                          QGauss<dim>(2 * degree + 1),
                          update_JxW_values);
  for (const auto &cell : s.configuration->dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        fe_values.reinit(cell);
        double exact = 0., sum = 0.;
        for (const double JxW : fe_values.get_JxW_values())
          exact += JxW;
        for (unsigned int q = 0; q < cells.n_points; ++q)
          sum += volume[cell->active_cell_index() * cells.n_points + q];
        EXPECT_NEAR(sum / exact, 1., 1e-13);
      }

  std::vector<Point<dim>>     centroid_0, centroid_1;
  std::vector<Tensor<1, dim>> moment;
  cells.centroids(x_0, centroid_0, volume_0);
  cells.centroids(x_1, centroid_1, volume);
  cells.swept_volumes(x_0, x_1, swept);
  cells.swept_moments(x_0, x_1, moment);
  for (const unsigned int c : cells.owned_cells())
    for (unsigned int i = c * cells.n_points; i < (c + 1) * cells.n_points; ++i)
      {
        double         gain = 0.;
        Tensor<1, dim> moment_gain;
        for (unsigned int f = 0; f < cells.faces_per_sub_cell; ++f)
          {
            const auto &incidence = cells.incidences(i)[f];
            if (incidence.face == SubCells<dim>::none)
              continue;
            const double sign = incidence.side == 0 ? 1. : -1.;
            EXPECT_EQ(cells.faces()[incidence.face].sub_cell[incidence.side],
                      i);
            gain += sign * swept[incidence.face];
            moment_gain += sign * moment[incidence.face];
          }
        EXPECT_NEAR((volume_0[i] + gain) / volume[i], 1., 1e-14);
        for (unsigned int d = 0; d < dim; ++d)
          EXPECT_NEAR(volume_0[i] * centroid_0[i][d] + moment_gain[d],
                      volume[i] * centroid_1[i][d],
                      1e-14 * volume[i]);
      }
}

TEST(SubCells, Geometry)
{
  geometry<2>(1);
  geometry<2>(2);
  geometry<3>(1);
  geometry<3>(2);
}
