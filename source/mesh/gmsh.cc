// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/process.h>
#include <alveolus/base/text_file.h>
#include <alveolus/mesh/gmsh.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>

namespace alveolus
{
  void
  GmshSettings::declare_parameters(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Mesher time limit",
                      time_limit,
                      "Wall clock time [s] after which the mesher is stopped.",
                      dealii::Patterns::Double(0.01));
  }



  std::string
  mesher_program()
  {
    const char *const chosen = std::getenv("ALVEOLUS_MESHER");
    return chosen == nullptr || *chosen == 0 ? "gmsh" : chosen;
  }



  MeshingJob
  MeshingJob::part(const std::string &suffix) const
  {
    MeshingJob job = *this;
    job.name += "-" + suffix;
    std::replace(job.name.begin(), job.name.end(), ' ', '-');
    return job;
  }



  std::string
  run_gmsh(const std::string  &geometry,
           const unsigned int  dim,
           const GmshSettings &settings,
           const MeshingJob   &job)
  {
    return text_from_root(job.communicator, [&]() -> std::string {
      // Absolute paths: none can be taken for an option. The name stays a name
      // in this folder, whatever it was made of.
      std::string stem = job.name;
      for (char &c : stem)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '-' &&
            c != '_')
          c = '-';
      const std::filesystem::path folder =
        std::filesystem::absolute(job.output_directory);
      const std::string script  = (folder / (stem + ".geo")).string();
      const std::string result  = (folder / (stem + ".msh")).string();
      const std::string options = script + ".opt";
      write_text_file(script, geometry);
      // Never take an old mesh. And gmsh would execute a file of options that
      // somebody has put beside the script.
      for (const std::string &file : {result, options})
        {
          std::error_code error;
          std::filesystem::remove(file, error);
          if (std::filesystem::symlink_status(file).type() !=
              std::filesystem::file_type::not_found)
            throw InputError(job.where,
                             "'" + file + "' cannot be removed",
                             "remove it, or choose another output folder");
        }

      const std::string   name_of_it = mesher_program();
      const ProcessResult run        = run_process({name_of_it,
                                                    script,
                                                    "-" + std::to_string(dim),
                                                    "-format",
                                                    "msh41",
                                                    "-nt",
                                                    "1",
                                                    "-o",
                                                    result},
                                            settings.time_limit,
                                            // no .gmshrc, no saved options:
                                            // nothing is below this
                                            {{"GMSH_HOME", "/dev/null"}});
      const std::string   program    = "'" + name_of_it + "'";
      if (!run.started)
        throw InputError(job.where,
                         "the mesher " + program + " " + run.summary(),
                         "install gmsh (Debian: apt-get install gmsh), name "
                         "it in the environment variable ALVEOLUS_MESHER, or "
                         "read a finished mesh with the mesh type 'file'");
      if (!run.succeeded())
        throw RunError(job.where,
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
        throw RunError(job.where,
                       "the mesher " + program + " ended without a mesh",
                       "check that ALVEOLUS_MESHER names gmsh");
      return read_text_file(MPI_COMM_SELF, result, job.where);
    });
  }
} // namespace alveolus
