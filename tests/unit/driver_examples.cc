// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The parts that doc/tutorial-extend.md builds: they are registered, and do
// what their texts say.
#include "../../doc/examples/centred_scheme.cc"
#include "../../doc/examples/stiffening_elastic.cc"
#include "../../doc/examples/trailing_rule.cc"
#include "rezoning_bench.h"

#include <alveolus/transfer/swept_transfer.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  std::unique_ptr<Material>
  stiffening()
  {
    auto material = Registry<Material>::create("stiffening elastic", "test");
    ParameterHandler prm;
    material->declare_parameters(prm);
    prm.set("Shear modulus", "3");
    prm.set("Bulk modulus", "10");
    prm.set("Stiffening", "2.5");
    material->initialize(3, "test");
    return material;
  }
} // namespace



// A stretch along an axis, and the tangent against central differences.
TEST(Examples, Material)
{
  const auto          material = stiffening();
  const HistoryLayout layout(material->history_fields(), 3);
  std::vector<double> old(layout.size), trial(layout.size);
  material->initial_history(old.data());
  MaterialResponse response;
  Tensor<2, 3>     f = unit_symmetric_tensor<3>();
  f[0][0]            = 1.3;
  material->evaluate(f, old.data(), trial.data(), true, response);
  // h = (ln 1.3, 0, 0): dev h = ln 1.3 (2, -1, -1)/3, e = 2/3 (ln 1.3)^2
  const double h = std::log(1.3), e = 2. / 3. * h * h;
  const double secant = 2. * 3. * (1. + 2. * 2.5 * e);
  EXPECT_NEAR(response.stress[0][0], 10. * h + secant * 2. / 3. * h, 1e-12);
  EXPECT_NEAR(response.stress[1][1], 10. * h - secant / 3. * h, 1e-12);
  EXPECT_NEAR(response.energy, 5. * h * h + 3. * e * (1. + 2.5 * e), 1e-12);

  f[0][1] = 0.4;
  f[1][2] = -0.2;
  f[2][0] = 0.1;
  material->evaluate(f, old.data(), trial.data(), true, response);
  const double step = 1e-6;
  for (unsigned int k = 0; k < 3; ++k)
    for (unsigned int l = 0; l < 3; ++l)
      {
        SymmetricTensor<2, 3> stress[2];
        for (const int side : {0, 1})
          {
            Tensor<2, 3> change = unit_symmetric_tensor<3>();
            change[k][l] += side == 0 ? -step : step;
            MaterialResponse other;
            material->evaluate(
              change * f, old.data(), trial.data(), false, other);
            stress[side] = other.stress;
          }
        EXPECT_LT(((stress[1] - stress[0]) / (2. * step) -
                   response.tangent[k][l])
                    .norm(),
                  1e-7)
          << k << l;
      }
}



template <int dim>
void
trailing()
{
  const Bench<dim> bench(unit_mesh<dim>(2), 1);
  Rezoning<dim>    run(bench);
  run.add("trailing", {{"On", "left block"}, {"Share", "0.25"}});
  run.add("material", {{"On", "Y"}});
  const auto x = run(bench.initial, bench.initial, bench.map([](auto X) {
    X[0] += 0.2;
    return X;
  }));
  EXPECT_LT(bench.distance(x,
                           [](Point<dim> X) {
                             const bool Y =
                               X.distance(Point<dim>::unit_vector(1)) < 1e-10;
                             X[0] += X[0] < 0.6 && !Y ? 0.05 : 0.2;
                             return X;
                           }),
            1e-14);
}

TEST(Examples, Rule)
{
  trailing<2>();
  trailing<3>();
}



// All nodes go to the right by the same distance: constants stay, a linear
// profile is read off where the sub-cells are then (but next to the ends), and
// nothing gets lost.
template <int dim>
void
centred()
{
  const Bench<dim> bench(unit_mesh<dim>(4), 1);
  HistoryField     density, other;
  density.name = "density";
  other.name   = "other";
  HistoryStore<dim> store(
    *bench.mesh.triangulation,
    std::map<types::material_id, unsigned int>{{0, 0}, {1, 0}},
    std::vector<HistoryLayout>{HistoryLayout({density, other}, dim)},
    Utilities::pow(2, dim));
  SweptTransfer<dim>      transfer(bench.configuration,
                              store,
                              Registry<TransferScheme<dim>>::create("centred",
                                                                    "test"),
                              "density",
                              0.5);
  const SubCells<dim>    &cells = transfer.subcells();
  std::vector<Point<dim>> before, after;
  std::vector<double>     volume;
  cells.centroids(bench.initial, before, volume);
  for (const unsigned int c : cells.owned_cells())
    for (unsigned int q = 0; q < store.n_points; ++q)
      {
        store.old_record(c, q)[0] = 1. + before[c * store.n_points + q][0];
        store.old_record(c, q)[1] = 7.;
      }
  const auto           moved  = bench.map([](auto X) {
    X[0] += 0.03;
    return X;
  });
  const TransferReport report = transfer.transfer(store, bench.initial, moved);
  EXPECT_NEAR(report.error(), 0., 1e-14 * report.content_after);
  cells.centroids(moved, after, volume);
  for (const unsigned int c : cells.owned_cells())
    for (unsigned int q = 0; q < store.n_points; ++q)
      {
        const double x = before[c * store.n_points + q][0];
        if (x > 0.125 && x < 0.875)
          {
            EXPECT_NEAR(store.old_record(c, q)[0],
                        1. + after[c * store.n_points + q][0],
                        1e-14);
          }
        EXPECT_EQ(store.old_record(c, q)[1], 7.);
      }
}

TEST(Examples, Scheme)
{
  centred<2>();
  centred<3>();
}
