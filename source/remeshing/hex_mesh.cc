// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remeshing/hex_mesh.h>

#include <algorithm>
#include <tuple>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = BodySurface::none;

    class Division
    {
    public:
      Division(const SurfaceMesh                  &surface,
               const std::vector<FilledComponent> &filled,
               const MeshDescription<3>           &old)
        : surface(surface)
        , body(surface.body.body)
        , old(old)
      {
        find_sites();
        for (unsigned int c = 0; c < filled.size(); ++c)
          divide_component(c, filled[c]);
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
          if (face_of(t).layer != none)
            divide_columns(t);
        name_quads();
        name_lines();
        take_over_names();
      }

      HexMesh mesh;

    private:
      /** A layer between two parts. */
      struct Span
      {
        unsigned int first = none, second = none, layer = none;

        bool
        operator<(const Span &other) const
        {
          return std::tie(first, second, layer) <
                 std::tie(other.first, other.second, other.layer);
        }
      };

      const SurfaceMesh        &surface;
      const BodySurface        &body;
      const MeshDescription<3> &old;

      /** Vertices, middles of edges, middles of triangles. */
      std::vector<SurfaceMesh::Vertex>    sites;
      std::map<SurfaceEdge, unsigned int> edge_site;
      std::map<SurfaceEdge, Span>         edge_span; ///< if in a glued patch
      unsigned int                        first_triangle_site = 0;
      /** Nodes by site and part, and by site, span and level. */
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> nodes;
      std::map<std::tuple<unsigned int, Span, unsigned int>, unsigned int>
                                           inner_nodes;
      std::map<unsigned int, unsigned int> slider_of; ///< by site

      const BodySurface::Face &
      face_of(const unsigned int triangle) const
      {
        return body
          .faces[surface.body.patch_face[surface.triangles[triangle].patch]];
      }

      void
      find_sites()
      {
        sites = surface.vertices;
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
          for (unsigned int i = 0; i < 3; ++i)
            {
              const auto       &v    = surface.triangles[t].vertices;
              const SurfaceEdge edge = surface_edge(v[i], v[(i + 1) % 3]);
              if (edge_site.count(edge) == 0)
                {
                  edge_site[edge] = sites.size();
                  sites.push_back(surface.middle(edge));
                }
              if (face_of(t).layer != none)
                edge_span[edge] = span_of(face_of(t));
            }
        first_triangle_site = sites.size();
        for (const auto &triangle : surface.triangles)
          sites.push_back(surface.middle(triangle));
      }

      Span
      span_of(const BodySurface::Face &face) const
      {
        return {body.components[face.components[0]].part,
                body.components[face.components[1]].part,
                face.layer};
      }

      unsigned int
      add_node(const Point<3> &x, const bool is_inside)
      {
        mesh.description.vertices.push_back(x);
        mesh.is_inside.push_back(is_inside);
        return mesh.description.vertices.size() - 1;
      }

      /** Whoever slides takes its nodes along. */
      void
      note_slider(const unsigned int site, const HexMesh::Slider::Node &node)
      {
        if (sites[site].on != SurfaceMesh::Vertex::On::patch)
          return;
        const auto entry = slider_of.emplace(site, mesh.sliders.size());
        if (entry.second)
          {
            mesh.sliders.emplace_back();
            mesh.sliders.back().vertex = sites[site];
          }
        mesh.sliders[entry.first->second].nodes.push_back(node);
      }

      unsigned int
      node(const unsigned int site, const unsigned int part)
      {
        const auto entry = nodes.emplace(std::make_pair(site, part),
                                         mesh.description.vertices.size());
        if (entry.second)
          {
            add_node(sites[site].x[part], false);
            note_slider(site, {entry.first->second, part, part, 0.});
          }
        return entry.first->second;
      }

      unsigned int
      node(const unsigned int site, const Span &span, const unsigned int level)
      {
        const unsigned int n = body.layers[span.layer].materials.size();
        if (level == 0)
          return node(site, span.first);
        if (level == n)
          return node(site, span.second);
        const auto entry =
          inner_nodes.emplace(std::make_tuple(site, span, level),
                              mesh.description.vertices.size());
        if (entry.second)
          {
            const double    s = double(level) / n;
            const Point<3> &a = sites[site].x[span.first],
                           &b = sites[site].x[span.second];
            add_node(Point<3>(a + s * (b - a)), false);
            note_slider(site,
                        {entry.first->second, span.first, span.second, s});
          }
        return entry.first->second;
      }

      void
      add_cell(const std::array<unsigned int, 8> &vertices,
               const unsigned int                 material)
      {
        DescribedElement<3> cell;
        cell.vertices = vertices;
        cell.tag      = material;
        cell.number   = mesh.description.cells.size() + 1;
        mesh.description.cells.push_back(cell);
      }

      void
      divide_component(const unsigned int c, const FilledComponent &filled)
      {
        using Triple                   = std::array<unsigned int, 3>;
        const unsigned int        part = body.components[c].part;
        std::vector<unsigned int> node_of;
        for (unsigned int v = 0; v < filled.mesh.vertices.size(); ++v)
          node_of.push_back(v < filled.surface_vertices.size()
                              ? node(filled.surface_vertices[v], part)
                              : add_node(filled.mesh.vertices[v], true));
        std::map<SurfaceEdge, unsigned int> middles;
        std::map<Triple, unsigned int>      centres;
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
          {
            const auto &face = face_of(t);
            if (face.components[0] != c && face.components[1] != c)
              continue;
            const auto &v = surface.triangles[t].vertices;
            Triple      triple;
            for (unsigned int i = 0; i < 3; ++i)
              {
                const unsigned int w = v[(i + 1) % 3];
                triple[i]            = node(v[i], part);
                middles[surface_edge(node(v[i], part), node(w, part))] =
                  node(edge_site.at(surface_edge(v[i], w)), part);
              }
            std::sort(triple.begin(), triple.end());
            centres[triple] = node(first_triangle_site + t, part);
          }
        const auto mean = [&](const auto &of) {
          Tensor<1, 3> sum;
          for (const unsigned int v : of)
            sum += mesh.description.vertices[v] / double(of.size());
          return Point<3>(sum);
        };
        const auto middle = [&](const unsigned int a, const unsigned int b) {
          const SurfaceEdge edge = surface_edge(a, b);
          const auto        entry =
            middles.emplace(edge, mesh.description.vertices.size());
          if (entry.second)
            add_node(mean(
                       std::array<unsigned int, 2>{{edge.first, edge.second}}),
                     true);
          return entry.first->second;
        };
        const auto centre = [&](Triple triple) {
          std::sort(triple.begin(), triple.end());
          const auto entry =
            centres.emplace(triple, mesh.description.vertices.size());
          if (entry.second)
            add_node(mean(triple), true);
          return entry.first->second;
        };
        // Even permutations, so that each corner sees the others alike
        constexpr unsigned int corners[4][4] = {{0, 1, 2, 3},
                                                {1, 0, 3, 2},
                                                {2, 0, 1, 3},
                                                {3, 0, 2, 1}};
        for (const auto &tetrahedron : filled.mesh.cells)
          {
            std::array<unsigned int, 4> v;
            for (unsigned int i = 0; i < 4; ++i)
              v[i] = node_of[tetrahedron[i]];
            const unsigned int inside = add_node(mean(v), true);
            for (const auto &order : corners)
              {
                const unsigned int p = v[order[0]], q = v[order[1]],
                                   r = v[order[2]], s = v[order[3]];
                // One after the other: they may add nodes
                std::array<unsigned int, 8> cell;
                cell[0] = p;
                cell[1] = middle(p, q);
                cell[2] = middle(p, r);
                cell[3] = centre({{p, q, r}});
                cell[4] = middle(p, s);
                cell[5] = centre({{p, q, s}});
                cell[6] = centre({{p, r, s}});
                cell[7] = inside;
                add_cell(cell, body.components[c].material);
              }
          }
      }

      void
      divide_columns(const unsigned int t)
      {
        const Span  span      = span_of(face_of(t));
        const auto &v         = surface.triangles[t].vertices;
        const auto &materials = body.layers[span.layer].materials;
        for (unsigned int k = 0; k < materials.size(); ++k)
          for (unsigned int i = 0; i < 3; ++i)
            {
              const unsigned int a = v[i], b = v[(i + 1) % 3],
                                 c = v[(i + 2) % 3];
              const std::array<unsigned int, 4> corner{
                {a,
                 edge_site.at(surface_edge(a, b)),
                 edge_site.at(surface_edge(a, c)),
                 first_triangle_site + t}};
              std::array<unsigned int, 8> cell;
              for (unsigned int j = 0; j < 8; ++j)
                cell[j] = node(corner[j % 4], span, k + j / 4);
              add_cell(cell, materials[k]);
            }
      }

      void
      add_quad(const std::array<unsigned int, 4> &vertices,
               const unsigned int                 tag)
      {
        if (tag == 0)
          return;
        DescribedElement<2> quad;
        quad.vertices = vertices;
        quad.tag      = tag;
        quad.number   = mesh.description.quads.size() + 1;
        mesh.description.quads.push_back(quad);
      }

      void
      name_quads()
      {
        for (unsigned int t = 0; t < surface.triangles.size(); ++t)
          {
            const auto        &face = face_of(t);
            const auto        &v    = surface.triangles[t].vertices;
            const unsigned int part = body.part(face);
            if (face.components[1] == none)
              for (unsigned int i = 0; i < 3; ++i)
                add_quad(
                  {{node(v[i], part),
                    node(edge_site.at(surface_edge(v[i], v[(i + 1) % 3])),
                         part),
                    node(edge_site.at(surface_edge(v[i], v[(i + 2) % 3])),
                         part),
                    node(first_triangle_site + t, part)}},
                  face.boundary);
          }
        for (const auto &[edge, site] : edge_site)
          {
            const unsigned int c = surface.curve(edge);
            if (c == none || body.curves[c].ids.strip.empty())
              continue;
            const Span  span  = edge_span.at(edge);
            const auto &strip = body.curves[c].ids.strip;
            for (const unsigned int end : {edge.first, edge.second})
              for (unsigned int k = 0; k < strip.size(); ++k)
                add_quad({{node(end, span, k),
                           node(site, span, k),
                           node(end, span, k + 1),
                           node(site, span, k + 1)}},
                         strip[k]);
          }
      }

      void
      add_line(const unsigned int a, const unsigned int b, const unsigned tag)
      {
        DescribedElement<1> line;
        line.vertices = {{a, b}};
        line.tag      = tag;
        line.number   = mesh.description.lines.size() + 1;
        mesh.description.lines.push_back(line);
      }

      void
      name_lines()
      {
        for (const auto &[edge, site] : edge_site)
          {
            const unsigned int c = surface.curve(edge);
            if (c != none)
              for (const auto &[part, tag] : body.curves[c].ids.lines)
                for (const unsigned int end : {edge.first, edge.second})
                  add_line(node(end, part), node(site, part), tag);
          }
        std::map<unsigned int, unsigned int> corner; // vertex of a node
        for (unsigned int v = 0; v < surface.vertices.size(); ++v)
          if (surface.vertices[v].on == SurfaceMesh::Vertex::On::corner)
            corner[surface.vertices[v].index] = v;
        for (const auto &[old_node, tags] : body.through)
          for (const auto &[edge, span] : edge_span)
            {
              const unsigned int v = corner.at(old_node);
              if (edge.first != v && edge.second != v)
                continue;
              for (unsigned int k = 0; k < tags.size(); ++k)
                if (tags[k] != 0)
                  add_line(node(v, span, k), node(v, span, k + 1), tags[k]);
              break;
            }
        for (const auto &[name, place] : body.points)
          mesh.description.points[name] =
            node(corner.at(place.node), place.part);
      }

      void
      take_over_names()
      {
        MeshDescription<3> &fresh = mesh.description;
        fresh.curves              = old.curves;
        fresh.surfaces            = old.surfaces;
        fresh.regions             = old.regions;
        for (std::size_t v = 0; v < fresh.vertices.size(); ++v)
          fresh.vertex_numbers.push_back(v + 1);
      }
    };
  } // namespace



  HexMesh
  divide_into_hexahedra(const SurfaceMesh                  &surface,
                        const std::vector<FilledComponent> &filled,
                        const MeshDescription<3>           &old)
  {
    return Division(surface, filled, old).mesh;
  }
} // namespace alveolus
