// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// The balance of energy: the work of external forces against what the materials
// say they store and dissipate. The trapezoidal rule errs by O(dt^3) a step, so
// halving the step takes the error of a smooth path to a quarter. What the rule
// does not touch holds to round-off.
#include <alveolus/base/errors.h>
#include <alveolus/driver/simulation.h>

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  using Sets   = std::vector<std::string>;
  using Column = std::vector<double>;

  /** Columns of a history by name. */
  class History : public std::map<std::string, Column>
  {
  public:
    double
    last(const std::string &name) const
    {
      EXPECT_EQ(count(name), 1) << name;
      return count(name) == 1 ? at(name).back() : NAN;
    }
  };

  /** Run a shipped scene with changes. */
  template <int dim = 2>
  History
  run(const std::string &name, const Sets &sets, const bool all_files = false)
  {
    const std::string output =
      "driver_invariants." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    const ParameterText text =
      ParameterText::read(ALVEOLUS_SOURCE_DIR "/prm/" + name + ".prm", sets);
    Log        log(Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0, true);
    const auto scene        = std::make_shared<Scene<dim>>(text);
    scene->output_directory = output;
    scene->fields           = all_files;
    scene->checkpoint.write = all_files;
    if (all_files)
      scene->checkpoint.step_interval = 1;
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, log);
    EXPECT_TRUE(simulation.run()) << name;
    MPI_Barrier(MPI_COMM_WORLD);

    History                  history;
    std::ifstream            file(output + "/history.csv");
    std::string              header, line, value;
    std::vector<std::string> names;
    std::getline(file, header);
    for (std::istringstream list(header); std::getline(list, value, ',');)
      names.push_back(value);
    while (std::getline(file, line))
      {
        std::istringstream values(line);
        for (const auto &column : names)
          {
            std::getline(values, value, ',');
            history[column].push_back(std::stod(value));
          }
      }
    MPI_Barrier(MPI_COMM_WORLD);
    return history;
  }



  Sets
  steps(const unsigned int n, const double end, const Sets &more)
  {
    Sets       sets = more;
    const auto size = std::to_string(end / n);
    sets.push_back("Time/End=" + std::to_string(end));
    sets.push_back("Time/Initial step=" + size);
    sets.push_back("Time/Maximum step=" + size);
    sets.push_back("Solver/Tolerance=1e-12");
    sets.push_back("Solver/Absolute tolerance=0");
    return sets;
  }



  /** Balance errors for n, 2n, 4n steps; the ratio of the last two. */
  template <int dim = 2>
  double
  falls_by(const std::string &name,
           const unsigned int n,
           const double       end,
           const Sets        &sets)
  {
    Column errors;
    for (const unsigned int factor : {1, 2, 4})
      {
        const History h = run<dim>(name, steps(factor * n, end, sets));
        errors.push_back(h.last("energy balance"));
      }
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      std::cout << name << ": " << errors[0] << ' ' << errors[1] << ' '
                << errors[2] << std::endl;
    return errors[1] / errors[2];
  }

  const Sets coarse = {"Mesh/grid generator/Refinements=0"};

  Sets
  with(const Sets &a, const Sets &b)
  {
    Sets all = a;
    all.insert(all.end(), b.begin(), b.end());
    return all;
  }
} // namespace



TEST(EnergyBooks, FollowerPressureOnRubber)
{
  const Sets soft = with(coarse, {"Materials/rubber/Bulk modulus=100"});
  EXPECT_NEAR(falls_by("verification/thick-cylinder-rubber", 2, 1., soft),
              4.,
              0.3);
  EXPECT_NEAR(falls_by("verification/thick-cylinder-rubber",
                       2,
                       1.,
                       with(soft, {"Regions/wall/Volumetric treatment=none"})),
              4.,
              0.3);
}



TEST(EnergyBooks, DraggedAndTurnedDisc)
{
  EXPECT_NEAR(
    falls_by("disc-in-ring", 2, 0.4, with(coarse, {"Rezoning/Names="})),
    4.,
    0.3);
}



// Transfer and unbalanced forces have terms of their own: the rest closes as
// before.
TEST(EnergyBooks, Rezoned)
{
  const Sets    finer = {"Mesh/grid generator/Refinements=1"};
  const History h     = run("disc-in-ring", steps(4, 0.4, finer));
  EXPECT_GT(std::abs(h.last("energy by transfer [mJ]")),
            10. * std::abs(h.last("energy balance")) *
              h.last("external work [mJ]"));
  EXPECT_NEAR(falls_by("disc-in-ring", 2, 0.4, finer), 4., 0.5);
}



TEST(EnergyBooks, Layer)
{
  const Sets layer = {"Rezoning/Names=",
                      "Interfaces/Names=layer",
                      "Interfaces/layer/Type=ligament",
                      "Interfaces/layer/Thickness=1",
                      "Interfaces/layer/Poisson's ratio=0.3",
                      "Interfaces/layer/Tangent modulus=0: 1",
                      "Conditions/disc/Attachment=layer"};
  EXPECT_NEAR(falls_by("disc-in-ring", 2, 0.4, with(coarse, layer)), 4., 0.5);
}



// With full integration and without rezoning a step begins in equilibrium: the
// work is that of the recorded force along the path, nothing is out of balance
// and nothing changes but by work. All to round-off.
TEST(EnergyBooks, WorkIsThatOfTheRecordedForce)
{
  const History h =
    run("disc-in-ring",
        steps(4,
              0.4,
              with(coarse,
                   {"Rezoning/Names=",
                    "Conditions/disc/Rotation=0",
                    "Regions/ring/Volumetric treatment=none"})));
  double work = 0., force = 0., place = 0.;
  for (unsigned int i = 0; i < h.at("time [T]").size(); ++i)
    {
      const double next = h.at("force x [N]")[i];
      const double x    = 3. * h.at("time [T]")[i];
      work += 0.5 * (force + next) * (x - place);
      force = next;
      place = x;
      EXPECT_NEAR(h.at("external work [mJ]")[i], work, 1e-10 * work);
      EXPECT_NEAR(h.at("work of unbalanced forces [mJ]")[i], 0., 1e-10 * work);
      EXPECT_NEAR(h.at("energy by update [mJ]")[i], 0., 1e-13 * work);
      EXPECT_LT(h.at("resultant of forces")[i], 1e-11);
    }
  EXPECT_GT(work, 0.1);
}



TEST(EnergyBooks, InThreeDimensions)
{
  EXPECT_NEAR(falls_by<3>("verification/cook-membrane",
                          2,
                          1.,
                          {"Mesh/grid generator/Arguments=4, 4, 1 : 0, 0, 0 : "
                           "48, 44, 1 : true"}),
              4.,
              0.3);
}



// The energy that a new mesh takes or gives has a term of its own.
TEST(EnergyBooks, OverARemesh)
{
  const Sets remeshed = {
    "Mesh/grid generator/Arguments=4, 4 : 0, 0 : 48, 44 : true",
    "Remeshing/Type=structured",
    "Remeshing/Times=0.5",
    "Remeshing/structured/Blocks=membrane",
    "Remeshing/structured/Edge length=6"};
  const std::string name = "verification/cook-membrane-plane-strain";
  const History     h    = run(name, steps(8, 1., remeshed));
  EXPECT_GT(std::abs(h.last("energy by remeshing [mJ]")),
            10. * std::abs(h.last("energy balance")) *
              h.last("external work [mJ]"));
  EXPECT_NEAR(falls_by(name, 2, 1., remeshed), 4., 0.5);
}



// Two blocks pressed together by half of their stiffness
TEST(EnergyBooks, Contact)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "contact is written for one process";
  EXPECT_NEAR(falls_by("verification/contact-patch",
                       2,
                       1.,
                       {"Conditions/load/Function=5*t"}),
              4.,
              0.5);
}



// Density lost under load: the energy it takes at fixed strain is booked from
// the materials, not from forces. Without plasticity: bone that loses density
// in the state of yielding is beyond the yield surface when the next step
// begins, which costs an order.
TEST(EnergyBooks, Remodelling)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "many steps, nothing that several processes change";
  const std::string name = "../tests/scene/extruded-plane";
  const Sets bone = {"Mesh/grid generator/Arguments=6, 3 : 0, 0 : 8, 4 : true",
                     "Rezoning/Names=",
                     "Materials/bone/Yield stress=1e5"};
  const History h = run(name, steps(16, 4., bone));
  EXPECT_GT(std::abs(h.last("energy by remodelling [mJ]")),
            0.5 * h.last("external work [mJ]"));
  EXPECT_NEAR(falls_by(name, 16, 4., bone), 4., 0.8);
}



// Transfer takes points with different fabric together and leaves some beyond
// their yield surfaces. What flow takes from them in the next step is not
// booked at the transfer, too: that once was 0.9 % here.
TEST(EnergyBooks, FlowAfterTransfer)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "many steps, nothing that several processes change";
  const History h = run("academic",
                        {"Mesh/Type=file",
                         "Mesh/file/File name=" ALVEOLUS_SOURCE_DIR
                         "/meshes/academic-coarse.msh",
                         "Time/End=20",
                         "Time/Initial step=0.5",
                         "Time/Maximum step=0.5"});
  EXPECT_GT(h.last("plastic dissipation [mJ]"), 100.);
  EXPECT_LT(std::abs(h.last("energy balance")), 1e-3);
}



// Plastic work is found from the return, not from forces. The step in which a
// point begins to yield costs an order there: less than a quarter is not
// promised, a half is.
TEST(EnergyBooks, PlasticBar)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "many steps, nothing that several processes change";
  const Sets sets = {
    "Mesh/grid generator/Arguments=5, 2 : 0, 0 : 26.667, 6.413 "
    ": true"};
  const History h = run("verification/necking", steps(40, 0.5, sets));
  EXPECT_LT(std::abs(h.last("energy balance")), 1e-3);
  EXPECT_GT(h.last("plastic dissipation [mJ]"),
            0.9 * h.last("external work [mJ]"));
  EXPECT_GT(falls_by("verification/necking", 20, 0.5, sets), 2.);
}



// Switching an optional part off does not change the rest, to the last bit.
namespace
{
  const Sets academic = {"Mesh/Type=file",
                         "Mesh/file/File name=" ALVEOLUS_SOURCE_DIR
                         "/meshes/academic-coarse.msh",
                         "Time/End=3",
                         "Time/Initial step=1",
                         "Time/Maximum step=1"};

  /** All columns but times must be those of @p other where both have them. */
  void
  expect_same(const History &history, const History &other, const char *what)
  {
    unsigned int n = 0;
    for (const auto &[name, column] : history)
      if (other.count(name) > 0 && name.find("[s]") == std::string::npos)
        {
          EXPECT_EQ(column, other.at(name)) << what << ": " << name;
          ++n;
        }
    EXPECT_GT(n, 10) << what;
  }
} // namespace



TEST(Independence, BooksRecordsOutputAndCheckpoints)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "the order of messages changes the last digits";
  const History all = run("academic", academic);
  EXPECT_EQ(all.count("energy balance"), 1);
  const History without =
    run("academic", with(academic, {"Monitor/Energy balance=false"}));
  EXPECT_EQ(without.count("energy balance"), 0);
  EXPECT_EQ(without.size() + 10, all.size());
  expect_same(without, all, "books of energy");
  expect_same(run("academic",
                  with(academic,
                       {"Records/Names=A",
                        "Records/A/Type=point displacement",
                        "Records/A/On=A"})),
              all,
              "records");
  expect_same(run("academic", with(academic, {"Solver/Report imbalance=true"})),
              all,
              "imbalance");
  expect_same(run("academic",
                  with(academic, {"Monitor/Inverted corners=report"})),
              all,
              "corners");
  expect_same(run("academic", academic, true), all, "fields and checkpoints");
  // A law that nobody uses
  expect_same(run("academic",
                  with(academic,
                       {"Interfaces/Names=ligament, other",
                        "Interfaces/other/Type=ligament",
                        "Interfaces/other/Tangent modulus=0: 1"})),
              all,
              "interface");
}



// A law at rest and a mesh whose rules leave it with the material are as none.
TEST(Independence, RemodellingAndRezoning)
{
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) > 1)
    GTEST_SKIP() << "the same on any number of processes";
  const Sets    lagrangian = with(academic, {"Rezoning/Names="});
  const History none =
    run("academic", with(lagrangian, {"Regions/bone/Remodelling=none"}));
  EXPECT_EQ(none.count("bone mass [mg]"), 0);
  EXPECT_EQ(none.count("limited values"), 0);
  EXPECT_EQ(none.count("energy by transfer [mJ]"), 0);
  EXPECT_EQ(none.count("energy by remodelling [mJ]"), 0);
  expect_same(run("academic",
                  with(lagrangian,
                       {"Remodelling/mechanostat/Formation rate=0",
                        "Remodelling/mechanostat/Resorption rate=0"})),
              none,
              "remodelling at rest");
  expect_same(run("academic",
                  with(academic,
                       {"Regions/bone/Remodelling=none",
                        "Rezoning/Names=all",
                        "Rezoning/all/Type=material",
                        "Rezoning/all/On=left, centre, right"})),
              none,
              "material rule");
}



// What is no state is found, wherever it is; round-off is not.
TEST(StateCheck, FindsWhatIsWrong)
{
  const ParameterText text =
    ParameterText::read(ALVEOLUS_SOURCE_DIR "/prm/academic.prm",
                        with(academic,
                             {"Remodelling/mechanostat/Degree of "
                              "anisotropy=1"}));
  const auto  scene = std::make_shared<Scene<2>>(text);
  TimerOutput timer(std::cout, TimerOutput::never, TimerOutput::wall_times);
  Model<2>    model(scene,
                 scene->mesh_source->create(MPI_COMM_WORLD, ".", "."),
                 timer);
  auto       &history = model.state->history;
  const auto &layout  = history.layout(0);
  const int   density = layout.offset("density");
  const int   fabric  = layout.offset("log fabric");
  ASSERT_GE(density, 0);
  ASSERT_GE(fabric, 0);
  double *record = nullptr; // on the last process alone
  if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) + 1 ==
      Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD))
    for (const auto &cell : model.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        record = history.old_record(cell->active_cell_index(), 3);

  const auto found_with = [&](const unsigned int i, const double value) {
    const double before = record ? record[i] : 0.;
    if (record)
      record[i] = value;
    const StateFindings found = check_state(*model.state, model.regions, false);
    if (record)
      record[i] = before;
    return found;
  };
  const auto sound = found_with(0, 0.);
  EXPECT_EQ(sound.garbage, "");
  EXPECT_EQ(sound.n_beyond_bounds, 0);
  EXPECT_EQ(found_with(density, 1.3 + 1e-12).n_beyond_bounds, 0);

  const auto dense = found_with(density, 1.31);
  EXPECT_EQ(dense.garbage, "");
  EXPECT_EQ(dense.n_beyond_bounds, 1);
  EXPECT_NE(dense.worst.find("'density'"), std::string::npos) << dense.worst;
  EXPECT_EQ(found_with(density, 0.29).n_beyond_bounds, 1);
  // Bounds are +-ln 3, and the trace is not zero
  EXPECT_EQ(found_with(fabric, 1.2).n_beyond_bounds, 1);
  EXPECT_EQ(found_with(fabric, 1e-3).n_beyond_bounds, 1);

  EXPECT_NE(found_with(density, NAN).garbage.find("not a finite number"),
            std::string::npos);
  EXPECT_NE(found_with(0, INFINITY).garbage, "");
  EXPECT_NE(found_with(0, 70.).garbage.find("volume ratio"), std::string::npos);
}
