// SPDX-License-Identifier: LGPL-2.1-or-later
// Wanted edge lengths on a SmoothBody: by old edges, curvature, and distance.
#include <alveolus/remeshing/smooth_body.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  // Normal curvature in the directions of the edges of the faces, by the turn
  // of the fitted normals
  std::vector<double>
  SmoothBody::curvatures() const
  {
    std::vector<double> result(body.n_nodes(), 0.);
    for (const auto &face : body.faces)
      for (const unsigned int part : patch_parts[face.patch])
        for (unsigned int i = 0; i < 4; ++i)
          {
            const auto        &normal = normals.at({face.patch, part});
            const auto        &x      = body.places[part];
            const unsigned int a = face.nodes[i], b = face.nodes[(i + 1) % 4];
            // Of a plane 0 in spite of round-off, unlike the arc cosine
            const double turn =
              2. * std::asin(
                     std::min(1., 0.5 * (normal.at(a) - normal.at(b)).norm()));
            for (const unsigned int v : {a, b})
              result[v] = std::max(result[v], turn / x[a].distance(x[b]));
          }
    return result;
  }



  void
  SmoothBody::set_sizes(const double factor,
                        const double smallest,
                        const double largest,
                        const double growth,
                        const double largest_turn)
  {
    const unsigned int                    n = body.n_nodes();
    std::map<SurfaceEdge, double>         lengths;
    std::vector<double>                   sum(n, 0.);
    std::vector<unsigned int>             count(n, 0);
    std::vector<std::vector<SurfaceEdge>> neighbours(n);
    for (const auto &face : body.faces)
      for (unsigned int i = 0; i < 4; ++i)
        {
          const unsigned int a = face.nodes[i], b = face.nodes[(i + 1) % 4];
          const auto        &x = body.places[body.part(face)];
          if (lengths.emplace(surface_edge(a, b), x[a].distance(x[b])).second)
            for (const unsigned int v : {a, b})
              {
                sum[v] += x[a].distance(x[b]);
                ++count[v];
              }
        }
    sizes.assign(n, 0.);
    const std::vector<double> curvature = curvatures();
    for (unsigned int v = 0; v < n; ++v)
      {
        double wanted = factor * sum[v] / count[v];
        if (largest_turn < curvature[v] * wanted)
          wanted = largest_turn / curvature[v];
        sizes[v] = std::min(largest, std::max(smallest, wanted));
      }
    // Within each part: all pairs, since the way may lead through the inside
    for (unsigned int p = 0; p < body.is_in.size(); ++p)
      {
        const std::vector<double> before(sizes);
        for (unsigned int i = 0; i < n; ++i)
          if (body.is_in[p][i])
            for (unsigned int j = 0; j < n; ++j)
              if (body.is_in[p][j] && before[j] < sizes[i])
                sizes[i] =
                  std::min(sizes[i],
                           before[j] + growth * body.places[p][i].distance(
                                                  body.places[p][j]));
      }
  }
} // namespace alveolus
