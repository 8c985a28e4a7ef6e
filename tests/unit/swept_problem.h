// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_swept_problem_h
#define alveolus_tests_unit_swept_problem_h

// History on a mesh whose nodes move, for tests of transfer on the same
// connectivity.
#include "noise.h"

#include <alveolus/transfer/godunov.h>
#include <alveolus/transfer/swept_transfer.h>

#include <deal.II/grid/grid_generator.h>

#include <functional>

namespace alveolus::bench
{
  using namespace dealii;

  using Shape = HistoryField::Shape;

  /** Layout like that of bone: 10 values in 2D, 14 in 3D. */
  template <int dim>
  HistoryLayout
  bone_layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.3;
    density.upper = 1.9;
    HistoryField plastic;
    plastic.name  = "plastic strain";
    plastic.lower = 0.;
    HistoryField elastic;
    elastic.name  = "elastic strain";
    elastic.shape = Shape::symmetric_tensor;
    HistoryField fabric;
    fabric.name      = "log fabric";
    fabric.shape     = Shape::symmetric_tensor;
    fabric.traceless = true;
    return HistoryLayout({density, plastic, elastic, fabric}, dim);
  }

  /** Mesh, configuration, history and transfer of one test. */
  template <int dim>
  struct Problem
  {
    using Grid = parallel::distributed::Triangulation<dim>;

    Problem(const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const double                       donor_fraction = 0.5,
            const MPI_Comm                     communicator   = MPI_COMM_WORLD)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      store         = std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}, {1, 1}},
        std::vector<HistoryLayout>{bone_layout<dim>(), bone_layout<dim>()},
        Utilities::pow(degree + 1, dim));
      transfer =
        std::make_unique<SweptTransfer<dim>>(*configuration,
                                             *store,
                                             std::make_unique<Godunov<dim>>(),
                                             "density",
                                             donor_fraction);
    }

    /** x + motion(x) for every node. */
    NodalVector
    moved(const std::function<Tensor<1, dim>(const Point<dim> &)> &motion) const
    {
      NodalVector                          x = configuration->positions();
      std::vector<types::global_dof_index> dofs(
        configuration->fe.n_dofs_per_cell());
      const NodalVector start = x;
      const auto       &part  = *start.get_partitioner();
      x.zero_out_ghost_values();
      for (const auto &cell :
           configuration->dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            cell->get_dof_indices(dofs);
            for (unsigned int i = 0; i < dofs.size(); i += 1)
              if (configuration->fe.system_to_component_index(i).first == 0)
                {
                  const unsigned int base =
                    configuration->fe.system_to_component_index(i).second;
                  Point<dim> p;
                  for (unsigned int d = 0; d < dim; ++d)
                    p[d] = start.local_element(part.global_to_local(
                      dofs[configuration->fe.component_to_system_index(d,
                                                                       base)]));
                  const Tensor<1, dim> m = motion(p);
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const auto dof =
                        dofs[configuration->fe.component_to_system_index(d,
                                                                         base)];
                      if (configuration->locally_owned.is_element(dof))
                        x[dof] = p[d] + m[d];
                    }
                }
          }
      x.update_ghost_values();
      return x;
    }

    /** Interior nodes of [0,1]^dim by noise of size @p size. */
    NodalVector
    shaken(const double size, const unsigned int seed = 1) const
    {
      return moved([&](const Point<dim> &p) {
        Tensor<1, dim> m;
        for (unsigned int d = 0; d < dim; ++d)
          if (p[d] < 1e-10 || p[d] > 1. - 1e-10)
            return Tensor<1, dim>();
        for (unsigned int d = 0; d < dim; ++d)
          m[d] = size * noise(p, 3 * seed + d);
        return m;
      });
    }

    /** Fill records from a function of the sub-cell's centroid. */
    void
    fill(const std::function<void(const Point<dim> &, double *)> &f)
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      transfer->subcells().centroids(configuration->positions(),
                                     centroid,
                                     volume);
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q], store->old_record(c, q));
    }

    /** Random, admissible records. */
    void
    fill_noise()
    {
      const unsigned int size = store->layout(0).size;
      fill([size](const Point<dim> &p, double *r) {
        for (unsigned int k = 0; k < size; ++k)
          r[k] = noise(p, k);
        r[0] = 1.1 + 0.8 * r[0];
        r[1] = 0.5 + 0.5 * r[1];
      });
    }

    /** Go over the records of owned cells. */
    void
    for_each(const std::function<void(const double *)> &f) const
    {
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(store->old_record(c, q));
    }

    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
    std::unique_ptr<HistoryStore<dim>>  store;
    std::unique_ptr<SweptTransfer<dim>> transfer;
  };

  /** [0,1]^dim of 8^2 or 4^3 cells. */
  template <int dim>
  void
  cube(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::subdivided_hyper_cube(t, dim == 2 ? 8 : 4);
  }

  /** Cells of all orientations, curved boundary. */
  template <int dim>
  void
  ball(parallel::distributed::Triangulation<dim> &t)
  {
    GridGenerator::hyper_ball_balanced(t);
    t.refine_global(dim == 2 ? 2 : 1);
  }
} // namespace alveolus::bench

#endif
