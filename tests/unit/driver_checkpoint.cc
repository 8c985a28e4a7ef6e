// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// A run that goes on from a checkpoint equals the one that was not interrupted,
// wherever the checkpoint lies; changed settings are named.
#include <alveolus/base/errors.h>
#include <alveolus/base/interrupt.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/mesh/describe_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/remeshing/remesher.h>
#include <alveolus/scene/settings.h>

#include <gtest/gtest.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;
namespace fs = std::filesystem;

namespace
{
  /** Row of the history, from 1, at which the recorder interrupts; 0: never. */
  unsigned int interrupt_at = 0;
  unsigned int n_recorded   = 0;

  /** Sends the signal that a user would send, in the middle of a step. */
  template <int dim>
  class Interrupter : public Recorder<dim>
  {
  public:
    void
    declare_parameters(ParameterHandler &) override
    {}
    void
    attach(const State<dim> &, const std::string &) override
    {}
    std::vector<Recorded>
    record(const State<dim> &state, const NodalVector &) const override
    {
      if (++n_recorded == interrupt_at &&
          Utilities::MPI::this_mpi_process(
            state.configuration.communicator()) == 0)
        std::raise(SIGTERM);
      return {{"nothing", 0.}};
    }
  };

  /**
   * A new mesh of the same vertices, in another order: a remesh without the
   * costs of one.
   */
  template <int dim>
  class SameVertices : public Remesher<dim>
  {
  public:
    void
    declare_parameters(ParameterHandler &) override
    {}
    std::vector<RemeshCandidate<dim>>
    candidates(const Configuration<dim> &old,
               const std::string &,
               const std::string &) const override
    {
      const Nodes<dim> nodes(old);
      auto description = describe_mesh(nodes, old.positions(), "test");
      std::reverse(description.cells.begin(), description.cells.end());
      std::vector<RemeshCandidate<dim>> result(1);
      result[0].mesh        = build_mesh(description, old.communicator());
      result[0].quality     = 1.;
      result[0].description = "the same vertices";
      return result;
    }
  };
} // namespace

ALVEOLUS_REGISTER_DIM(alveolus::Recorder, Interrupter, "interrupter", "Test.")
ALVEOLUS_REGISTER_DIM(alveolus::Remesher, SameVertices, "same", "Test.")

namespace
{
  using Sets = std::vector<std::string>;

  bool
  is_first()
  {
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  bool
  alone()
  {
    return Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1;
  }

  std::string
  folder(const std::string &name)
  {
    return "driver_checkpoint." +
           std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD)) +
           "/" + name;
  }

  /** A folder with nothing in it, the same for all. */
  std::string
  new_folder(const std::string &name)
  {
    if (is_first())
      fs::remove_all(folder(name));
    MPI_Barrier(MPI_COMM_WORLD);
    return folder(name);
  }

  /** Run a scene of tests/scene from its beginning. */
  template <int dim>
  bool
  start(const std::string &scene_name,
        const Sets        &sets,
        const std::string &output,
        const unsigned int interrupted_at = 0)
  {
    const ParameterText text =
      ParameterText::read(std::string(ALVEOLUS_SOURCE_DIR "/tests/scene/") +
                            scene_name + ".prm",
                          sets);
    interrupt_at = interrupted_at;
    n_recorded   = 0;
    Interrupt::install();
    Log        log(is_first(), true);
    const auto scene        = std::make_shared<Scene<dim>>(text);
    scene->output_directory = output;
    return Simulation<dim>(scene, MPI_COMM_WORLD, log).run();
  }

  /** Go on from the newest checkpoint in @p name. */
  template <int dim>
  bool
  resume(const std::string &name,
         const std::string &output,
         const Sets        &sets           = {},
         const bool         accept         = false,
         const unsigned int interrupted_at = 0)
  {
    auto blocks =
      std::make_shared<const BlockFile>(read_checkpoint(name, MPI_COMM_WORLD));
    const ParameterText text = saved_settings(*blocks, sets);
    interrupt_at             = interrupted_at;
    n_recorded               = 0;
    Interrupt::install();
    Log                log(is_first(), true);
    const auto         scene = std::make_shared<Scene<dim>>(text);
    std::ostringstream resolved;
    scene->write_resolved(resolved);
    check_settings(*blocks, resolved.str(), accept);
    scene->output_directory = output;
    return Simulation<dim>(scene, MPI_COMM_WORLD, log, std::move(blocks)).run();
  }

  using Rows = std::vector<std::vector<std::string>>;

  /** A file of comma separated columns without those of wall times. */
  Rows
  table(const std::string &name)
  {
    Rows              rows;
    std::ifstream     file(name);
    std::string       line, value;
    std::vector<bool> kept;
    while (std::getline(file, line))
      {
        rows.emplace_back();
        std::istringstream values(line);
        for (std::size_t i = 0; std::getline(values, value, ','); ++i)
          {
            if (rows.size() == 1)
              kept.push_back(value.find("[s]") == std::string::npos);
            if (i < kept.size() && kept[i])
              rows.back().push_back(value);
          }
      }
    return rows;
  }

  /**
   * Serial: the same to the last digit. On several processes a run is not
   * repeated to the last digit anyway (order of messages; 3e-12 of the largest
   * value of a column within 24 T), so within 1e-10; changes of mass by that of
   * the mass.
   */
  void
  expect_same(const std::string &a, const std::string &b)
  {
    MPI_Barrier(MPI_COMM_WORLD);
    if (!is_first())
      return;
    const Rows one = table(a), other = table(b);
    ASSERT_GT(one.size(), 1u) << a;
    if (alone())
      {
        EXPECT_EQ(one, other) << a << " and " << b;
        return;
      }
    ASSERT_EQ(one.size(), other.size()) << a << " and " << b;
    ASSERT_EQ(one[0], other[0]);
    const auto is_mass = [](const std::string &column) {
      return column.find("[mg]") != std::string::npos;
    };
    for (std::size_t column = 0; column < one[0].size(); ++column)
      {
        double size = 1e-3;
        for (std::size_t row = 1; row < one.size(); ++row)
          for (std::size_t c = 0; c < one[0].size(); ++c)
            if (c == column || (is_mass(one[0][c]) && is_mass(one[0][column])))
              size = std::max(size, std::abs(std::stod(one[row].at(c))));
        for (std::size_t row = 1; row < one.size(); ++row)
          EXPECT_NEAR(std::stod(one[row][column]),
                      std::stod(other[row].at(column)),
                      1e-10 * size)
            << one[0][column] << ", row " << row;
      }
  }

  const Sets recorder = {"Records/Names=interrupter",
                         "Records/interrupter/Type=interrupter"};

  Sets
  operator+(Sets a, const Sets &b)
  {
    a.insert(a.end(), b.begin(), b.end());
    return a;
  }

  std::string
  reason(const std::string &output)
  {
    std::ifstream file(output + "/summary.json");
    std::string   line;
    while (std::getline(file, line))
      if (line.find("\"reason\"") != std::string::npos)
        return line;
    return "";
  }

  const Sets academic = recorder + Sets{"Time/End=10",
                                        "Time/Initial step=1",
                                        "Time/Maximum step=1",
                                        "Output/Field interval=4"};
} // namespace



// Interface, remodelling, rezoning, transfer; interrupted at every third row
TEST(Resume, EqualsTheUninterruptedRun)
{
  const std::string full = new_folder("full");
  // Without checkpoints, which thereby change nothing
  EXPECT_TRUE(
    start<2>("academic", academic + Sets{"Checkpoint/Write=false"}, full));
  EXPECT_FALSE(fs::exists(full + "/checkpoint"));
  for (const unsigned int row : {1, 4, 7})
    {
      const std::string cut = new_folder("cut");
      EXPECT_FALSE(start<2>("academic", academic, cut, row));
      if (is_first())
        {
          EXPECT_NE(reason(cut).find("interrupted by SIGTERM"),
                    std::string::npos)
            << reason(cut);
          EXPECT_EQ(table(cut + "/history.csv").size(), row + 1);
        }
      EXPECT_TRUE(resume<2>(cut, cut));
      expect_same(full + "/history.csv", cut + "/history.csv");
      if (is_first())
        {
          // The last fields of the first part were no part of the run.
          std::size_t n = 0;
          for (const auto &entry : fs::directory_iterator(cut))
            n += entry.path().extension() == (alone() ? ".vtu" : ".pvtu");
          EXPECT_EQ(n, 4u); // t = 0, 4, 8, 10
          EXPECT_FALSE(fs::exists(cut + "/remeshes.csv"));
        }
    }
}



TEST(Resume, AgainAndAgain)
{
  const std::string full = new_folder("full"), cut = new_folder("cut");
  const Sets        short_run = academic + Sets{"Time/End=5"};
  EXPECT_TRUE(start<2>("academic", short_run, full));
  EXPECT_FALSE(start<2>("academic", short_run, cut, 1));
  unsigned int n = 1;
  // The first record of a resumed run only compares columns.
  while (!resume<2>(cut, cut, {}, false, 2))
    ASSERT_LT(++n, 100u);
  EXPECT_GT(n, 3u);
  expect_same(full + "/history.csv", cut + "/history.csv");

  // And once more: nothing is left to do.
  EXPECT_TRUE(resume<2>(cut, cut));
  expect_same(full + "/history.csv", cut + "/history.csv");
}



// A checkpoint between two rezonings remembers where rules count from.
TEST(Resume, RezonedEveryThirdStep)
{
  const Sets sets = academic + Sets{"Time/End=7", "Rezoning/Every steps=3"};
  const std::string full = new_folder("full");
  EXPECT_TRUE(start<2>("academic", sets, full));
  for (const unsigned int row : {2, 3, 4})
    {
      const std::string cut = new_folder("cut");
      EXPECT_FALSE(start<2>("academic", sets, cut, row));
      EXPECT_EQ(read_checkpoint(cut, MPI_COMM_WORLD).has("rezoning/start"),
                row != 3);
      EXPECT_TRUE(resume<2>(cut, cut));
      expect_same(full + "/history.csv", cut + "/history.csv");
    }
}



// Before, between and after remeshes; the third one begins the run.
TEST(Resume, BeforeAndAfterRemeshes)
{
  const Sets        sets = academic + Sets{"Remeshing/Type=same",
                                    "Remeshing/Times=0, 3, 6",
                                    "Conditions/tooth/Attachment=tied",
                                    "Remeshing/Accept quality=0"};
  const std::string full = new_folder("full");
  EXPECT_TRUE(start<2>("academic", sets, full));
  MPI_Barrier(MPI_COMM_WORLD);
  const Rows remeshes = table(full + "/remeshes.csv");
  ASSERT_EQ(remeshes.size(), 4u);
  const std::size_t n_rows = table(full + "/history.csv").size() - 1;
  unsigned int      n_cut  = 0;
  for (unsigned int record = 1; record <= n_rows + 4; record += 2)
    {
      const std::string cut = new_folder("cut");
      if (start<2>("academic", sets, cut, record))
        continue; // in the last step
      ++n_cut;
      EXPECT_TRUE(resume<2>(cut, cut));
      expect_same(full + "/history.csv", cut + "/history.csv");
      expect_same(full + "/remeshes.csv", cut + "/remeshes.csv");
      if (HasFailure())
        {
          ADD_FAILURE() << "interrupted at record " << record;
          break;
        }
    }
  EXPECT_GT(n_cut, 4u);
}



// Curved manifolds and refinement: the mesh comes from its source again.
TEST(Resume, RefinedCurvedMesh)
{
  const Sets sets =
    recorder + Sets{"Mesh/Degree=2", "Mesh/grid generator/Refinements=2"};
  const std::string full = new_folder("full"), cut = new_folder("cut");
  EXPECT_TRUE(start<2>("thick-cylinder-rezoned", sets, full));
  EXPECT_FALSE(start<2>("thick-cylinder-rezoned", sets, cut, 2));
  const BlockFile blocks = read_checkpoint(cut, MPI_COMM_WORLD);
  EXPECT_FALSE(blocks.has("mesh/cells"));
  EXPECT_TRUE(resume<2>(cut, cut));
  expect_same(full + "/history.csv", cut + "/history.csv");
}



TEST(Resume, ThreeDimensions)
{
  const Sets sets =
    recorder +
    Sets{"Time/Initial step=0.25", "Time/Maximum step=0.25", "Mesh/Degree=1"};
  const std::string full = new_folder("full"), cut = new_folder("cut");
  EXPECT_TRUE(start<3>("cook-membrane", sets, full));
  EXPECT_FALSE(start<3>("cook-membrane", sets, cut, 2));
  EXPECT_TRUE(resume<3>(cut, cut));
  expect_same(full + "/history.csv", cut + "/history.csv");
}



// Multipliers and the structure of the matrix
TEST(Resume, Contact)
{
  if (!alone())
    GTEST_SKIP() << "contact works on one process";
  const Sets sets =
    recorder + Sets{"Time/Initial step=0.25", "Time/Maximum step=0.25"};
  const std::string full = new_folder("full"), cut = new_folder("cut");
  EXPECT_TRUE(start<2>("../../prm/verification/contact-patch", sets, full));
  EXPECT_FALSE(start<2>("../../prm/verification/contact-patch", sets, cut, 2));
  EXPECT_TRUE(resume<2>(cut, cut));
  expect_same(full + "/history.csv", cut + "/history.csv");
}



TEST(Resume, IntoAnotherFolder)
{
  const std::string full = new_folder("full"), cut = new_folder("cut"),
                    other = new_folder("other");
  EXPECT_TRUE(start<2>("academic", academic, full));
  EXPECT_FALSE(start<2>("academic", academic, cut, 4));
  const auto before = CheckpointFolder::find(cut);
  EXPECT_TRUE(resume<2>(cut, other));
  expect_same(full + "/history.csv", other + "/history.csv");
  EXPECT_EQ(CheckpointFolder::find(cut), before);
  EXPECT_TRUE(resume<2>(other, other));
}



TEST(Resume, ChangedSettingsAreNamed)
{
  const std::string cut = new_folder("cut");
  EXPECT_FALSE(start<2>("academic", academic, cut, 3));
  const auto message = [&](const Sets &sets, const bool accept) -> std::string {
    try
      {
        resume<2>(cut, cut, sets, accept, 2);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  };
  const std::string refused =
    message({"Time/End=11", "Title=May change", "Solver/Tolerance=1e-8"},
            false);
  EXPECT_NE(refused.find("Time / End: was '10', is '11'"), std::string::npos)
    << refused;
  EXPECT_NE(refused.find("Solver / Tolerance"), std::string::npos);
  EXPECT_NE(refused.find("--accept-changes"), std::string::npos);
  EXPECT_EQ(refused.find("Title"), std::string::npos);
  EXPECT_EQ(message({"Title=May change", "Checkpoint/Step interval=7"}, false),
            "");
  EXPECT_EQ(message({"Time/End=11"}, true), "");
  const std::string never = message({"Mesh/Degree=2"}, true);
  EXPECT_NE(never.find("Mesh / Degree: was '1', is '2' (cannot be changed)"),
            std::string::npos)
    << never;
}



// A failing step leaves the last accepted state, from which a run with other
// settings goes on.
TEST(Resume, AfterFailure)
{
  const std::string cut = new_folder("cut");
  EXPECT_FALSE(start<2>("academic", academic, cut, 3));
  const double time = read_checkpoint(cut, MPI_COMM_WORLD).number("state/time");
  EXPECT_FALSE(resume<2>(
    cut, cut, {"Solver/Maximum iterations=1", "Time/Minimum step=1"}, true));
  if (is_first())
    {
      EXPECT_NE(reason(cut).find("smallest step"), std::string::npos)
        << reason(cut);
    }
  const BlockFile blocks = read_checkpoint(cut, MPI_COMM_WORLD);
  EXPECT_EQ(blocks.number("state/time"), time);
  EXPECT_EQ(blocks.integers("totals")[0], 3u);
  EXPECT_EQ(blocks.integers("totals")[1], 1u); // rejected
  EXPECT_TRUE(
    resume<2>(cut,
              cut,
              {"Solver/Maximum iterations=15", "Time/Minimum step=0.01"},
              true));
}
