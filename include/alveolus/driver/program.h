// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_program_h
#define alveolus_driver_program_h

#include <deal.II/base/mpi.h>

#include <iosfwd>
#include <string>
#include <vector>

namespace alveolus
{
  /** What the command line asks for, once it is parsed. */
  struct ProgramOptions
  {
    std::string scene;  ///< parameter file; may be empty with `resume`
    std::string output; ///< output folder; empty: the scene's
    std::string resume; ///< output folder or checkpoint file; empty: anew
    std::vector<std::string> sets; ///< 'Section/Parameter=value'

    bool print_parameters = false; ///< and nothing else
    bool validate         = false; ///< make and check everything, solve nothing
    bool quiet            = false; ///< nothing on the screen
    bool accept           = false; ///< changed settings when resuming
    bool allow_scripts    = false; ///< a mesh file may be a script of gmsh
  };

  /**
   * Do what is asked for, from the parameter file to the results (collective).
   * @param errors where the reason is written if it does not succeed; one
   *        message, by the first process
   * @return the exit code: 0 completed; 1 stopped early or could not go on; 2
   *         bad input, refused before any work
   * @throws nothing: every exception becomes a message and a code
   */
  int
  run_program(const ProgramOptions &options,
              const MPI_Comm       &communicator,
              std::ostream         &errors);
} // namespace alveolus

#endif
