// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/planar_mesher.h>

#include <algorithm>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Points  = std::vector<Point<2>>;
    using Indices = std::vector<unsigned int>;

    /** The nodes on curves, numbered once for all areas. */
    struct CurveNodes
    {
      Points               positions;
      std::vector<Indices> on_curve;

      explicit CurveNodes(const PlanarGeometry &geometry)
        : positions(geometry.points)
      {
        for (const PlanarCurve &curve : geometry.curves)
          {
            Indices nodes(1, curve.begin);
            for (unsigned int i = 1; i < curve.n_segments(); ++i)
              {
                nodes.push_back(positions.size());
                positions.push_back(curve.nodes[i]);
              }
            nodes.push_back(curve.end);
            on_curve.push_back(nodes);
          }
      }

      /** Nodes of several parts of a loop one after the other, joints once. */
      template <class Iterator>
      Indices
      of(Iterator begin, const Iterator end) const
      {
        Indices nodes;
        for (; begin != end; ++begin)
          {
            Indices more = on_curve[begin->curve];
            if (begin->reversed)
              std::reverse(more.begin(), more.end());
            AssertThrow(nodes.empty() || nodes.back() == more.front(),
                        ExcMessage("The curves of a loop do not join."));
            nodes.insert(nodes.end(),
                         more.begin() + (nodes.empty() ? 0 : 1),
                         more.end());
          }
        return nodes;
      }

      Points
      positions_of(const Indices &nodes) const
      {
        Points result;
        for (const unsigned int node : nodes)
          result.push_back(positions[node]);
        return result;
      }
    };

    /**
     * A finished mesh with its vertices sorted as they have to be: those of the
     * boundary first.
     */
    AreaMesh
    prepared_mesh(const AreaMesh            &given,
                  const std::vector<Points> &loops,
                  const std::string         &where)
    {
      std::map<std::pair<double, double>, unsigned int> places;
      AreaMesh                                          mesh = given;
      mesh.vertices.clear();
      for (const Points &loop : loops)
        for (const Point<2> &p : loop)
          {
            places[{p[0], p[1]}] = mesh.vertices.size();
            mesh.vertices.push_back(p);
          }
      const std::size_t n_boundary = mesh.vertices.size();
      Indices           index;
      for (const Point<2> &p : given.vertices)
        {
          const auto place = places.find({p[0], p[1]});
          index.push_back(place == places.end() ? mesh.vertices.size()
                                                : place->second);
          if (place == places.end())
            mesh.vertices.push_back(p);
        }
      if (mesh.vertices.size() != given.vertices.size())
        throw RunError(where,
                       "a finished mesh does not have the " +
                         std::to_string(n_boundary) +
                         " nodes of its area's boundary",
                       "");
      for (Quad &quad : mesh.quads)
        for (unsigned int &v : quad)
          v = index[v];
      return mesh;
    }

    /**
     * Mesh an area.
     * @param boundary global indices of its first vertices
     */
    AreaMesh
    mesh_area(const PlanarArea   &area,
              const CurveNodes   &nodes,
              const PlanarMesher &mesher,
              const MeshingJob   &job,
              Indices            &boundary)
    {
      std::vector<Points> loops;
      for (const auto &loop : area.loops)
        {
          Indices indices = nodes.of(loop.begin(), loop.end());
          AssertThrow(indices.front() == indices.back(),
                      ExcMessage("The loop of an area is not closed."));
          indices.pop_back();
          boundary.insert(boundary.end(), indices.begin(), indices.end());
          loops.push_back(nodes.positions_of(indices));
        }

      if (area.prepared)
        return prepared_mesh(*area.prepared, loops, job.where);
      if (area.structured)
        {
          const auto           &loop = area.loops[0];
          std::array<Points, 4> sides;
          for (unsigned int k = 0; k < 4; ++k)
            sides[k] = nodes.positions_of(
              nodes.of(loop.begin() + area.corners[k],
                       k == 3 ? loop.end()
                              : loop.begin() + area.corners[k + 1]));
          if (area.caps[0] + area.caps[1] > 0)
            return mesh_capped_area(sides, area.caps, area.name);
          if (sides[0].size() != sides[2].size() ||
              sides[1].size() != sides[3].size())
            throw RunError(job.where,
                           "the structured area '" + area.name +
                             "' has unequal numbers of segments on opposite "
                             "sides",
                           "");
          return mesh_structured_area(sides);
        }

      return mesh_unstructured_area(area, loops, mesher, job.part(area.name));
    }
  } // namespace



  std::string
  PlanarMeshReport::summary() const
  {
    std::string text;
    for (const std::string &area : areas)
      text += (text.empty() ? "" : "; ") + area;
    return text;
  }



  MeshDescription<2>
  mesh_planar_geometry(const PlanarGeometry &geometry,
                       const PlanarMesher   &mesher,
                       const MeshingJob     &job,
                       PlanarMeshReport     &report)
  {
    report = PlanarMeshReport();
    const CurveNodes   nodes(geometry);
    MeshDescription<2> mesh;
    mesh.source   = job.name;
    mesh.vertices = nodes.positions;
    mesh.curves   = geometry.curve_names;
    mesh.regions  = geometry.region_names;

    report.smallest_scaled_jacobian = 1.;
    for (const PlanarArea &area : geometry.areas)
      {
        Indices            boundary;
        const AreaMesh     part = mesh_area(area, nodes, mesher, job, boundary);
        const unsigned int shift = mesh.vertices.size() - boundary.size();
        mesh.vertices.insert(mesh.vertices.end(),
                             part.vertices.begin() + boundary.size(),
                             part.vertices.end());
        for (const Quad &quad : part.quads)
          {
            DescribedElement<2> cell;
            for (unsigned int v = 0; v < 4; ++v)
              cell.vertices[v] =
                quad[v] < boundary.size() ? boundary[quad[v]] : quad[v] + shift;
            cell.tag    = area.tag;
            cell.number = mesh.cells.size() + 1;
            mesh.cells.push_back(cell);
          }
        report.n_mesher_runs += part.n_mesher_runs;
        report.smallest_scaled_jacobian =
          std::min(report.smallest_scaled_jacobian, part.quality);
        std::ostringstream text;
        text << area.name << ": " << part.quads.size()
             << " cells, smallest scaled Jacobian " << std::setprecision(3)
             << part.quality << " (" << part.remark << ")";
        report.areas.push_back(text.str());
      }

    for (std::size_t c = 0; c < geometry.curves.size(); ++c)
      if (geometry.curves[c].tag != 0)
        for (std::size_t i = 0; i + 1 < nodes.on_curve[c].size(); ++i)
          {
            DescribedElement<1> line;
            line.vertices = {{nodes.on_curve[c][i], nodes.on_curve[c][i + 1]}};
            line.tag      = geometry.curves[c].tag;
            line.number   = mesh.lines.size() + 1;
            mesh.lines.push_back(line);
          }
    for (const auto &point : geometry.point_names)
      {
        const auto node =
          std::find(mesh.vertices.begin(), mesh.vertices.end(), point.second);
        if (node == mesh.vertices.end())
          throw RunError(job.where,
                         "the point '" + point.first +
                           "' is no vertex of the new mesh",
                         "let it be on a curve");
        mesh.points[point.first] = node - mesh.vertices.begin();
      }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      mesh.vertex_numbers.push_back(v + 1);
    try
      {
        check_description(mesh);
      }
    catch (const InputError &error)
      {
        throw RunError(job.where, error.what(), "");
      }
    return mesh;
  }
} // namespace alveolus
