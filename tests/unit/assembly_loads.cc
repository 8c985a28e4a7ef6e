// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Loads of given total: resultants, moments, independence of the mesh, rigid
// turns, load stiffness.
#include "dense_system.h"

#include <alveolus/assembly/distributed_force.h>
#include <alveolus/base/errors.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/physics/transformations.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;

namespace
{
  using Settings = std::vector<std::pair<std::string, std::string>>;

  /** Unit square or cube with boundaries left, right, all; no material. */
  template <int dim>
  Mesh<dim>
  unit_mesh(const unsigned int n)
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(
        MPI_COMM_WORLD);
    Point<dim> corner;
    for (unsigned int d = 0; d < dim; ++d)
      corner[d] = 1.;
    GridGenerator::subdivided_hyper_rectangle(*mesh.triangulation,
                                              std::vector<unsigned int>(dim, n),
                                              Point<dim>(),
                                              corner,
                                              true);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      cell->set_material_id(0);
    mesh.names.boundaries = {{"left", {0}}, {"right", {1}}, {"top", {3}}};
    for (unsigned int b = 0; b < 2 * dim; ++b)
      mesh.names.boundaries["all"].insert(b);
    mesh.names.regions["body"]  = {0};
    mesh.names.points["corner"] = corner;
    return mesh;
  }

  template <int dim>
  struct Body
  {
    Body(const unsigned int degree, const unsigned int n)
      : mesh(unit_mesh<dim>(n))
      , state(mesh, degree, {{0, 0}}, {HistoryLayout()})
    {}

    /** Place the material point X of each node: x = place(X'), u = x - X'. */
    template <class Slide, class Place>
    void
    place(const Slide &slide, const Place &place)
    {
      NodalVector x = state.configuration.make_vector();
      NodalVector u = state.configuration.make_vector();
      for (const NodeId node : state.nodes.relevant())
        {
          const Point<dim> X = slide(
            state.nodes.get(state.configuration.initial_positions(), node));
          const Point<dim> at = place(X);
          state.nodes.set(x, node, at);
          state.nodes.set(u, node, Point<dim>(at - X));
        }
      x.update_ghost_values();
      u.update_ghost_values();
      state.configuration.set_positions(x);
      state.displacement = u;
    }

    Mesh<dim>  mesh;
    State<dim> state;
  };

  template <int dim>
  std::unique_ptr<Condition<dim>>
  make(const std::string &type, const Settings &settings)
  {
    auto             object = Registry<Condition<dim>>::create(type, "Type");
    ParameterHandler prm;
    object->declare_parameters(prm);
    for (const auto &[key, value] : settings)
      prm.set(key, value);
    return object;
  }

  /** External nodal forces of a load at time 2 and a given increment. */
  template <int dim>
  NodalVector
  forces(const State<dim>  &state,
         Condition<dim>    &load,
         const NodalVector *increment = nullptr)
  {
    NodalVector zero   = state.configuration.make_vector();
    NodalVector result = state.configuration.make_vector();
    result.zero_out_ghost_values();
    result = 0.;
    load.begin_step(state, {1., 2.});
    load.add_forces(state,
                    increment != nullptr ? *increment : zero,
                    AssemblyTarget{result});
    result.compress(VectorOperation::add);
    result *= -1.;
    result.update_ghost_values();
    return result;
  }

  /** Resultant, and moment about the origin, of nodal forces at places. */
  template <int dim, class PlaceOf>
  std::pair<Tensor<1, 3>, Tensor<1, 3>>
  resultant(const State<dim> &state, const NodalVector &f, const PlaceOf &place)
  {
    Tensor<1, 3> force, moment;
    for (const NodeId node : state.nodes.relevant())
      if (state.nodes.is_owned(node))
        {
          Tensor<1, 3> arm, at;
          for (unsigned int d = 0; d < dim; ++d)
            {
              arm[d] = place(node)[d];
              at[d]  = state.nodes.get(f, node)[d];
            }
          force += at;
          moment += cross_product_3d(arm, at);
        }
    return {Utilities::MPI::sum(force, MPI_COMM_WORLD),
            Utilities::MPI::sum(moment, MPI_COMM_WORLD)};
  }

  template <int dim>
  std::pair<Tensor<1, 3>, Tensor<1, 3>>
  resultant_now(const State<dim> &state, const NodalVector &f)
  {
    const NodalVector x = state.configuration.positions();
    return resultant(state, f, [&](const NodeId node) {
      return state.nodes.get(x, node);
    });
  }

  /** Bulges the faces x = const and grades the nodes along them. */
  template <int dim>
  Point<dim>
  curved(const Point<dim> &X)
  {
    Point<dim> Y = X;
    for (unsigned int d = 1; d < dim; ++d)
      Y[0] += 0.3 * (X[0] - 0.5) * X[d] * (1.2 - X[d]);
    Y[1] += 0.2 * X[1] * (1. - X[1]);
    return Y;
  }

  template <int dim>
  Point<dim>
  same(const Point<dim> &X)
  {
    return X;
  }

  template <int dim>
  Tensor<2, dim>
  turn(const double angle)
  {
    Tensor<1, 3> axis({1., -0.5, 2.});
    if (dim == 2)
      axis = Point<3>(0., 0., 1.);
    const auto R = Physics::Transformations::Rotations::rotation_matrix_3d(
      axis / axis.norm(), angle);
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = R[i][j];
    return result;
  }

  template <int dim>
  Tensor<1, 3>
  in_space(const Tensor<1, dim> &v)
  {
    Tensor<1, 3> w;
    for (unsigned int d = 0; d < dim; ++d)
      w[d] = v[d];
    return w;
  }

  double
  value(const std::vector<Recorded> &row, const std::string &name)
  {
    for (const auto &entry : row)
      if (entry.first == name)
        return entry.second;
    ADD_FAILURE() << "no " << name;
    return 0.;
  }
} // namespace



template <int dim>
void
check_totals(const unsigned int degree)
{
  SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
               std::to_string(degree));
  Body<dim> body(degree, 4);
  body.place(curved<dim>, same<dim>);
  auto &state = body.state;
  state.time  = 2.;
  for (const std::string follower : {"false", "true"})
    {
      // 0.6 t N at t = 2; a pressure on the right pushes to the left
      auto pressure = make<dim>("distributed force",
                                {{"On", "right"},
                                 {"Force", "0.6*t"},
                                 {"Follower", follower}});
      pressure->attach(state, "Conditions / load");
      auto r = resultant_now(state, forces(state, *pressure)).first;
      EXPECT_NEAR(r.norm(), 1.2, 1e-13);
      EXPECT_LT(r[0], -1.);
      EXPECT_EQ(pressure->applied(state)[0].first, "applied force [N]");
      EXPECT_NEAR(pressure->applied(state)[0].second, 1.2, 1e-15);
      EXPECT_EQ(pressure->applied(state).size(), 1u);

      auto pull = make<dim>("distributed force",
                            {{"On", "right, top"},
                             {"Force", "0.6*t"},
                             {"Direction", "3, -4"},
                             {"Follower", follower}});
      pull->attach(state, "Conditions / load");
      r = resultant_now(state, forces(state, *pull)).first;
      EXPECT_LT((r - Tensor<1, 3>({0.72, -0.96, 0.})).norm(), 1e-13);

      auto couple = make<dim>("couple",
                              {{"On", "right"},
                               {"Moment", "0.25*t"},
                               {"Follower", follower}});
      couple->attach(state, "Conditions / load");
      auto [force, moment] = resultant_now(state, forces(state, *couple));
      EXPECT_LT(force.norm(), 1e-13);
      EXPECT_LT((moment - Tensor<1, 3>({0., 0., 0.5})).norm(), 1e-13);
      EXPECT_NEAR(value(couple->applied(state), "applied moment [N mm]"),
                  0.5,
                  1e-15);

      // force and couple: the ratio is the shift of the line of action
      auto both = make<dim>("distributed force",
                            {{"On", "right"},
                             {"Force", "0.6*t"},
                             {"Direction", "0, 1"},
                             {"Moment-to-force ratio", "-8"},
                             {"Follower", follower}});
      both->attach(state, "Conditions / load");
      auto alone = make<dim>("distributed force",
                             {{"On", "right"},
                              {"Force", "0.6*t"},
                              {"Direction", "0, 1"},
                              {"Follower", follower}});
      alone->attach(state, "Conditions / load");
      const auto with    = resultant_now(state, forces(state, *both));
      const auto without = resultant_now(state, forces(state, *alone));
      EXPECT_LT((with.first - without.first).norm(), 1e-12);
      EXPECT_LT(
        (with.second - without.second - Tensor<1, 3>({0., 0., -9.6})).norm(),
        1e-12);
      EXPECT_NEAR(value(both->applied(state), "applied moment [N mm]"),
                  -9.6,
                  1e-14);
    }
  // A uniform pressure on a plane piece: nodal forces of its shape functions,
  // with the area centroid as line of action
  Body<dim> plain(degree, 3);
  auto      pressure =
    make<dim>("distributed force", {{"On", "right"}, {"Force", "t"}});
  pressure->attach(plain.state, "Conditions / load");
  const auto [force, moment] =
    resultant_now(plain.state, forces(plain.state, *pressure));
  const Tensor<1, 3> expected({-2., 0., 0.});
  const Tensor<1, 3> centre({1., 0.5, dim == 3 ? 0.5 : 0.});
  EXPECT_LT((force - expected).norm(), 1e-13);
  EXPECT_LT((moment - cross_product_3d(centre, expected)).norm(), 1e-13);
}

TEST(Loads, TotalsAreGiven)
{
  for (const unsigned int degree : {1, 2})
    {
      check_totals<2>(degree);
      check_totals<3>(degree);
    }
}



// The body turned as a whole: dead forces stay, their couple fades like the
// cosine; what follows turns with it.
template <int dim>
void
check_turned(const unsigned int degree)
{
  SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
               std::to_string(degree));
  const double angle = 0.7;
  const auto   R     = turn<dim>(angle);
  Body<dim>    before(degree, 3), after(degree, 3);
  before.place(curved<dim>, same<dim>);
  after.place(curved<dim>, [&](const Point<dim> &X) {
    return Point<dim>(R * X + Tensor<1, dim>(Point<dim>::unit_vector(0)));
  });
  for (const std::string type : {"distributed force", "couple"})
    for (const std::string follower : {"false", "true"})
      {
        Settings settings = {{"On", "right"}, {"Follower", follower}};
        if (type == "couple")
          {
            settings.emplace_back("Moment", "0.25*t");
            if (dim == 3)
              settings.emplace_back("Axis", "1, -0.5, 2");
          }
        else
          settings.emplace_back("Force", "0.6*t");
        auto a = make<dim>(type, settings), b = make<dim>(type, settings);
        a->attach(before.state, "Conditions / load");
        b->attach(after.state, "Conditions / load");
        const NodalVector f     = forces(before.state, *a);
        const NodalVector g     = forces(after.state, *b);
        double            worst = 0.;
        for (const NodeId node : before.state.nodes.relevant())
          {
            const Tensor<1, dim> at = before.state.nodes.get(f, node);
            worst                   = std::max(worst,
                             (Tensor<1, dim>(after.state.nodes.get(g, node)) -
                              (follower == "true" ? R * at : at))
                               .norm());
          }
        EXPECT_LT(worst, 1e-13) << type << ' ' << follower;
        if (type == "couple")
          {
            const auto [force, moment] = resultant_now(after.state, g);
            EXPECT_LT(force.norm(), 1e-13);
            // the axis is that of the turn
            if (follower == "true")
              {
                EXPECT_NEAR(moment.norm(), 0.5, 1e-13);
              }
            else if (dim == 2)
              {
                EXPECT_NEAR(moment[2], 0.5 * std::cos(angle), 1e-13);
              }
          }
      }
}

TEST(Loads, RigidTurn)
{
  for (const unsigned int degree : {1, 2})
    {
      check_turned<2>(degree);
      check_turned<3>(degree);
    }
}



// Dead loads act on the material: with the nodes slid along the piece they do
// the same work in every motion that both meshes can represent.
template <int dim>
void
check_slid()
{
  Tensor<2, dim> A(unit_symmetric_tensor<dim>()), B;
  A[0][1]           = 0.4;
  A[1][0]           = -0.2;
  B[0][0]           = 0.3;
  B[0][1]           = -1.1;
  B[1][0]           = 0.7;
  B[1][1]           = 0.9;
  const auto deform = [&](const Point<dim> &X) { return Point<dim>(A * X); };
  const auto slide  = [&](const Point<dim> &X) {
    Point<dim> Y = X;
    for (unsigned int d = 0; d < dim; ++d)
      Y[d] += 0.15 * std::sin(numbers::PI * X[d]) * (0.5 + X[0]);
    Y[0] = X[0];
    return Y;
  };
  Body<dim> first(1, 6), second(1, 6);
  first.place(same<dim>, deform);
  second.place(slide, deform);
  for (const Settings &settings :
       {Settings{{"Type", "distributed force"}, {"Force", "t"}},
        Settings{{"Type", "distributed force"},
                 {"Force", "t"},
                 {"Direction", "1, 2"}},
        Settings{{"Type", "couple"}, {"Moment", "t"}}})
    {
      double work[2];
      for (const unsigned int k : {0, 1})
        {
          const auto &state = (k == 0 ? first : second).state;
          Settings    all(settings.begin() + 1, settings.end());
          all.emplace_back("On", "right");
          auto load = make<dim>(settings[0].second, all);
          load->attach(state, "Conditions / load");
          const NodalVector f   = forces(state, *load);
          const NodalVector x   = state.configuration.positions();
          double            sum = 0.;
          for (const NodeId node : state.nodes.relevant())
            if (state.nodes.is_owned(node))
              {
                const Tensor<1, dim> X =
                  state.nodes.get(x, node) -
                  state.nodes.get(state.displacement, node);
                sum += (B * X) * Tensor<1, dim>(state.nodes.get(f, node));
              }
          work[k] = Utilities::MPI::sum(sum, MPI_COMM_WORLD);
        }
      EXPECT_GT(std::abs(work[0]), 0.1);
      EXPECT_NEAR(work[0], work[1], 1e-13);
    }
}

TEST(Loads, DeadLoadsDoNotDependOnTheMesh)
{
  check_slid<2>();
  check_slid<3>();
}



// Follower loads: the matrix lacks only the derivative of the scaling, which is
// a multiple of the load in every column and nothing in a rigid motion; and the
// totals stay while the piece is strained.
template <int dim>
void
check_follower(const unsigned int degree, const std::string &type)
{
  SCOPED_TRACE(type + ", dim " + std::to_string(dim) + ", degree " +
               std::to_string(degree));
  Body<dim> body(degree, dim == 2 ? 2 : 1);
  body.place(curved<dim>, same<dim>);
  auto    &state    = body.state;
  Settings settings = {{"On", "right"}, {"Follower", "true"}};
  if (type == "couple")
    settings.emplace_back("Moment", "0.25*t");
  else
    {
      settings.emplace_back("Force", "0.6*t");
      if (type == "inclined force")
        settings.emplace_back("Direction", "1, 2");
    }
  auto load =
    make<dim>(type == "couple" ? "couple" : "distributed force", settings);
  load->attach(state, "Conditions / load");

  std::mt19937                           generator(5);
  std::uniform_real_distribution<double> random(-0.05, 0.05);
  NodalVector increment = state.configuration.make_vector();
  increment.zero_out_ghost_values();
  const unsigned int n = state.configuration.dof_handler.n_dofs();
  for (unsigned int i = 0; i < n; ++i)
    increment(i) = random(generator);

  const NodalVector f = forces(state, *load, &increment);
  NodalVector       x = state.configuration.positions();
  x.zero_out_ghost_values();
  x += increment;
  const auto [force, moment] = resultant(state, f, [&](const NodeId node) {
    return state.nodes.get(x, node);
  });
  if (type == "couple")
    {
      // about the area centroid of the deformed piece
      Body<dim> deformed(degree, dim == 2 ? 2 : 1);
      x.update_ghost_values();
      deformed.state.configuration.set_positions(x);
      FEFaceValues<dim> values(deformed.state.configuration.mapping(),
                               deformed.state.configuration.fe,
                               QGauss<dim - 1>(degree + 1),
                               update_quadrature_points | update_JxW_values);
      double            area = 0.;
      Tensor<1, dim>    centroid;
      for (const auto &[cell, face] :
           boundary_faces(deformed.state.configuration, {1}))
        {
          values.reinit(cell, face);
          for (const unsigned int q : values.quadrature_point_indices())
            {
              area += values.JxW(q);
              centroid += values.JxW(q) * values.quadrature_point(q);
            }
        }
      const auto about =
        moment - cross_product_3d(in_space<dim>(centroid / area), force);
      EXPECT_NEAR(about.norm(), 0.5, 1e-13);
    }
  else
    {
      EXPECT_NEAR(force.norm(), 1.2, 1e-13);
    }

  DenseSystem system(n);
  NodalVector residual = state.configuration.make_vector();
  residual             = 0.;
  load->add_forces(state, increment, AssemblyTarget{residual, &system});
  double     off_range = 0., largest = 0.;
  const auto difference = [&](const NodalVector &direction) {
    const double h     = 1e-6;
    NodalVector  there = increment, back = increment;
    there.add(h, direction);
    back.add(-h, direction);
    NodalVector d = forces(state, *load, &back); // residual: minus the load
    d -= forces(state, *load, &there);
    d /= 2. * h;
    return d;
  };
  for (unsigned int b = 0; b < n; ++b)
    {
      NodalVector direction = state.configuration.make_vector();
      direction             = 0.;
      direction(b)          = 1.;
      NodalVector missing   = difference(direction);
      for (unsigned int a = 0; a < n; ++a)
        {
          largest = std::max(largest, std::abs(missing(a)));
          missing(a) -= system.matrix(a, b);
        }
      missing.add(-(missing * f) / (f * f), f);
      off_range = std::max(off_range, missing.linfty_norm());
    }
  EXPECT_LT(off_range, 1e-8 * largest);

  // Rigid velocities: the matrix is all there is.
  for (unsigned int mode = 0; mode < dim + (dim == 2 ? 1 : 3); ++mode)
    {
      NodalVector velocity = state.configuration.make_vector();
      velocity.zero_out_ghost_values();
      for (const NodeId node : state.nodes.relevant())
        {
          Tensor<1, dim> v;
          if (mode < dim)
            v[mode] = 1.;
          else
            {
              const Tensor<1, 3> axis =
                Point<3>::unit_vector(dim == 2 ? 2 : mode - dim);
              const Tensor<1, 3> w =
                cross_product_3d(axis, in_space<dim>(state.nodes.get(x, node)));
              for (unsigned int d = 0; d < dim; ++d)
                v[d] = w[d];
            }
          state.nodes.set(velocity, node, Point<dim>(v));
        }
      NodalVector missing = difference(velocity);
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < n; ++b)
          missing(a) -= system.matrix(a, b) * velocity(b);
      EXPECT_LT(missing.linfty_norm(), 1e-8 * largest) << "mode " << mode;
    }
}

TEST(Loads, FollowerStiffness)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "on one process";
  for (const unsigned int degree : {1, 2})
    for (const std::string type : {"force", "inclined force", "couple"})
      {
        check_follower<2>(degree, type);
        check_follower<3>(degree, type);
      }
}



TEST(Loads, PointForce)
{
  Body<2> body(1, 3);
  auto    load =
    make<2>("point force", {{"On", "corner"}, {"Force", "3*t; -4*t"}});
  load->attach(body.state, "Conditions / load");
  const auto [force, moment] =
    resultant_now(body.state, forces(body.state, *load));
  EXPECT_LT((force - Tensor<1, 3>({6., -8., 0.})).norm(), 1e-14);
  EXPECT_NEAR(moment[2], -14., 1e-14);
  body.state.time = 2.;
  EXPECT_NEAR(load->applied(body.state)[0].second, 10., 1e-14);
}



TEST(Loads, BadInput)
{
  Body<2>    body(1, 2);
  const auto fails = [&](const std::string &type, const Settings &settings) {
    auto load = make<2>(type, settings);
    EXPECT_THROW(load->attach(body.state, "Conditions / load"), InputError);
  };
  fails("distributed force", {{"On", "crown"}, {"Force", "t"}});
  fails("distributed force", {{"On", "all"}, {"Force", "t"}}); // no resultant
  fails("distributed force", {{"On", "left"}, {"Force", "t*x"}});
  fails("distributed force", {{"On", "left"}, {"Force", "t; t"}});
  fails("distributed force",
        {{"On", "left"}, {"Force", "t"}, {"Direction", "down"}});
  fails("distributed force",
        {{"On", "left"}, {"Force", "t"}, {"Direction", "0, 0"}});
  fails("couple", {{"On", "crown"}, {"Moment", "1"}});
  fails("couple", {{"On", "left"}, {"Moment", "sin("}});
  fails("point force", {{"On", "tip"}, {"Force", "1; 0"}});
  fails("point force", {{"On", "corner"}, {"Force", "1"}});
  Body<3> solid(1, 1);
  auto    couple =
    make<3>("couple", {{"On", "left"}, {"Moment", "1"}, {"Axis", "0, 0, 0"}});
  EXPECT_THROW(couple->attach(solid.state, "Conditions / load"), InputError);
}
