// SPDX-License-Identifier: LGPL-2.1-or-later
// How the triangles of a SurfaceMesh change: edges are divided, joined and
// turned, and nodes moved. What they are stands in surface_mesh.cc.
#include <alveolus/remeshing/surface_mesh.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    // Botsch and Kobbelt's bounds of the length over the wanted one
    constexpr double longest = 4. / 3., shortest = 4. / 5.;

    /** So that round-off decides nothing. */
    long
    quantised(const double ratio)
    {
      return std::lround(1e7 * ratio);
    }
  } // namespace



  unsigned int
  SurfaceMesh::divide_long_edges()
  {
    unsigned int n_divided = 0;
    for (unsigned int pass = 0; pass < 10; ++pass)
      {
        std::vector<std::pair<long, SurfaceEdge>> edges;
        for (const SurfaceEdge &edge : all_edges())
          {
            const double ratio = relative_length(edge);
            if (quantised(ratio) > quantised(longest))
              edges.emplace_back(-quantised(ratio), edge);
          }
        if (edges.empty())
          break;
        std::sort(edges.begin(), edges.end());
        std::set<unsigned int> changed;
        for (const auto &entry : edges)
          {
            // The longest edge of its triangles first: not if one was divided
            const SurfaceEdge &edge = entry.second;
            const auto         at   = triangles_at(edge);
            bool               wait = at.empty();
            for (const unsigned int t : at)
              wait = wait || changed.count(t) != 0;
            if (wait)
              continue;
            const unsigned int m = vertices.size();
            const unsigned int c = curve(edge);
            vertices.push_back(middle(edge));
            around.emplace_back();
            if (c != none)
              {
                curve_of.erase(edge);
                curve_of[surface_edge(edge.first, m)]  = c;
                curve_of[surface_edge(edge.second, m)] = c;
                ++n_curve_edges[c];
              }
            for (const unsigned int t : at)
              {
                remove_triangle(t);
                for (const unsigned int end : {edge.first, edge.second})
                  {
                    Triangle half = triangles[t];
                    std::replace(half.vertices.begin(),
                                 half.vertices.end(),
                                 end,
                                 m);
                    changed.insert(triangles.size());
                    add_triangle(half);
                  }
              }
            ++n_divided;
          }
      }
    return n_divided;
  }



  // The vertex a goes to b.
  bool
  SurfaceMesh::join(const unsigned int a, const unsigned int b)
  {
    const SurfaceEdge  edge = surface_edge(a, b);
    const unsigned int c    = curve(edge);
    const Vertex      &from = vertices[a];
    if (from.on == Vertex::On::corner ||
        (from.on == Vertex::On::curve && from.index != c))
      return false;
    if (c != none)
      {
        const auto &curve = body.body.curves[c];
        const bool  loop  = curve.nodes.front() == curve.nodes.back();
        if (n_curve_edges[c] <= (loop ? 4u : 1u))
          return false;
      }
    const auto at = triangles_at(edge);
    // Only vertices of common triangles may be neighbours of both
    std::set<unsigned int> of_a, of_b, both;
    for (const unsigned int t : around[a])
      of_a.insert(triangles[t].vertices.begin(), triangles[t].vertices.end());
    for (const unsigned int t : around[b])
      of_b.insert(triangles[t].vertices.begin(), triangles[t].vertices.end());
    std::set_intersection(of_a.begin(),
                          of_a.end(),
                          of_b.begin(),
                          of_b.end(),
                          std::inserter(both, both.end()));
    if (both.size() != at.size() + 2)
      return false;
    std::vector<Triangle> fresh;
    for (const unsigned int t : around[a])
      if (std::count(at.begin(), at.end(), t) == 0)
        {
          Triangle moved = triangles[t];
          std::replace(moved.vertices.begin(), moved.vertices.end(), a, b);
          if (!faces_as(moved, areas(triangles[t])) || quality(moved) < 0.2)
            return false;
          const unsigned int part = body.parts_of(moved.patch)[0];
          for (unsigned int i = 0; i < 3; ++i)
            if (moved.vertices[i] != b &&
                length(moved.vertices[i], b, part) >
                  longest * 0.5 *
                    (vertices[moved.vertices[i]].size + vertices[b].size))
              return false;
          fresh.push_back(moved);
        }
    // A triangle with all three corners on curves of the rim of a patch would
    // be of no use where the patch is narrow; it is left to the quality.
    const std::vector<unsigned int> gone(around[a]);
    for (const unsigned int t : gone)
      remove_triangle(t);
    for (const Triangle &triangle : fresh)
      add_triangle(triangle);
    if (c != none)
      {
        // The other edge of a on the curve goes to b
        curve_of.erase(edge);
        --n_curve_edges[c];
        for (const unsigned int v : of_a)
          {
            const auto entry = curve_of.find(surface_edge(a, v));
            if (v == a || entry == curve_of.end())
              continue;
            curve_of.erase(entry);
            curve_of[surface_edge(b, v)] = c;
          }
      }
    return true;
  }



  unsigned int
  SurfaceMesh::join_short_edges()
  {
    std::vector<std::pair<long, SurfaceEdge>> edges;
    for (const SurfaceEdge &edge : all_edges())
      {
        const double ratio = relative_length(edge);
        if (quantised(ratio) < quantised(shortest))
          edges.emplace_back(quantised(ratio), edge);
      }
    std::sort(edges.begin(), edges.end());
    unsigned int n_joined = 0;
    for (const auto &entry : edges)
      {
        const SurfaceEdge &edge = entry.second;
        if (triangles_at(edge).empty() ||
            quantised(relative_length(edge)) >= quantised(shortest))
          continue;
        if (join(edge.first, edge.second) || join(edge.second, edge.first))
          ++n_joined;
      }
    return n_joined;
  }



  // Where the smaller quality of the two triangles becomes larger
  unsigned int
  SurfaceMesh::turn_edges()
  {
    unsigned int n_turned = 0;
    for (unsigned int pass = 0; pass < 10; ++pass)
      {
        bool again = false;
        for (const SurfaceEdge &edge : all_edges())
          {
            const auto at = triangles_at(edge);
            if (curve(edge) != none || at.size() != 2)
              continue;
            const Triangle a = triangles[at[0]], b = triangles[at[1]];
            unsigned int   i = 0, j = 0; // opposite of the edge
            while (a.vertices[i] == edge.first || a.vertices[i] == edge.second)
              ++i;
            while (b.vertices[j] == edge.first || b.vertices[j] == edge.second)
              ++j;
            const unsigned int p = a.vertices[i], q = b.vertices[j];
            if (!triangles_at(surface_edge(p, q)).empty())
              continue;
            // p r s and q s r become p r q and q s p
            const unsigned int r = a.vertices[(i + 1) % 3],
                               s = a.vertices[(i + 2) % 3];
            const Triangle c{{{p, r, q}}, a.patch}, d{{{q, s, p}}, a.patch};
            const double   old   = std::min(quality(a), quality(b));
            const double   fresh = std::min(quality(c), quality(d));
            if (quantised(fresh) <= quantised(old + 1e-3))
              continue;
            auto       reference = areas(a);
            const auto more      = areas(b);
            for (unsigned int k = 0; k < more.size(); ++k)
              reference[k] += more[k];
            if (!faces_as(c, reference) || !faces_as(d, reference))
              continue;
            remove_triangle(at[0]);
            remove_triangle(at[1]);
            add_triangle(c);
            add_triangle(d);
            ++n_turned;
            again = true;
          }
        if (!again)
          break;
      }
    return n_turned;
  }



  bool
  SurfaceMesh::try_place(const unsigned int v, Vertex place)
  {
    std::vector<std::vector<Tensor<1, 3>>> before;
    double                                 worst = 1.;
    for (const unsigned int t : around[v])
      {
        before.push_back(areas(triangles[t]));
        worst = std::min(worst, quality(triangles[t]));
      }
    std::swap(vertices[v], place);
    bool   good  = true;
    double fresh = 1.;
    for (unsigned int k = 0; good && k < before.size(); ++k)
      {
        const Triangle &triangle = triangles[around[v][k]];
        fresh                    = std::min(fresh, quality(triangle));
        good                     = faces_as(triangle, before[k]);
      }
    if (good && quantised(fresh) >= quantised(std::min(worst, 0.6)))
      return true;
    std::swap(vertices[v], place);
    return false;
  }



  void
  SurfaceMesh::move_vertices()
  {
    for (unsigned int v = 0; v < vertices.size(); ++v)
      {
        const Vertex vertex = vertices[v];
        if (around[v].empty() || vertex.on == Vertex::On::corner)
          continue;
        if (vertex.on == Vertex::On::curve)
          {
            std::set<unsigned int> ends;
            for (const unsigned int t : around[v])
              for (const unsigned int w : triangles[t].vertices)
                if (w != v && curve(surface_edge(v, w)) == vertex.index)
                  ends.insert(w);
            if (ends.size() == 2)
              try_place(v,
                        curve_vertex(vertex.index,
                                     middle_of_curve(vertex.index,
                                                     vertices[*ends.begin()],
                                                     vertices[*ends.rbegin()],
                                                     true,
                                                     &vertex)));
            continue;
          }
        // The centroid of the triangles around, larger where they may be larger
        const unsigned int part = body.parts_of(vertex.index)[0];
        Tensor<1, 3>       sum;
        double             weights = 0.;
        for (const unsigned int t : around[v])
          {
            double       size = 0.;
            Tensor<1, 3> centre;
            for (const unsigned int w : triangles[t].vertices)
              {
                size += vertices[w].size / 3.;
                centre += vertices[w].x[part] / 3.;
              }
            const double weight =
              area(triangles[t], part).norm() / std::pow(size, 3);
            sum += weight * centre;
            weights += weight;
          }
        const Point<3> target(sum / weights);
        if (!try_place(v, patch_vertex(vertex.index, target)))
          try_place(v,
                    patch_vertex(vertex.index,
                                 Point<3>(0.5 * (target + Tensor<1, 3>(
                                                            vertex.x[part])))));
      }
  }



  void
  SurfaceMesh::remesh(const unsigned int n_rounds)
  {
    for (unsigned int round = 0; round < n_rounds; ++round)
      {
        divide_long_edges();
        join_short_edges();
        turn_edges();
        move_vertices();
      }
    for (unsigned int round = 0; round < 5; ++round)
      {
        turn_edges();
        move_vertices();
      }
    tidy_up();
  }



  // Number the vertices and triangles that are left.
  void
  SurfaceMesh::tidy_up()
  {
    std::vector<unsigned int> number(vertices.size(), none);
    std::vector<Vertex>       kept;
    for (unsigned int v = 0; v < vertices.size(); ++v)
      if (!around[v].empty())
        {
          number[v] = kept.size();
          kept.push_back(vertices[v]);
        }
    std::vector<Triangle> left;
    for (unsigned int t = 0; t < triangles.size(); ++t)
      if (alive[t])
        {
          Triangle triangle = triangles[t];
          for (unsigned int &v : triangle.vertices)
            v = number[v];
          left.push_back(triangle);
        }
    std::map<SurfaceEdge, unsigned int> curves;
    for (const auto &entry : curve_of)
      curves[surface_edge(number[entry.first.first],
                          number[entry.first.second])] = entry.second;
    vertices = std::move(kept);
    curve_of = std::move(curves);
    triangles.clear();
    alive.clear();
    around.assign(vertices.size(), {});
    for (const Triangle &triangle : left)
      add_triangle(triangle);
  }
} // namespace alveolus
