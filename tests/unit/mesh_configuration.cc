// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The mapping of a moved mesh: areas and positions follow the displacement.
#include <alveolus/mesh/configuration.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;

template <int dim>
void
stretched_volume(const unsigned int degree)
{
  Mesh<dim> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<dim>>(MPI_COMM_WORLD);
  GridGenerator::subdivided_hyper_cube(*mesh.triangulation, 3);
  Configuration<dim> configuration(mesh, degree);
  NodalVector        x = configuration.positions();
  x *= 2.;
  x.update_ghost_values();
  configuration.set_positions(x);

  FEValues<dim> fe_values(configuration.mapping(),
                          configuration.fe,
                          QGauss<dim>(degree + 1),
                          update_JxW_values);
  double        volume = 0.;
  for (const auto &cell : configuration.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        fe_values.reinit(cell);
        for (const double JxW : fe_values.get_JxW_values())
          volume += JxW;
      }
  volume = Utilities::MPI::sum(volume, MPI_COMM_WORLD);
  EXPECT_NEAR(volume, std::pow(2., dim), 1e-13);
}

TEST(Configuration, StretchedVolume)
{
  stretched_volume<2>(1);
  stretched_volume<2>(2);
  stretched_volume<3>(1);
  stretched_volume<3>(2);
}

// A disc of degree 2: area and nodes of the mapping are those of the curved
// cells, not of the polygon.
TEST(Configuration, CurvedManifold)
{
  Mesh<2> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
  GridGenerator::hyper_ball(*mesh.triangulation);
  mesh.triangulation->refine_global(3);
  Configuration<2>  configuration(mesh, 2);
  const NodalVector x = configuration.positions();

  FEValues<2>                          fe_values(configuration.mapping(),
                        configuration.fe,
                        QGauss<2>(4),
                        update_JxW_values);
  FEValues<2>                          at_nodes(configuration.mapping(),
                       configuration.fe,
                       Quadrature<2>(
                         configuration.fe.get_unit_support_points()),
                       update_quadrature_points);
  std::vector<types::global_dof_index> dofs(configuration.fe.n_dofs_per_cell());
  double                               area = 0.;
  for (const auto &cell : configuration.dof_handler.active_cell_iterators())
    if (cell->is_locally_owned())
      {
        fe_values.reinit(cell);
        for (const double JxW : fe_values.get_JxW_values())
          area += JxW;
        at_nodes.reinit(cell);
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          EXPECT_NEAR(x[dofs[i]],
                      at_nodes.quadrature_point(
                        i)[configuration.fe.system_to_component_index(i).first],
                      1e-14);
      }
  area = Utilities::MPI::sum(area, MPI_COMM_WORLD);
  // The polygon with 32 corners has 3.1214.
  EXPECT_NEAR(area, numbers::PI, 1e-4);
}
