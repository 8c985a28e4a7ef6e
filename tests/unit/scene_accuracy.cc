// SPDX-License-Identifier: LGPL-2.1-or-later
// Accuracy levels: which statement wins, what is refused, and that every scene
// that is shipped has them.
#include <alveolus/base/errors.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/scene/settings.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

using namespace dealii;
using namespace alveolus;
namespace fs = std::filesystem;

namespace
{
  using Sets = std::vector<std::string>;

  const std::string folder = "scene_accuracy";

  /** A scene whose levels stand between its own end and what comes later. */
  const std::string scene = R"(
set Title = Levels
subsection Mesh
  set Type = grid generator
end
subsection Regions
  set Names = body
  subsection body
    set On       = region 0
    set Material = rubber
  end
end
subsection Materials
  set Names = rubber
  subsection rubber
    set Type = Hencky elastic
  end
end
subsection Time
  set Maximum step = 1
  set Initial step = 1
  set End          = 8
end
subsection Accuracy levels
  subsection fast
    subsection Mesh
      subsection grid generator
        set Refinements = 1
      end
    end
    subsection Time
      set Maximum step = 4
      set Initial step = 2
    end
  end
  subsection reference
    subsection Time
      set Maximum step = 0.25
    end
    subsection Mesh
      set Degree = 2
    end
  end
end
subsection Solver
  set Tolerance = 1e-7
end
)";

  std::string
  written(const std::string &name, const std::string &content)
  {
    fs::create_directories(folder);
    std::ofstream(folder + "/" + name) << content;
    return folder + "/" + name;
  }

  ParameterText
  text(const Sets &sets, const std::string &further = "")
  {
    return ParameterText::read(further.empty()
                                 ? written("base.prm", scene)
                                 : (written("base.prm", scene),
                                    written("variant.prm",
                                            "include base.prm\n" + further)),
                               sets);
  }

  std::string
  resolved(const ParameterText &text)
  {
    std::ostringstream out;
    Scene<2>(text).write_resolved(out);
    return out.str();
  }

  std::string
  value(const std::string &resolved, const std::string &path)
  {
    return ParameterText::parse(resolved, "resolved").value(path, "missing");
  }

  std::string
  message(const ParameterText &text)
  {
    try
      {
        Scene<2> scene(text);
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }

  /** The scenes that are shipped. */
  std::vector<std::string>
  shipped()
  {
    std::vector<std::string> result;
    for (const auto &entry : fs::directory_iterator(ALVEOLUS_SOURCE_DIR "/prm"))
      if (entry.path().extension() == ".prm")
        result.push_back(entry.path().string());
    std::sort(result.begin(), result.end());
    return result;
  }

  bool
  is_3d(const ParameterText &text)
  {
    return text.value("Dimension", "2") == "3";
  }
} // namespace



// scene < level < what stands behind the levels < variant < --set
TEST(Accuracy, LaterStatementsWin)
{
  const std::string step = "Time/Maximum step";
  EXPECT_EQ(value(resolved(text({})), step), "1");
  EXPECT_EQ(value(resolved(text({"Accuracy=balanced"})), step), "1");
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"})), step), "4");
  EXPECT_EQ(value(resolved(text({"Accuracy=reference"})), step), "0.25");
  const std::string variant = "subsection Time\n set Maximum step = 3\nend\n";
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"}, variant)), step), "3");
  EXPECT_EQ(value(resolved(text({"Accuracy=fast", step + "=2"}, variant)),
                  step),
            "2");
  EXPECT_EQ(value(resolved(text({step + "=2", "Accuracy=fast"}, variant)),
                  step),
            "2");
  // What the variant does not touch is still the level's.
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"}, variant)),
                  "Time/Initial step"),
            "2");

  // Behind the levels in the same file
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"})), "Solver/Tolerance"),
            "1e-7");
  EXPECT_EQ(value(resolved(text({"Accuracy levels/fast/Solver/Tolerance=1e-5",
                                 "Accuracy=fast"})),
                  "Solver/Tolerance"),
            "1e-5");
}



// A variant chooses a level, adds to one and defines another.
TEST(Accuracy, VariantsHaveLevels)
{
  const std::string variant = R"(
set Accuracy = coarse
subsection Time
  set Maximum step = 3
end
subsection Accuracy levels
  subsection fast
    subsection Time
      set Maximum step = 5
    end
  end
  subsection coarse
    subsection Time
      set Maximum step = 8
    end
  end
end
)";
  const std::string step    = "Time/Maximum step";
  EXPECT_EQ(value(resolved(text({}, variant)), step), "8");
  EXPECT_EQ(value(resolved(text({"Accuracy=balanced"}, variant)), step), "3");
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"}, variant)), step), "5");
  EXPECT_EQ(value(resolved(text({"Accuracy=reference"}, variant)), step), "3");

  const ParameterText fast =
    text({"Accuracy=fast", "Time/Initial step=1"}, variant);
  const AccuracyLevels levels(fast);
  EXPECT_EQ(levels.chosen(), "fast");
  EXPECT_EQ(levels.names(),
            std::vector<std::string>(
              {"balanced", "fast", "reference", "coarse"}));
  EXPECT_EQ(levels.settings(),
            std::vector<std::string>(
              {"Mesh / grid generator / Refinements = 1",
               "Time / Initial step = 2 (not taken: --set 'Time/Initial "
               "step=1' sets 1)",
               "Time / Maximum step = 5"}));
}



// The resolved parameters are those of the level, and can be run again.
TEST(Accuracy, ResolvedParametersRepeat)
{
  for (const std::string level : {"balanced", "fast", "reference"})
    {
      const std::string first = resolved(text({"Accuracy=" + level}));
      EXPECT_EQ(value(first, "Accuracy"), level);
      EXPECT_EQ(resolved(ParameterText::parse(first, "again")), first);
    }
  EXPECT_EQ(value(resolved(text({"Accuracy=fast"})),
                  "Mesh/grid generator/Refinements"),
            "1");
}



// Without levels there is no parameter, and only the scene as it stands.
TEST(Accuracy, ScenesWithoutLevels)
{
  const std::string plain  = scene.substr(0, scene.find("subsection Accuracy"));
  const ParameterText none = ParameterText::parse(plain, "plain.prm");
  EXPECT_EQ(value(resolved(none), "Accuracy"), "missing");
  EXPECT_FALSE(AccuracyLevels(none).used());
  const std::string balanced =
    resolved(ParameterText::parse(plain + "set Accuracy = balanced\n", "p"));
  EXPECT_EQ(value(balanced, "Accuracy"), "balanced");
  const std::string refused =
    message(ParameterText::parse(plain + "set Accuracy = fast\n", "plain.prm"));
  EXPECT_TRUE(contains(refused, "there is no level 'fast' in plain.prm"))
    << refused;
  EXPECT_TRUE(contains(refused, "only balanced")) << refused;
}



TEST(Accuracy, RefusesWhatCannotBe)
{
  const std::string unknown = message(text({"Accuracy=fats"}));
  EXPECT_TRUE(contains(unknown, "--set 'Accuracy=fats'")) << unknown;
  EXPECT_TRUE(contains(unknown, "balanced, fast, reference")) << unknown;
  const auto refused = [](const std::string &set) {
    return message(text({"Accuracy levels/" + set}));
  };
  EXPECT_TRUE(contains(refused("Time=1"), "belongs to no level"));
  EXPECT_TRUE(
    contains(refused("balanced/Time/End=1"), "the scene as it stands"));
  EXPECT_TRUE(
    contains(refused("fast/Dimension=3"), "a level sets 'Dimension'"));
  EXPECT_TRUE(
    contains(refused("fast/Accuracy=reference"), "a level sets 'Accuracy'"));
  EXPECT_TRUE(contains(refused("fast/Accuracy levels/a/Time/End=1"),
                       "a level holds levels"));
  // A slip in a level names its place.
  const std::string slip = message(
    text({"Accuracy levels/fast/Time/Largest step=1", "Accuracy=fast"}));
  EXPECT_TRUE(contains(slip, "(accuracy fast)")) << slip;
  EXPECT_TRUE(contains(slip, "there is no parameter 'Largest step'")) << slip;
}



// Resuming compares what the level sets, not how it is written.
TEST(Accuracy, ResumingCompares)
{
  const ParameterText before = text({"Accuracy=fast"});
  BlockFile           blocks;
  save_settings(before, resolved(before), blocks);
  const auto changes = [&](const Sets &sets) {
    std::string list;
    for (const auto &change :
         changed_settings(blocks, resolved(saved_settings(blocks, sets))))
      list += change.parameter + (change.acceptable ? "; " : "!; ");
    return list;
  };
  EXPECT_EQ(changes({}), "");
  EXPECT_EQ(changes({"Accuracy levels/reference/Time/End=3"}), "");
  EXPECT_EQ(changes({"Accuracy levels/fast/Time/Maximum step=3"}),
            "Time / Maximum step; ");
  const std::string other = changes({"Accuracy=reference"});
  EXPECT_TRUE(contains(other, "Accuracy; ")) << other;
  EXPECT_TRUE(contains(other, "Time / Maximum step; ")) << other;
  EXPECT_TRUE(contains(other, "Mesh / Degree!; "))
    << other; // the mesh is fixed
}



// Every scene has the three levels, all parameters of which exist, and balanced
// is the scene without levels to the last character.
TEST(Accuracy, ShippedScenesHaveLevels)
{
  ASSERT_GE(shipped().size(), 19u);
  for (const auto &file : shipped())
    {
      SCOPED_TRACE(file);
      const AccuracyLevels levels(ParameterText::read(file, {}));
      for (const std::string level : {"fast", "reference"})
        {
          ASSERT_EQ(
            std::count(levels.names().begin(), levels.names().end(), level), 1);
          const ParameterText text =
            ParameterText::read(file, {"Accuracy=" + level});
          if (is_3d(text))
            EXPECT_NO_THROW(Scene<3>{text});
          else
            EXPECT_NO_THROW(Scene<2>{text});
          EXPECT_FALSE(AccuracyLevels(text).settings().empty());
        }

      ParameterText without = ParameterText::read(file, {});
      EXPECT_EQ(without.value("Accuracy", "balanced"), "balanced");
      without.entries.erase(std::remove_if(without.entries.begin(),
                                           without.entries.end(),
                                           [](const auto &entry) {
                                             return !entry.section.empty() &&
                                                    entry.section[0] ==
                                                      "Accuracy levels";
                                           }),
                            without.entries.end());
      const auto balanced = AccuracyLevels(ParameterText::read(file, {}));
      ASSERT_EQ(balanced.statements().entries.size(), without.entries.size());
      for (unsigned int i = 0; i < without.entries.size(); ++i)
        {
          EXPECT_EQ(balanced.statements().entries[i].section,
                    without.entries[i].section);
          EXPECT_EQ(balanced.statements().entries[i].name,
                    without.entries[i].name);
          EXPECT_EQ(balanced.statements().entries[i].value,
                    without.entries[i].value);
        }
    }
}



namespace
{
  /** Make everything a scene needs, as --validate does, and run it to @p end,
   * if that is positive. */
  template <int dim>
  bool
  made(const ParameterText &text, const bool run)
  {
    const auto scene        = std::make_shared<Scene<dim>>(text);
    scene->output_directory = folder + "/output";
    Log             log(true, true);
    Simulation<dim> simulation(scene, MPI_COMM_WORLD, log);
    simulation.describe();
    return !run || simulation.run();
  }

  bool
  made(const ParameterText &text, const bool run)
  {
    return is_3d(text) ? made<3>(text, run) : made<2>(text, run);
  }

  /** Settings that shorten a scene of a level to two of its steps, in 3D on a
   * coarse mesh. */
  Sets
  two_steps(const std::string &file, const std::string &level)
  {
    const ParameterText  text(ParameterText::read(file, {"Accuracy=" + level}));
    const AccuracyLevels levels(text);
    const double         step =
      std::stod(levels.statements().value("Time/Initial step", ""));
    const std::string type = text.value("Mesh/Type", "");
    Sets              sets = {"Accuracy=" + level,
                              "Time/End=" + std::to_string(2. * step),
                              "Time/Maximum step=" + std::to_string(step),
                              "Output/Fields=false",
                              "Checkpoint/Write=false"};
    if (is_3d(text))
      sets.push_back("Mesh/" + type + "/Mesh density=0.02");
    return sets;
  }
} // namespace



// The fast level of every scene runs: two steps. A test of its own,
// scene/accuracy-fast, a quarter of a minute.
TEST(Accuracy, DISABLED_FastLevelsRun)
{
  for (const auto &file : shipped())
    {
      SCOPED_TRACE(file);
      EXPECT_TRUE(
        made(ParameterText::read(file, two_steps(file, "fast")), true));
    }
}



// Every level of every scene makes its mesh and all objects: the slow test
// scene/accuracy-all.
TEST(Accuracy, DISABLED_AllLevelsAreValid)
{
  for (const auto &file : shipped())
    for (const std::string level : {"fast", "balanced", "reference"})
      {
        SCOPED_TRACE(file + ", " + level);
        EXPECT_TRUE(
          made(ParameterText::read(file, {"Accuracy=" + level}), false));
      }
}
