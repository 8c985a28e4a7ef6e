// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/area_mesher.h>
#include <alveolus/mesh/msh_reader.h>
#include <alveolus/mesh/strip_mesh.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Points  = std::vector<Point<2>>;
    using Indices = std::vector<unsigned int>;

    /** Decimals [mm] of the coordinates the mesher gets. */
    constexpr double rounding = 1e9;

    /** Node sizes within this factor share a field of the mesher. */
    constexpr double size_class = 1.1;

    double
    rounded(const double x)
    {
      return std::round(x * rounding) / rounding;
    }

    double
    smallest_quality(const AreaMesh &mesh)
    {
      double smallest = 1.;
      for (const Quad &quad : mesh.quads)
        smallest = std::min(smallest, scaled_jacobian(mesh.vertices, quad));
      return smallest;
    }

    /** Turn all cells round if they are seen from behind. One by one would hide
     * that a cell is inverted. */
    void
    orient(AreaMesh &mesh)
    {
      double area = 0.;
      for (const Quad &quad : mesh.quads)
        for (const auto &[a, b] :
             {std::make_pair(0, 1), {1, 3}, {3, 2}, {2, 0}})
          area += mesh.vertices[quad[a]][0] * mesh.vertices[quad[b]][1] -
                  mesh.vertices[quad[a]][1] * mesh.vertices[quad[b]][0];
      if (area < 0.)
        for (Quad &quad : mesh.quads)
          std::swap(quad[1], quad[2]);
    }

    /**
     * The node of a loop, 0 or 1, from which on every second one goes to the
     * mesher. The others end up in the middle of its edges: those where the
     * loop turns less.
     */
    unsigned int
    start_of(const Points &loop)
    {
      const std::size_t n = loop.size();
      double turns[2]     = {0., 0.}; // sums of squares at even, odd nodes
      for (std::size_t i = 0; i < n; ++i)
        {
          const Tensor<1, 2> a = loop[i] - loop[(i + n - 1) % n];
          const Tensor<1, 2> b = loop[(i + 1) % n] - loop[i];
          const double turn    = std::atan2(a[0] * b[1] - a[1] * b[0], a * b);
          turns[i % 2] += turn * turn;
        }
      return turns[1] > turns[0] * (1. + 1e-9) ? 1 : 0;
    }

    /**
     * Gmsh's script of an area whose boundary is every second node. The wanted
     * edge length at x is the smallest over the boundary nodes i of
     * s_i + growth |x - x_i|, where s_i is the edge length there.
     */
    std::string
    script(const PlanarArea          &area,
           const std::vector<Points> &loops,
           const Indices             &starts,
           const PlanarMesherOptions &options)
    {
      std::ostringstream points, lines, surface;
      points.precision(17);
      // No name in it: what is text elsewhere would be a command here.
      points << "// An area, lengths in mm.\n";
      std::map<int, std::vector<unsigned int>> classes; // of node sizes
      unsigned int                             n_points = 0;
      for (std::size_t l = 0; l < loops.size(); ++l)
        {
          const Points      &loop  = loops[l];
          const unsigned int first = n_points + 1;
          const std::size_t  n     = loop.size() / 2;
          for (std::size_t i = 0; i < n; ++i)
            {
              const auto coarse = [&](const std::size_t k) {
                return loop[starts[l] + 2 * (k % n)];
              };
              const Point<2> p = coarse(i);
              ++n_points;
              points << "Point(" << n_points << ") = {" << rounded(p[0]) << ", "
                     << rounded(p[1]) << ", 0};\n";
              lines << "Line(" << n_points << ") = {" << n_points << ", "
                    << (i + 1 < n ? n_points + 1 : first) << "};\n";
              const double size = 0.5 * (p.distance(coarse(i + 1)) +
                                         p.distance(coarse(i + n - 1)));
              classes[std::lround(std::log(size) / std::log(size_class))]
                .push_back(n_points);
            }
          lines << "Transfinite Curve {" << first << ":" << n_points
                << "} = 2;\n"
                << "Curve Loop(" << l + 1 << ") = {" << first << ":" << n_points
                << "};\n";
          surface << (l == 0 ? "" : ", ") << l + 1;
        }

      double extent = 0.; // an edge is never longer than the area
      for (const Point<2> &p : loops[0])
        extent = std::max(extent, p.distance(loops[0][0]));
      const double largest_size = std::min(area.largest_size, extent);

      std::ostringstream geo;
      geo.precision(10);
      geo << points.str() << lines.str() << "Plane Surface(1) = {"
          << surface.str() << "};\nRecombine Surface {1};\n"
          << "Physical Surface(\"area\") = {1};\n";
      unsigned int       field = 0;
      std::ostringstream thresholds;
      for (const auto &entry : classes)
        {
          const double size =
            options.size_factor * std::pow(size_class, entry.first);
          const double largest =
            std::max(size, 2. * options.size_factor * largest_size);
          geo << "Field[" << field + 1 << "] = Distance;\nField[" << field + 1
              << "].PointsList = {";
          for (std::size_t i = 0; i < entry.second.size(); ++i)
            geo << (i == 0 ? "" : ", ") << entry.second[i];
          // Quads are as large as their coarse ones: twice the edge, so that
          // the growth doubles too.
          geo << "};\nField[" << field + 2 << "] = Threshold;\nField["
              << field + 2 << "].InField = " << field + 1 << ";\nField["
              << field + 2 << "].SizeMin = " << size << ";\nField[" << field + 2
              << "].SizeMax = " << largest << ";\nField[" << field + 2
              << "].DistMin = 0;\nField[" << field + 2 << "].DistMax = "
              << std::max(1e-6, (largest - size) / (2. * area.growth)) << ";\n";
          thresholds << (field == 0 ? "" : ", ") << field + 2;
          field += 2;
        }
      geo << "Field[" << field + 1 << "] = Min;\nField[" << field + 1
          << "].FieldsList = {" << thresholds.str()
          << "};\nBackground Field = " << field + 1 << ";\n"
          << "Mesh.MeshSizeExtendFromBoundary = 0;\n"
          << "Mesh.MeshSizeFromPoints = 0;\n"
          << "Mesh.Algorithm = " << options.algorithm << ";\n"
          << "Mesh.Smoothing = " << options.smoothing << ";\n"
          << "Mesh.RecombinationAlgorithm = 1;\n"
          << "Mesh.SubdivisionAlgorithm = 1;\n"
          << "Mesh.RandomSeed = 1;\n"
          << "Mesh.RandomFactor = 1e-9;\n"
          << "Mesh.ElementOrder = 1;\n"
          << "Mesh.SaveAll = 0;\n"
          << "Mesh.Binary = 0;\n";
      return geo.str();
    }

    /** Vertices at the boundary of a mesh of quads. */
    std::vector<bool>
    at_boundary(const MeshDescription<2> &mesh)
    {
      std::map<std::pair<unsigned int, unsigned int>, unsigned int> n_cells;
      for (const auto &cell : mesh.cells)
        {
          const auto &v = cell.vertices;
          for (const auto &edge : {std::minmax(v[0], v[1]),
                                   std::minmax(v[1], v[3]),
                                   std::minmax(v[3], v[2]),
                                   std::minmax(v[2], v[0])})
            ++n_cells[edge];
        }
      std::vector<bool> result(mesh.vertices.size(), false);
      for (const auto &entry : n_cells)
        if (entry.second == 1)
          result[entry.first.first] = result[entry.first.second] = true;
      return result;
    }

    /**
     * The mesher's vertices at the boundary become the nodes of the loops (in
     * this order at the beginning of the vertices), which they are near to.
     */
    AreaMesh
    fitted(const MeshDescription<2>  &raw,
           const std::vector<Points> &loops,
           const Indices             &starts)
    {
      AreaMesh              mesh;
      std::vector<Point<2>> expected;
      double                shortest = std::numeric_limits<double>::max();
      for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t i = 0; i < loops[l].size(); ++i)
          {
            const Points     &loop = loops[l];
            const std::size_t n    = loop.size();
            mesh.vertices.push_back(loop[i]);
            const Point<2> &next = loop[(i + 1) % n];
            if (i % 2 == starts[l])
              {
                expected.push_back(loop[i]);
                shortest = std::min(shortest, loop[i].distance(next));
              }
            else
              expected.push_back(
                Point<2>(0.5 * (loop[(i + n - 1) % n] + Tensor<1, 2>(next))));
          }
      std::vector<std::pair<double, unsigned int>> by_x;
      for (unsigned int i = 0; i < expected.size(); ++i)
        by_x.emplace_back(expected[i][0], i);
      std::sort(by_x.begin(), by_x.end());

      const double            tolerance = 1e-4 * shortest;
      const std::vector<bool> outer     = at_boundary(raw);
      constexpr unsigned int  none = std::numeric_limits<unsigned int>::max();
      Indices                 index(raw.vertices.size(), none);
      std::size_t             n_found = 0;
      for (unsigned int v = 0; v < raw.vertices.size(); ++v)
        if (outer[v])
          {
            const Point<2> &p = raw.vertices[v];
            for (auto entry =
                   std::lower_bound(by_x.begin(),
                                    by_x.end(),
                                    std::make_pair(p[0] - tolerance, 0u));
                 entry != by_x.end() && entry->first <= p[0] + tolerance;
                 ++entry)
              if (expected[entry->second].distance(p) <= tolerance)
                index[v] = entry->second;
            n_found += index[v] != none;
            if (index[v] == none)
              throw RunError("mesher", "it changed the boundary", "");
          }
      if (n_found != expected.size())
        throw RunError("mesher", "it left out nodes of the boundary", "");
      for (unsigned int v = 0; v < raw.vertices.size(); ++v)
        if (index[v] == none)
          {
            index[v] = mesh.vertices.size();
            mesh.vertices.push_back(raw.vertices[v]);
          }
      for (const auto &cell : raw.cells)
        {
          Quad quad;
          for (unsigned int v = 0; v < 4; ++v)
            quad[v] = index[cell.vertices[v]];
          mesh.quads.push_back(quad);
        }
      return mesh;
    }

    std::string
    described(const PlanarMesherOptions &options)
    {
      std::ostringstream text;
      text << "algorithm " << options.algorithm << ", smoothing "
           << options.smoothing << ", size factor " << options.size_factor;
      return text.str();
    }
  } // namespace



  AreaMesh
  mesh_structured_area(const std::array<Points, 4> &sides)
  {
    const unsigned int n = sides[0].size() - 1, m = sides[1].size() - 1;
    AssertThrow(sides[2].size() == n + 1 && sides[3].size() == m + 1,
                ExcMessage("Opposite sides differ"));
    // Sides seen from bottom left: bottom, right, top, left
    const auto bottom = [&](const unsigned int i) { return sides[0][i]; };
    const auto right  = [&](const unsigned int j) { return sides[1][j]; };
    const auto top    = [&](const unsigned int i) { return sides[2][n - i]; };
    const auto left   = [&](const unsigned int j) { return sides[3][m - j]; };

    AreaMesh mesh;
    for (const Points &side : sides)
      mesh.vertices.insert(mesh.vertices.end(), side.begin(), side.end() - 1);
    for (unsigned int j = 1; j < m; ++j)
      for (unsigned int i = 1; i < n; ++i)
        {
          const double x = double(i) / n, y = double(j) / m;
          mesh.vertices.emplace_back(
            (1. - y) * bottom(i) + y * top(i) + (1. - x) * left(j) +
            x * right(j) - (1. - x) * (1. - y) * bottom(0) -
            x * (1. - y) * bottom(n) - (1. - x) * y * top(0) - x * y * top(n));
        }
    const auto index = [n, m](const unsigned int i, const unsigned int j) {
      if (j == 0)
        return i;
      if (i == n)
        return n + j;
      if (j == m)
        return n + m + n - i;
      if (i == 0)
        return n + m + n + m - j;
      return 2 * (n + m) + (j - 1) * (n - 1) + i - 1;
    };
    for (unsigned int j = 0; j < m; ++j)
      for (unsigned int i = 0; i < n; ++i)
        mesh.quads.push_back({{index(i, j),
                               index(i + 1, j),
                               index(i, j + 1),
                               index(i + 1, j + 1)}});
    orient(mesh); // the loop may run either way round
    mesh.quality = smallest_quality(mesh);
    mesh.remark  = "structured";
    return mesh;
  }



  AreaMesh
  mesh_capped_area(const std::array<Points, 4>       &sides,
                   const std::array<unsigned int, 2> &caps,
                   const std::string                 &name)
  {
    Strip strip;
    strip.bottom = sides[0];
    strip.right  = sides[1];
    strip.top.assign(sides[2].rbegin(), sides[2].rend());
    strip.left.assign(sides[3].rbegin(), sides[3].rend());
    strip.caps           = caps;
    strip.n_across       = sides[1].size() - 1 + 2 * caps[1];
    const StripMesh made = mesh_strip(strip, name);

    // From the strip's order of the border to that of the loop
    AreaMesh                  mesh;
    std::vector<unsigned int> index(made.n_border);
    const auto                add = [&](const auto begin, const auto end) {
      for (auto i = begin; i != end; ++i)
        {
          index[*i] = mesh.vertices.size();
          mesh.vertices.push_back(made.vertices[*i]);
        }
    };
    add(made.bottom.begin(), made.bottom.end() - 1);
    add(made.right.begin(), made.right.end() - 1);
    add(made.top.rbegin(), made.top.rend() - 1);
    add(made.left.rbegin(), made.left.rend() - 1);
    mesh.vertices.insert(mesh.vertices.end(),
                         made.vertices.begin() + made.n_border,
                         made.vertices.end());
    mesh.quads = made.quads;
    for (Quad &quad : mesh.quads)
      for (auto &v : quad)
        if (v < made.n_border)
          v = index[v];
    orient(mesh); // the loop may run either way round
    mesh.quality = smallest_quality(mesh);
    mesh.remark  = "structured";
    return mesh;
  }



  AreaMesh
  mesh_unstructured_area(const PlanarArea          &area,
                         const std::vector<Points> &loops,
                         const PlanarMesher        &mesher,
                         const MeshingJob          &job)
  {
    AreaMesh     best;
    std::string  failure;
    unsigned int n_runs = 0, n_boundary = 0;
    Indices      starts;
    for (const Points &loop : loops)
      {
        if (loop.size() % 2 != 0)
          throw RunError(job.where,
                         "the boundary of the area '" + area.name +
                           "' has an odd number of edges",
                         "no mesh of quads has: add or remove one");
        n_boundary += loop.size();
        starts.push_back(start_of(loop));
      }
    for (const PlanarMesherOptions &options : mesher.attempts)
      {
        const MeshingJob attempt =
          ++n_runs == 1 ? job : job.part(std::to_string(n_runs));
        AreaMesh candidate;
        try
          {
            const std::string text = run_gmsh(
              script(area, loops, starts, options), 2, mesher.gmsh, attempt);
            MeshDescription<2> raw;
            try
              {
                raw = read_msh<2>(text, attempt.name + ".msh");
              }
            catch (const InputError &error)
              {
                // e.g. a triangle that was left: no fault of the user
                throw RunError(job.where, error.what(), "");
              }
            candidate = fitted(raw, loops, starts);
          }
        catch (const RunError &error)
          {
            failure = error.what();
            continue;
          }
        orient(candidate);
        std::vector<bool> fixed(candidate.vertices.size(), false);
        std::fill(fixed.begin(), fixed.begin() + n_boundary, true);
        const unsigned int n_divided = divide_flat_corners(candidate.vertices,
                                                           candidate.quads,
                                                           fixed,
                                                           mesher.good_quality);
        candidate.quality            = optimise_quads(candidate.vertices,
                                           candidate.quads,
                                           fixed,
                                           mesher.good_quality);
        candidate.remark             = described(options);
        if (n_divided > 0)
          candidate.remark +=
            ", " + std::to_string(n_divided) + " flat corners divided";
        if (best.quads.empty() || candidate.quality > best.quality)
          best = std::move(candidate);
        if (best.quality >= mesher.good_quality)
          break;
      }
    if (best.quads.empty() || !(best.quality > 0.))
      throw RunError(job.where,
                     "no valid mesh of quads of the area '" + area.name +
                       "' is found in " + std::to_string(n_runs) + " attempts" +
                       (failure.empty() ? "" : " (" + failure + ")"),
                     "change the sizes of its edges a little");
    best.n_mesher_runs = n_runs;
    return best;
  }
} // namespace alveolus
