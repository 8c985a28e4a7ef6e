// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The scenes of prm/verification against exact and published solutions, run as
// users run them: parameter file, overrides, output folder.
#include <alveolus/base/errors.h>
#include <alveolus/driver/simulation.h>

#include <deal.II/base/quadrature_lib.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Sets = std::vector<std::string>;

  const std::string refinements      = "Mesh/grid generator/Refinements=";
  const std::string degree           = "Mesh/Degree=";
  const std::string full_integration = "Regions/wall/Volumetric treatment=none";

  template <int dim>
  bool
  simulate(const ParameterText &text, const std::string &output)
  {
    Log        log(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0, true);
    const auto scene        = std::make_shared<Scene<dim>>(text);
    scene->output_directory = output;
    scene->fields           = false;
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, log);
    return simulation.run();
  }



  /** Run a scene and return the last value of a column of its history. */
  double
  run(const std::string &name, const Sets &sets, const std::string &column)
  {
    const ParameterText text = ParameterText::read(
      std::string(ALVEOLUS_SOURCE_DIR "/prm/verification/") + name + ".prm",
      sets);
    const std::string output =
      "driver_verification." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    EXPECT_TRUE(text.value("Dimension", "2") == "3" ? simulate<3>(text, output)
                                                    : simulate<2>(text, output))
      << name;
    MPI_Barrier(MPI_COMM_WORLD);

    std::ifstream file(output + "/history.csv");
    std::string   header, line, last;
    std::getline(file, header);
    while (std::getline(file, line))
      last = line;
    MPI_Barrier(MPI_COMM_WORLD);
    std::istringstream names(header), values(last);
    std::string        name_of_column, value;
    while (std::getline(names, name_of_column, ',') &&
           std::getline(values, value, ','))
      if (name_of_column == column)
        return std::stod(value);
    ADD_FAILURE() << name << " has no column '" << column << "'";
    return 0.;
  }



  /** Then direct solvers are slow on small problems: fewer of them are run. */
  bool
  many_processes()
  {
    return Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1;
  }



  /** Order of convergence between two successive halvings of the mesh. */
  double
  order(const double coarse, const double fine)
  {
    return std::log2(std::abs(coarse / fine));
  }



  void
  report(const std::string &what, const std::vector<double> &errors)
  {
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) != 0)
      return;
    std::cout << what << ':';
    for (unsigned int i = 0; i < errors.size(); ++i)
      {
        std::cout << "  " << errors[i];
        if (i > 0)
          std::cout << " (order " << order(errors[i - 1], errors[i]) << ')';
      }
    std::cout << std::endl;
  }



  /**
   * Pressure that draws an incompressible Mooney-Rivlin cylinder in plane
   * strain from the radii 1 and 2 to an inner radius @p a: equilibrium is
   * d sigma_r/dr = (sigma_theta - sigma_r)/r, the stretches are r/R and R/r,
   * the stress difference is 2 (c1 + c2) (l^2 - l^-2) (both invariants are
   * 1 + l^2 + l^-2).
   */
  double
  cylinder_pressure(const double a, const double c1_plus_c2)
  {
    const double    c = a * a - 1.;
    const QGauss<1> rule(20);
    double          sum = 0.;
    for (unsigned int q = 0; q < rule.size(); ++q)
      {
        const double R = 1. + rule.point(q)[0];
        const double r = std::sqrt(R * R + c), l = r / R;
        // dr = (R/r) dR
        sum += rule.weight(q) * 2. * c1_plus_c2 * (l * l - 1. / (l * l)) / r *
               (R / r);
      }
    return sum;
  }
} // namespace



// u(r) = p (1 + nu)/(E (b^2 - 1)) ((1 - 2 nu) r + b^2/r), a = 1, b = 2
TEST(ThickCylinder, LameSolution)
{
  const double E = 1000., nu = 0.3, p = 1e-3;
  const auto   lame = [&](const double r) {
    return p * (1. + nu) / (3. * E) * ((1. - 2. * nu) * r + 4. / r);
  };
  const auto errors = [&](const unsigned int k, const Sets &sets) {
    std::vector<double> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        Sets all = sets;
        all.push_back(refinements + std::to_string(k + i));
        result.push_back(
          run("thick-cylinder", all, "A: displacement x [mm]") / lame(1.) - 1.);
      }
    return result;
  };

  const auto linear = errors(1, {degree + "1"});
  report("Lame, degree 1", linear);
  EXPECT_GT(order(linear[1], linear[2]), 1.9);
  EXPECT_LT(std::abs(linear[2]), 2e-3);

  const auto full = errors(1, {degree + "1", full_integration});
  report("Lame, degree 1, full integration", full);
  EXPECT_GT(order(full[1], full[2]), 1.9);
  EXPECT_LT(std::abs(full[2]), 4e-3);

  const auto quadratic = errors(0, {degree + "2"});
  report("Lame, degree 2", quadratic);
  EXPECT_GT(order(quadratic[1], quadratic[2]), 3.);
  EXPECT_LT(std::abs(quadratic[2]), 5e-5);
}



// The inner radius reached under the exact pressure, judged by the pressure
// that belongs to it
TEST(ThickCylinder, IncompressibleMooneyRivlin)
{
  if (many_processes())
    GTEST_SKIP() << "on one process";
  const double exact = cylinder_pressure(1.5, 0.5);
  EXPECT_NEAR(exact, 0.4282284090965, 1e-12); // as in the parameter file
  const auto errors = [&](const unsigned int k, const Sets &sets) {
    std::vector<double> result;
    for (unsigned int i = 0; i < 3; ++i)
      {
        Sets all = sets;
        all.push_back(refinements + std::to_string(k + i));
        const double u =
          run("thick-cylinder-rubber", all, "A: displacement x [mm]");
        result.push_back(cylinder_pressure(1. + u, 0.5) / exact - 1.);
      }
    return result;
  };

  const auto mean = errors(1, {});
  report("Mooney-Rivlin, pressure, mean dilatation", mean);
  EXPECT_GT(order(mean[0], mean[1]), 1.9);
  EXPECT_GT(order(mean[1], mean[2]), 1.9);
  EXPECT_LT(std::abs(mean[2]), 1e-3);

  const auto locked = errors(1, {full_integration});
  report("Mooney-Rivlin, pressure, full integration", locked);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_GT(std::abs(locked[i]), 10. * std::abs(mean[i]));

  const auto quadratic = errors(0, {degree + "2"});
  report("Mooney-Rivlin, pressure, degree 2", quadratic);
  EXPECT_GT(order(quadratic[0], quadratic[1]), 3.);
  EXPECT_LT(std::abs(quadratic[2]), 1e-5);
}



// Rezoning after every step changes the result by less than the error of the
// mesh, and by less and less on finer ones.
TEST(ThickCylinder, RezoningChangesNothingExact)
{
  const std::string   column = "A: displacement x [mm]";
  const double        limit  = run("thick-cylinder-rezoned",
                           {degree + "2", refinements + "2", "Rezoning/Names="},
                           column);
  std::vector<double> changes, errors;
  for (unsigned int k = 1; k < 4; ++k)
    {
      const Sets   sets = {refinements + std::to_string(k)};
      const double ale  = run("thick-cylinder-rezoned", sets, column);
      const double lagrangian =
        run("thick-cylinder-rezoned", {sets[0], "Rezoning/Names="}, column);
      changes.push_back(ale - lagrangian);
      errors.push_back(lagrangian - limit);
    }
  report("Rezoned minus Lagrangian [mm]", changes);
  report("Lagrangian minus limit [mm]", errors);
  for (unsigned int i = 0; i < changes.size(); ++i)
    {
      EXPECT_LT(std::abs(changes[i]), std::abs(errors[i]));
      EXPECT_GT(std::abs(changes[i]), 1e-6); // the mesh was indeed rezoned
    }
  EXPECT_LT(std::abs(changes[2]), 0.6 * std::abs(changes[1]));
}



// An elastic body does not remember how it was loaded: with full integration
// the result does not depend on the steps; mean dilatation averages over the
// cells of x_n, where it does, by less than the error of the mesh.
TEST(ThickCylinder, StepsOfAnElasticBodyDoNotMatter)
{
  const std::string column = "A: displacement x [mm]";
  const auto        change = [&](const std::string &treatment) {
    std::vector<double> u;
    for (const std::string step : {"0.1", "0.05"})
      u.push_back(run("thick-cylinder-rezoned",
                      {"Rezoning/Names=",
                       "Regions/wall/Volumetric treatment=" + treatment,
                       "Time/Initial step=" + step,
                       "Time/Maximum step=" + step},
                      column));
    return std::abs(u[0] - u[1]);
  };
  EXPECT_LT(change("none"), 1e-8);
  EXPECT_LT(change("mean dilatation"), 3e-4); // error of the mesh: 3e-3
}



namespace
{
  std::string
  membrane_mesh(const unsigned int n)
  {
    const std::string text = std::to_string(n);
    return "Mesh/grid generator/Arguments=" + text + ", " + text +
           ", 1 : 0, 0, 0 : 48, 44, 1 : true";
  }
} // namespace



// Pelteret & McBride (2016), table "Tip y-displacement (in mm)", two decimals
TEST(CookMembrane, PublishedTipDisplacements)
{
  const std::string column = "tip: displacement y [mm]";
  const std::vector<std::pair<unsigned int, double>> linear = {
    {1, 5.15}, {2, 8.72}, {4, 12.02}, {8, 13.61}, {16, 14.13}};
  for (const auto &[n, published] : linear)
    {
      if (n > 4 && many_processes())
        continue;
      EXPECT_NEAR(run("cook-membrane",
                      {membrane_mesh(n), degree + "1"},
                      column),
                  published,
                  0.0051)
        << n << " elements of degree 1";
    }
  const std::vector<std::pair<unsigned int, double>> quadratic = {{1, 12.19},
                                                                  {2, 13.83},
                                                                  {4, 14.22}};
  for (const auto &[n, published] : quadratic)
    {
      if (n > 2 && many_processes())
        continue;
      EXPECT_NEAR(run("cook-membrane",
                      {membrane_mesh(n), degree + "2"},
                      column),
                  published,
                  0.0051)
        << n << " elements of degree 2";
    }
}



TEST(CookMembrane, PlaneStrainIsAPlateBetweenSmoothWalls)
{
  const std::string column = "tip: displacement y [mm]";
  const double      plane  = run("cook-membrane-plane-strain", {}, column);
  const double      plate  = run("cook-membrane",
                           {"Conditions/Names=clamped, load, faces",
                                  "Conditions/faces/Type=displacement",
                                  "Conditions/faces/On=front, back",
                                  "Conditions/faces/Components=z"},
                           column);
  EXPECT_NEAR(plane, plate, 1e-8 * plane);
}
