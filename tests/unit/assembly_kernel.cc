// SPDX-License-Identifier: LGPL-2.1-or-later
// Element forces and matrices against differences of energy and forces.
#include "unit_body.h"

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;
using namespace alveolus::bench;



namespace
{
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
