// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/text_file.h>
#include <alveolus/mesh/gmsh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/msh_reader.h>

#include <filesystem>

namespace alveolus
{
  /** A mesh with names from a gmsh file; see read_msh(). */
  template <int dim>
  class FileSource : public MeshSource<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("File name",
                        file_name,
                        "Mesh file of gmsh (.msh), text format 4.1 or 2.2, "
                        "lengths in mm; relative to the folder of the "
                        "parameter file. A script (.geo), which can start "
                        "programs, is refused unless --allow-scripts stands "
                        "on the command line; it is run as a copy in the "
                        "output folder.");
      prm.add_parameter("Refinements",
                        n_refinements,
                        "How often every cell is divided in the middle of its "
                        "edges; curves keep the file's polygonal shape.",
                        dealii::Patterns::Integer(0, 10));
      prm.add_parameter("Allow touching parts",
                        allow_touching_parts,
                        "Whether separate parts of the mesh may have nodes at "
                        "the same place or on each other's edges, e.g. for "
                        "contact. Otherwise such a mesh is refused as not "
                        "conforming.");
    }

    Mesh<dim>
    create(const MPI_Comm    &communicator,
           const std::string &input_directory,
           const std::string &output_directory) const override
    {
      const std::string name = path_below(input_directory, file_name);
      std::string       text =
        read_text_file(communicator, name, "Mesh / file / File name");
      const std::string ending =
        std::filesystem::path(name).extension().string();
      if (ending == ".geo" || ending == ".geo_unrolled")
        {
          if (!this->may_run_scripts())
            throw InputError(
              "Mesh / file / File name",
              "'" + name + "' is a script of gmsh, which can start programs",
              "make the mesh yourself (gmsh -" + std::to_string(dim) +
                " ... -o NAME.msh) and name that, or, if you trust the "
                "script, add --allow-scripts to the command line");
          text = run_gmsh(text,
                          dim,
                          GmshSettings(),
                          {"mesh-from-script",
                           output_directory,
                           "Mesh / file / File name",
                           communicator});
        }
      MeshDescription<dim> description = read_msh<dim>(text, name);
      const MeshRepairs    repairs =
        check_description(description, allow_touching_parts);
      this->check_number_of_cells(description.cells.size(),
                                  n_refinements,
                                  "Mesh / file / Refinements");
      Mesh<dim> mesh = build_mesh(description, communicator);
      if (repairs.n_unused_vertices > 0)
        mesh.description += "; " + std::to_string(repairs.n_unused_vertices) +
                            " unused nodes dropped";
      if (repairs.n_turned_cells > 0)
        mesh.description += "; " + std::to_string(repairs.n_turned_cells) +
                            " cells of negative orientation turned";
      if (repairs.n_parts > 1)
        mesh.description +=
          "; " + std::to_string(repairs.n_parts) + " separate parts";
      if (n_refinements > 0)
        {
          mesh.triangulation->refine_global(n_refinements);
          mesh.description +=
            "; refined " + std::to_string(n_refinements) + " times";
        }
      return mesh;
    }

  private:
    std::string  file_name;
    unsigned int n_refinements        = 0;
    bool         allow_touching_parts = false;
  };
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::MeshSource,
  alveolus::FileSource,
  "file",
  "A mesh file of gmsh (.msh, text format 4.1 or 2.2) with quads or hexahedra; "
  "its physical groups are the names of points, curves, boundaries (curves in "
  "2D, surfaces in 3D) and regions.")
