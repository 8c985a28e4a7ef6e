// SPDX-License-Identifier: LGPL-2.1-or-later
// The columns of the history file, their order above all.
#include <alveolus/driver/simulation.h>

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  /** Run a scene of tests/scene and return the header of its history. */
  std::vector<std::string>
  columns(const std::string &name, const std::vector<std::string> &sets)
  {
    const ParameterText text = ParameterText::read(
      std::string(ALVEOLUS_SOURCE_DIR "/tests/scene/") + name + ".prm", sets);
    Log        log(true, true);
    const auto scene        = std::make_shared<Scene<2>>(text);
    scene->output_directory = "driver_history";
    scene->fields           = false;
    EXPECT_TRUE(Simulation<2>(scene, MPI_COMM_WORLD, log).run());
    std::ifstream            file("driver_history/history.csv");
    std::string              line, column;
    std::vector<std::string> result;
    std::getline(file, line);
    std::istringstream names(line);
    while (std::getline(names, column, ','))
      result.push_back(column);
    return result;
  }
} // namespace



// What is applied comes right after the time, before any other force.
TEST(History, AppliedForceLeads)
{
  const auto names =
    columns("pressed-by-force", {"Conditions/load/Moment-to-force ratio=0.01"});
  ASSERT_GT(names.size(), 3u);
  EXPECT_EQ(names[0], "time [T]");
  EXPECT_EQ(names[1], "applied force [N]");
  EXPECT_EQ(names[2], "applied moment [N mm]");
  EXPECT_EQ(names[3], "time step [T]");
  EXPECT_EQ(names.back(), "foot: force y [N]");
}
