// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_process_h
#define alveolus_base_process_h

#include <map>
#include <string>
#include <vector>

namespace alveolus
{
  /** How another program ended and what it wrote. */
  struct ProcessResult
  {
    bool        started = false;   ///< false: there is no such program
    std::string start_error;       ///< reason if it could not be started
    bool        timed_out = false; ///< it was killed at its time limit
    int         signal    = 0;     ///< signal that ended it, 0 if none
    int         exit_code = -1;    ///< valid if it ended by itself
    double      seconds   = 0.;    ///< wall clock time
    std::string output;            ///< end of what it wrote to stdout
    std::string errors;            ///< end of what it wrote to stderr

    /** Whether it was started and has ended by itself with exit code 0. */
    bool
    succeeded() const
    {
      return started && !timed_out && signal == 0 && exit_code == 0;
    }

    /** One sentence about how it ended, e.g. "crashed by signal 11 (...)". */
    std::string
    summary() const;

    /** The last @p n_lines lines of errors, or of output if there are none. */
    std::string
    last_words(const unsigned int n_lines = 8) const;
  };

  /**
   * Run another program to its end, with an argument vector and without a
   * shell, so that nothing in the arguments can be run as a command.
   * Its standard input is empty, its output is captured (of each stream the
   * last 256 kB). When @p time_limit [s] is over it is killed together with the
   * processes it started. Variables of a surrounding MPI start (mpirun) are
   * hidden from it: a program linked with MPI would take itself for one of our
   * processes.
   * @param arguments the program (searched in PATH if it holds no slash)
   *        followed by its arguments
   * @param environment variables to set in addition
   * @throws nothing about the program: a missing program, a crash or a time-out
   *         is in the result
   */
  ProcessResult
  run_process(const std::vector<std::string>           &arguments,
              const double                              time_limit,
              const std::map<std::string, std::string> &environment = {});
} // namespace alveolus

#endif
