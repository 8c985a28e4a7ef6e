// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/mesh/quad_optimiser.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    // Of the vertices 0, 1, 2, 3 the neighbours after and before, anticlockwise
    constexpr unsigned int next[] = {1, 3, 0, 2}, last[] = {2, 0, 3, 1};

    /** Vertices with the cells around them and the neighbours on edges. */
    struct Stars
    {
      std::vector<std::vector<unsigned int>> cells, neighbours;

      Stars(const std::size_t n_vertices, const std::vector<Quad> &quads)
        : cells(n_vertices)
        , neighbours(n_vertices)
      {
        for (unsigned int c = 0; c < quads.size(); ++c)
          for (unsigned int v = 0; v < 4; ++v)
            {
              cells[quads[c][v]].push_back(c);
              neighbours[quads[c][v]].push_back(quads[c][next[v]]);
              neighbours[quads[c][v]].push_back(quads[c][last[v]]);
            }
        for (auto &list : neighbours)
          {
            std::sort(list.begin(), list.end());
            list.erase(std::unique(list.begin(), list.end()), list.end());
          }
      }
    };
  } // namespace



  double
  scaled_jacobian(const std::vector<Point<2>> &vertices, const Quad &quad)
  {
    double smallest = 1.;
    for (unsigned int v = 0; v < 4; ++v)
      {
        const Tensor<1, 2> a = vertices[quad[next[v]]] - vertices[quad[v]];
        const Tensor<1, 2> b = vertices[quad[last[v]]] - vertices[quad[v]];
        const double       lengths = a.norm() * b.norm();
        if (!(lengths > 0.))
          return -1.;
        smallest = std::min(smallest, (a[0] * b[1] - a[1] * b[0]) / lengths);
      }
    return smallest;
  }



  void
  pillow(std::vector<Point<2>>           &vertices,
         std::vector<Quad>               &quads,
         std::vector<bool>               &fixed,
         const std::vector<unsigned int> &cells)
  {
    // Edges of the cells, anticlockwise around each; inner ones come twice
    std::set<std::pair<unsigned int, unsigned int>> edges;
    std::map<unsigned int, Tensor<1, 2>>            sums; // of cell centres
    std::map<unsigned int, unsigned int>            n_around;
    for (const unsigned int c : cells)
      {
        Tensor<1, 2> centre;
        for (const unsigned int v : quads[c])
          centre += 0.25 * vertices[v];
        for (unsigned int v = 0; v < 4; ++v)
          {
            edges.emplace(quads[c][v], quads[c][next[v]]);
            sums[quads[c][v]] += centre;
            ++n_around[quads[c][v]];
          }
      }
    std::map<unsigned int, unsigned int> copies;
    const auto                           copy_of = [&](const unsigned int v) {
      const auto entry = copies.emplace(v, vertices.size());
      if (entry.second)
        {
          vertices.emplace_back(
            0.5 * (sums[v] / n_around[v] + Tensor<1, 2>(vertices[v])));
          fixed.push_back(false);
        }
      return entry.first->second;
    };
    std::vector<Quad> ring;
    for (const auto &[a, b] : edges)
      if (edges.count({b, a}) == 0)
        {
          // in this order whatever the compiler makes of a list
          const unsigned int c = copy_of(a), d = copy_of(b);
          ring.push_back({{a, b, c, d}});
        }
    for (const unsigned int c : cells)
      for (unsigned int &v : quads[c])
        if (copies.count(v) != 0)
          v = copies[v];
    quads.insert(quads.end(), ring.begin(), ring.end());
  }



  unsigned int
  divide_flat_corners(std::vector<Point<2>> &vertices,
                      std::vector<Quad>     &quads,
                      std::vector<bool>     &fixed,
                      const double           least_sine)
  {
    const Stars               stars(vertices.size(), quads);
    std::vector<unsigned int> flat;
    for (unsigned int c = 0; c < quads.size(); ++c)
      for (unsigned int v = 0; v < 4; ++v)
        {
          const unsigned int corner = quads[c][v];
          if (!fixed[corner] || stars.cells[corner].size() != 1)
            continue;
          const Tensor<1, 2> a = vertices[quads[c][next[v]]] - vertices[corner];
          const Tensor<1, 2> b = vertices[quads[c][last[v]]] - vertices[corner];
          const double       sine =
            (a[0] * b[1] - a[1] * b[0]) / (a.norm() * b.norm());
          if (sine < least_sine && (a * b < 0. || sine < 0.))
            {
              flat.push_back(c);
              break;
            }
        }
    for (const unsigned int c : flat)
      pillow(vertices, quads, fixed, {c});
    return flat.size();
  }



  double
  optimise_quads(std::vector<Point<2>>   &vertices,
                 const std::vector<Quad> &quads,
                 const std::vector<bool> &fixed,
                 const double             good_quality,
                 const unsigned int       n_smoothing,
                 const unsigned int       n_sweeps)
  {
    const Stars stars(vertices.size(), quads);
    const auto  quality_around = [&](const unsigned int v) {
      double smallest = 1.;
      for (const unsigned int c : stars.cells[v])
        smallest = std::min(smallest, scaled_jacobian(vertices, quads[c]));
      return smallest;
    };
    // Moves v if that is better (or good enough); tells whether it did.
    const auto try_place =
      [&](const unsigned int v, const Point<2> &place, const double least) {
        const Point<2> old = vertices[v];
        vertices[v]        = place;
        if (quality_around(v) > least)
          return true;
        vertices[v] = old;
        return false;
      };

    for (unsigned int sweep = 0; sweep < n_smoothing; ++sweep)
      for (unsigned int v = 0; v < vertices.size(); ++v)
        if (!fixed[v] && !stars.neighbours[v].empty())
          {
            Point<2> mean;
            for (const unsigned int w : stars.neighbours[v])
              mean += vertices[w] / double(stars.neighbours[v].size());
            try_place(v, mean, std::min(quality_around(v), good_quality));
          }

    for (unsigned int sweep = 0; sweep < n_sweeps; ++sweep)
      {
        bool moved = false;
        for (unsigned int v = 0; v < vertices.size(); ++v)
          {
            if (fixed[v] || stars.cells[v].empty())
              continue;
            double best = quality_around(v);
            if (best >= good_quality)
              continue;
            double step = 0.;
            for (const unsigned int w : stars.neighbours[v])
              step += 0.25 * vertices[w].distance(vertices[v]) /
                      stars.neighbours[v].size();
            const double smallest_step = 1e-3 * step;
            while (step > smallest_step)
              {
                bool           better = false;
                const Point<2> centre = vertices[v];
                for (unsigned int direction = 0; direction < 8; ++direction)
                  {
                    const double angle =
                      0.25 * numbers::PI * static_cast<double>(direction);
                    if (try_place(v,
                                  centre + Point<2>(step * std::cos(angle),
                                                    step * std::sin(angle)),
                                  best))
                      {
                        best   = quality_around(v);
                        better = true;
                      }
                  }
                moved |= better;
                if (!better)
                  step *= 0.5;
              }
          }
        if (!moved)
          break;
      }

    double smallest = 1.;
    for (const Quad &quad : quads)
      smallest = std::min(smallest, scaled_jacobian(vertices, quad));
    return smallest;
  }
} // namespace alveolus
