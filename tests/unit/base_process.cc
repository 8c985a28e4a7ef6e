// SPDX-License-Identifier: LGPL-2.1-or-later
// Other programs: their output, their ends, and no shell in between.
#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>
#include <alveolus/base/text_file.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <thread>

using namespace alveolus;

TEST(Process, OutputAndExitCode)
{
  const auto run =
    run_process({"/bin/sh", "-c", "echo one; echo two >&2; exit 3"}, 20.);
  EXPECT_TRUE(run.started);
  EXPECT_FALSE(run.succeeded());
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_EQ(run.output, "one\n");
  EXPECT_EQ(run.errors, "two\n");
  EXPECT_EQ(run.last_words(), "two");
  EXPECT_EQ(run.summary(), "ended with exit code 3");
  EXPECT_TRUE(run_process({"true"}, 20.).succeeded());
}

TEST(Process, ArgumentsReachNoShell)
{
  const std::string evil = "$(touch evil-file) `id` ; * \"'\n&& false";
  const auto        run  = run_process({"printf", "%s", evil}, 20.);
  EXPECT_TRUE(run.succeeded());
  EXPECT_EQ(run.output, evil);
  EXPECT_FALSE(std::filesystem::exists("evil-file"));
}

TEST(Process, StandardInputIsEmpty)
{
  EXPECT_TRUE(run_process({"cat"}, 20.).succeeded());
}

TEST(Process, MuchOutputKeepsItsEnd)
{
  const auto run = run_process(
    {"/bin/sh", "-c", "head -c 5000000 /dev/zero | tr '\\0' x; echo end"}, 60.);
  EXPECT_TRUE(run.succeeded());
  EXPECT_GT(run.output.size(), 100000u);
  EXPECT_LT(run.output.size(), 1000000u);
  EXPECT_EQ(run.output.substr(run.output.size() - 4), "end\n");
  EXPECT_EQ(run.last_words().size(), 2000u);
}

TEST(Process, LastLines)
{
  const auto run = run_process({"seq", "1", "100"}, 20.);
  EXPECT_EQ(run.last_words(3), "98\n99\n100");
  EXPECT_EQ(run.last_words(100).substr(0, 4), "1\n2\n");
}

TEST(Process, MissingProgram)
{
  for (const std::string name : {"no-such-program", "/no/such/program", ""})
    {
      const auto run = run_process({name}, 20.);
      EXPECT_FALSE(run.started);
      EXPECT_FALSE(run.succeeded());
      EXPECT_EQ(run.summary().find("could not be started ("), 0u);
    }
  EXPECT_FALSE(run_process({}, 20.).started);
}

TEST(Process, Crash)
{
  const auto run = run_process({"/bin/sh", "-c", "kill -SEGV $$"}, 20.);
  EXPECT_FALSE(run.succeeded());
  EXPECT_EQ(run.signal, 11);
  EXPECT_NE(run.summary().find("crashed by signal 11"), std::string::npos);
}

// The program and the one it started are both gone when the limit is over.
TEST(Process, Hang)
{
  std::filesystem::remove("late-file");
  const auto begin = std::chrono::steady_clock::now();
  const auto run =
    run_process({"/bin/sh", "-c", "(sleep 1; touch late-file) & sleep 60"},
                0.3);
  EXPECT_TRUE(run.timed_out);
  EXPECT_FALSE(run.succeeded());
  EXPECT_GE(run.seconds, 0.3);
  EXPECT_LT(std::chrono::duration<double>(std::chrono::steady_clock::now() -
                                          begin)
              .count(),
            20.);
  std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  EXPECT_FALSE(std::filesystem::exists("late-file"));
}

// A grandchild that keeps the pipes open does not keep us waiting.
TEST(Process, Grandchild)
{
  const auto run = run_process({"/bin/sh", "-c", "sleep 60 & echo done"}, 30.);
  EXPECT_TRUE(run.succeeded());
  EXPECT_EQ(run.output, "done\n");
  EXPECT_LT(run.seconds, 20.);
}

TEST(Process, Environment)
{
  setenv("OMPI_COMM_WORLD_RANK", "7", 1);
  setenv("ALVEOLUS_TEST_OLD", "old", 1);
  const auto run =
    run_process({"env"},
                20.,
                {{"ALVEOLUS_TEST_NEW", "new"}, {"ALVEOLUS_TEST_OLD", "x y"}});
  unsetenv("OMPI_COMM_WORLD_RANK");
  unsetenv("ALVEOLUS_TEST_OLD");
  const std::string output = "\n" + run.output;
  EXPECT_EQ(output.find("OMPI_COMM_WORLD_RANK"), std::string::npos);
  EXPECT_NE(output.find("\nALVEOLUS_TEST_NEW=new\n"), std::string::npos);
  EXPECT_NE(output.find("\nALVEOLUS_TEST_OLD=x y\n"), std::string::npos);
  EXPECT_EQ(output.find("=old"), std::string::npos);
  EXPECT_NE(output.find("\nPATH="), std::string::npos);
}

TEST(TextFile, RoundTripAndErrors)
{
  const std::string text("a\r\nb\0c", 6);
  write_text_file("text_file.txt", text);
  EXPECT_EQ(read_text_file(MPI_COMM_WORLD, "text_file.txt", "where"), text);
  EXPECT_EQ(path_below("/in", "a/b"), "/in/a/b");
  EXPECT_EQ(path_below("/in", "/a/b"), "/a/b");
  try
    {
      read_text_file(MPI_COMM_WORLD, "no-such-file", "Mesh / File name");
      ADD_FAILURE();
    }
  catch (const InputError &error)
    {
      EXPECT_EQ(std::string(error.what())
                  .find("Mesh / File name: cannot read 'no-such-file' (No such "
                        "file or directory)"),
                0u);
    }
  EXPECT_THROW(write_text_file("/no/such/folder/file", "x"), RunError);
  EXPECT_THROW(text_from_root(MPI_COMM_WORLD,
                              []() -> std::string {
                                throw std::runtime_error("x");
                              }),
               RunError);
}
