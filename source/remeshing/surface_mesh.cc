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
    /** Cosine between a triangle and what it was. */
    constexpr double largest_turn = 0.5;
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
} // namespace alveolus
