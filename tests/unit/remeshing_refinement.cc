// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Local refinement: transfers on meshes with hanging nodes, and the remesher
// that makes them.
#include "noise.h"

#include <alveolus/base/errors.h>
#include <alveolus/mesh/hanging_nodes.h>
#include <alveolus/mesh/mesh_record.h>
#include <alveolus/remeshing/remesher.h>
#include <alveolus/transfer/nodal_transfer.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/swept_transfer.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  template <int dim>
  Mesh<dim>
  cube(const unsigned int refinements)
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    GridGenerator::subdivided_hyper_cube(*mesh.triangulation, 2);
    mesh.triangulation->refine_global(refinements);
    mesh.names.regions["body"] = {0};
    return mesh;
  }

  /** Configuration and history of a mesh, with moved nodes. */
  template <int dim>
  struct Body
  {
    Body(const Mesh<dim>                                              &mesh,
         const std::function<NodalVector(const Configuration<dim> &)> &at = {})
      : configuration(mesh, 1)
    {
      HistoryField density, elastic;
      density.name  = "density";
      elastic.name  = "elastic strain";
      elastic.shape = HistoryField::Shape::symmetric_tensor;
      store         = std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}},
        std::vector<HistoryLayout>{HistoryLayout({density, elastic}, dim)},
        Utilities::pow(2, dim));
      if (at)
        configuration.set_positions(at(configuration));
    }

    NodalVector
    at_nodes(const std::function<Tensor<1, dim>(const Point<dim> &)> &f) const
    {
      NodalVector          result = configuration.make_vector();
      const NodalVector    x      = configuration.positions();
      const CellNodes<dim> nodes(configuration);
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors p;
      for (const auto &cell :
           configuration.mesh.triangulation->active_cell_iterators())
        if (!cell->is_artificial())
          {
            const unsigned int c = cell->active_cell_index();
            nodes.gather(x, c, p);
            for (unsigned int i = 0; i < nodes.n_nodes; ++i)
              {
                const Tensor<1, dim> value = f(Point<dim>(p[i]));
                for (unsigned int d = 0; d < dim; ++d)
                  if (nodes.local_entries(c, i)[d] <
                      result.locally_owned_size())
                    result.local_element(nodes.local_entries(c, i)[d]) =
                      value[d];
              }
          }
      result.update_ghost_values();
      HangingNodes<dim>(configuration).distribute(result);
      return result;
    }

    /** Positions with nodes inside the cube moved by noise. */
    NodalVector
    shaken(const double size, const unsigned int seed) const
    {
      return at_nodes([=](const Point<dim> &p) {
        Tensor<1, dim> x = p;
        for (unsigned int d = 0; d < dim; ++d)
          if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
            x[d] += size * noise(p, 3 * seed + d);
        return x;
      });
    }

    void
    for_each(const std::function<void(unsigned int, double *)> &f)
    {
      for (const auto &cell :
           configuration.mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          for (unsigned int q = 0; q < store->n_points; ++q)
            f(cell->active_cell_index() * store->n_points + q,
              store->old_record(cell->active_cell_index(), q));
    }

    Configuration<dim>                 configuration;
    std::unique_ptr<HistoryStore<dim>> store;
  };

  template <int dim>
  std::unique_ptr<Remesher<dim>>
  remesher(const std::string &parameters)
  {
    auto result = Registry<Remesher<dim>>::create("refinement", "test");
    ParameterHandler prm;
    result->declare_parameters(prm);
    prm.parse_input_from_string(parameters);
    return result;
  }

  /** Divides where a peak in one corner is steep. */
  template <int dim>
  RemeshCandidate<dim>
  divided(const Configuration<dim> &old, const std::string &parameters)
  {
    auto                maker = remesher<dim>(parameters);
    std::vector<double> values(old.mesh.triangulation->n_active_cells());
    for (const auto &cell : old.mesh.triangulation->active_cell_iterators())
      if (!cell->is_artificial())
        values[cell->active_cell_index()] =
          std::exp(-8. * cell->center().norm_square());
    maker->initialize(old.mesh.names, "test");
    maker->tell(values);
    return std::move(maker->candidates(old, ".", "test")[0]);
  }
} // namespace



// Volumes and swept volumes agree across hanging faces, so constants stay to
// the last bit and contents to round-off, with both orders.
template <int dim>
void
swept()
{
  const Mesh<dim> coarse = cube<dim>(dim == 2 ? 2 : 1);
  const Body<dim> before(coarse);
  const Mesh<dim> mesh =
    std::move(divided(before.configuration, "set Refine part = 0.2").mesh);
  ASSERT_TRUE(mesh.triangulation->has_hanging_nodes());
  for (const std::string scheme : {"Godunov", "limited linear"})
    {
      Body<dim>          body(mesh);
      SweptTransfer<dim> transfer(
        body.configuration,
        *body.store,
        Registry<TransferScheme<dim>>::create(scheme, "Scheme"));
      std::vector<double> volume;
      transfer.subcells().volumes(body.configuration.positions(), volume);
      double whole = 0.;
      body.for_each([&](const unsigned int s, double *r) {
        whole += volume[s];
        for (unsigned int k = 0; k < body.store->layout(0).size; ++k)
          r[k] = 0.4 + 0.0317 * k;
        r[1] = noise(Point<dim>(), s % 97);
      });
      EXPECT_NEAR(Utilities::MPI::sum(whole, MPI_COMM_WORLD), 1., 1e-13);
      for (unsigned int round = 0; round < 3; ++round)
        {
          const NodalVector x_0 = body.configuration.positions();
          const NodalVector x_1 = body.shaken(dim == 2 ? 0.012 : 0.025, round);
          const TransferReport report =
            transfer.transfer(*body.store, x_0, x_1);
          body.configuration.set_positions(x_1);
          EXPECT_LT(report.geometric_conservation_error, 1e-12);
          EXPECT_LT(std::abs(report.error()), 1e-14);
          EXPECT_NEAR(report.content_after, 0.4, 1e-13);
        }
      body.for_each([&](const unsigned int, double *r) {
        EXPECT_EQ(r[0], 0.4);
        EXPECT_EQ(r[2], 0.4 + 0.0317 * 2);
        EXPECT_LE(std::abs(r[1]), 1.);
      });
    }
}

TEST(HangingNodes, SweptTransfer)
{
  swept<2>();
  swept<3>();
}



// Content of a varying field, too, and linear nodal fields.
template <int dim>
void
contents()
{
  const Mesh<dim> coarse = cube<dim>(dim == 2 ? 2 : 1);
  const Body<dim> before(coarse);
  const Mesh<dim> mesh =
    std::move(divided(before.configuration, "set Refine part = 0.3").mesh);
  for (const std::string scheme : {"Godunov", "limited linear"})
    {
      Body<dim>          body(mesh);
      SweptTransfer<dim> transfer(
        body.configuration,
        *body.store,
        Registry<TransferScheme<dim>>::create(scheme, "Scheme"));
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      transfer.subcells().centroids(body.configuration.positions(),
                                    centroid,
                                    volume);
      body.for_each(
        [&](const unsigned int s, double *r) { r[0] = noise(centroid[s], 5); });
      const auto linear = [](const Point<dim> &p) {
        Tensor<1, dim> u;
        for (unsigned int d = 0; d < dim; ++d)
          u[d] = 0.3 - d + (1. + d) * p[0] - 2. * p[dim - 1];
        return u;
      };
      NodalVector       u      = body.at_nodes(linear);
      const NodalVector x_0    = body.configuration.positions();
      const NodalVector x_1    = body.shaken(dim == 2 ? 0.012 : 0.025, 3);
      const auto        report = transfer.transfer(*body.store, x_0, x_1);
      EXPECT_LT(std::abs(report.error()), 1e-14);
      EXPECT_LT(std::abs(report.through_boundary), 1e-14);
      NodalTransfer<dim>(body.configuration).transfer(u, x_0, x_1);
      body.configuration.set_positions(x_1);
      NodalVector exact = body.at_nodes(linear);
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        EXPECT_NEAR(u.local_element(i), exact.local_element(i), 1e-12);
    }
}

TEST(HangingNodes, ContentsAndLinearFields)
{
  contents<2>();
  contents<3>();
}



// Divided and joined, the deformed body stays where it is, and history comes to
// the new cells as overlap dictates.
template <int dim>
void
remesh()
{
  const Mesh<dim> coarse = cube<dim>(dim == 2 ? 2 : 1);
  Body<dim>       a(coarse);
  // In 3D affine: there sub-cells are cut into tetrahedra
  a.configuration.set_positions(dim == 2 ? a.shaken(0.02, 1)
                                         : a.at_nodes([](const Point<dim> &p) {
                                             return Tensor<1, dim>(1.1 * p);
                                           }));
  a.for_each([&](const unsigned int s, double *r) {
    r[0] = 1. + 0.1 * (s % 7);
    for (unsigned int k = 1; k < a.store->layout(0).size; ++k)
      r[k] = 0.0317 * k;
  });
  RemeshCandidate<dim> fine = divided(a.configuration, "set Refine part = 0.3");
  EXPECT_TRUE(fine.mesh.triangulation->has_hanging_nodes());
  EXPECT_GT(fine.mesh.triangulation->n_global_active_cells(),
            coarse.triangulation->n_global_active_cells());
  Body<dim>  b(fine.mesh, fine.positions);
  const auto report =
    OverlapTransfer<dim>(a.configuration, *a.store, "limited linear")
      .transfer(b.configuration, *b.store);
  EXPECT_NEAR(report.content_after() / report.content_before(), 1., 1e-13);
  EXPECT_NEAR(report.regions[0].volume_after / report.regions[0].volume_before,
              1.,
              1e-13);
  EXPECT_EQ(report.n_uncovered, 0u);
  b.for_each([&](const unsigned int, double *r) {
    for (unsigned int k = 1; k < b.store->layout(0).size; ++k)
      EXPECT_NEAR(r[k], 0.0317 * k, 1e-15);
  });

  // It can be stored, and goes back to the mesh it was.
  BlockFile blocks;
  save_mesh(fine.mesh, blocks);
  const Mesh<dim> restored = load_mesh<dim>(blocks, MPI_COMM_WORLD);
  EXPECT_EQ(fingerprint(restored), fingerprint(fine.mesh));
  RemeshCandidate<dim> joined =
    divided(b.configuration,
            "set Refine part = 0\n set Coarsen part = 1\n"
            "set Smallest level = " +
              std::to_string(dim == 2 ? 2 : 1));
  EXPECT_EQ(fingerprint(joined.mesh), fingerprint(coarse));
  const Body<dim>   c(joined.mesh, joined.positions);
  const NodalVector x_a = a.configuration.positions();
  const NodalVector x_c = c.configuration.positions();
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
    for (unsigned int i = 0; i < x_a.locally_owned_size(); ++i)
      {
        EXPECT_EQ(x_a.local_element(i), x_c.local_element(i));
      }
}

TEST(RefinementRemesher, DividedAndJoined)
{
  remesh<2>();
  remesh<3>();
}
