// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The reference map: strains of exact deformations, rotations, the outline at
// rest, and maps that must be refused.
#include <alveolus/base/errors.h>
#include <alveolus/base/tensors.h>
#include <alveolus/transfer/nodal_transfer.h>
#include <alveolus/transfer/reference_map.h>
#include <alveolus/transfer/subcells.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;

namespace
{
  /** A number in [-1,1] without pattern, the same on every process. */
  template <int dim>
  double
  noise(const Point<dim> &x, const unsigned int seed)
  {
    double sum = 0.7 * seed;
    for (unsigned int d = 0; d < dim; ++d)
      sum += (12.9898 + 31.4 * d + seed) * std::round(x[d] * 1e6) * 1e-6;
    const double y = std::sin(sum) * 437.5453;
    return 2. * (y - std::floor(y)) - 1.;
  }

  template <int dim>
  using Function = std::function<Tensor<1, dim>(const Point<dim> &)>;

  /** A body of one region, at rest at its initial positions. */
  template <int dim>
  struct Body
  {
    using Grid = parallel::distributed::Triangulation<dim>;

    Body(const unsigned int                 degree,
         const std::function<void(Grid &)> &make_grid)
    {
      mesh.triangulation = std::make_unique<Grid>(MPI_COMM_WORLD);
      make_grid(*mesh.triangulation);
      configuration = std::make_unique<Configuration<dim>>(mesh, degree);
      HistoryField elastic;
      elastic.name  = "elastic strain";
      elastic.shape = HistoryField::Shape::symmetric_tensor;
      store         = std::make_unique<HistoryStore<dim>>(
        *mesh.triangulation,
        std::map<types::material_id, unsigned int>{{0, 0}},
        std::vector<HistoryLayout>{HistoryLayout({elastic}, dim)},
        Utilities::pow(degree + 1, dim));
      // Not NodalVector::operator=, which may swap ghost states
      x = configuration->positions();
      u = configuration->make_vector();
      u.update_ghost_values();
      outline = std::make_unique<ReferenceOutline<dim>>(*configuration,
                                                        *store,
                                                        std::set<unsigned>{0});
    }

    /** Nodal vector f(x) of the positions x. */
    NodalVector
    at_nodes(const Function<dim> &f) const
    {
      NodalVector          result = configuration->make_vector();
      const CellNodes<dim> nodes(*configuration);
      result.zero_out_ghost_values();
      typename CellNodes<dim>::NodeTensors p;
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
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
      return result;
    }

    /** The material moves to f(x), and the mesh with it. */
    Body &
    deform(const Function<dim> &f)
    {
      const NodalVector now = at_nodes(f);
      for (unsigned int i = 0; i < u.locally_owned_size(); ++i)
        u.local_element(i) += now.local_element(i) - x.local_element(i);
      u.update_ghost_values();
      x = now;
      x.update_ghost_values();
      return *this;
    }

    /** The mesh moves to f(x), the material stays. */
    ReferenceMapReport
    rezone(const Function<dim> &f)
    {
      const NodalVector now = at_nodes(f);
      NodalTransfer<dim>(*configuration).transfer(u, x, now);
      x = now;
      x.update_ghost_values();
      return map().admit(*outline, x, u);
    }

    ReferenceMap<dim>
    map(const bool mean_dilatation = true, const bool with_volume = true) const
    {
      return ReferenceMap<dim>(*configuration,
                               *store,
                               {{0, {with_volume, mean_dilatation}}});
    }

    /** Largest difference of the strains from h. */
    double
    difference(const SymmetricTensor<2, 3> &h)
    {
      double result = 0.;
      for_each([&](const unsigned int, const unsigned int, double *record) {
        result = std::max(result, (unpack(record, dim) - h).norm());
      });
      return Utilities::MPI::max(result, MPI_COMM_WORLD);
    }

    void
    for_each(const std::function<
             void(const unsigned int, const unsigned int, double *)> &f)
    {
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          for (unsigned int q = 0; q < store->n_points; ++q)
            f(cell->active_cell_index(),
              q,
              store->old_record(cell->active_cell_index(), q));
    }

    Mesh<dim>                              mesh;
    std::unique_ptr<Configuration<dim>>    configuration;
    std::unique_ptr<HistoryStore<dim>>     store;
    std::unique_ptr<ReferenceOutline<dim>> outline;
    NodalVector                            x, u;
  };

  template <int dim>
  std::function<void(parallel::distributed::Triangulation<dim> &)>
  cube(const unsigned int n)
  {
    return [n](parallel::distributed::Triangulation<dim> &t) {
      GridGenerator::subdivided_hyper_rectangle(
        t,
        std::vector<unsigned int>(dim, n),
        Point<dim>(),
        dim == 2 ? Point<dim>(1., 1.) : Point<dim>(1., 1., 1.),
        true);
      for (const auto &cell : t.active_cell_iterators())
        cell->set_material_id(0);
    };
  }

  /** Inside the unit cube: moved by noise; on its boundary: along it. */
  template <int dim>
  Function<dim>
  shaken(const double size, const unsigned int seed)
  {
    return [=](const Point<dim> &p) {
      Tensor<1, dim> y = p;
      for (unsigned int d = 0; d < dim; ++d)
        if (p[d] > 1e-10 && p[d] < 1. - 1e-10)
          y[d] += size * noise(p, 3 * seed + d);
      return y;
    };
  }

  template <int dim>
  Tensor<2, dim>
  stretch()
  {
    Tensor<2, dim> F;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        F[i][j] = (i == j ? 1.1 + 0.2 * i : 0.1 + 0.2 * i - 0.3 * j);
    return F;
  }

  /** (1/2) ln(F F^T), 3 x 3. */
  template <int dim>
  SymmetricTensor<2, 3>
  hencky(const Tensor<2, dim> &F)
  {
    SymmetricTensor<2, 3> b = unit_symmetric_tensor<3>();
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j <= i; ++j)
        b[i][j] = F[i] * F[j];
    return 0.5 * log(b);
  }

  Tensor<2, 2>
  rotation(const double degrees)
  {
    const double a = degrees * numbers::PI / 180.;
    return Tensor<2, 2>(
      {{std::cos(a), -std::sin(a)}, {std::sin(a), std::cos(a)}});
  }
} // namespace



// X(x) is linear: interpolation and the gradient are exact, on any mesh.
template <int dim>
void
uniform_deformation(const unsigned int degree)
{
  const Tensor<2, dim> F = stretch<dim>(), inverse = invert(F);
  Body<dim>            body(degree, cube<dim>(dim == 2 ? 5 : 3));
  body.rezone(shaken<dim>(0.02 / degree, 1));
  body.deform([&](const Point<dim> &p) { return F * p; });
  for (const bool mean_dilatation : {true, false})
    {
      body.map(mean_dilatation).apply(body.x, body.u, *body.store);
      EXPECT_LT(body.difference(hencky(F)), 1e-13);
    }
  for (unsigned int seed = 2; seed < 5; ++seed)
    {
      // Rezoned in the frame at rest, so that nodes slide along the sides
      const auto report = body.rezone([&](const Point<dim> &p) {
        return F * shaken<dim>(0.015 / degree, seed)(Point<dim>(inverse * p));
      });
      EXPECT_EQ(report.objection(), "");
      EXPECT_GT(report.smallest_jacobian, 0.2);
      EXPECT_LT(report.largest_distance, 1e-12);
    }
  body.map().apply(body.x, body.u, *body.store);
  EXPECT_LT(body.difference(hencky(F)), 1e-12);
  EXPECT_NEAR(body.map().volumes_at_rest(body.x, body.u)[0], 1., 1e-13);
}

TEST(ReferenceMap, UniformDeformation)
{
  uniform_deformation<2>(1);
  uniform_deformation<2>(2);
  uniform_deformation<3>(1);
}



// With mean dilatation exp(tr h) is the ratio of the cell's volumes; without it
// and with the history's own trace only the isochoric part is of the map.
TEST(ReferenceMap, VolumeTreatment)
{
  Body<2> body(1, cube<2>(4));
  body.rezone(shaken<2>(0.05, 1));
  const SubCells<2>   cells(*body.configuration,
                          [](const unsigned int) { return 0; });
  std::vector<double> at_rest, now;
  cells.volumes(body.x, at_rest);
  body.deform([](const Point<2> &p) {
    return Tensor<1, 2>({p[0] + 0.2 * p[0] * p[1], p[1] + 0.3 * p[0] * p[0]});
  });
  cells.volumes(body.x, now);
  const auto sum = [](const std::vector<double> &v, const unsigned int c) {
    return v[4 * c] + v[4 * c + 1] + v[4 * c + 2] + v[4 * c + 3];
  };
  std::vector<SymmetricTensor<2, 3>> deviators;
  body.map().apply(body.x, body.u, *body.store);
  body.for_each([&](const unsigned int c, const unsigned int, double *r) {
    EXPECT_NEAR(std::exp(r[0] + r[1] + r[2]),
                sum(now, c) / sum(at_rest, c),
                1e-13);
    deviators.push_back(deviator(unpack(r, 2)));
    pack(0.01 * unit_symmetric_tensor<3>(), r, 2);
  });
  body.map(true, false).apply(body.x, body.u, *body.store);
  unsigned int i = 0;
  body.for_each([&](const unsigned int, const unsigned int, double *r) {
    EXPECT_NEAR(trace(unpack(r, 2)), 0.03, 1e-15);
    EXPECT_LT((deviator(unpack(r, 2)) - deviators[i++]).norm(), 1e-15);
  });
}



// Turned as a rigid body, strains turn with it whatever they are; if they are
// uniform, also while the mesh inside is rezoned.
TEST(ReferenceMap, RotatedDisc)
{
  const auto disc = [](parallel::distributed::Triangulation<2> &t) {
    GridGenerator::hyper_ball_balanced(t);
    t.refine_global(2);
  };
  const Tensor<2, 2> R = rotation(30.), F = stretch<2>();
  Tensor<2, 3>       R3;
  for (unsigned int i = 0; i < 2; ++i)
    for (unsigned int j = 0; j < 2; ++j)
      R3[i][j] = R[i][j];
  R3[2][2] = 1.;

  Body<2> any(1, disc);
  any.deform([](const Point<2> &p) {
    return Tensor<1, 2>(
      {p[0] + 0.1 * std::sin(3. * p[1]), 1.2 * p[1] + 0.2 * p[0] * p[0]});
  });
  std::vector<SymmetricTensor<2, 3>> strains;
  any.map().apply(any.x, any.u, *any.store);
  any.for_each([&](const unsigned int, const unsigned int, double *r) {
    strains.push_back(unpack(r, 2));
  });
  for (unsigned int turn = 0; turn < 12; ++turn)
    {
      any.deform([&](const Point<2> &p) { return R * p; });
      any.map().apply(any.x, any.u, *any.store);
      unsigned int i = 0;
      any.for_each([&](const unsigned int, const unsigned int, double *r) {
        strains[i] = rotate(R3, strains[i]);
        EXPECT_LT((unpack(r, 2) - strains[i]).norm(), 1e-12);
        ++i;
      });
    }

  Body<2>               uniform(1, disc);
  SymmetricTensor<2, 3> h = hencky(F);
  uniform.deform([&](const Point<2> &p) { return F * p; });
  Tensor<2, 2> now = F;
  for (unsigned int turn = 0; turn < 12; ++turn)
    {
      uniform.deform([&](const Point<2> &p) { return R * p; });
      now                       = R * now;
      h                         = rotate(R3, h);
      const Tensor<2, 2> back   = invert(now);
      const auto         report = uniform.rezone([&](const Point<2> &p) {
        const Tensor<1, 2> X    = back * p;
        const double       free = std::max(0., 0.9 - X.norm());
        Tensor<1, 2>       y    = p;
        for (unsigned int d = 0; d < 2; ++d)
          y[d] += 0.015 * free * noise(Point<2>(X), turn + 20 * d);
        return y;
      });
      EXPECT_EQ(report.n_projected, 0u);
      uniform.map().apply(uniform.x, uniform.u, *uniform.store);
      EXPECT_LT(uniform.difference(h), 1e-12);
    }
}



// The mesh of a resting disc is turned through its material by 7.3 degrees:
// boundary nodes stay on the circle, from which the spline of the outline is
// O(h^4) away, while chords are O(h^2). The volume at rest is that of the
// polygon, which is turned, too.
TEST(ReferenceMap, OutlineOfADisc)
{
  const Tensor<2, 2>  R = rotation(7.3);
  std::vector<double> distances;
  for (const unsigned int refinements : {1, 2, 3})
    {
      Body<2>      body(1, [&](parallel::distributed::Triangulation<2> &t) {
        GridGenerator::hyper_ball_balanced(t);
        t.refine_global(refinements);
      });
      const double volume = body.map().volumes_at_rest(body.x, body.u)[0];
      const auto report = body.rezone([&](const Point<2> &p) { return R * p; });
      EXPECT_EQ(report.objection(), "");
      EXPECT_GT(report.n_projected, 0u);
      distances.push_back(report.largest_distance);
      // What the spline is away from the circle, times its length
      EXPECT_NEAR(body.map().volumes_at_rest(body.x, body.u)[0],
                  volume,
                  2. * numbers::PI * report.largest_distance);
    }
  EXPECT_GT(std::log2(distances[0] / distances[1]), 3.7);
  EXPECT_GT(std::log2(distances[1] / distances[2]), 3.7);
  EXPECT_LT(distances[2], 1e-5);
}



// Nodes on faces, edges and corners go to faces, edges and corners, also of an
// outline that was saved.
TEST(ReferenceOutline, PiecesOfACube)
{
  const Body<3> body(1, cube<3>(3));
  BlockFile     blocks;
  body.outline->save(blocks);
  const ReferenceOutline<3> restored(blocks);
  const auto                key = [](const std::uint64_t id) {
    return (std::uint64_t(1) << 63) | id;
  };
  const Point<3> X(0.1, 0.4, 0.2);
  double         size, size_restored;
  for (const auto &[keys, nearest] :
       std::vector<std::pair<OutlineKeys, Point<3>>>{
         {{key(0)}, {0., 0.4, 0.2}},
         {{key(3)}, {0.1, 1., 0.2}},
         {{key(0), key(4)}, {0., 0.4, 0.}},
         {{key(1), key(3)}, {1., 1., 0.2}},
         {{key(1), key(3), key(5)}, {1., 1., 1.}}})
    {
      EXPECT_LT(body.outline->nearest(keys, X, size).distance(nearest), 1e-15);
      EXPECT_EQ(restored.nearest(keys, X, size_restored),
                body.outline->nearest(keys, X, size));
      EXPECT_EQ(size, size_restored);
      EXPECT_GT(size, 0.33);
    }
  // A piece that the body does not have
  EXPECT_THROW(body.outline->nearest({key(7)}, X, size), RunError);
}



TEST(ReferenceMap, Refusals)
{
  // X is folded where u grows faster than x.
  Body<2> body(1, cube<2>(4));
  body.u      = body.at_nodes([](const Point<2> &p) {
    return Tensor<1, 2>({2. * p[0] * (1. - p[0]), 0.});
  });
  auto report = body.map().admit(*body.outline, body.x, body.u);
  EXPECT_LT(report.smallest_jacobian, 0.);
  EXPECT_NE(report.objection().find("not invertible"), std::string::npos);
  EXPECT_THROW(body.map().apply(body.x, body.u, *body.store), RunError);

  // The mesh is led far beyond the body.
  Body<2> outside(1, cube<2>(4));
  outside.u = outside.at_nodes([](const Point<2> &) {
    return Tensor<1, 2>({0.2, 0.});
  });
  report    = outside.map().admit(*outside.outline, outside.x, outside.u);
  EXPECT_NEAR(report.largest_distance, 0.2, 1e-14);
  EXPECT_NE(report.objection().find("outside the body"), std::string::npos);
}



// A smooth deformation while the mesh makes one turn of a vortex inside the
// square, in steps of half a cell: the strain converges with the first order of
// the gradient of a piecewise linear map, in spite of all interpolations.
TEST(ReferenceMap, Convergence)
{
  std::vector<double> errors;
  for (const unsigned int n : {16, 32, 64})
    {
      Body<2> body(1, cube<2>(n));
      body.deform([](const Point<2> &p) {
        return Tensor<1, 2>(
          {p[0] + 0.05 * std::sin(3. * p[1]) * p[0] * (1. - p[0]),
           p[1] + 0.1 * p[0] * p[1] * (1. - p[1])});
      });
      const Body<2> start(1, cube<2>(n));
      for (unsigned int step = 0; step < n; ++step)
        {
          const double angle = 0.25 / n;
          body.rezone([&](const Point<2> &p) {
            const double w =
              16. * p[0] * (1. - p[0]) * p[1] * (1. - p[1]) * angle;
            return Tensor<1, 2>(
              {p[0] - w * (p[1] - 0.5), p[1] + w * (p[0] - 0.5)});
          });
        }
      body.map(false).apply(body.x, body.u, *body.store);

      // Exact strain at a point x: X by a fixed point, F from it
      double              error = 0.;
      const QGauss<2>     gauss(2);
      const CellNodes<2>  nodes(*body.configuration);
      const SubCells<2>   cells(*body.configuration,
                              [](const unsigned int) { return 0; });
      std::vector<double> volume;
      cells.volumes(body.x, volume);
      CellNodes<2>::NodeTensors p;
      CellNodes<2>::NodeNumbers shape;
      body.for_each([&](const unsigned int c, const unsigned int q, double *r) {
        nodes.gather(body.x, c, p);
        nodes.shape_values(gauss.point(q), shape);
        Tensor<1, 2> x;
        for (unsigned int i = 0; i < 4; ++i)
          x += shape[i] * p[i];
        Tensor<1, 2> X = x;
        for (unsigned int k = 0; k < 60; ++k)
          X = Tensor<1, 2>(
            {x[0] - 0.05 * std::sin(3. * X[1]) * X[0] * (1. - X[0]),
             x[1] - 0.1 * X[0] * X[1] * (1. - X[1])});
        const Tensor<2, 2> F(
          {{1. + 0.05 * std::sin(3. * X[1]) * (1. - 2. * X[0]),
            0.15 * std::cos(3. * X[1]) * X[0] * (1. - X[0])},
           {0.1 * X[1] * (1. - X[1]), 1. + 0.1 * X[0] * (1. - 2. * X[1])}});
        error += volume[4 * c + q] * (unpack(r, 2) - hencky(F)).norm();
      });
      errors.push_back(Utilities::MPI::sum(error, MPI_COMM_WORLD));
    }
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
    std::cout << "L1 error of the strain: " << errors[0] << " " << errors[1]
              << " " << errors[2] << std::endl;
  EXPECT_GT(std::log2(errors[0] / errors[1]), 0.9);
  EXPECT_GT(std::log2(errors[1] / errors[2]), 0.9);
}
