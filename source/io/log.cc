// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/io/log.h>

#include <iostream>
#include <unistd.h>

namespace alveolus
{
  Log::Log(const bool speaks, const bool quiet)
    : speaks(speaks)
    , quiet(quiet)
    , terminal(isatty(STDOUT_FILENO) != 0)
  {}



  void
  Log::open(const std::string &file_name, const bool append)
  {
    if (!speaks)
      return;
    require_plain(file_name);
    file.open(file_name, append ? std::ios::app : std::ios::trunc);
    if (!file)
      throw InputError(file_name,
                       "cannot be written",
                       "choose another `Output / Directory` or `--output`");
  }



  void
  Log::say(const std::string &line)
  {
    note(line);
    if (!speaks || quiet)
      return;
    if (progress_open)
      std::cout << '\n';
    progress_open = false;
    std::cout << line << std::endl;
  }



  void
  Log::progress(const std::string &line)
  {
    note(line);
    if (!speaks || quiet)
      return;
    if (terminal)
      std::cout << "\r\033[K" << line << std::flush;
    else
      std::cout << line << std::endl;
    progress_open = terminal;
  }



  void
  Log::note(const std::string &line)
  {
    if (speaks && file.is_open())
      file << line << std::endl;
  }
} // namespace alveolus
