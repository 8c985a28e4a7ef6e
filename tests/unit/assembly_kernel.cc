// SPDX-License-Identifier: LGPL-2.1-or-later
// Element forces and matrices against differences of energy and forces, patch
// test, rigid rotations, load stiffness of pressure and interface.
#include <alveolus/assembly/mechanics_assembler.h>
#include <alveolus/base/errors.h>
#include <alveolus/materials/remodelled_bone.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/physics/transformations.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Settings = std::vector<std::pair<std::string, std::string>>;

  template <class Interface>
  std::unique_ptr<Interface>
  make(const std::string &type, const Settings &settings)
  {
    auto             object = Registry<Interface>::create(type, "Type");
    ParameterHandler prm;
    object->declare_parameters(prm);
    for (const auto &[key, value] : settings)
      prm.set(key, value);
    return object;
  }

  std::unique_ptr<Material>
  make_material(const std::string &type,
                const Settings    &settings,
                const unsigned int dim)
  {
    auto material = make<Material>(type, settings);
    if (auto *bone = dynamic_cast<RemodelledBone *>(material.get()))
      bone->set_remodelled(true, true);
    material->initialize(dim, "Materials / test");
    return material;
  }

  /** What a history starts from. */
  struct Prestrain
  {
    double strain  = 0.; ///< largest components of the elastic strain
    double density = 0.; ///< of bone
    double fabric  = 0.; ///< largest components of the log fabric
  };

  /** Unit square or cube of n^dim cells with one material, no conditions. */
  template <int dim>
  struct Body
  {
    Body(std::unique_ptr<Material> body_material,
         const unsigned int        degree,
         const unsigned int        n,
         const bool                mean_dilatation = true)
      : material(std::move(body_material))
      , mesh(unit_mesh(n))
      , regions({{"body", material.get(), mean_dilatation}})
      , state(mesh,
              degree,
              {{0, 0}},
              {HistoryLayout(material->history_fields(), dim)})
    {
      for (unsigned int c = 0; c < n_cells(); ++c)
        for (unsigned int q = 0; q < state.history.n_points; ++q)
          material->initial_history(state.history.old_record(c, q));
      state.history.trial_values = state.history.old_values;
    }

    static Mesh<dim>
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
                                                std::vector<unsigned int>(dim,
                                                                          n),
                                                Point<dim>(),
                                                corner,
                                                true);
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        cell->set_material_id(0);
      mesh.names.boundaries = {{"left", {0}}, {"right", {1}}};
      for (unsigned int b = 0; b < 2 * dim; ++b)
        mesh.names.boundaries["all"].insert(b);
      mesh.names.regions["body"] = {0};
      return mesh;
    }

    unsigned int
    n_cells() const
    {
      return mesh.triangulation->n_active_cells();
    }

    double
    random(const double size)
    {
      return std::uniform_real_distribution<double>(-size, size)(generator);
    }

    SymmetricTensor<2, 3>
    random_tensor(const double size)
    {
      SymmetricTensor<2, 3> t;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          if (j < dim || i == j)
            t[i][j] = random(size);
      return t;
    }

    bool
    at_boundary(const Point<dim> &X) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (X[d] < 1e-12 || X[d] > 1. - 1e-12)
          return true;
      return false;
    }

    /** Nodal vector of values f(X, x), X initial and x current position. */
    template <typename F>
    NodalVector
    nodal(const F &f) const
    {
      NodalVector       v = state.configuration.make_vector();
      const NodalVector x = state.configuration.positions();
      for (const NodeId node : state.nodes.relevant())
        state.nodes.set(
          v,
          node,
          f(state.nodes.get(state.configuration.initial_positions(), node),
            state.nodes.get(x, node)));
      v.update_ghost_values();
      return v;
    }

    /** Move nodes at random, by a part of their distance. */
    void
    distort(const bool inside_only)
    {
      const double size = 0.12 / (state.configuration.degree *
                                  std::round(std::pow(n_cells(), 1. / dim)));
      state.configuration.set_positions(
        nodal([&](const Point<dim> &X, const Point<dim> &x) {
          Point<dim> y = x;
          if (!inside_only || !at_boundary(X))
            for (unsigned int d = 0; d < dim; ++d)
              y[d] += random(size);
          return y;
        }));
    }

    /** Random history, the same at all points if @p uniform. */
    void
    strain(const Prestrain &prestrain, const bool uniform)
    {
      std::vector<double> record;
      const auto         &layout = state.history.layout(0);
      const int           rho    = layout.offset("density");
      const int           fabric = layout.offset("log fabric");
      for (unsigned int c = 0; c < n_cells(); ++c)
        for (unsigned int q = 0; q < state.history.n_points; ++q)
          {
            double *values = state.history.old_record(c, q);
            if (record.empty() || !uniform)
              {
                pack(random_tensor(prestrain.strain), values, dim);
                if (rho >= 0)
                  values[rho] = prestrain.density;
                if (fabric >= 0)
                  pack(deviator(random_tensor(prestrain.fabric)),
                       values + fabric,
                       dim);
                record.assign(values, values + layout.size);
              }
            else
              std::copy(record.begin(), record.end(), values);
          }
    }

    std::unique_ptr<Material> material;
    Mesh<dim>                 mesh;
    std::vector<Region>       regions;
    State<dim>                state;
    std::mt19937              generator{4711};
  };



  /** One distorted cell with a random prestrain and a random increment. */
  template <int dim>
  struct Cell : public Body<dim>
  {
    Cell(std::unique_ptr<Material> material,
         const unsigned int        degree,
         const bool                mean_dilatation,
         const Prestrain          &prestrain,
         const double              size)
      : Body<dim>(std::move(material), degree, 1, mean_dilatation)
      , geometry(this->state.configuration)
      , kernel(this->state.configuration, geometry)
      , increment(this->state.configuration.fe.n_dofs_per_cell())
    {
      this->distort(false);
      this->strain(prestrain, false);
      geometry.update();
      for (double &value : increment)
        value = this->random(size);
    }

    Vector<double>
    forces(FullMatrix<double> *matrix = nullptr)
    {
      Vector<double> result(increment.size());
      EXPECT_EQ(
        kernel.evaluate(
          0, this->regions[0], this->state.history, increment, matrix, result),
        CellKernel<dim>::Status::good);
      return result;
    }

    /** f(increment + h e_b) - f(increment - h e_b) over 2 h. */
    template <typename F>
    auto
    difference(const unsigned int b, const F &f)
    {
      const double h = 5e-7, middle = increment[b];
      increment[b] = middle + h;
      auto result  = f();
      increment[b] = middle - h;
      result -= f();
      increment[b] = middle;
      result /= 2. * h;
      return result;
    }

    /** Largest deviation of the matrix from differences, relative. */
    double
    matrix_error()
    {
      const unsigned int n = increment.size();
      FullMatrix<double> matrix(n, n);
      forces(&matrix);
      double largest = 0.;
      for (unsigned int b = 0; b < n; ++b)
        {
          const Vector<double> column =
            difference(b, [&]() { return forces(); });
          for (unsigned int a = 0; a < n; ++a)
            largest = std::max(largest, std::abs(matrix(a, b) - column[a]));
        }
      return largest / matrix.linfty_norm();
    }

    /** Largest deviation of the forces from differences of the energy. */
    double
    force_error()
    {
      const Vector<double> exact   = forces();
      double               largest = 0.;
      for (unsigned int b = 0; b < increment.size(); ++b)
        {
          const double slope = difference(b, [&]() {
            forces();
            return kernel.energy;
          });
          largest            = std::max(largest, std::abs(slope - exact[b]));
        }
      return largest / exact.linfty_norm();
    }

    double
    asymmetry()
    {
      const unsigned int n = increment.size();
      FullMatrix<double> matrix(n, n);
      forces(&matrix);
      double largest = 0.;
      for (unsigned int a = 0; a < n; ++a)
        for (unsigned int b = 0; b < a; ++b)
          largest = std::max(largest, std::abs(matrix(a, b) - matrix(b, a)));
      return largest / matrix.linfty_norm();
    }

    /** Points whose plastic strain has grown. */
    unsigned int
    n_yielding()
    {
      forces();
      auto        &history = this->state.history;
      const int    alpha   = history.layout(0).offset("plastic strain");
      unsigned int n       = 0;
      for (unsigned int q = 0; q < history.n_points; ++q)
        n +=
          history.trial_record(0, q)[alpha] > history.old_record(0, q)[alpha];
      return n;
    }

    StepGeometry<dim> geometry;
    CellKernel<dim>   kernel;
    Vector<double>    increment;
  };



  template <int dim>
  void
  check_hyperelastic(const std::string &type, const Settings &settings)
  {
    for (const unsigned int degree : {1, 2})
      for (const bool mean_dilatation : {false, true})
        {
          SCOPED_TRACE(type + ", dim " + std::to_string(dim) + ", degree " +
                       std::to_string(degree) +
                       (mean_dilatation ? ", mean dilatation" : ", full"));
          Prestrain prestrain;
          prestrain.strain  = 0.06;
          prestrain.density = 0.9;
          Cell<dim> cell(make_material(type, settings, dim),
                         degree,
                         mean_dilatation,
                         prestrain,
                         0.08 / degree);
          EXPECT_LE(cell.matrix_error(), 1e-7);
          EXPECT_LE(cell.force_error(), 1e-7);
          EXPECT_LE(cell.asymmetry(), 1e-13);
        }
  }

  template <int dim>
  void
  check_bone(const Settings &settings, const bool yields)
  {
    for (const unsigned int degree : {1, 2})
      for (const bool mean_dilatation : {false, true})
        {
          SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
                       std::to_string(degree) +
                       (mean_dilatation ? ", mean dilatation" : ", full"));
          Prestrain prestrain;
          prestrain.strain  = 0.003;
          prestrain.density = 0.9;
          prestrain.fabric  = 0.25;
          Cell<dim> cell(make_material("remodelled bone", settings, dim),
                         degree,
                         mean_dilatation,
                         prestrain,
                         (yields ? 0.1 : 0.001) / degree);
          const unsigned int n = cell.n_yielding();
          if (yields)
            {
              EXPECT_GT(n, cell.geometry.n_points / 2);
            }
          else
            {
              EXPECT_EQ(n, 0u);
            }
          EXPECT_LE(cell.matrix_error(), 1e-7);
        }
  }
} // namespace



TEST(CellKernel, HyperelasticMatrixAndForcesAreDerivatives)
{
  const Settings hencky = {{"Young's modulus", "1000"},
                           {"Poisson's ratio", "0.4"}};
  const Settings neo    = {{"Shear modulus", "80"}, {"Bulk modulus", "400"}};
  check_hyperelastic<2>("Hencky elastic", hencky);
  check_hyperelastic<3>("Hencky elastic", hencky);
  check_hyperelastic<2>("neo-Hookean", neo);
  check_hyperelastic<3>("neo-Hookean", neo);
}



// Without plasticity and fabric, H is a multiple of I and bone hyperelastic.
TEST(CellKernel, IsotropicDamagedBoneIsHyperelastic)
{
  check_hyperelastic<2>("remodelled bone", {{"Plasticity", "false"}});
  check_hyperelastic<3>("remodelled bone", {{"Plasticity", "false"}});
}



TEST(CellKernel, MatrixOfElasticBoneWithFabric)
{
  check_bone<2>({}, false);
  check_bone<3>({}, false);
}



TEST(CellKernel, MatrixOfYieldingBoneWithFabric)
{
  check_bone<2>({}, true);
  check_bone<3>({}, true);
  check_bone<2>({{"Yield law", "effective"}}, true);
  check_bone<3>({{"Yield law", "effective"}}, true);
}



TEST(CellKernel, InvertedCellsAreReported)
{
  Cell<2> cell(make_material("Hencky elastic", {}, 2), 1, false, {}, 0.);
  // Draw the vertex at (1, 1) beyond the opposite one.
  cell.increment[6] = cell.increment[7] = -1.5;
  Vector<double> forces(8);
  EXPECT_EQ(
    cell.kernel.evaluate(
      0, cell.regions[0], cell.state.history, cell.increment, nullptr, forces),
    CellKernel<2>::Status::inverted);
}



namespace
{
  /** A linear displacement gives one stress everywhere, in equilibrium. */
  template <int dim>
  void
  check_patch(const std::string &type,
              const Settings    &settings,
              const unsigned int degree,
              const bool         mean_dilatation)
  {
    SCOPED_TRACE(type + ", dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree) +
                 (mean_dilatation ? ", mean dilatation" : ", full"));
    Body<dim> body(make_material(type, settings, dim),
                   degree,
                   dim == 2 ? 4 : 3,
                   mean_dilatation);
    body.distort(true);
    Prestrain prestrain;
    prestrain.strain  = 0.01;
    prestrain.density = 1.;
    prestrain.fabric  = 0.2;
    body.strain(prestrain, true);
    auto &state = body.state;

    Tensor<2, 3> f = Tensor<2, 3>(unit_symmetric_tensor<3>());
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        f[i][j] += body.random(0.05);
    const NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &x) {
        Point<dim> du;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            du[i] += (f[i][j] - (i == j)) * x[j];
        return du;
      });

    typename MechanicsAssembler<dim>::Conditions none;
    MechanicsAssembler<dim> assembler(state, body.regions, none);
    NodalVector             residual = state.configuration.make_vector();
    assembler.begin_step({0., 1.});
    const AssemblyResult result =
      assembler.assemble(increment, AssemblyTarget{residual});
    ASSERT_TRUE(result.good);

    // The material at one point, evaluated directly
    const unsigned int  size = state.history.layout(0).size;
    std::vector<double> record(size);
    MaterialResponse    response;
    body.material->evaluate(
      f, state.history.old_record(0, 0), record.data(), false, response);
    for (unsigned int c = 0; c < body.n_cells(); ++c)
      for (unsigned int q = 0; q < state.history.n_points; ++q)
        for (unsigned int i = 0; i < size; ++i)
          ASSERT_NEAR(state.history.trial_record(c, q)[i], record[i], 1e-13);

    // Force on the face x = 1 of x_n: first Piola-Kirchhoff stress times 1 mm^2
    const Tensor<2, 3> P =
      Tensor<2, 3>(response.stress) * transpose(invert(f)) /
      body.material->volume_ratio(state.history.old_record(0, 0));
    const NodalVector X = state.configuration.initial_positions();
    Tensor<1, dim>    right;
    double            largest = 0., scale = 0.;
    for (const NodeId node : state.nodes.relevant())
      {
        const Point<dim> force = state.nodes.get(residual, node);
        scale                  = std::max(scale, Tensor<1, dim>(force).norm());
        if (!body.at_boundary(state.nodes.get(X, node)))
          largest = std::max(largest, Tensor<1, dim>(force).norm());
      }
    // By virtual work with v_i = x: it vanishes on the face x = 0, and the
    // tractions of the other faces do none in sum.
    for (unsigned int i = 0; i < dim; ++i)
      {
        double work = 0.;
        for (const NodeId node : state.nodes.relevant())
          work += state.nodes.get(residual, node)[i] *
                  state.nodes.get(state.configuration.positions(), node)[0];
        right[i] = work;
        EXPECT_NEAR(right[i], P[i][0], 1e-12 * P.norm());
      }
    EXPECT_LE(largest, 1e-13 * scale);
  }



  template <int dim>
  Tensor<2, dim>
  rotation(const double angle)
  {
    const Tensor<2, 3> R =
      Physics::Transformations::Rotations::rotation_matrix_3d(
        dim == 2 ? Point<3>(0., 0., 1.)
                 : Point<3>(1. / std::sqrt(3.),
                            1. / std::sqrt(3.),
                            1. / std::sqrt(3.)),
        angle);
    Tensor<2, dim> result;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        result[i][j] = R[i][j];
    return result;
  }



  /**
   * A body turned by 360 degrees in twelve steps: forces of an unstressed one
   * and deviation of the co-rotated strain of a prestrained one.
   */
  template <int dim>
  void
  check_rotation(const std::string &type,
                 const Settings    &settings,
                 const double       young,
                 const Prestrain   &prestrain)
  {
    SCOPED_TRACE(type + ", dim " + std::to_string(dim));
    Body<dim> body(make_material(type, settings, dim), 1, 2);
    body.distort(false);
    body.strain(prestrain, true);
    auto      &state  = body.state;
    const auto before = state.history.old_values;
    const int  fabric = state.history.layout(0).offset("log fabric");
    Point<dim> centre;
    centre[0]              = 3.;
    const Tensor<2, dim> R = rotation<dim>(numbers::PI / 6.);
    typename MechanicsAssembler<dim>::Conditions none;
    MechanicsAssembler<dim> assembler(state, body.regions, none);
    NodalVector             residual = state.configuration.make_vector();
    double                  largest  = 0.;
    for (unsigned int step = 1; step <= 12; ++step)
      {
        const NodalVector increment =
          body.nodal([&](const Point<dim> &, const Point<dim> &x) {
            return Point<dim>(R * (x - centre) - (x - centre));
          });
        assembler.begin_step({0., 1.});
        ASSERT_TRUE(
          assembler.assemble(increment, AssemblyTarget{residual}).good);
        largest = std::max(largest, residual.linfty_norm());
        state.configuration.move(increment);
        state.history.commit();

        const Tensor<2, dim> turn = rotation<dim>(step * numbers::PI / 6.);
        Tensor<2, 3>         Q    = Tensor<2, 3>(unit_symmetric_tensor<3>());
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            Q[i][j] = turn[i][j];
        const auto turned = [&](const double *values) {
          return symmetrize(Q * Tensor<2, 3>(unpack(values, dim)) *
                            transpose(Q));
        };
        for (unsigned int c = 0; c < body.n_cells(); ++c)
          for (unsigned int q = 0; q < state.history.n_points; ++q)
            {
              const std::size_t first =
                state.history.old_record(c, q) - &state.history.old_values[0];
              ASSERT_LE((unpack(state.history.old_record(c, q), dim) -
                         turned(&before[first]))
                          .norm(),
                        1e-12);
              if (fabric >= 0)
                {
                  ASSERT_LE((unpack(state.history.old_record(c, q) + fabric,
                                    dim) -
                             turned(&before[first + fabric]))
                              .norm(),
                            1e-10);
                }
            }
      }
    if (prestrain.strain == 0.)
      {
        EXPECT_LE(largest, 1e-12 * young);
      }
  }
} // namespace



TEST(PatchTest, LinearDisplacementGivesOneStress)
{
  for (const bool mean_dilatation : {false, true})
    for (const unsigned int degree : {1, 2})
      {
        const Settings neo = {{"Shear modulus", "80"}, {"Bulk modulus", "400"}};
        check_patch<2>("neo-Hookean", neo, degree, mean_dilatation);
        check_patch<3>("neo-Hookean", neo, degree, mean_dilatation);
        check_patch<2>("remodelled bone", {}, degree, mean_dilatation);
        check_patch<3>("remodelled bone", {}, degree, mean_dilatation);
      }
}



TEST(RigidRotation, MakesNoStressAndTurnsWhatThereIs)
{
  const Settings hencky = {{"Young's modulus", "1000"}};
  check_rotation<2>("Hencky elastic", hencky, 1000., {});
  check_rotation<3>("Hencky elastic", hencky, 1000., {});
  Prestrain prestrain;
  prestrain.density = 0.9;
  prestrain.fabric  = 0.25;
  check_rotation<2>("remodelled bone", {}, 13750., prestrain);
  check_rotation<3>("remodelled bone", {}, 13750., prestrain);
  prestrain.strain = 0.003;
  check_rotation<2>("remodelled bone", {}, 13750., prestrain);
  check_rotation<3>("remodelled bone", {}, 13750., prestrain);
}



namespace
{
  /** A matrix of all entries, no constraints, no solver. */
  class DenseSystem : public LinearSystem
  {
  public:
    explicit DenseSystem(const unsigned int n)
      : matrix(n, n)
    {}
    void
    clear() override
    {
      matrix = 0.;
    }
    void
    add(const FullMatrix<double>                   &cell_matrix,
        const std::vector<types::global_dof_index> &dofs) override
    {
      for (unsigned int i = 0; i < dofs.size(); ++i)
        for (unsigned int j = 0; j < dofs.size(); ++j)
          matrix(dofs[i], dofs[j]) += cell_matrix(i, j);
    }
    void
    compress() override
    {}
    void
    solve(NodalVector &, const NodalVector &) override
    {}
    std::string
    name() const override
    {
      return "dense";
    }

    FullMatrix<double> matrix;
  };



  /** Relative deviation of a condition's matrix from force differences. */
  template <int dim>
  double
  stiffness_error(const State<dim> &state,
                  Condition<dim>   &condition,
                  NodalVector      &increment)
  {
    const unsigned int n = state.configuration.dof_handler.n_dofs();
    DenseSystem        system(n);
    NodalVector        forces = state.configuration.make_vector();
    forces                    = 0.;
    condition.add_forces(state, increment, AssemblyTarget{forces, &system});
    const auto evaluate = [&]() {
      NodalVector result = state.configuration.make_vector();
      result             = 0.;
      condition.add_forces(state, increment, AssemblyTarget{result});
      return result;
    };
    double largest = 0.;
    for (unsigned int b = 0; b < n; ++b)
      {
        const double h = 1e-6, middle = increment(b);
        increment(b)        = middle + h;
        const NodalVector p = evaluate();
        increment(b)        = middle - h;
        const NodalVector m = evaluate();
        increment(b)        = middle;
        for (unsigned int a = 0; a < n; ++a)
          largest =
            std::max(largest,
                     std::abs(system.matrix(a, b) - (p(a) - m(a)) / (2. * h)));
      }
    return largest / system.matrix.linfty_norm();
  }



  template <int dim>
  void
  check_pressure(const unsigned int degree)
  {
    SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree));
    Body<dim> body(make_material("Hencky elastic", {}, dim),
                   degree,
                   dim == 2 ? 2 : 1);
    body.distort(false);
    auto &state = body.state;
    auto  pressure =
      make<Condition<dim>>("pressure", {{"On", "all"}, {"Function", "3*t"}});
    pressure->attach(state, "Conditions / pressure");
    pressure->begin_step(state, {0., 2.});
    NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &) {
        Point<dim> du;
        for (unsigned int d = 0; d < dim; ++d)
          du[d] = body.random(0.05 / degree);
        return du;
      });
    EXPECT_LE(stiffness_error(state, *pressure, increment), 1e-8);

    // Pressure on a closed surface has no resultant; its work in v = x is
    // p dim V of the deformed body, with the sign of a load from outside.
    NodalVector forces = state.configuration.make_vector();
    forces             = 0.;
    pressure->add_forces(state, increment, AssemblyTarget{forces});
    StepGeometry<dim> geometry(state.configuration);
    const NodalVector x_n = state.configuration.positions();
    Tensor<1, dim>    resultant;
    double            work = 0.;
    for (const NodeId node : state.nodes.relevant())
      {
        resultant += state.nodes.get(forces, node);
        const Tensor<1, dim> x =
          state.nodes.get(x_n, node) +
          Tensor<1, dim>(state.nodes.get(increment, node));
        work += x * Tensor<1, dim>(state.nodes.get(forces, node));
      }
    state.configuration.move(increment);
    geometry.update();
    double volume = 0.;
    for (unsigned int c = 0; c < body.n_cells(); ++c)
      for (unsigned int q = 0; q < geometry.n_points; ++q)
        volume += geometry.weights(c)[q];
    EXPECT_LE(resultant.norm(), 1e-13);
    EXPECT_NEAR(work, 6. * dim * volume, 1e-12);
  }



  template <int dim>
  void
  check_interface(const unsigned int degree)
  {
    SCOPED_TRACE("dim " + std::to_string(dim) + ", degree " +
                 std::to_string(degree));
    Body<dim> body(make_material("Hencky elastic", {}, dim),
                   degree,
                   dim == 2 ? 2 : 1);
    body.distort(false);
    auto         &state = body.state;
    InterfaceLaws laws;
    laws["layer"] = make<InterfaceLaw>(
      "ligament",
      {{"Thickness", "0.2"},
       {"Table file", ALVEOLUS_SOURCE_DIR "/prm/tables/ligament-table-2.csv"}});
    laws["layer"]->initialize("Interfaces / layer", "/");
    auto tooth = make<Condition<dim>>(
      "rigid body",
      {{"On", "right"},
       {"Motion", dim == 2 ? "0.03*t; 0.02*t" : "0.03*t; 0.02*t; -0.01*t"},
       {"Rotation", "2*t"},
       {"Centre", "1, 0.5, 0.5"},
       {"Attachment", "layer"}});
    tooth->choose_interface_law(laws, "Conditions / tooth");
    tooth->attach(state, "Conditions / tooth");
    for (double &jump : tooth->face_history()->old_values)
      jump = body.random(0.03);
    tooth->begin_step(state, {1., 2.});
    NodalVector increment =
      body.nodal([&](const Point<dim> &, const Point<dim> &) {
        Point<dim> du;
        for (unsigned int d = 0; d < dim; ++d)
          du[d] = body.random(0.01);
        return du;
      });
    EXPECT_LE(stiffness_error(state, *tooth, increment), 1e-7);

    // What the body exerts is what the boundary receives.
    NodalVector forces = state.configuration.make_vector();
    forces             = 0.;
    tooth->add_forces(state, increment, AssemblyTarget{forces});
    Tensor<1, dim> received;
    for (const NodeId node : state.nodes.relevant())
      received -= Tensor<1, dim>(state.nodes.get(forces, node));
    const auto recorded = tooth->record(state, forces);
    ASSERT_EQ(recorded[1].first, "force x [N]");
    for (unsigned int d = 0; d < dim; ++d)
      EXPECT_NEAR(recorded[1 + d].second, received[d], 1e-13);
    EXPECT_GT(received.norm(), 1e-4);
  }
} // namespace



TEST(Pressure, LoadStiffnessIsTheDerivative)
{
  for (const unsigned int degree : {1, 2})
    {
      check_pressure<2>(degree);
      check_pressure<3>(degree);
    }
}



TEST(Interface, MatrixIsTheDerivative)
{
  for (const unsigned int degree : {1, 2})
    {
      check_interface<2>(degree);
      check_interface<3>(degree);
    }
}
