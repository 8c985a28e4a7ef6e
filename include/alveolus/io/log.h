// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_log_h
#define alveolus_io_log_h

#include <fstream>
#include <string>

namespace alveolus
{
  /** Messages to the screen and to log.txt; only the first process speaks. */
  class Log
  {
  public:
    /**
     * @param speaks false on processes other than the first
     * @param quiet  nothing to the screen
     */
    Log(const bool speaks, const bool quiet);

    /**
     * Write to @p file_name from now on.
     * @param append keep what is there
     * @throws InputError
     */
    void
    open(const std::string &file_name, const bool append = false);

    /** A line for screen and file. */
    void
    say(const std::string &line);

    /**
     * The progress line: on a terminal it replaces the last one, elsewhere it
     * is a line of its own.
     */
    void
    progress(const std::string &line);

    /** A line for the file only. */
    void
    note(const std::string &line);

  private:
    bool          speaks, quiet, terminal;
    bool          progress_open = false;
    std::ofstream file;
  };
} // namespace alveolus

#endif
