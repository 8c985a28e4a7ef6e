// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/text_file.h>
#include <alveolus/base/whole_file.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

namespace alveolus
{
  namespace
  {
    enum Outcome : int
    {
      good,
      input_error,
      run_error
    };

    /** Throw the error whose what() is @p message. */
    template <class Error>
    [[noreturn]] void
    throw_again(const std::string &message)
    {
      const std::size_t colon = message.find(": ");
      if (colon == std::string::npos)
        throw Error("error", message, "");
      throw Error(message.substr(0, colon), message.substr(colon + 2), "");
    }
  } // namespace



  std::string
  text_from_root(const MPI_Comm                     &communicator,
                 const std::function<std::string()> &produce)
  {
    std::pair<int, std::string> result(good, "");
    if (dealii::Utilities::MPI::this_mpi_process(communicator) == 0)
      {
        try
          {
            result.second = produce();
          }
        catch (const InputError &error)
          {
            result = {input_error, error.what()};
          }
        catch (const std::exception &error)
          {
            result = {run_error, error.what()};
          }
      }
    result = dealii::Utilities::MPI::broadcast(communicator, result, 0);
    if (result.first == input_error)
      throw_again<InputError>(result.second);
    if (result.first == run_error)
      throw_again<RunError>(result.second);
    return result.second;
  }



  std::string
  read_text_file(const MPI_Comm    &communicator,
                 const std::string &name,
                 const std::string &where)
  {
    return text_from_root(communicator, [&] {
      std::error_code ignored;
      if (name.empty())
        throw InputError(where, "no file name is given", "set it");
      if (std::filesystem::is_directory(name, ignored))
        throw InputError(where, "'" + name + "' is a folder", "name a file");
      // A device may have no end.
      if (std::filesystem::is_character_file(name, ignored))
        throw InputError(where, "'" + name + "' is a device", "name a file");
      std::ifstream file(name, std::ios::binary);
      if (!file)
        throw InputError(where,
                         "cannot read '" + name + "' (" + std::strerror(errno) +
                           ")",
                         "relative names start from the folder of the "
                         "parameter file");
      std::ostringstream text;
      text << file.rdbuf();
      if (file.bad())
        throw InputError(where, "reading '" + name + "' failed", "");
      return text.str();
    });
  }



  void
  write_text_file(const std::string &name, const std::string &text)
  {
    WholeFile file(name);
    file.stream() << text;
    file.commit();
  }



  std::string
  path_below(const std::string &directory, const std::string &name)
  {
    return name.empty() ? name
                        : (std::filesystem::path(directory) / name).string();
  }
} // namespace alveolus
