// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_two_ways_problem_h
#define alveolus_tests_unit_two_ways_problem_h

// History on a mesh whose nodes move, transferred on the same connectivity or
// by overlap.
#include "noise.h"

#include <alveolus/base/tensors.h>
#include <alveolus/transfer/overlap_transfer.h>
#include <alveolus/transfer/swept_transfer.h>

#include <deal.II/grid/grid_generator.h>

#include <functional>
#include <string>

namespace alveolus::bench
{
  using namespace dealii;

  using Shape = HistoryField::Shape;

  /** Schemes of first and second order. */
  inline const std::string first = "Godunov", second = "limited linear";

  /** How the history gets to the new positions. */
  enum class Way
  {
    swept,
    overlap
  };

  /** Bound of the fabric's principal values. */
  inline constexpr double fabric_bound = 20.;

  /** Layout with a density and two tensors, one of them bounded. */
  template <int dim>
  HistoryLayout
  bone_layout()
  {
    HistoryField density;
    density.name  = "density";
    density.lower = 0.3;
    density.upper = 1.9;
    HistoryField elastic;
    elastic.name  = "elastic strain";
    elastic.shape = Shape::symmetric_tensor;
    HistoryField fabric;
    fabric.name      = "log fabric";
    fabric.shape     = Shape::symmetric_tensor;
    fabric.traceless = true;
    fabric.lower     = -fabric_bound;
    fabric.upper     = fabric_bound;
    return HistoryLayout({density, elastic, fabric}, dim);
  }

  /** What a move did, by either transfer. */
  struct Moved
  {
    double       content_before, content_after, through_boundary;
    unsigned int n_limited;
  };

  /** Mesh, configuration and history; moves it by either transfer. */
  template <int dim>
  struct Problem
  {
    using Grid     = parallel::distributed::Triangulation<dim>;
    using Function = std::function<Tensor<1, dim>(const Point<dim> &)>;

    Problem(const Way                          way,
            const std::string                 &scheme,
            const unsigned int                 degree,
            const std::function<void(Grid &)> &make_grid,
            const MPI_Comm                     communicator   = MPI_COMM_WORLD,
            const double                       donor_fraction = 0.5)
      : way(way)
      , scheme(scheme)
    {
      mesh.triangulation = std::make_unique<Grid>(communicator);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      store         = make_store();
      transfer      = std::make_unique<SweptTransfer<dim>>(
        *configuration,
        *store,
        Registry<TransferScheme<dim>>::create(scheme, "Scheme"),
        "density",
        donor_fraction);
    }

    std::unique_ptr<HistoryStore<dim>>
    make_store() const
    {
      return std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}, {1, 1}},
        std::vector<HistoryLayout>{bone_layout<dim>(), bone_layout<dim>()},
        Utilities::pow(configuration->degree + 1, dim));
    }

    /** f at the initial positions of the nodes. */
    NodalVector
    positions(const Function &f) const
    {
      NodalVector          result = configuration->make_vector();
      const CellNodes<dim> nodes(*configuration);
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors position;
      for (const unsigned int c : transfer->subcells().owned_cells())
        {
          nodes.gather(configuration->initial_positions(), c, position);
          for (unsigned int i = 0; i < nodes.n_nodes; ++i)
            {
              const Tensor<1, dim> value = f(Point<dim>(position[i]));
              for (unsigned int d = 0; d < dim; ++d)
                if (nodes.local_entries(c, i)[d] < result.locally_owned_size())
                  result.local_element(nodes.local_entries(c, i)[d]) = value[d];
            }
        }
      result.update_ghost_values();
      return result;
    }

    /** Move mesh and history to @p x. */
    Moved
    move(const NodalVector &x)
    {
      if (way == Way::swept)
        {
          const TransferReport r =
            transfer->transfer(*store, configuration->positions(), x);
          configuration->set_positions(x);
          return {r.content_before,
                  r.content_after,
                  r.through_boundary,
                  r.n_limited};
        }
      const OverlapTransfer<dim> overlap(*configuration, *store, scheme);
      std::unique_ptr<HistoryStore<dim>> next = make_store();
      configuration->set_positions(x);
      const OverlapReport r = overlap.transfer(*configuration, *next);
      store->old_values     = next->old_values;
      return {r.content_before(), r.content_after(), 0., r.n_limited};
    }

    /** Go over owned sub-cells: centroid, volume, record. */
    void
    for_each(
      const std::function<void(const Point<dim> &, double, double *)> &f) const
    {
      std::vector<Point<dim>> centroid;
      std::vector<double>     volume;
      transfer->subcells().centroids(configuration->positions(),
                                     centroid,
                                     volume);
      for (const unsigned int c : transfer->subcells().owned_cells())
        for (unsigned int q = 0; q < store->n_points; ++q)
          f(centroid[c * store->n_points + q],
            volume[c * store->n_points + q],
            store->old_record(c, q));
    }

    /** Random records; the fabric is at its bounds in many places. */
    void
    fill_noise()
    {
      for_each([this](const Point<dim> &p, double, double *r) {
        for (unsigned int k = 0; k < store->layout(0).size; ++k)
          r[k] = noise(p, k);
        r[0]           = 1.1 + 0.8 * r[0];
        double *fabric = r + store->layout(0).offset("log fabric");
        pack(tensor_function(unpack(fabric, dim),
                             [](const double value) {
                               return std::min(fabric_bound,
                                               std::max(-fabric_bound,
                                                        40. * value));
                             }),
             fabric,
             dim);
      });
    }

    Way                                 way;
    std::string                         scheme;
    Mesh<dim>                           mesh;
    std::unique_ptr<Configuration<dim>> configuration;
    std::unique_ptr<HistoryStore<dim>>  store;
    std::unique_ptr<SweptTransfer<dim>> transfer;
  };

  /** [0,1]^dim of n^dim cells. */
  template <int dim>
  std::function<void(parallel::distributed::Triangulation<dim> &)>
  cube(const unsigned int n)
  {
    return [n](parallel::distributed::Triangulation<dim> &t) {
      GridGenerator::subdivided_hyper_cube(t, n);
    };
  }

  /** Interior nodes of [0,1]^dim by noise of size @p size. */
  template <int dim>
  std::function<Tensor<1, dim>(const Point<dim> &)>
  shaken(const double size, const unsigned int seed = 1)
  {
    return [=](const Point<dim> &p) {
      Tensor<1, dim> x = p;
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
          x[d] += size * noise(p, 3 * seed + d);
      return x;
    };
  }

  /** Cells of the unit cube along a side. */
  template <int dim>
  constexpr unsigned int n_cells = dim == 2 ? 8 : 4;

  inline constexpr Way both_ways[] = {Way::swept, Way::overlap};
} // namespace alveolus::bench

#endif
