// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/remeshing/layer_columns.h>
#include <alveolus/remeshing/surface_patches.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = BodySurface::none;

    class Extraction
    {
    public:
      Extraction(const MeshDescription<3>           &mesh,
                 const std::set<types::material_id> &layer_ids,
                 const double                        corner_angle,
                 const std::string                  &where)
        : mesh(mesh)
        , where(where)
        , cells(mesh, layer_ids, where)
        , image(mesh.vertices.size(), none)
      {
        body.components = cells.components;
        body.layers     = cells.layers;
        body.places.resize(cells.n_parts);
        body.is_in.resize(cells.n_parts);
        number_nodes();
        find_faces();
        find_lines();
        find_points();
        divide_into_patches(body, edges, corner_angle);
      }

      BodySurface body;

    private:
      const MeshDescription<3> &mesh;
      const std::string        &where;
      const LayerColumns        cells;
      std::vector<unsigned int> image; ///< node of the surface, by vertex
      std::map<SurfaceEdge, BodySurface::Edge> edges;

      [[noreturn]] void
      fail(const std::string &found, const std::string &advice) const
      {
        throw RunError(where, found, advice);
      }

      /** Nodes of faces of the surface, walls glued together, in the order of
       * the vertices. */
      void
      number_nodes()
      {
        std::vector<bool> needed(mesh.vertices.size(), false);
        for (const auto &entry : cells.sides)
          if (is_surface(entry.second))
            for (const unsigned int v : entry.first)
              needed[v] = true;
        for (const LayerColumns::Column &column : cells.columns)
          for (const auto &edge : column.edges)
            needed[edge.front()] = needed[edge.back()] = true;
        for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
          {
            const auto edge = cells.column_edges.find(v);
            if (!needed[v] ||
                (edge != cells.column_edges.end() && cells.level[v] != 0))
              continue;
            image[v] = body.is_in[0].size();
            for (unsigned int p = 0; p < body.is_in.size(); ++p)
              {
                body.is_in[p].push_back(false);
                body.places[p].emplace_back();
              }
          }
        for (const LayerColumns::Column &column : cells.columns)
          for (const auto &edge : column.edges)
            for (const unsigned int v : edge)
              image[v] = image[edge.front()];
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          if (cells.component[c] != none)
            for (const unsigned int v : mesh.cells[c].vertices)
              if (image[v] != none)
                {
                  const unsigned int p =
                    body.components[cells.component[c]].part;
                  body.is_in[p][image[v]]  = true;
                  body.places[p][image[v]] = mesh.vertices[v];
                }
      }

      /** Whether a face outside of layers is at the boundary or between
       * materials. */
      bool
      is_surface(const std::vector<CellSide> &of_face) const
      {
        if (cells.component[of_face[0].first] == none)
          return false;
        return of_face.size() == 1 ||
               (cells.component[of_face[1].first] != none &&
                cells.component[of_face[0].first] !=
                  cells.component[of_face[1].first]);
      }

      void
      find_faces()
      {
        std::map<SortedFace, unsigned int> tags;
        for (const auto &quad : mesh.quads)
          {
            SortedFace key = quad.vertices;
            std::sort(key.begin(), key.end());
            tags[key] = quad.tag;
          }
        const auto add = [&](const CellSide &side, BodySurface::Face face) {
          for (unsigned int i = 0; i < 4; ++i)
            face.nodes[i] = image[mesh.cells[side.first]
                                    .vertices[vertices_around[side.second][i]]];
          face.components[0] = cells.component[side.first];
          body.faces.push_back(face);
        };
        // In the order of the cells
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          for (unsigned int f = 0; f < 6; ++f)
            {
              const CellSide side(c, f);
              const auto    &both = cells.sides.at(cells.sorted_face(side));
              if (!is_surface(both) || cells.component[c] == none)
                continue;
              BodySurface::Face face;
              if (both.size() == 2)
                {
                  face.components[1] =
                    cells.component[cells.beyond(side).first];
                  if (face.components[1] < cells.component[c])
                    continue; // comes from the other side
                }
              else
                {
                  const auto tag = tags.find(cells.sorted_face(side));
                  face.boundary  = tag == tags.end() ? 0 : tag->second;
                }
              add(side, face);
            }
        for (const LayerColumns::Column &column : cells.columns)
          {
            BodySurface::Face face;
            face.components[1] = column.beyond;
            face.layer         = column.layer;
            add(column.wall, face);
          }
        for (unsigned int f = 0; f < body.faces.size(); ++f)
          for (unsigned int i = 0; i < 4; ++i)
            edges[surface_edge(body.faces[f].nodes[i],
                               body.faces[f].nodes[(i + 1) % 4])]
              .faces.push_back(f);

        // The ends of layers at the boundary
        for (const LayerColumns::Column &column : cells.columns)
          for (unsigned int i = 0; i < 4; ++i)
            {
              const auto &a = column.edges[i], &b = column.edges[(i + 1) % 4];
              std::vector<unsigned int> strip;
              for (unsigned int k = 0; k + 1 < a.size(); ++k)
                {
                  SortedFace key{{a[k], b[k], a[k + 1], b[k + 1]}};
                  std::sort(key.begin(), key.end());
                  const auto &of_face = cells.sides.at(key);
                  if (of_face.size() > 1)
                    {
                      if (cells.component[of_face[0].first] != none ||
                          cells.component[of_face[1].first] != none)
                        fail("a layer ends at another region",
                             "name regions as 'Layers' that end at the "
                             "boundary");
                      continue;
                    }
                  const auto tag = tags.find(key);
                  strip.push_back(tag == tags.end() ? 0 : tag->second);
                }
              if (!strip.empty())
                edges[surface_edge(image[a[0]], image[b[0]])].strip = strip;
            }
      }

      void
      find_lines()
      {
        for (const auto &line : mesh.lines)
          {
            const unsigned int v = line.vertices[0], w = line.vertices[1];
            const auto         edge = cells.column_edges.find(v);
            if (edge != cells.column_edges.end() &&
                std::count(edge->second.begin(), edge->second.end(), w) != 0)
              {
                auto &tags = body.through[image[v]];
                tags.resize(edge->second.size() - 1, 0);
                tags[std::min(cells.level[v], cells.level[w])] = line.tag;
                continue;
              }
            const auto         found = image[v] == none || image[w] == none
                                         ? edges.end()
                                         : edges.find(surface_edge(image[v], image[w]));
            const unsigned int part  = part_at(v);
            if (found == edges.end() || part == none || part_at(w) != part)
              fail("a named line runs inside a region or a layer",
                   "this remesher carries lines of boundaries and interfaces "
                   "only");
            found->second.lines[part] = line.tag;
          }
      }

      /** Part whose place a vertex is; none inside layers. */
      unsigned int
      part_at(const unsigned int vertex) const
      {
        if (image[vertex] == none)
          return none;
        for (unsigned int p = 0; p < body.is_in.size(); ++p)
          if (body.is_in[p][image[vertex]] &&
              body.places[p][image[vertex]] == mesh.vertices[vertex])
            return p;
        return none;
      }

      void
      find_points()
      {
        for (const auto &point : mesh.points)
          {
            const unsigned int part = part_at(point.second);
            if (part == none)
              fail("the named point '" + point.first +
                     "' is inside a region or a layer",
                   "this remesher carries points of boundaries and interfaces "
                   "only");
            body.points[point.first] = {image[point.second], part};
            body.corners.insert(image[point.second]);
          }
        for (const auto &entry : body.through)
          body.corners.insert(entry.first);
      }
    };
  } // namespace



  BodySurface
  extract_surface(const MeshDescription<3>           &mesh,
                  const std::set<types::material_id> &layers,
                  const double                        corner_angle,
                  const std::string                  &where)
  {
    return Extraction(mesh, layers, corner_angle, where).body;
  }
} // namespace alveolus
