// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
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
    /** Cosine between a triangle and what it was. */
    constexpr double largest_turn = 0.5;

    /** So that round-off decides nothing. */
    long
    quantised(const double ratio)
    {
      return std::lround(1e7 * ratio);
    }
  } // namespace



  SurfaceMesh::SurfaceMesh(const SmoothBody &smooth)
    : body(smooth)
    , n_curve_edges(smooth.body.curves.size(), 0)
  {
    const BodySurface &old = body.body;
    vertices.resize(old.n_nodes());
    std::vector<unsigned int> patch(old.n_nodes(), none), curve(patch);
    std::vector<double>       u(old.n_nodes(), 0.);
    for (const auto &triangle : body.triangles)
      for (const unsigned int v : triangle.nodes)
        patch[v] = triangle.patch;
    for (unsigned int c = 0; c < old.curves.size(); ++c)
      {
        const auto &nodes = old.curves[c].nodes;
        for (unsigned int i = 0; i < nodes.size(); ++i)
          if (old.corners.count(nodes[i]) == 0 &&
              !(old.curves[c].closed && i + 1 == nodes.size()))
            {
              curve[nodes[i]] = c;
              u[nodes[i]]     = i;
            }
        n_curve_edges[c] = nodes.size() - 1;
        for (unsigned int i = 0; i + 1 < nodes.size(); ++i)
          curve_of[surface_edge(nodes[i], nodes[i + 1])] = c;
      }
    for (unsigned int v = 0; v < vertices.size(); ++v)
      {
        Vertex &vertex = vertices[v];
        if (old.corners.count(v) != 0)
          {
            vertex.on    = Vertex::On::corner;
            vertex.index = v;
          }
        else if (curve[v] != none)
          {
            vertex.on    = Vertex::On::curve;
            vertex.index = curve[v];
            vertex.u     = u[v];
          }
        else
          {
            vertex.on    = Vertex::On::patch;
            vertex.index = patch[v];
          }
        vertex.size = body.sizes[v];
        for (unsigned int p = 0; p < old.is_in.size(); ++p)
          {
            vertex.x.push_back(old.places[p][v]);
            vertex.is_in.push_back(old.is_in[p][v]);
          }
      }
    around.resize(vertices.size());
    for (unsigned int t = 0; t < body.triangles.size(); ++t)
      {
        const auto &triangle = body.triangles[t];
        add_triangle({triangle.nodes, triangle.patch});
        for (unsigned int i = 0; i < 3; ++i)
          {
            Vertex &vertex = vertices[triangle.nodes[i]];
            if (vertex.on == Vertex::On::patch)
              {
                vertex.place.triangle   = t;
                vertex.place.weights    = {{0., 0., 0.}};
                vertex.place.weights[i] = 1.;
              }
          }
      }
  }



  void
  SurfaceMesh::add_triangle(const Triangle &triangle)
  {
    for (const unsigned int v : triangle.vertices)
      around[v].push_back(triangles.size());
    triangles.push_back(triangle);
    alive.push_back(true);
  }



  void
  SurfaceMesh::remove_triangle(const unsigned int t)
  {
    alive[t] = false;
    for (const unsigned int v : triangles[t].vertices)
      around[v].erase(std::find(around[v].begin(), around[v].end(), t));
  }



  std::vector<unsigned int>
  SurfaceMesh::triangles_at(const SurfaceEdge &edge) const
  {
    std::vector<unsigned int> result;
    for (const unsigned int t : around[edge.first])
      if (std::count(triangles[t].vertices.begin(),
                     triangles[t].vertices.end(),
                     edge.second) != 0)
        result.push_back(t);
    return result;
  }



  unsigned int
  SurfaceMesh::curve(const SurfaceEdge &edge) const
  {
    const auto entry = curve_of.find(edge);
    return entry == curve_of.end() ? none : entry->second;
  }



  std::vector<SurfaceEdge>
  SurfaceMesh::all_edges() const
  {
    std::set<SurfaceEdge> edges;
    for (unsigned int t = 0; t < triangles.size(); ++t)
      if (alive[t])
        for (unsigned int i = 0; i < 3; ++i)
          edges.insert(surface_edge(triangles[t].vertices[i],
                                    triangles[t].vertices[(i + 1) % 3]));
    return {edges.begin(), edges.end()};
  }



  SurfaceMesh::Vertex
  SurfaceMesh::curve_vertex(const unsigned int c, const double u) const
  {
    const auto &curve = body.body.curves[c];
    Vertex      vertex;
    vertex.on    = Vertex::On::curve;
    vertex.index = c;
    vertex.u     = u;
    vertex.size  = body.size_on_curve(c, u);
    vertex.x.resize(body.body.is_in.size());
    vertex.is_in.assign(body.body.is_in.size(), false);
    for (const unsigned int part : curve.parts)
      {
        vertex.x[part]     = body.on_curve(c, u, part);
        vertex.is_in[part] = true;
      }
    return vertex;
  }



  SurfaceMesh::Vertex
  SurfaceMesh::patch_vertex(const unsigned int patch, const Point<3> &x) const
  {
    Vertex vertex;
    vertex.on    = Vertex::On::patch;
    vertex.index = patch;
    vertex.place = body.nearest(patch, x);
    vertex.size  = body.size_on_patch(vertex.place);
    vertex.x.resize(body.body.is_in.size());
    vertex.is_in.assign(body.body.is_in.size(), false);
    for (const unsigned int part : body.parts_of(patch))
      {
        vertex.x[part]     = body.on_patch(vertex.place, part);
        vertex.is_in[part] = true;
      }
    return vertex;
  }



  double
  SurfaceMesh::parameter(const Vertex      &vertex,
                         const unsigned int c,
                         const double       u) const
  {
    const auto  &curve = body.body.curves[c];
    const double n     = curve.nodes.size() - 1;
    if (vertex.on == Vertex::On::corner)
      {
        const bool first = curve.nodes.front() == vertex.index;
        const bool last  = curve.nodes.back() == vertex.index;
        return first && (!last || u < 0.5 * n) ? 0. : n;
      }
    if (!curve.closed)
      return vertex.u;
    return vertex.u + n * std::round((u - vertex.u) / n);
  }



  // Halfway between a and b along the curve, or where the edges to both are as
  // long as wanted in proportion
  double
  SurfaceMesh::middle_of_curve(const unsigned int c,
                               const Vertex      &a,
                               const Vertex      &b,
                               const bool         by_size,
                               const Vertex      *at) const
  {
    double ua, ub;
    if (at != nullptr)
      {
        ua = parameter(a, c, at->u);
        ub = parameter(b, c, at->u);
      }
    else if (a.on == Vertex::On::corner && b.on == Vertex::On::corner)
      {
        ua = parameter(a, c, 0.);
        ub = parameter(b, c, 0.);
      }
    else if (a.on == Vertex::On::corner)
      {
        ub = b.u;
        ua = parameter(a, c, ub);
      }
    else
      {
        ua = a.u;
        ub = parameter(b, c, ua);
      }
    double part = 0.5;
    if (by_size)
      {
        const double la = 0.5 * (a.size + at->size),
                     lb = 0.5 * (b.size + at->size);
        part            = la / (la + lb);
      }
    const double sa = body.arc_length(c, ua), sb = body.arc_length(c, ub);
    return body.parameter(c, sa + part * (sb - sa));
  }



  SurfaceMesh::Vertex
  SurfaceMesh::middle(const SurfaceEdge &edge) const
  {
    const unsigned int c = curve(edge);
    const Vertex      &a = vertices[edge.first], &b = vertices[edge.second];
    if (c != none)
      return curve_vertex(c, middle_of_curve(c, a, b, false));
    const auto         at    = triangles_at(edge);
    const unsigned int patch = triangles[at[0]].patch;
    const unsigned int part  = body.parts_of(patch)[0];
    return patch_vertex(patch,
                        Point<3>(0.5 * (a.x[part] + Tensor<1, 3>(b.x[part]))));
  }



  SurfaceMesh::Vertex
  SurfaceMesh::middle(const Triangle &triangle) const
  {
    const unsigned int part = body.parts_of(triangle.patch)[0];
    Tensor<1, 3>       mean;
    for (const unsigned int v : triangle.vertices)
      mean += vertices[v].x[part] / 3.;
    return patch_vertex(triangle.patch, Point<3>(mean));
  }



  double
  SurfaceMesh::length(const unsigned int a,
                      const unsigned int b,
                      const unsigned int p) const
  {
    return vertices[a].x[p].distance(vertices[b].x[p]);
  }



  double
  SurfaceMesh::relative_length(const SurfaceEdge &edge) const
  {
    unsigned int part = none;
    for (const unsigned int t : triangles_at(edge))
      part = std::min(part, body.parts_of(triangles[t].patch)[0]);
    return length(edge.first, edge.second, part) /
           (0.5 * (vertices[edge.first].size + vertices[edge.second].size));
  }



  Tensor<1, 3>
  SurfaceMesh::area(const Triangle &triangle, const unsigned int part) const
  {
    const Point<3> &a = vertices[triangle.vertices[0]].x[part];
    return 0.5 * cross_product_3d(vertices[triangle.vertices[1]].x[part] - a,
                                  vertices[triangle.vertices[2]].x[part] - a);
  }



  std::vector<Tensor<1, 3>>
  SurfaceMesh::areas(const Triangle &triangle) const
  {
    std::vector<Tensor<1, 3>> result;
    for (const unsigned int part : body.parts_of(triangle.patch))
      result.push_back(area(triangle, part));
    return result;
  }



  bool
  SurfaceMesh::faces_as(const Triangle                  &triangle,
                        const std::vector<Tensor<1, 3>> &reference) const
  {
    const auto now = areas(triangle);
    for (unsigned int i = 0; i < now.size(); ++i)
      if (!(now[i] * reference[i] >
            largest_turn * now[i].norm() * reference[i].norm()))
        return false;
    return true;
  }



  double
  SurfaceMesh::quality(const Triangle &triangle) const
  {
    double smallest = 1.;
    for (const unsigned int part : body.parts_of(triangle.patch))
      {
        double squares = 0.;
        for (unsigned int i = 0; i < 3; ++i)
          squares += std::pow(length(triangle.vertices[i],
                                     triangle.vertices[(i + 1) % 3],
                                     part),
                              2);
        smallest =
          std::min(smallest,
                   4. * std::sqrt(3.) * area(triangle, part).norm() / squares);
      }
    return smallest;
  }



  double
  SurfaceMesh::smallest_quality() const
  {
    double smallest = 1.;
    for (unsigned int t = 0; t < triangles.size(); ++t)
      if (alive[t])
        smallest = std::min(smallest, quality(triangles[t]));
    return smallest;
  }



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
