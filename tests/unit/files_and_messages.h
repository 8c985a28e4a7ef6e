// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_files_and_messages_h
#define alveolus_tests_unit_files_and_messages_h

// Files of a test, and the messages of its errors.
#include <deal.II/base/mpi.h>

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace alveolus::bench
{
  using namespace dealii;

  inline bool
  is_root()
  {
    return Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0;
  }

  /** A folder for this test's file and number of processes, so that runs may
   * coincide. */
  inline std::string
  folder()
  {
    const std::filesystem::path source =
      testing::UnitTest::GetInstance()->current_test_info()->file();
    const std::string name =
      source.stem().string() + "." +
      std::to_string(Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD));
    if (is_root())
      std::filesystem::create_directories(name);
    MPI_Barrier(MPI_COMM_WORLD);
    return name;
  }

  /** Write a file into the folder. */
  inline void
  write(const std::string &name, const std::string &text)
  {
    const std::string path = folder() + "/" + name;
    if (is_root())
      std::ofstream(path) << text;
    MPI_Barrier(MPI_COMM_WORLD);
  }

  /** what() of the error that @p function ends with. */
  template <class Error, class Function>
  std::string
  message(const Function &function)
  {
    try
      {
        function();
      }
    catch (const Error &error)
      {
        return error.what();
      }
    return "no error";
  }

  /** Every one of @p words is in @p text. */
  inline void
  expect_words(const std::string &text, const std::vector<std::string> &words)
  {
    for (const std::string &word : words)
      EXPECT_NE(text.find(word), std::string::npos)
        << "no '" << word << "' in: " << text;
  }
} // namespace alveolus::bench

#endif
