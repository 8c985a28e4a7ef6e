// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/block_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>

#include <cmath>
#include <sstream>

namespace alveolus
{
  namespace
  {
    /** Corners of the faces of a cell, in its lexicographic numbering. */
    constexpr unsigned int faces[6][4] = {{0, 2, 4, 6},
                                          {1, 3, 5, 7},
                                          {0, 1, 4, 5},
                                          {2, 3, 6, 7},
                                          {0, 1, 2, 3},
                                          {4, 5, 6, 7}};
  } // namespace



  BlockMesh::BlockMesh(const std::string &source, const double length)
    : tolerance(1e-9 * length)
  {
    mesh.source = source;
  }



  unsigned int
  BlockMesh::vertex(const Place &x)
  {
    // Of the boxes of this size a vertex may be in the next one by round-off.
    std::array<long, 3> box;
    for (unsigned int d = 0; d < 3; ++d)
      box[d] = std::lround(x[d] / (100. * tolerance));
    for (long i = -1; i <= 1; ++i)
      for (long j = -1; j <= 1; ++j)
        for (long k = -1; k <= 1; ++k)
          {
            const auto found = at.find({{box[0] + i, box[1] + j, box[2] + k}});
            if (found != at.end() &&
                mesh.vertices[found->second].distance(x) < tolerance)
              return found->second;
          }
    const unsigned int number = mesh.vertices.size();
    at.emplace(box, number);
    mesh.vertices.push_back(x);
    mesh.vertex_numbers.push_back(number + 1);
    return number;
  }



  void
  BlockMesh::add(const std::string                         &region,
                 const Divisions                           &n,
                 const std::function<Place(const Place &)> &map)
  {
    auto &tags = mesh.regions[region];
    if (tags.empty())
      tags.insert(++n_tags);
    std::vector<unsigned int> vertices;
    for (unsigned int k = 0; k <= n[2]; ++k)
      for (unsigned int j = 0; j <= n[1]; ++j)
        for (unsigned int i = 0; i <= n[0]; ++i)
          vertices.push_back(vertex(map(Place(static_cast<double>(i) / n[0],
                                              static_cast<double>(j) / n[1],
                                              static_cast<double>(k) / n[2]))));
    for (unsigned int k = 0; k < n[2]; ++k)
      for (unsigned int j = 0; j < n[1]; ++j)
        for (unsigned int i = 0; i < n[0]; ++i)
          {
            DescribedElement<3> cell;
            cell.tag    = *tags.begin();
            cell.number = mesh.cells.size() + 1;
            for (unsigned int v = 0; v < 8; ++v)
              cell.vertices[v] =
                vertices[((k + (v >> 2)) * (n[1] + 1) + j + ((v >> 1) & 1)) *
                           (n[0] + 1) +
                         i + (v & 1)];
            mesh.cells.push_back(cell);
          }
  }



  void
  BlockMesh::name_point(const std::string &name, const Place &place)
  {
    for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
      if (mesh.vertices[v].distance(place) < tolerance)
        {
          mesh.points[name] = v;
          return;
        }
    std::ostringstream text;
    text << "there is no vertex at (" << place << ") for point '" << name
         << "'";
    throw InputError(mesh.source, text.str(), "place points at vertices");
  }



  void
  BlockMesh::name_curve(const std::string &name, const Condition &condition)
  {
    std::vector<bool> on;
    for (const Place &x : mesh.vertices)
      on.push_back(condition(x));
    std::set<std::pair<unsigned int, unsigned int>> lines;
    for (const auto &cell : mesh.cells)
      for (unsigned int v = 0; v < 8; ++v)
        for (const unsigned int step : {1u, 2u, 4u})
          if ((v & step) == 0)
            {
              const unsigned int a = cell.vertices[v],
                                 b = cell.vertices[v | step];
              if (on[a] && on[b])
                lines.emplace(std::min(a, b), std::max(a, b));
            }
    const unsigned int tag = ++n_tags;
    for (const auto &line : lines)
      {
        DescribedElement<1> element;
        element.tag      = tag;
        element.number   = mesh.lines.size() + 1;
        element.vertices = {{line.first, line.second}};
        mesh.lines.push_back(element);
      }
    mesh.curves[name].insert(tag);
  }



  void
  BlockMesh::name_segment(const std::string &name,
                          const Place       &a,
                          const Place       &b)
  {
    const dealii::Tensor<1, 3> way = b - a;
    name_curve(name, [&](const Place &x) {
      const double part = (x - a) * way / way.norm_square();
      return part > -1e-9 && part < 1. + 1e-9 &&
             (x - a - part * way).norm() < tolerance;
    });
  }



  void
  BlockMesh::name_boundary(const std::string &name, const Condition &condition)
  {
    std::vector<bool> on;
    for (const Place &x : mesh.vertices)
      on.push_back(condition(x));
    std::map<std::set<unsigned int>,
             std::pair<std::array<unsigned int, 4>, int>>
      found;
    for (const auto &cell : mesh.cells)
      for (const auto &face : faces)
        {
          std::array<unsigned int, 4> corners{};
          bool                        all = true;
          for (unsigned int v = 0; v < 4; ++v)
            {
              corners[v] = cell.vertices[face[v]];
              all        = all && on[corners[v]];
            }
          if (all)
            {
              auto &entry = found[{corners.begin(), corners.end()}];
              entry.first = corners;
              ++entry.second;
            }
        }
    const unsigned int tag = ++n_tags;
    for (const auto &entry : found)
      if (entry.second.second == 1)
        {
          DescribedElement<2> element;
          element.tag      = tag;
          element.number   = mesh.quads.size() + 1;
          element.vertices = entry.second.first;
          mesh.quads.push_back(element);
        }
    mesh.surfaces[name].insert(tag);
  }



  MeshDescription<3>
  BlockMesh::description(const std::string &where) const
  {
    MeshDescription<3> result  = mesh;
    const double       quality = smallest_scaled_jacobian(result);
    if (quality <= 0.)
      throw InputError(where,
                       "these dimensions give cells turned inside out "
                       "(smallest scaled Jacobian " +
                         std::to_string(quality) + ")",
                       "choose dimensions closer to the default ones");
    check_description(result);
    return result;
  }
} // namespace alveolus
