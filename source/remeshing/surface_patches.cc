// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remeshing/surface_patches.h>

#include <deal.II/base/tensor.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = BodySurface::none;

    class PatchFinder
    {
    public:
      PatchFinder(BodySurface                                    &body,
                  const std::map<SurfaceEdge, BodySurface::Edge> &edges,
                  const double                                    corner_angle)
        : body(body)
        , edges(edges)
        , corner_angle(corner_angle)
      {
        find_patches();
        find_curves();
      }

    private:
      BodySurface                                    &body;
      const std::map<SurfaceEdge, BodySurface::Edge> &edges;
      const double                                    corner_angle;
      std::set<SurfaceEdge> inner_edges; ///< of patches

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
        for (const auto &entry : edges)
          if (!is_feature(entry.second))
            inner_edges.insert(entry.first);
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



  void
  divide_into_patches(BodySurface                                    &body,
                      const std::map<SurfaceEdge, BodySurface::Edge> &edges,
                      const double corner_angle)
  {
    PatchFinder(body, edges, corner_angle);
  }
} // namespace alveolus
