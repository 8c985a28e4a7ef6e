// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/strip_mesh.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Points  = std::vector<Point<2>>;
    using Indices = std::vector<unsigned int>;

    /** Position at the fraction @p s of the segments of a side. */
    Point<2>
    along(const Points &side, const double s)
    {
      const double       x = s * (side.size() - 1);
      const unsigned int i =
        std::min<unsigned int>(static_cast<unsigned int>(x), side.size() - 2);
      return side[i] + (x - i) * (side[i + 1] - side[i]);
    }

    /** Columns, in multiples of the quads across, that an end's shape moves. */
    constexpr unsigned int reach = 2;

    /** Inner vertices of worse cells are moved. */
    constexpr double good_quality = 0.7;
  } // namespace



  StripMesh
  mesh_strip(const Strip &strip, const std::string &name)
  {
    const unsigned int n = strip.n_across, m = strip.bottom.size() - 1;
    const std::array<const Points *, 2> ends{{&strip.left, &strip.right}};
    for (unsigned int e = 0; e < 2; ++e)
      if (2 * strip.caps[e] >= n ||
          ends[e]->size() - 1 != n - 2 * strip.caps[e])
        throw RunError("mesh of " + name,
                       "an end has " + std::to_string(ends[e]->size() - 1) +
                         " segments with " + std::to_string(n) +
                         " quads across and a cap of " +
                         std::to_string(strip.caps[e]),
                       "");
    if (strip.top.size() != m + 1)
      throw RunError("mesh of " + name,
                     "its long sides have " + std::to_string(m) + " and " +
                       std::to_string(strip.top.size() - 1) + " segments",
                     "");

    StripMesh  mesh;
    const auto add = [&](const Point<2> &p) {
      mesh.vertices.push_back(p);
      return static_cast<unsigned int>(mesh.vertices.size() - 1);
    };
    for (const auto &p : strip.bottom)
      mesh.bottom.push_back(add(p));
    for (const auto &p : strip.top)
      mesh.top.push_back(add(p));
    for (unsigned int e = 0; e < 2; ++e)
      {
        Indices &side = e == 0 ? mesh.left : mesh.right;
        side.push_back(e == 0 ? mesh.bottom.front() : mesh.bottom.back());
        for (unsigned int j = 1; j + 1 < ends[e]->size(); ++j)
          side.push_back(add((*ends[e])[j]));
        side.push_back(e == 0 ? mesh.top.front() : mesh.top.back());
      }
    mesh.n_border = mesh.vertices.size();

    // Lattice of m columns and n rows. At an end without cap its last column
    // is the end; at one with a cap it is the border of the core, bent to the
    // corners.
    const auto line = [](const Points &side, const double y) {
      return (1. - y) * side.front() + y * Tensor<1, 2>(side.back());
    };
    const auto interpolated = [&](const double x, const double y) {
      // What an end departs from a straight line fades out along the strip.
      const auto weight = [&](const double columns) {
        return std::max(0., 1. - columns / std::min(m, reach * n));
      };
      return Point<2>(
        (1. - y) * along(strip.bottom, x) +
        y * Tensor<1, 2>(along(strip.top, x)) +
        weight(x * m) * (along(strip.left, y) - line(strip.left, y)) +
        weight((1. - x) * m) * (along(strip.right, y) - line(strip.right, y)));
    };
    std::vector<Indices> lattice(m + 1, Indices(n + 1));
    for (unsigned int i = 0; i <= m; ++i)
      {
        lattice[i][0] = mesh.bottom[i];
        lattice[i][n] = mesh.top[i];
        for (unsigned int j = 1; j < n; ++j)
          {
            const bool         at_left = i == 0, at_end = i == 0 || i == m;
            const unsigned int cap = at_end ? strip.caps[at_left ? 0 : 1] : 0;
            if (at_end && cap == 0)
              {
                lattice[i][j] = (at_left ? mesh.left : mesh.right)[j];
                continue;
              }
            double x = static_cast<double>(i) / m;
            if (at_end)
              {
                // Layers of the cap as thick as half a column
                const double depth =
                  0.5 * std::min({j, n - j, cap}) / (cap * m);
                x += at_left ? depth : -depth;
              }
            lattice[i][j] = add(interpolated(x, static_cast<double>(j) / n));
          }
      }
    for (unsigned int i = 0; i < m; ++i)
      for (unsigned int j = 0; j < n; ++j)
        mesh.quads.push_back({{lattice[i][j],
                               lattice[i + 1][j],
                               lattice[i][j + 1],
                               lattice[i + 1][j + 1]}});

    for (unsigned int e = 0; e < 2; ++e)
      {
        const unsigned int k = strip.caps[e];
        if (k == 0)
          continue;
        const Indices     &column = lattice[e == 0 ? 0 : m];
        const Indices     &end    = e == 0 ? mesh.left : mesh.right;
        const unsigned int r      = n - 2 * k;
        // Layers from the core (0) to the end (k)
        std::vector<Indices> layer(k + 1, Indices(r + 1));
        for (unsigned int l = 0; l <= k; ++l)
          for (unsigned int j = 0; j <= r; ++j)
            if (l == 0)
              layer[l][j] = column[k + j];
            else if (l == k)
              layer[l][j] = end[j];
            else if (j == 0)
              layer[l][j] = column[k - l];
            else if (j == r)
              layer[l][j] = column[n - k + l];
            else
              {
                const double   s = static_cast<double>(l) / k;
                const Point<2> p =
                  mesh.vertices[column[k + j]] +
                  s * (mesh.vertices[end[j]] - mesh.vertices[column[k + j]]);
                layer[l][j] = add(p);
              }
        for (unsigned int l = 0; l < k; ++l)
          for (unsigned int j = 0; j < r; ++j)
            {
              Quad quad{{layer[l][j],
                         layer[l + 1][j],
                         layer[l][j + 1],
                         layer[l + 1][j + 1]}};
              if (e == 0)
                quad = {{quad[1], quad[0], quad[3], quad[2]}};
              mesh.quads.push_back(quad);
            }
      }
    std::vector<bool> fixed(mesh.vertices.size(), false);
    std::fill(fixed.begin(), fixed.begin() + mesh.n_border, true);
    optimise_quads(mesh.vertices, mesh.quads, fixed, good_quality);
    return mesh;
  }
} // namespace alveolus
