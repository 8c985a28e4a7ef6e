// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Recorders against known motions and shapes.
#include <alveolus/base/errors.h>
#include <alveolus/io/recorder.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/physics/transformations.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Settings = std::vector<std::pair<std::string, std::string>>;

  /**
   * Box 3 x 2 (x 1) mm with cells of 0.25 (2D) or 0.5 mm; region "left" for x <
   * 1.5, "right" beyond, which keep a tensor and a number, and a tensor.
   */
  template <int dim>
  Mesh<dim>
  box()
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    Point<dim>                end;
    std::vector<unsigned int> n = {12, 8};
    end[0]                      = 3.;
    end[1]                      = 2.;
    if (dim == 3)
      {
        end[dim - 1] = 1.;
        n            = {6, 4, 2};
      }
    GridGenerator::subdivided_hyper_rectangle(
      *mesh.triangulation, n, Point<dim>(), end, true);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      cell->set_material_id(cell->center()[0] < 1.5 ? 0 : 1);
    mesh.names.regions["left"]    = {0};
    mesh.names.regions["right"]   = {1};
    mesh.names.boundaries["side"] = {0};
    mesh.names.boundaries["top"]  = {3};
    mesh.names.boundaries["rim"]  = {0, 1, 2, 3};
    for (unsigned int b = 0; b < 4; ++b)
      mesh.names.boundaries["piece " + std::to_string(b)] = {b};
    for (const auto &[name, ids] : mesh.names.boundaries)
      mesh.names.curves[name] = {};
    Point<dim> middle = end;
    middle[0]         = 1.5;
    mesh.names.points = {{"tip", end}, {"middle", middle}};
    return mesh;
  }

  template <int dim>
  std::vector<HistoryLayout>
  layouts()
  {
    HistoryField strain, density;
    strain.name  = "elastic strain";
    strain.shape = HistoryField::Shape::symmetric_tensor;
    density.name = "density";
    return {HistoryLayout({density, strain}, dim),
            HistoryLayout({density}, dim)};
  }

  template <int dim>
  struct Body
  {
    explicit Body(const unsigned int degree = 1)
      : mesh(box<dim>())
      , state(mesh, degree, {{0, 0}, {1, 1}}, layouts<dim>())
    {}

    /** Displace the material from X to place(X), the nodes with it. */
    template <class Place>
    void
    move(const Place &place)
    {
      NodalVector x = state.configuration.make_vector();
      NodalVector u = state.configuration.make_vector();
      for (const NodeId node : state.nodes.relevant())
        {
          const Point<dim> X =
            state.nodes.get(state.configuration.initial_positions(), node);
          state.nodes.set(x, node, Point<dim>(place(X)));
          state.nodes.set(u, node, Point<dim>(place(X) - X));
        }
      x.update_ghost_values();
      u.update_ghost_values();
      state.configuration.set_positions(x);
      state.displacement = u;
    }

    std::vector<Recorded>
    record(const std::string &type, const Settings &settings) const
    {
      auto             recorder = Registry<Recorder<dim>>::create(type, "Type");
      ParameterHandler prm;
      recorder->declare_parameters(prm);
      for (const auto &[key, value] : settings)
        prm.set(key, value);
      recorder->attach(state, "Records / test");
      return recorder->record(state, state.configuration.make_vector());
    }

    Mesh<dim>  mesh;
    State<dim> state;
  };

  double
  value(const std::vector<Recorded> &row, const std::string &name)
  {
    std::string known;
    for (const auto &entry : row)
      {
        if (entry.first == name)
          return entry.second;
        known += entry.first + "; ";
      }
    ADD_FAILURE() << "no " << name << " in " << known;
    return 0.;
  }

  template <int dim>
  Tensor<2, dim>
  turn(const Tensor<1, 3> &axis, const double degrees)
  {
    const auto R = Physics::Transformations::Rotations::rotation_matrix_3d(
      axis / axis.norm(), degrees * numbers::PI / 180.);
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = R[i][j];
    return result;
  }

  const Tensor<1, 3> z_axis = Point<3>(0., 0., 1.);
} // namespace



TEST(RigidMotion, TurnAboutACentre)
{
  for (const unsigned int degree : {1, 2})
    for (const double angle : {-170., -3., 1e-5, 40.})
      {
        Body<2>        body(degree);
        const Point<2> centre(7., -4.);
        const auto     R = turn<2>(z_axis, angle);
        body.move([&](const Point<2> &X) { return centre + R * (X - centre); });
        const auto row = body.record("rigid motion", {{"On", "right"}});
        EXPECT_NEAR(value(row, "rotation [degrees]"), angle, 1e-11);
        EXPECT_NEAR(value(row, "centre of rotation x [mm]"),
                    7.,
                    1e-13 / std::abs(angle) * 1e3);
        EXPECT_NEAR(value(row, "centre of rotation y [mm]"),
                    -4.,
                    1e-13 / std::abs(angle) * 1e3);
        // of the centroid (2.25, 1)
        const Point<2> X_c(2.25, 1.);
        EXPECT_NEAR(value(row, "translation x [mm]"),
                    (centre + R * (X_c - centre) - X_c)[0],
                    1e-12);
        EXPECT_NEAR(value(row, "deviation [mm]"), 0., 1e-12);
      }
  Body<2> body;
  body.move([](const Point<2> &X) { return X + Point<2>(0.3, -0.2); });
  const auto row = body.record("rigid motion", {{"On", "left, right"}});
  EXPECT_NEAR(value(row, "translation x [mm]"), 0.3, 1e-14);
  EXPECT_NEAR(value(row, "translation y [mm]"), -0.2, 1e-14);
  EXPECT_NEAR(value(row, "rotation [degrees]"), 0., 1e-12);
}



// The fit does not see a stretch along the region's axes of inertia; what it
// leaves is the stretch: x = 1.1 X in a box of length 3 about its centre.
TEST(RigidMotion, LeastSquares)
{
  Body<2>    body;
  const auto R = turn<2>(z_axis, 25.);
  body.move([&](const Point<2> &X) {
    return Point<2>(R * Point<2>(1.1 * X[0], X[1]));
  });
  const auto row = body.record("rigid motion", {{"On", "left, right"}});
  EXPECT_NEAR(value(row, "rotation [degrees]"), 25., 1e-12);
  EXPECT_NEAR(value(row, "deviation [mm]"), 0.1 * 3. / std::sqrt(12.), 1e-12);

  // and does not depend on where the nodes are
  Body<2> graded;
  {
    auto       &state = graded.state;
    NodalVector x = state.configuration.make_vector(), u = x;
    for (const NodeId node : state.nodes.relevant())
      {
        Point<2> X =
          state.nodes.get(state.configuration.initial_positions(), node);
        X[0] += 0.2 * X[0] * (1.5 - X[0]) * (3. - X[0]);
        const Point<2> at(R * Point<2>(1.1 * X[0], X[1]));
        state.nodes.set(x, node, at);
        state.nodes.set(u, node, Point<2>(at - X));
      }
    x.update_ghost_values();
    u.update_ghost_values();
    state.configuration.set_positions(x);
    state.displacement = u;
  }
  const auto other = graded.record("rigid motion", {{"On", "left, right"}});
  for (unsigned int i = 0; i < row.size(); ++i)
    EXPECT_NEAR(other[i].second, row[i].second, 1e-11) << row[i].first;
}



TEST(RigidMotion, InSpace)
{
  for (const double angle : {1e-4, 30., 179.})
    {
      Body<3>            body;
      const Tensor<1, 3> axis({2., -1., 2.});
      const auto         R = turn<3>(axis, angle);
      body.move([&](const Point<3> &X) {
        return Point<3>(R * X) + Point<3>(0.1, 0.2, 0.3);
      });
      const auto row = body.record("rigid motion", {{"On", "left"}});
      EXPECT_NEAR(value(row, "rotation x [degrees]"), 2. / 3. * angle, 1e-9);
      EXPECT_NEAR(value(row, "rotation y [degrees]"), -1. / 3. * angle, 1e-9);
      EXPECT_NEAR(value(row, "rotation z [degrees]"), 2. / 3. * angle, 1e-9);
      EXPECT_NEAR(value(row, "deviation [mm]"), 0., 1e-11);
      // A point of the axis moves along it only: (0.1, 0.2, 0.3) a = 0.2
      Point<3> on_axis;
      for (unsigned int d = 0; d < 3; ++d)
        on_axis[d] =
          value(row, std::string("axis of rotation at ") + "xyz"[d] + " [mm]");
      const Tensor<1, 3> moved =
        Point<3>(R * on_axis) + Point<3>(0.1, 0.2, 0.3) - on_axis;
      EXPECT_LT((moved - 0.2 * axis / 3.).norm(), 1e-10);
      EXPECT_NEAR(value(row, "translation along axis [mm]"), 0.2, 1e-10);
    }
}



TEST(PointDisplacement, Magnitude)
{
  Body<2> body;
  body.move([](const Point<2> &X) { return X + X[0] * Point<2>(0.1, -0.2); });
  auto row = body.record("point displacement",
                         {{"On", "tip"}, {"Components", "magnitude"}});
  ASSERT_EQ(row.size(), 1u);
  EXPECT_NEAR(value(row, "displacement [mm]"), 0.3 * std::sqrt(5.), 1e-14);
  row = body.record("point displacement",
                    {{"On", "tip"}, {"Components", "y, magnitude"}});
  ASSERT_EQ(row.size(), 2u);
  EXPECT_NEAR(value(row, "displacement y [mm]"), -0.6, 1e-14);
  EXPECT_EQ(body.record("point displacement", {{"On", "tip"}}).size(), 2u);
  EXPECT_THROW(body.record("point displacement",
                           {{"On", "tip"}, {"Components", "size"}}),
               InputError);
}



template <int dim>
void
check_strain()
{
  Body<dim>  body;
  auto      &history = body.state.history;
  const auto R       = turn<3>(dim == 2 ? z_axis : Point<3>(1., 2., 3.), 30.);
  for (const auto &cell : body.mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned() && cell->material_id() == 0)
      for (unsigned int q = 0; q < history.n_points; ++q)
        {
          // from -0.3 to 0.2 in principal values as the density goes on; one
          // point has the extremes
          SymmetricTensor<2, 3> h;
          const bool            special =
            cell->center()[0] < 0.5 && cell->center()[1] < 0.5 && q == 2;
          h[0][0]                   = special ? -0.3 : -0.01;
          h[1][1]                   = special ? 0.2 : 0.02;
          h[2][2]                   = special ? 0.04 : 0.;
          const Tensor<2, 3> turned = R * Tensor<2, 3>(h) * transpose(R);
          double *record = history.old_record(cell->active_cell_index(), q);
          record[0]      = 1.;
          pack(symmetrize(turned), record + 1, dim);
        }
  const auto row = body.record("strain extremes", {{"On", "left"}});
  EXPECT_NEAR(value(row, "least Hencky strain"), -0.3, 1e-14);
  EXPECT_NEAR(value(row, "greatest Hencky strain"), 0.2, 1e-14);
  EXPECT_NEAR(value(row, "least engineering strain"),
              std::exp(-0.3) - 1.,
              1e-14);
  EXPECT_NEAR(value(row, "greatest engineering strain"),
              std::exp(0.2) - 1.,
              1e-14);
  EXPECT_NEAR(value(row, "least volume ratio"), std::exp(-0.06), 1e-14);
  EXPECT_NEAR(value(row, "greatest volume ratio"), std::exp(0.01), 1e-14);
}

TEST(StrainExtremes, KnownStrains)
{
  check_strain<2>();
  check_strain<3>();
  EXPECT_THROW(Body<2>().record("strain extremes", {{"On", "gum"}}),
               InputError);
  // this region keeps no strain
  EXPECT_THROW(Body<2>().record("strain extremes", {{"On", "right"}}),
               InputError);
}



TEST(CornerQuality, AnglesAndElements)
{
  Body<2> body;
  // shear by 45 degrees: corners of 45 and 135 degrees, scaled Jacobian 1/sqrt2
  body.move([](const Point<2> &X) { return X + Point<2>(X[1], 0.); });
  auto row =
    body.record("corner quality", {{"On", "tip, middle"}, {"Region", "right"}});
  EXPECT_EQ(value(row, "tip elements"), 1.);
  EXPECT_NEAR(value(row, "tip angle [degrees]"), 45., 1e-12);
  EXPECT_NEAR(value(row, "tip scaled Jacobian at the corner"),
              std::sqrt(0.5),
              1e-14);
  EXPECT_EQ(value(row, "middle elements"), 1.);
  EXPECT_NEAR(value(row, "middle angle [degrees]"), 135., 1e-12);
  row = body.record("corner quality",
                    {{"On", "middle"}, {"Region", "left, right"}});
  EXPECT_EQ(value(row, "middle elements"), 2.);
  EXPECT_NEAR(value(row, "middle angle [degrees]"), 180., 1e-12);

  // Only the corner pulled inwards, beyond the diagonal of its element of 0.25
  // mm, which becomes a dart
  body.move([](const Point<2> &X) {
    return X.distance(Point<2>(3., 2.)) < 1e-9 ? Point<2>(2.8, 1.8) : X;
  });
  row = body.record("corner quality", {{"On", "tip"}, {"Region", "right"}});
  // corner at (2.8, 1.8) between (2.75, 2) and (3, 1.75): vectors (-0.05, 0.2)
  // and (0.2, -0.05), seen from inside
  const double reflex = 360. - std::acos(-0.02 / 0.0425) * 180. / numbers::PI;
  EXPECT_NEAR(value(row, "tip angle [degrees]"), reflex, 1e-10);
  EXPECT_NEAR(value(row, "tip scaled Jacobian at the corner"),
              std::sin(reflex * numbers::PI / 180.),
              1e-12);
  EXPECT_NEAR(value(row, "tip scaled Jacobian of the elements"),
              std::sin(reflex * numbers::PI / 180.),
              1e-12);
  EXPECT_THROW(body.record("corner quality",
                           {{"On", "tip"}, {"Region", "left"}}),
               InputError);

  Body<3> solid;
  solid.move([](const Point<3> &X) { return X + Point<3>(X[1], 0., 0.); });
  row = solid.record("corner quality", {{"On", "tip"}, {"Region", "right"}});
  EXPECT_EQ(value(row, "tip elements"), 1.);
  EXPECT_NEAR(value(row, "tip scaled Jacobian at the corner"),
              std::sqrt(0.5),
              1e-14);
}



// The boundaries bulge by a parabola: outwards or inwards, on all four sides,
// and turned as a whole.
TEST(RimDepth, Parabola)
{
  for (const unsigned int degree : {1, 2})
    for (const double depth : {0.3, -0.2})
      for (const double angle : {0., 110.})
        {
          Body<2>    body(degree);
          const auto R = turn<2>(z_axis, angle);
          body.move([&](const Point<2> &X) {
            const double s = 4. * X[0] * (3. - X[0]) / 9.;
            const double t = X[1] * (2. - X[1]);
            return Point<2>(R * Point<2>(X[0] + depth * t * (X[0] - 1.5) / 1.5,
                                         X[1] + depth * s * (X[1] - 1.)));
          });
          for (unsigned int b = 0; b < 4; ++b)
            {
              const auto row =
                body.record("rim depth",
                            {{"On", "piece " + std::to_string(b)}});
              EXPECT_NEAR(value(row, "depth [mm]"), depth, 1e-12) << b;
              EXPECT_NEAR(value(row, "chord [mm]"), b < 2 ? 2. : 3., 1e-12);
            }
        }
  EXPECT_THROW(Body<2>().record("rim depth", {{"On", "rim"}}), InputError);
  EXPECT_THROW(Body<2>().record("rim depth", {{"On", "gum"}}), InputError);
}



namespace
{
  /** A law of which only the derived quantity matters. */
  class Squared : public Material
  {
  public:
    void
    declare_parameters(ParameterHandler &) override
    {}
    void
    initialize(const unsigned int, const std::string &) override
    {}
    std::vector<HistoryField>
    history_fields() const override
    {
      return {};
    }
    void
    initial_history(double *) const override
    {}
    void
    evaluate(const Tensor<2, 3> &,
             const double *,
             double *,
             const bool,
             MaterialResponse &) const override
    {}
    std::vector<std::pair<std::string, std::string>>
    derived_names() const override
    {
      return {{"other", ""}, {"square", ""}};
    }
    std::vector<double>
    derived_values(const double *history) const override
    {
      return {0., history[0] * history[0]};
    }
  };
} // namespace

TEST(Extremes, HistoryAndDerived)
{
  Body<2> body;
  auto   &history = body.state.history;
  // density -0.5 ... 2.5 by columns of cells; 8 cells to a column
  for (const auto &cell : body.mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned())
      for (unsigned int q = 0; q < history.n_points; ++q)
        history.old_record(cell->active_cell_index(), q)[0] =
          cell->center()[0] - 0.625;
  auto row = body.record("extremes", {{"Field", "density"}});
  EXPECT_EQ(row.size(), 2u);
  EXPECT_NEAR(value(row, "least"), -0.5, 1e-14);
  EXPECT_NEAR(value(row, "greatest"), 2.25, 1e-14);

  auto             recorder = Registry<Recorder<2>>::create("extremes", "Type");
  ParameterHandler prm;
  recorder->declare_parameters(prm);
  prm.set("Field", "square");
  prm.set("Count up to", "0.07");
  const Squared material;
  recorder->offer_regions(
    {{"left", &material, true}, {"right", &material, true}});
  recorder->attach(body.state, "Records / test");
  row = recorder->record(body.state, body.state.configuration.make_vector());
  EXPECT_NEAR(value(row, "least"), 0., 1e-14);
  EXPECT_NEAR(value(row, "greatest"), 2.25 * 2.25, 1e-13);
  // -0.25, 0, 0.25: three columns of 8 cells with 4 points
  EXPECT_EQ(value(row, "points up to 0.07"), 96.);
  EXPECT_THROW(body.record("extremes", {{"Field", "square"}}), InputError);
  EXPECT_THROW(body.record("extremes",
                           {{"Field", "density"}, {"Count up to", "few"}}),
               InputError);
}
