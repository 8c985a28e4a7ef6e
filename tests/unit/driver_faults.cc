// SPDX-License-Identifier: LGPL-2.1-or-later
// Faults in the middle of a run: a material that answers with NaN, memory that
// is at its end, a body that nothing holds. The run ends with its reason, what
// was computed stays, and it can go on from there.
#include <alveolus/base/errors.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/materials/hencky_elastic.h>
#include <alveolus/scene/settings.h>

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <new>
#include <sstream>

using namespace dealii;
using namespace alveolus;
namespace fs = std::filesystem;

namespace
{
  /** Allocations to go until one fails; negative: none does. */
  long allocations_left = -1;

  /** What the recorder below sets off after the row of this number. */
  unsigned int fault_at        = 0;
  unsigned int n_rows          = 0;
  bool         nan_is_set_off  = false;
  long         fails_after     = -1;
  bool         material_is_bad = false;
} // namespace

// This program's own, which the libraries use, too.
void *
operator new(const std::size_t size)
{
  if (allocations_left >= 0 && allocations_left-- == 0)
    throw std::bad_alloc();
  if (void *const memory = std::malloc(size > 0 ? size : 1))
    return memory;
  throw std::bad_alloc();
}

void
operator delete(void *const memory) noexcept
{
  std::free(memory);
}

void
operator delete(void *const memory, std::size_t) noexcept
{
  std::free(memory);
}

namespace
{
  /** An elastic material that gives NaN from some moment on. */
  class Faulty : public HenckyElastic
  {
  public:
    void
    evaluate(const Tensor<2, 3> &f,
             const double       *old,
             double             *trial,
             const bool          need_tangent,
             MaterialResponse   &response) const override
    {
      HenckyElastic::evaluate(f, old, trial, need_tangent, response);
      if (material_is_bad)
        response.stress[0][1] = std::numeric_limits<double>::quiet_NaN();
    }
  };

  template <int dim>
  class FaultAfterRow : public Recorder<dim>
  {
  public:
    void
    declare_parameters(ParameterHandler &) override
    {}
    void
    attach(const State<dim> &, const std::string &) override
    {}
    std::vector<Recorded>
    record(const State<dim> &, const NodalVector &) const override
    {
      if (++n_rows == fault_at)
        {
          material_is_bad  = nan_is_set_off;
          allocations_left = fails_after;
        }
      return {{"nothing", 0.}};
    }
  };
} // namespace

ALVEOLUS_REGISTER(alveolus::Material, Faulty, "faulty", "Test.")
ALVEOLUS_REGISTER_DIM(alveolus::Recorder, FaultAfterRow, "fault", "Test.")

namespace
{
  using Sets = std::vector<std::string>;

  /** The block of the scene tests, pressed in ten steps. */
  const Sets block = {"Records/Names=fault, press",
                      "Records/fault/Type=fault",
                      "Materials/rubber/Type=faulty",
                      "Time/Initial step=0.1",
                      "Time/Maximum step=0.1",
                      "Time/Minimum step=0.02",
                      "Checkpoint/Step interval=1",
                      "Output/Fields=false"};

  bool
  run(const std::string &output,
      const bool         resume,
      const Sets        &sets  = {},
      const std::string &scene = "base/block")
  {
    Log                              log(true, true);
    std::shared_ptr<const BlockFile> blocks;
    if (resume)
      blocks = std::make_shared<const BlockFile>(
        read_checkpoint(output, MPI_COMM_WORLD));
    const ParameterText text =
      resume ? saved_settings(*blocks, sets)
             : ParameterText::read(ALVEOLUS_SOURCE_DIR "/tests/scene/" + scene +
                                     ".prm",
                                   sets);
    const auto object        = std::make_shared<Scene<2>>(text);
    object->output_directory = output;
    Simulation<2> simulation(object, MPI_COMM_WORLD, log, std::move(blocks));
    const bool    completed = simulation.run();
    allocations_left        = -1;
    return completed;
  }

  std::string
  content(const std::string &file)
  {
    std::ifstream      in(file);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

  /** history.csv without columns of wall times and of repeated steps. */
  std::string
  history(const std::string &folder)
  {
    std::istringstream lines(content(folder + "/history.csv"));
    std::ostringstream result;
    std::vector<bool>  kept;
    std::string        line, value;
    for (bool head = true; std::getline(lines, line); head = false)
      {
        std::istringstream values(line);
        for (std::size_t i = 0; std::getline(values, value, ','); ++i)
          {
            if (head)
              kept.push_back(value.find("[s]") == std::string::npos &&
                             value.find("rejected") == std::string::npos);
            if (kept.at(i))
              result << value << ',';
          }
        result << '\n';
      }
    return result.str();
  }

  class Faults : public testing::Test
  {
  protected:
    void
    SetUp() override
    {
      fs::remove_all("driver_faults");
      fault_at = n_rows = 0;
      material_is_bad   = false;
      allocations_left  = -1;
      ASSERT_TRUE(run("driver_faults/full", false, block));
      full = history("driver_faults/full");
      ASSERT_EQ(n_rows, 10u);
      n_rows = 0;
    }

    std::string full;
  };
} // namespace



TEST_F(Faults, MaterialGivesNaN)
{
  const std::string folder = "driver_faults/nan";
  fault_at                 = 4;
  nan_is_set_off           = true;
  fails_after              = -1;
  EXPECT_FALSE(run(folder, false, block));
  const std::string summary = content(folder + "/summary.json");
  EXPECT_NE(summary.find("a material gave no valid stress"), std::string::npos)
    << summary;
  EXPECT_NE(summary.find("\"completed\": false"), std::string::npos);
  // Nothing of it gets into the results.
  EXPECT_EQ(full.compare(0, history(folder).size(), history(folder)), 0);
  EXPECT_EQ(content(folder + "/history.csv").find("nan"), std::string::npos);

  material_is_bad = false;
  fault_at        = 0;
  EXPECT_TRUE(run(folder, true));
  const BlockFile last = read_checkpoint(folder, MPI_COMM_WORLD);
  EXPECT_DOUBLE_EQ(last.number("state/time"), 1.);
}



// At many places of a step memory comes to its end; the run goes on from the
// state before that step as if nothing had happened.
TEST_F(Faults, OutOfMemory)
{
  nan_is_set_off             = false;
  unsigned int       n_ended = 0;
  const unsigned int n_times = 40;
  for (unsigned int i = 0; i < n_times; ++i)
    {
      const std::string folder = "driver_faults/memory";
      fs::remove_all(folder);
      n_rows               = 0;
      fault_at             = 4;
      fails_after          = 20 + i * (4 + i / 2); // within a step or two
      const bool completed = run(folder, false, block);
      fault_at             = 0;
      if (completed)
        continue; // where memory is asked for that can be done without
      ++n_ended;
      const std::string summary = content(folder + "/summary.json");
      EXPECT_NE(summary.find("out of memory"), std::string::npos) << summary;
      EXPECT_TRUE(run(folder, true));
      EXPECT_EQ(history(folder), full) << "allocation " << fails_after;
      if (HasFailure())
        break;
    }
  EXPECT_GT(n_ended, n_times / 2);
}



// The body may turn and shift: the matrix is singular but for round-off.
TEST_F(Faults, NothingHoldsTheBody)
{
  const std::string folder = "driver_faults/free";
  EXPECT_FALSE(run(folder,
                   false,
                   {"Conditions/Names=load",
                    "Conditions/load/Type=traction",
                    "Conditions/load/On=top",
                    "Conditions/load/Function=t; 0",
                    "Records/Names=",
                    "Time/Minimum step=0.02",
                    "Output/Fields=false"}));
  const std::string summary = content(folder + "/summary.json");
  EXPECT_NE(summary.find("singular"), std::string::npos) << summary;
  EXPECT_NE(summary.find("hold every body"), std::string::npos) << summary;
}
