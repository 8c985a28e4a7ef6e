// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/remeshing/body_surface.h>

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

    // Vertices around the faces of a cell, counterclockwise seen from outside
    constexpr unsigned int around[6][4] = {{0, 4, 6, 2},
                                           {1, 3, 7, 5},
                                           {0, 1, 5, 4},
                                           {2, 6, 7, 3},
                                           {0, 2, 3, 1},
                                           {4, 5, 7, 6}};

    using Sorted = std::array<unsigned int, 4>;
    /** A cell and one of its faces. */
    using Side = std::pair<unsigned int, unsigned int>;

    class Extraction
    {
    public:
      Extraction(const MeshDescription<3>           &mesh,
                 const std::set<types::material_id> &layer_ids,
                 const double                        corner_angle,
                 const std::string                  &where)
        : mesh(mesh)
        , layer_ids(layer_ids)
        , corner_angle(corner_angle)
        , where(where)
        , image(mesh.vertices.size(), none)
        , level(mesh.vertices.size(), 0)
      {
        find_neighbours();
        find_components();
        find_columns();
        number_nodes();
        find_faces();
        find_lines();
        find_points();
        find_patches();
        find_curves();
      }

      BodySurface body;

    private:
      const MeshDescription<3>           &mesh;
      const std::set<types::material_id> &layer_ids;
      const double                        corner_angle;
      const std::string                  &where;

      std::map<Sorted, std::vector<Side>> sides;
      std::vector<unsigned int>           component; ///< of each cell, or none
      std::vector<unsigned int>           layer_of;  ///< of each cell, or none

      /** A column of a layer: the vertices of its edges from wall to wall. */
      struct Column
      {
        unsigned int                             layer;
        Side                                     wall;   ///< of the first part
        unsigned int                             beyond; ///< component
        std::array<std::vector<unsigned int>, 4> edges;
      };
      std::vector<Column> columns;
      /** Of the vertices of layers: the column's edge. */
      std::map<unsigned int, std::vector<unsigned int>> column_edges;

      std::vector<unsigned int> image; ///< node of the surface, by vertex
      std::vector<unsigned int> level; ///< within the layer, by vertex
      std::map<SurfaceEdge, BodySurface::Edge> edges;

      [[noreturn]] void
      fail(const std::string &found, const std::string &advice) const
      {
        throw RunError(where, found, advice);
      }

      bool
      in_layer(const unsigned int cell) const
      {
        return layer_ids.count(mesh.cells[cell].tag) != 0;
      }

      Sorted
      sorted_face(const Side &side) const
      {
        Sorted result;
        for (unsigned int i = 0; i < 4; ++i)
          result[i] = mesh.cells[side.first].vertices[around[side.second][i]];
        std::sort(result.begin(), result.end());
        return result;
      }

      /** The cell beyond a face and its number of it; none at the boundary. */
      Side
      beyond(const Side &side) const
      {
        for (const Side &other : sides.at(sorted_face(side)))
          if (other.first != side.first)
            return other;
        return {none, none};
      }

      void
      find_neighbours()
      {
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          for (unsigned int f = 0; f < 6; ++f)
            sides[sorted_face({c, f})].emplace_back(c, f);
      }

      void
      find_components()
      {
        component.assign(mesh.cells.size(), none);
        std::vector<bool> has_part(mesh.cells.size(), false);
        unsigned int      n_parts = 0;
        // Parts first: connected whatever the material
        std::vector<unsigned int> part(mesh.cells.size(), none);
        const auto                flood = [&](const unsigned int         start,
                               std::vector<unsigned int> &mark,
                               const unsigned int         value,
                               const bool                 same_material) {
          std::vector<unsigned int> front{start};
          mark[start] = value;
          while (!front.empty())
            {
              const unsigned int c = front.back();
              front.pop_back();
              for (unsigned int f = 0; f < 6; ++f)
                {
                  const unsigned int n = beyond({c, f}).first;
                  if (n == none || in_layer(n) || mark[n] != none ||
                      (same_material && mesh.cells[n].tag != mesh.cells[c].tag))
                    continue;
                  mark[n] = value;
                  front.push_back(n);
                }
            }
        };
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          {
            if (in_layer(c))
              continue;
            if (part[c] == none)
              flood(c, part, n_parts++, false);
            if (component[c] == none)
              {
                flood(c, component, body.components.size(), true);
                body.components.push_back({mesh.cells[c].tag, part[c]});
              }
          }
        if (n_parts == 0)
          fail("there are layers only", "name thin regions as 'Layers'");
        body.places.resize(n_parts);
        body.is_in.resize(n_parts);
      }

      void
      find_columns()
      {
        layer_of.assign(mesh.cells.size(), none);
        // By the component of the first part, the one beyond, and materials
        std::map<std::vector<types::material_id>, unsigned int> kinds;
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          for (unsigned int f = 0; f < 6; ++f)
            {
              if (in_layer(c))
                continue;
              Side inside = beyond({c, f});
              if (inside.first == none || !in_layer(inside.first))
                continue;
              Column                          column;
              std::vector<types::material_id> materials;
              std::vector<unsigned int>       passed;
              column.wall = {c, f};
              for (unsigned int i = 0; i < 4; ++i)
                column.edges[i].push_back(mesh.cells[c].vertices[around[f][i]]);
              while (inside.first != none && in_layer(inside.first))
                {
                  const auto &cell = mesh.cells[inside.first];
                  materials.push_back(cell.tag);
                  passed.push_back(inside.first);
                  // Each vertex of the face goes to its neighbour across
                  const unsigned int bit = 1u << (inside.second / 2);
                  for (auto &edge : column.edges)
                    {
                      const unsigned int v = std::find(cell.vertices.begin(),
                                                       cell.vertices.end(),
                                                       edge.back()) -
                                             cell.vertices.begin();
                      edge.push_back(cell.vertices[v ^ bit]);
                    }
                  inside = beyond({inside.first, inside.second ^ 1u});
                }
              if (inside.first == none)
                fail("a column of cells of a layer ends at the boundary",
                     "name regions as 'Layers' that lie between others, of "
                     "cells in columns from one to the other");
              const unsigned int here = body.components[component[c]].part;
              const unsigned int there =
                body.components[component[inside.first]].part;
              if (here == there)
                fail("the same part of the body is on both sides of a layer",
                     "name regions as 'Layers' that separate others");
              if (here > there)
                continue; // comes from the other side, too
              column.beyond    = component[inside.first];
              const auto entry = kinds.emplace(materials, body.layers.size());
              if (entry.second)
                body.layers.push_back({materials});
              column.layer = entry.first->second;
              for (const unsigned int cell : passed)
                {
                  if (layer_of[cell] != none)
                    fail("a cell of a layer belongs to two columns",
                         "name regions as 'Layers' whose cells form columns "
                         "from wall to wall");
                  layer_of[cell] = column.layer;
                }
              for (const auto &edge : column.edges)
                for (unsigned int k = 0; k < edge.size(); ++k)
                  {
                    const auto known = column_edges.emplace(edge[k], edge);
                    if (!known.second && known.first->second != edge)
                      fail("the columns of a layer do not fit together",
                           "name regions as 'Layers' whose cells form "
                           "columns from wall to wall");
                    level[edge[k]] = k;
                  }
              columns.push_back(column);
            }
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          if (in_layer(c) && layer_of[c] == none)
            fail("a cell of a layer is in no column from wall to wall",
                 "name regions as 'Layers' that lie between others");
      }

      /** Nodes of faces of the surface, walls glued together, in the order of
       * the vertices. */
      void
      number_nodes()
      {
        std::vector<bool> needed(mesh.vertices.size(), false);
        for (const auto &entry : sides)
          if (is_surface(entry.second))
            for (const unsigned int v : entry.first)
              needed[v] = true;
        for (const Column &column : columns)
          for (const auto &edge : column.edges)
            needed[edge.front()] = needed[edge.back()] = true;
        for (unsigned int v = 0; v < mesh.vertices.size(); ++v)
          {
            const auto edge = column_edges.find(v);
            if (!needed[v] || (edge != column_edges.end() && level[v] != 0))
              continue;
            image[v] = body.is_in[0].size();
            for (unsigned int p = 0; p < body.is_in.size(); ++p)
              {
                body.is_in[p].push_back(false);
                body.places[p].emplace_back();
              }
          }
        for (const Column &column : columns)
          for (const auto &edge : column.edges)
            for (const unsigned int v : edge)
              image[v] = image[edge.front()];
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          if (component[c] != none)
            for (const unsigned int v : mesh.cells[c].vertices)
              if (image[v] != none)
                {
                  const unsigned int p     = body.components[component[c]].part;
                  body.is_in[p][image[v]]  = true;
                  body.places[p][image[v]] = mesh.vertices[v];
                }
      }

      /** Whether a face outside of layers is at the boundary or between
       * materials. */
      bool
      is_surface(const std::vector<Side> &of_face) const
      {
        if (component[of_face[0].first] == none)
          return false;
        return of_face.size() == 1 ||
               (component[of_face[1].first] != none &&
                component[of_face[0].first] != component[of_face[1].first]);
      }

      void
      find_faces()
      {
        std::map<Sorted, unsigned int> tags;
        for (const auto &quad : mesh.quads)
          {
            Sorted key = quad.vertices;
            std::sort(key.begin(), key.end());
            tags[key] = quad.tag;
          }
        const auto add = [&](const Side &side, BodySurface::Face face) {
          for (unsigned int i = 0; i < 4; ++i)
            face.nodes[i] =
              image[mesh.cells[side.first].vertices[around[side.second][i]]];
          face.components[0] = component[side.first];
          body.faces.push_back(face);
        };
        // In the order of the cells
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          for (unsigned int f = 0; f < 6; ++f)
            {
              const Side  side(c, f);
              const auto &both = sides.at(sorted_face(side));
              if (!is_surface(both) || component[c] == none)
                continue;
              BodySurface::Face face;
              if (both.size() == 2)
                {
                  face.components[1] = component[beyond(side).first];
                  if (face.components[1] < component[c])
                    continue; // comes from the other side
                }
              else
                {
                  const auto tag = tags.find(sorted_face(side));
                  face.boundary  = tag == tags.end() ? 0 : tag->second;
                }
              add(side, face);
            }
        for (const Column &column : columns)
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
        for (const Column &column : columns)
          for (unsigned int i = 0; i < 4; ++i)
            {
              const auto &a = column.edges[i], &b = column.edges[(i + 1) % 4];
              std::vector<unsigned int> strip;
              for (unsigned int k = 0; k + 1 < a.size(); ++k)
                {
                  Sorted key{{a[k], b[k], a[k + 1], b[k + 1]}};
                  std::sort(key.begin(), key.end());
                  const auto &of_face = sides.at(key);
                  if (of_face.size() > 1)
                    {
                      if (component[of_face[0].first] != none ||
                          component[of_face[1].first] != none)
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
            const auto         edge = column_edges.find(v);
            if (edge != column_edges.end() &&
                std::count(edge->second.begin(), edge->second.end(), w) != 0)
              {
                auto &tags = body.through[image[v]];
                tags.resize(edge->second.size() - 1, 0);
                tags[std::min(level[v], level[w])] = line.tag;
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

      Tensor<1, 3>
      normal(const BodySurface::Face &face, const unsigned int part) const
      {
        const auto        &x = body.places[part];
        const Tensor<1, 3> n =
          cross_product_3d(x[face.nodes[2]] - x[face.nodes[0]],
                           x[face.nodes[3]] - x[face.nodes[1]]);
        return n / n.norm();
      }

      bool
      alike(const BodySurface::Face &a, const BodySurface::Face &b) const
      {
        return a.components == b.components && a.boundary == b.boundary &&
               a.layer == b.layer;
      }

      bool
      is_feature(const BodySurface::Edge &edge) const
      {
        if (edge.faces.size() != 2 || !edge.lines.empty() ||
            !edge.strip.empty())
          return true;
        const auto &a = body.faces[edge.faces[0]],
                   &b = body.faces[edge.faces[1]];
        if (!alike(a, b))
          return true;
        for (const unsigned int c : a.components)
          if (c != none)
            {
              const unsigned int p = body.components[c].part;
              if (normal(a, p) * normal(b, p) < std::cos(corner_angle))
                return true;
            }
        return false;
      }

      void
      find_patches()
      {
        for (auto entry = edges.begin(); entry != edges.end();)
          if (is_feature(entry->second))
            ++entry;
          else
            {
              inner_edges.insert(entry->first);
              ++entry;
            }
        for (unsigned int start = 0; start < body.faces.size(); ++start)
          {
            if (body.faces[start].patch != none)
              continue;
            std::vector<unsigned int> front{start};
            body.faces[start].patch = body.n_patches;
            while (!front.empty())
              {
                const auto &face = body.faces[front.back()];
                front.pop_back();
                for (unsigned int i = 0; i < 4; ++i)
                  {
                    const SurfaceEdge edge =
                      surface_edge(face.nodes[i], face.nodes[(i + 1) % 4]);
                    if (inner_edges.count(edge) == 0)
                      continue;
                    for (const unsigned int f : edges.at(edge).faces)
                      if (body.faces[f].patch == none)
                        {
                          body.faces[f].patch = body.n_patches;
                          front.push_back(f);
                        }
                  }
              }
            ++body.n_patches;
          }
      }
      std::set<SurfaceEdge> inner_edges;

      /** Patches around, so that a curve has the same ones everywhere. */
      std::multiset<unsigned int>
      patches_at(const BodySurface::Edge &edge) const
      {
        std::multiset<unsigned int> result;
        for (const unsigned int f : edge.faces)
          result.insert(body.faces[f].patch);
        return result;
      }

      void
      find_curves()
      {
        std::map<unsigned int, std::vector<unsigned int>> next;
        for (const auto &entry : edges)
          if (inner_edges.count(entry.first) == 0)
            {
              next[entry.first.first].push_back(entry.first.second);
              next[entry.first.second].push_back(entry.first.first);
            }
        for (const auto &[node, others] : next)
          {
            bool corner = others.size() != 2;
            if (!corner)
              {
                const auto &a = edges.at(surface_edge(node, others[0])),
                           &b = edges.at(surface_edge(node, others[1]));
                corner        = !(a == b) || patches_at(a) != patches_at(b);
                for (unsigned int p = 0; p < body.is_in.size(); ++p)
                  if (body.is_in[p][node] && body.is_in[p][others[0]] &&
                      body.is_in[p][others[1]])
                    {
                      const auto        &x = body.places[p];
                      const Tensor<1, 3> u = x[node] - x[others[0]];
                      const Tensor<1, 3> v = x[others[1]] - x[node];
                      corner = corner || u * v < std::cos(corner_angle) *
                                                   u.norm() * v.norm();
                    }
              }
            if (corner)
              body.corners.insert(node);
          }
        std::set<SurfaceEdge> done;
        const auto            follow = [&](const unsigned int start,
                                const unsigned int second) {
          BodySurface::Curve curve;
          curve.ids = edges.at(surface_edge(start, second));
          for (const unsigned int f : curve.ids.faces)
            for (const unsigned int c : body.faces[f].components)
              if (c != none)
                curve.parts.insert(body.components[c].part);
          curve.ids.faces.clear();
          curve.nodes = {start, second};
          done.insert(surface_edge(start, second));
          while (curve.nodes.back() != start &&
                 body.corners.count(curve.nodes.back()) == 0)
            {
              const unsigned int at = curve.nodes.back();
              const auto        &on = next.at(at);
              const unsigned int to =
                on[0] == curve.nodes[curve.nodes.size() - 2] ? on[1] : on[0];
              done.insert(surface_edge(at, to));
              curve.nodes.push_back(to);
            }
          curve.closed = body.corners.count(start) == 0;
          body.curves.push_back(curve);
        };
        for (const unsigned int corner : body.corners)
          if (next.count(corner) != 0)
            for (const unsigned int second : next.at(corner))
              if (done.count(surface_edge(corner, second)) == 0)
                follow(corner, second);
        for (const auto &entry : next)
          if (done.count(surface_edge(entry.first, entry.second[0])) == 0)
            follow(entry.first, entry.second[0]);
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
