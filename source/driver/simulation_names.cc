// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/text_file.h>
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>
#include <alveolus/io/mesh_picture.h>
#include <alveolus/io/named_sizes.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** "12 edges, 3.4 mm" */
    std::string
    extent(const NamedSize &entry, const int dim)
    {
      const bool        is_region = entry.kind == "region";
      const std::string member =
        is_region ? "cell" : (dim == 2 ? "edge" : "face");
      const int         power = is_region ? dim : dim - 1;
      const std::string unit  = power == 1   ? " mm"
                                : power == 2 ? " mm^2"
                                             : " mm^3";
      return std::to_string(entry.n_members) + " " + member +
             (entry.n_members == 1 ? ", " : "s, ") + number(entry.size, 5) +
             unit;
    }
  } // namespace



  template <int dim>
  void
  Simulation<dim>::describe_names()
  {
    log.say("Names of the mesh, for `On` and the like:");
    for (const NamedSize &entry : named_sizes(model->mesh))
      {
        std::string line = "  " + entry.kind;
        line.resize(14, ' ');
        line += entry.name;
        if (entry.kind == "point")
          {
            const auto &p = model->mesh.names.points.at(entry.name);
            line += ": (" + number(p[0]) + ", " + number(p[1]) +
                    (dim == 3 ? ", " + number(p[dim - 1]) : "") + ")";
          }
        else
          line += ": " + extent(entry, dim);
        log.say(line);
      }
    const std::string file    = scene.output_directory + "/mesh.svg";
    const std::string picture = mesh_picture(model->mesh, scene.title);
    on_first_process<RunError>(communicator,
                               [&]() { write_text_file(file, picture); });
    log.say("  picture     " + file);
  }

  template void
  Simulation<2>::describe_names();
  template void
  Simulation<3>::describe_names();
} // namespace alveolus
