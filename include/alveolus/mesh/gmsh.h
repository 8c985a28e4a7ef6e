// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_gmsh_h
#define alveolus_mesh_gmsh_h

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <string>

namespace alveolus
{
  /** How the mesher is run; parameters shared by all that need it. */
  struct GmshSettings
  {
    double time_limit = 120.; ///< [s]

    /** Add the parameters to the current subsection. */
    void
    declare_parameters(dealii::ParameterHandler &prm);
  };

  /** Who asks for a mesh, and where the files made on the way go: handed on
   * from mesh sources and remeshers down to the mesher. */
  struct MeshingJob
  {
    /** Of the mesh: in messages, and of its files without ending. */
    std::string name;
    std::string output_directory; ///< existing folder for the files
    std::string where;        ///< subsection of the parameters, for messages
    MPI_Comm    communicator; ///< of all processes that want the mesh

    /** The job of a part of this mesh, or of a further attempt at it: the same
     * with the name `NAME-suffix`, blanks replaced by dashes. */
    MeshingJob
    part(const std::string &suffix) const;
  };

  /**
   * The program that is started as gmsh: what the environment variable
   * `ALVEOLUS_MESHER` names, else "gmsh"; searched for in PATH if it holds no
   * slash. No parameter can name it: a parameter file or a checkpoint from
   * somebody else must not choose what is run here.
   */
  std::string
  mesher_program();

  /**
   * Let gmsh make a @p dim dimensional mesh of the geometry script
   * @p geometry (collective; process 0 runs it, out of process and without a
   * shell, so that its crash is an error message). The script must come from
   * this program, never from a user: gmsh's language can start programs.
   * Script and mesh are written as `NAME.geo` and `NAME.msh` into the job's
   * folder. Options of the user's own gmsh are not read, and one thread is
   * used, so that the same input gives the same mesh.
   * @return the mesh file's text (format 4.1), on every process
   * @throws InputError if gmsh cannot be started, RunError if it crashes,
   * hangs, reports an error or writes no mesh
   */
  std::string
  run_gmsh(const std::string  &geometry,
           const unsigned int  dim,
           const GmshSettings &settings,
           const MeshingJob   &job);
} // namespace alveolus

#endif
