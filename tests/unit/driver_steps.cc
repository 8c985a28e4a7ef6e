// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Time steps and meshes that look after themselves: what limits a step is named
// and counted, bad meshes are told, replaced, or end the run; rezoning only
// every so many steps.
#include <alveolus/base/errors.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/mesh/describe_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/remeshing/remesher.h>

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;
namespace fs = std::filesystem;

namespace
{
  /** The old mesh, its inner vertices put amidst their neighbours. */
  template <int dim>
  class Smoother : public Remesher<dim>
  {
  public:
    void
    declare_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Sweeps", sweeps, "Test.");
    }
    std::vector<RemeshCandidate<dim>>
    candidates(const Configuration<dim> &old,
               const std::string &,
               const std::string &) const override
    {
      const Nodes<dim> nodes(old);
      auto description = describe_mesh(nodes, old.positions(), "test");
      std::map<unsigned int, std::set<unsigned int>> neighbours;
      std::map<unsigned int, unsigned int>           n_cells;
      for (const auto &cell : description.cells)
        for (unsigned int v = 0; v < cell.vertices.size(); ++v)
          {
            ++n_cells[cell.vertices[v]];
            for (unsigned int d = 0; d < dim; ++d)
              neighbours[cell.vertices[v]].insert(cell.vertices[v ^ (1 << d)]);
          }
      for (unsigned int sweep = 0; sweep < sweeps; ++sweep)
        for (const auto &[vertex, others] : neighbours)
          if (n_cells[vertex] == (1 << dim))
            {
              Point<dim> sum;
              for (const unsigned int other : others)
                sum += description.vertices[other];
              description.vertices[vertex] = sum / (1. * others.size());
            }
      std::vector<RemeshCandidate<dim>> result(1);
      result[0].mesh        = build_mesh(description, old.communicator());
      result[0].description = "smoothed";
      return result;
    }

  private:
    unsigned int sweeps = 100;
  };
} // namespace

ALVEOLUS_REGISTER_DIM(alveolus::Remesher, Smoother, "smoother", "Test.")

namespace
{
  using Sets = std::vector<std::string>;

  bool
  is_first()
  {
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** What a run has left. */
  struct Outcome
  {
    bool                                       completed = false;
    nlohmann::json                             summary;
    std::map<std::string, std::vector<double>> columns;
    std::string                                log;

    unsigned int
    count(const std::string &text) const
    {
      unsigned int n = 0;
      for (auto at = log.find(text); at != std::string::npos;
           at      = log.find(text, at + 1))
        ++n;
      return n;
    }

    /** A count of the summary; 0 if it is not there. */
    unsigned int
    number(const std::string &group, const std::string &cause) const
    {
      return summary.count(group) == 0 ? 0 : summary[group].value(cause, 0u);
    }

    double
    largest(const std::string &column, const unsigned int first_row = 0) const
    {
      const auto &values = columns.at(column);
      return *std::max_element(values.begin() + first_row, values.end());
    }
  };

  /** Outcome a scene of tests/scene; the same result on every process. */
  Outcome
  run(const std::string &scene_name, const Sets &sets)
  {
    const std::string output =
      "driver_steps." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    if (is_first())
      fs::remove_all(output);
    MPI_Barrier(MPI_COMM_WORLD);
    const ParameterText text =
      ParameterText::read(std::string(ALVEOLUS_SOURCE_DIR "/tests/scene/") +
                            scene_name + ".prm",
                          sets);
    Log        log(is_first(), true);
    const auto scene        = std::make_shared<Scene<2>>(text);
    scene->output_directory = output;
    Outcome result;
    result.completed = Simulation<2>(scene, MPI_COMM_WORLD, log).run();
    MPI_Barrier(MPI_COMM_WORLD);

    std::ifstream file(output + "/summary.json");
    result.summary = nlohmann::json::parse(file);
    std::ostringstream lines;
    lines << std::ifstream(output + "/log.txt").rdbuf();
    result.log = lines.str();
    std::ifstream            history(output + "/history.csv");
    std::string              line, value;
    std::vector<std::string> names;
    for (bool header = true; std::getline(history, line); header = false)
      {
        std::istringstream values(line);
        for (unsigned int i = 0; std::getline(values, value, ','); ++i)
          if (header)
            names.push_back(value);
          else
            result.columns[names.at(i)].push_back(std::stod(value));
      }
    MPI_Barrier(MPI_COMM_WORLD);
    return result;
  }

  const std::string quality = "smallest scaled Jacobian";

  /** The academic case at the beginning, in constant steps. */
  const Sets academic = {"Time/End=10",
                         "Time/Initial step=1",
                         "Time/Maximum step=1",
                         "Output/Fields=false",
                         "Checkpoint/Write=false"};

  /** The block under 10 mm sin(pi t) of shear. */
  const Sets sheared = {
    "Conditions/Names=bottom, top",
    "Conditions/bottom/Components=x, y",
    "Conditions/top/Components=x, y",
    "Conditions/top/Function=10*sin(3.141592653589793*t); 0",
    "Records/Names=",
    "Time/Initial step=0.25",
    "Time/Maximum step=0.25",
    "Output/Fields=false",
    "Checkpoint/Write=false"};

  /** The pressed block with inner nodes displaced. */
  const Sets distorted = {
    "Mesh/grid generator/Function=subdivided_hyper_rectangle",
    "Mesh/grid generator/Arguments=6, 6 : 0, 0 : 10, 10 : true",
    "Mesh/grid generator/Refinements=0",
    "Mesh/grid generator/Region names=body: 3",
    "Mesh/grid generator/Map=x + 1.8*sin(pi*x/10)*sin(pi*y/10); y + "
    "1.8*sin(pi*x/10)*sin(pi*y/10)",
    "Conditions/left/On=right", // a remeshed curve has no id 0
    "Time/Initial step=0.5",
    "Time/Minimum step=0.5",
    "Time/Maximum step=0.5",
    "Output/Fields=false",
    "Checkpoint/Write=false"};
  const Sets smoothed = {"Remeshing/Type=smoother"};

  Sets
  operator+(Sets a, const Sets &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }
} // namespace



TEST(StepControl, LimitsTheNextStep)
{
  StepControl::Parameters parameters;
  parameters.initial_step = 0.5;
  parameters.maximum_step = 4.;
  parameters.minimum_step = 0.1;
  StepControl control(parameters);

  EXPECT_EQ(control.accepted(0.5, 1, {{"a", 1., 4.}, {"b", 1., 0.}}), "");
  EXPECT_EQ(control.step(), 0.75); // grown by 1.5, as without limits
  EXPECT_TRUE(control.limited().empty());

  // Growth only as far as a limit lets it
  const std::string said = control.accepted(0.75, 1, {{"a", 3., 4.}});
  EXPECT_NE(said.find("limited by a (3, allowed 4)"), std::string::npos);
  EXPECT_DOUBLE_EQ(control.step(), 1.);

  // The tightest one counts, also after an attempt that an output shortened.
  control.accepted(0.5, 1, {{"a", 2., 1.}, {"b", 10., 4.}});
  EXPECT_DOUBLE_EQ(control.step(), 0.2);
  control.accepted(0.2, 1, {{"b", 40., 4.}});
  EXPECT_DOUBLE_EQ(control.step(), 0.1);
  EXPECT_EQ(control.limited(),
            (std::map<std::string, unsigned int>{{"a", 1},
                                                 {"b", 2},
                                                 {"minimum step", 1}}));

  EXPECT_FALSE(control.rejected(0.1, "c"));
  BlockFile blocks;
  control.save(blocks);
  StepControl other(parameters);
  other.load(blocks);
  EXPECT_EQ(other.limited(), control.limited());
  EXPECT_EQ(other.rejections().at("c"), 1u);
  EXPECT_EQ(other.step(), control.step());
}



TEST(RezoningPlan, EveryStepsOrBelowQuality)
{
  RezoningPlan plan; // always
  for (unsigned int n = 1; n < 5; ++n)
    EXPECT_TRUE(plan.due(n, 1.));
  plan.every = 3;
  EXPECT_FALSE(plan.due(1, 0.) || plan.due(2, 0.));
  EXPECT_TRUE(plan.due(3, 1.));
  plan.below_quality = 0.4;
  EXPECT_TRUE(plan.due(2, 0.39));
  plan.every = 0;
  EXPECT_FALSE(plan.due(3, 0.41));
  EXPECT_TRUE(plan.due(3, 0.39));
  plan.check("Rezoning");
  plan.below_quality = -1.;
  EXPECT_THROW(plan.check("Rezoning"), InputError);
}



// The CFL number of the transfer goes with the step. It jumps where bone begins
// to be resorbed; from then on the steps are as short as it asks for.
TEST(Limits, SweptFraction)
{
  const Outcome free   = run("academic", academic);
  const double  before = free.largest("swept fraction");
  EXPECT_GT(before, 1e-3);
  EXPECT_EQ(free.largest("limited steps"), 0.);

  std::ostringstream limit;
  limit << "Time/Largest swept fraction=" << 0.5 * before;
  const Outcome limited = run("academic", academic + Sets{limit.str()});
  EXPECT_TRUE(limited.completed);
  EXPECT_LT(limited.columns.at("swept fraction").back(), 0.6 * before);
  const unsigned int n = limited.columns.at("limited steps").back();
  EXPECT_GT(n, 0u);
  EXPECT_EQ(limited.number("steps limited by", "swept fraction"), n);
  EXPECT_EQ(limited.count("next step limited by swept fraction"), n);
  EXPECT_GT(limited.columns.at("time [T]").size(),
            free.columns.at("time [T]").size());
}



// What would be rejected is foreseen.
TEST(Limits, DensityChange)
{
  const Sets longer =
    academic +
    Sets{"Time/End=20", "Time/Initial step=2", "Time/Maximum step=2"};
  const Outcome      free = run("academic", longer);
  const unsigned int rejected =
    free.number("rejected attempts by cause", "density change");
  EXPECT_GT(rejected, 2u);
  EXPECT_EQ(rejected, free.count("density changed by"));

  const Outcome foreseen =
    run("academic", longer + Sets{"Time/Wanted density change=0.06"});
  EXPECT_TRUE(foreseen.completed);
  EXPECT_LT(2 * foreseen.number("rejected attempts by cause", "density change"),
            rejected);
  EXPECT_GT(foreseen.number("steps limited by", "density change"), 0u);
}



TEST(Limits, LossOfQuality)
{
  const Outcome outcome =
    run("block",
        sheared + Sets{"Time/End=0.5", "Time/Largest loss of quality=0.05"});
  EXPECT_TRUE(outcome.completed);
  const unsigned int n =
    outcome.number("rejected attempts by cause", "loss of quality");
  EXPECT_GT(n, 0u);
  EXPECT_EQ(n, outcome.count("more than `Time / Largest loss of quality`"));
  double before = 1.; // squares
  for (const double now : outcome.columns.at(quality))
    {
      EXPECT_LE(before - now, 0.05);
      before = now;
    }
  EXPECT_LT(before, 0.8);
}



// Once each time it falls below the bound
TEST(Warning, OncePerCrossing)
{
  const Outcome outcome =
    run("block",
        sheared + Sets{"Time/End=2", "Monitor/Warn below quality=0.8"});
  EXPECT_TRUE(outcome.completed);
  EXPECT_LT(*std::min_element(outcome.columns.at(quality).begin(),
                              outcome.columns.at(quality).end()),
            0.8);
  EXPECT_EQ(outcome.summary["quality warnings"], 2);
  EXPECT_EQ(outcome.count("warning: the smallest scaled Jacobian"), 2u);
  EXPECT_EQ(outcome.count("is above 0.8 again"), 2u);
  // The bounds that hold where nothing is set
  EXPECT_EQ(RemeshPlan::Parameters().below_quality, 0.2);
  EXPECT_EQ(RemeshPlan::Parameters().accept_quality, 0.3);
  EXPECT_EQ(
    run("block", sheared + Sets{"Time/End=0.25"}).summary["quality warnings"],
    0);
}



TEST(Remeshing, BelowQuality)
{
  const Outcome before  = run("block", distorted);
  const double  initial = before.columns.at(quality).front();
  EXPECT_LT(initial, 0.6);
  EXPECT_GT(initial, 0.1);
  std::ostringstream below;
  below << "Remeshing/Below quality=" << initial + 0.005;

  // The mesh is replaced, and the block goes on as squares pressed together.
  const Outcome good = run("block", distorted + smoothed + Sets{below.str()});
  EXPECT_TRUE(good.completed);
  EXPECT_EQ(good.summary["remeshes"], 1);
  EXPECT_GT(good.columns.at(quality).back(), 0.95);

  // No better mesh: a clear stop, or on request as before
  const Sets useless = distorted + smoothed +
                       Sets{below.str(),
                            "Remeshing/smoother/Sweeps=0",
                            "Remeshing/Accept quality=0.7"};
  const Outcome stopped = run("block", useless);
  EXPECT_FALSE(stopped.completed);
  const std::string reason = stopped.summary["reason"];
  EXPECT_NE(reason.find("less than `Remeshing / Accept quality`"),
            std::string::npos)
    << reason;
  const Outcome on =
    run("block", useless + Sets{"Remeshing/If none is acceptable=go on"});
  EXPECT_TRUE(on.completed);
}



// A step that dies of the mesh is repeated on a new one.
TEST(Remeshing, AfterAStepThatDiedOfTheMesh)
{
  const Sets    strict = distorted + Sets{"Time/Largest loss of quality=0.01"};
  const Outcome died   = run("block", strict);
  EXPECT_FALSE(died.completed);
  // The advice is for the mesh, and tells whether it is a bad one.
  const auto says = [](const Outcome &outcome, const std::string &text) {
    return std::string(outcome.summary["reason"]).find(text) !=
           std::string::npos;
  };
  EXPECT_TRUE(says(died, "; rezone or remesh"));
  EXPECT_FALSE(says(died, "flat"));
  EXPECT_TRUE(
    says(run("block", strict + Sets{"Monitor/Warn below quality=0.9"}),
         "elements have become flat, the smallest scaled Jacobian is 0."));
  const Outcome with =
    run("block", strict + smoothed + Sets{"Remeshing/Below quality=-1"});
  EXPECT_TRUE(with.completed);
  EXPECT_EQ(with.summary["remeshes"], 1);
  EXPECT_EQ(with.number("rejected attempts by cause", "loss of quality"), 1u);
  EXPECT_EQ(with.count("remesh (no step is short enough)"), 1u);
}



// Rezoning every third step: as many are left out, and the tooth is where it is
// without that; the rules that hold something count from the last rezoning.
TEST(Rezoning, EveryThirdStep)
{
  const Sets frozen =
    academic + Sets{"Time/End=9", "Regions/bone/Remodelling=none"};
  const Outcome always = run("academic", frozen);
  const Outcome third =
    run("academic", frozen + Sets{"Rezoning/Every steps=3"});
  EXPECT_TRUE(third.completed);
  const unsigned int n = third.columns.at("time [T]").size();
  EXPECT_EQ(third.summary["steps not rezoned"], n - n / 3);
  for (unsigned int row = 0; row < n; ++row)
    EXPECT_EQ(third.columns.at("swept fraction")[row] > 0., row % 3 == 2);
  const double force = always.columns.at("force x [N]").back();
  EXPECT_NEAR(third.columns.at("force x [N]").back(),
              force,
              2e-3 * std::abs(force));

  const Outcome never =
    run("academic",
        frozen + Sets{"Rezoning/Every steps=0", "Rezoning/Below quality=0.01"});
  EXPECT_EQ(never.summary["steps not rezoned"], n);
}
