// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/text_file.h>
#include <alveolus/mesh/msh_sections.h>
#include <alveolus/remeshing/tetrahedra.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Decimals [mm] of the coordinates the mesher gets. */
    constexpr double rounding = 1e9;

    double
    rounded(const double x)
    {
      return std::round(x * rounding) / rounding;
    }

    std::string
    surface_file(const std::vector<Point<3>>                    &vertices,
                 const std::vector<std::array<unsigned int, 3>> &triangles)
    {
      std::ostringstream text;
      text.precision(17);
      text << "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n"
           << vertices.size() << '\n';
      for (std::size_t v = 0; v < vertices.size(); ++v)
        {
          text << v + 1;
          for (unsigned int d = 0; d < 3; ++d)
            text << ' ' << rounded(vertices[v][d]);
          text << '\n';
        }
      text << "$EndNodes\n$Elements\n" << triangles.size() << '\n';
      for (std::size_t t = 0; t < triangles.size(); ++t)
        {
          text << t + 1 << " 2 2 1 1";
          for (const unsigned int v : triangles[t])
            text << ' ' << v + 1;
          text << '\n';
        }
      text << "$EndElements\n";
      return text.str();
    }

    std::string
    script(const std::string &surface, const TetrahedraSettings &settings)
    {
      std::ostringstream geo;
      geo << "// Lengths in mm.\nMerge \"" << surface << "\";\n"
          << "Surface Loop(1) = {1};\nVolume(1) = {1};\n"
          << "Physical Volume(\"inside\") = {1};\n"
          << "Mesh.MeshSizeExtendFromBoundary = 1;\n"
          << "Mesh.MeshSizeFactor = " << settings.size_factor << ";\n"
          << "Mesh.Algorithm3D = " << settings.algorithm << ";\n"
          << "Mesh.Optimize = 1;\nMesh.OptimizeThreshold = 0.6;\n"
          << "Mesh.RandomSeed = 1;\n"
          << "Mesh.ElementOrder = 1;\nMesh.SaveAll = 0;\nMesh.Binary = 0;\n";
      return geo.str();
    }
  } // namespace



  Tetrahedra
  fill_with_tetrahedra(
    const std::vector<Point<3>>                    &vertices,
    const std::vector<std::array<unsigned int, 3>> &triangles,
    const TetrahedraSettings                       &settings,
    const MeshingJob                               &job)
  {
    const std::string surface = job.name + "-surface.msh";
    text_from_root(job.communicator, [&]() -> std::string {
      write_text_file(path_below(job.output_directory, surface),
                      surface_file(vertices, triangles));
      return "";
    });
    const std::string text =
      run_gmsh(script(surface, settings), 3, settings.gmsh, job);
    MshSections sections;
    try
      {
        sections = read_msh_sections(text, job.name + ".msh");
      }
    catch (const InputError &error)
      {
        throw RunError(job.where, error.what(), ""); // no fault of the user
      }

    // The mesher numbers the nodes anew: those of the surface by their places
    double shortest = std::numeric_limits<double>::max();
    for (const auto &triangle : triangles)
      for (unsigned int i = 0; i < 3; ++i)
        shortest = std::min(shortest,
                            vertices[triangle[i]].distance(
                              vertices[triangle[(i + 1) % 3]]));
    const double tolerance = std::max(1e-4 * shortest, 2. / rounding);
    std::vector<std::pair<double, unsigned int>> by_x;
    for (unsigned int v = 0; v < vertices.size(); ++v)
      by_x.emplace_back(rounded(vertices[v][0]), v);
    std::sort(by_x.begin(), by_x.end());
    Tetrahedra mesh;
    mesh.vertices = vertices;
    std::vector<bool>                             found(vertices.size(), false);
    std::unordered_map<std::size_t, unsigned int> number;
    for (const std::size_t node : sections.node_order)
      {
        const Point<3> &x    = sections.nodes.at(node).position;
        unsigned int    same = vertices.size();
        for (auto entry = std::lower_bound(
               by_x.begin(), by_x.end(), std::make_pair(x[0] - tolerance, 0u));
             entry != by_x.end() && entry->first <= x[0] + tolerance;
             ++entry)
          if (vertices[entry->second].distance(x) <= tolerance)
            same = entry->second;
        if (same < vertices.size())
          {
            number[node] = same;
            found[same]  = true;
            continue;
          }
        number[node] = mesh.vertices.size();
        mesh.vertices.push_back(x);
      }
    if (std::count(found.begin(), found.end(), false) != 0)
      throw RunError(job.where, "the mesher left out nodes of the surface", "");

    constexpr int tetrahedron = 4; // gmsh's number of the element type
    double        volume      = 0.;
    for (const MshElement &element : sections.elements)
      if (element.type == tetrahedron)
        {
          std::array<unsigned int, 4> cell;
          for (unsigned int i = 0; i < 4; ++i)
            cell[i] = number.at(element.nodes[i]);
          const Point<3> &a   = mesh.vertices[cell[0]];
          const double    det = cross_product_3d(mesh.vertices[cell[1]] - a,
                                              mesh.vertices[cell[2]] - a) *
                             (mesh.vertices[cell[3]] - a);
          if (det < 0.)
            std::swap(cell[2], cell[3]);
          volume += std::abs(det) / 6.;
          mesh.cells.push_back(cell);
        }

    // All triangles, and only these, must bound the tetrahedra.
    std::set<std::array<unsigned int, 3>> faces;
    for (const auto &cell : mesh.cells)
      for (unsigned int i = 0; i < 4; ++i)
        {
          std::array<unsigned int, 3> face{
            {cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]}};
          std::sort(face.begin(), face.end());
          const auto entry = faces.insert(face);
          if (!entry.second)
            faces.erase(entry.first);
        }
    double enclosed = 0.;
    for (std::array<unsigned int, 3> face : triangles)
      {
        enclosed += cross_product_3d(vertices[face[0]] - Point<3>(),
                                     vertices[face[1]] - Point<3>()) *
                    (vertices[face[2]] - Point<3>()) / 6.;
        std::sort(face.begin(), face.end());
        if (faces.erase(face) == 0)
          throw RunError(job.where, "the mesher changed the surface", "");
      }
    if (!faces.empty() || !(std::abs(volume - enclosed) < 1e-6 * enclosed))
      throw RunError(job.where,
                     "the mesher filled another volume than asked for",
                     "");
    return mesh;
  }
} // namespace alveolus
