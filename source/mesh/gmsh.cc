// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>
#include <alveolus/base/text_file.h>
#include <alveolus/mesh/gmsh.h>

#include <filesystem>

namespace alveolus
{
  void
  GmshSettings::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Mesher program",
                      program,
                      "The program gmsh, searched for in PATH if it is given "
                      "without a folder. It is run without a shell.",
                      dealii::Patterns::FileName());
    prm.add_parameter("Mesher time limit",
                      time_limit,
                      "Wall clock time [s] after which the mesher is stopped.",
                      dealii::Patterns::Double(0.01));
  }



  std::string
  run_gmsh(const std::string  &geometry,
           const unsigned int  dim,
           const std::string  &name,
           const std::string  &output_directory,
           const GmshSettings &settings,
           const std::string  &where,
           const MPI_Comm     &communicator)
  {
    return text_from_root(communicator, [&]() -> std::string {
      // Absolute paths: none can be taken for an option.
      const std::filesystem::path folder =
        std::filesystem::absolute(output_directory);
      const std::string script = (folder / (name + ".geo")).string();
      const std::string result = (folder / (name + ".msh")).string();
      write_text_file(script, geometry);
      std::error_code ignored;
      std::filesystem::remove(result, ignored); // never take an old one

      const ProcessResult run     = run_process({settings.program,
                                                 script,
                                                 "-" + std::to_string(dim),
                                                 "-format",
                                                 "msh41",
                                                 "-nt",
                                                 "1",
                                                 "-o",
                                                 result},
                                            settings.time_limit,
                                            // no .gmshrc, no saved options
                                            {{"GMSH_HOME", folder.string()}});
      const std::string   program = "'" + settings.program + "'";
      if (!run.started)
        throw InputError(where + " / Mesher program",
                         program + " " + run.summary(),
                         "install gmsh (Debian: apt-get install gmsh), name "
                         "the program, or read a finished mesh with the mesh "
                         "type 'file'");
      if (!run.succeeded())
        throw RunError(where,
                       "the mesher " + program + " " + run.summary() +
                         (run.last_words().empty()
                            ? ""
                            : "; its last words:\n" + run.last_words() + "\n"),
                       run.timed_out
                         ? "raise 'Mesher time limit' or lower the mesh density"
                         : "try the script " + script +
                             " by hand, other parameters, or the mesh type "
                             "'file' with a finished mesh");
      if (!std::filesystem::exists(result))
        throw RunError(where,
                       "the mesher " + program + " ended without a mesh",
                       "check that 'Mesher program' is gmsh");
      return read_text_file(MPI_COMM_SELF, result, where);
    });
  }
} // namespace alveolus
