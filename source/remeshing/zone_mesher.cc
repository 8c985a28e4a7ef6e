// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/geometry/grading.h>
#include <alveolus/mesh/best_first.h>
#include <alveolus/remeshing/zone_mesher.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Points  = std::vector<Point<2>>;
    using Indices = std::vector<unsigned int>;

    constexpr double degree = numbers::PI / 180.;

    Points
    positions_of(const GatheredMesh &mesh, const Indices &nodes)
    {
      Points result;
      for (const unsigned int node : nodes)
        result.push_back(mesh.positions[node]);
      return result;
    }

    /** Angle at b from c to a, anticlockwise, in [0, 2 pi). */
    double
    angle_between(const Point<2> &a, const Point<2> &b, const Point<2> &c)
    {
      const Tensor<1, 2> u = c - b, v = a - b;
      const double       angle = std::atan2(u[0] * v[1] - u[1] * v[0], u * v);
      return angle < 0. ? angle + 2. * numbers::PI : angle;
    }

    Points
    new_rim(const Points &old, const unsigned int n, const double end_ratio)
    {
      const CubicSpline<2> spline(old);
      const double         length = spline.length();
      // Sizes relative to the middle; their scale makes the number n.
      const auto size = [&](const double s) {
        return 1. + (end_ratio - 1.) * std::pow(2. * s / length - 1., 2);
      };
      double                 sum     = 0.;
      constexpr unsigned int samples = 2000;
      for (unsigned int i = 0; i < samples; ++i)
        sum += length / samples / size(length * (i + 0.5) / samples);
      const auto positions = graded_division(
        length, [&](const double s) { return size(s) * sum / n; }, n, n);
      Points nodes;
      for (const double s : positions)
        nodes.push_back(spline.at_arc_length(s));
      nodes.front() = old.front();
      nodes.back()  = old.back();
      return nodes;
    }

    /** Area between a line of edges and the straight line from end to end. */
    double
    area_below(const Points &points)
    {
      double area = 0.;
      for (std::size_t i = 1; i + 1 < points.size(); ++i)
        {
          const Tensor<1, 2> a = points[i] - points[0];
          const Tensor<1, 2> b = points[i + 1] - points[0];
          area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
        }
      return area;
    }

    /**
     * A lattice whose rim (side 0) has half as many edges as its cut (side 2).
     * In its last row, four columns of the cut become two:
     *
     *     t0 ---------- t1 ---------- t2
     *     |  \           |           / |
     *     |   i1 ------ i2 ------ i3   |
     *     |   |         |         |    |
     *     b0 -b1 ------ b2 ------ b3 - b4
     *
     * Cells of the rows before it come first, row by row from the rim.
     */
    AreaMesh
    halving_lattice(const std::array<Points, 4> &sides)
    {
      const unsigned int n = sides[0].size() - 1, k = sides[1].size() - 1;
      // The lattice with every second node of the cut, without its last row
      std::array<Points, 4> coarse = sides;
      coarse[2].clear();
      for (unsigned int i = 0; i <= n; ++i)
        coarse[2].push_back(sides[2][2 * i]);
      const AreaMesh upper = mesh_structured_area(coarse);

      AreaMesh mesh;
      for (const Points &side : sides)
        mesh.vertices.insert(mesh.vertices.end(), side.begin(), side.end() - 1);
      // Vertices of the coarse lattice on the cut are every second one.
      Indices index;
      for (unsigned int v = 0; v < upper.vertices.size(); ++v)
        {
          const unsigned int coarse_loop = 2 * (n + k);
          if (v < n + k)
            index.push_back(v);
          else if (v <= 2 * n + k)
            index.push_back(n + k + 2 * (v - n - k));
          else if (v < coarse_loop)
            index.push_back(v + n);
          else
            {
              index.push_back(mesh.vertices.size());
              mesh.vertices.push_back(upper.vertices[v]);
            }
        }
      for (unsigned int c = 0; c < n * (k - 1); ++c)
        {
          Quad quad = upper.quads[c];
          for (unsigned int &v : quad)
            v = index[v];
          mesh.quads.push_back(quad);
        }

      // Rows from left to right, seen from the rim: t from the last row of the
      // upper lattice, b the cut
      Indices t, b;
      for (unsigned int i = 0; i < n; ++i)
        {
          const Quad &last = upper.quads[n * (k - 1) + i];
          if (i == 0)
            t.push_back(index[last[0]]);
          t.push_back(index[last[1]]);
        }
      for (unsigned int i = 0; i <= 2 * n; ++i)
        b.push_back(n + k + 2 * n - i);
      const auto middle =
        [&](const unsigned int u, const unsigned int v, const unsigned int w) {
          const Tensor<1, 2> top =
            0.5 * (Tensor<1, 2>(mesh.vertices[u]) + mesh.vertices[v]);
          mesh.vertices.emplace_back(0.5 *
                                     (top + Tensor<1, 2>(mesh.vertices[w])));
          return static_cast<unsigned int>(mesh.vertices.size() - 1);
        };
      for (unsigned int p = 0; p < n / 2; ++p)
        {
          const unsigned int *tp = &t[2 * p], *bp = &b[4 * p];
          const unsigned int  i1 = middle(tp[0], tp[1], bp[1]);
          const unsigned int  i2 = middle(tp[1], tp[1], bp[2]);
          const unsigned int  i3 = middle(tp[1], tp[2], bp[3]);
          // In the order of the lattice: top left, top right, bottom ones
          mesh.quads.push_back({{tp[0], i1, bp[0], bp[1]}});
          mesh.quads.push_back({{i1, i2, bp[1], bp[2]}});
          mesh.quads.push_back({{i2, i3, bp[2], bp[3]}});
          mesh.quads.push_back({{i3, tp[2], bp[3], bp[4]}});
          mesh.quads.push_back({{tp[0], tp[1], i1, i2}});
          mesh.quads.push_back({{tp[1], tp[2], i2, i3}});
        }
      return mesh;
    }

    /** Tries meshes of one zone with one rim. */
    class ZoneMesher
    {
    public:
      ZoneMesher(const ZoneSettings &settings,
                 const Points       &rim,
                 const bool          nodes_kept,
                 const Points       &side_a,
                 const Points       &side_b,
                 const Points       &cut,
                 ZoneMeshes         &result)
        : settings(settings)
        , rim(rim)
        , nodes_kept(nodes_kept)
        , n(rim.size() - 1)
        , k(side_a.size() - 1)
        , n_cut(cut.size() - 1)
        , angles{{angle_between(side_a[1], rim[0], rim[1]),
                  angle_between(rim[n - 1], rim[n], side_b[1])}}
        // Around: rim, side b, cut from b to a, side a upwards
        , sides{{rim,
                 side_b,
                 Points(cut.rbegin(), cut.rend()),
                 Points(side_a.rbegin(), side_a.rend())}}
        , result(result)
      {
        for (const Points &side : sides)
          loop.insert(loop.end(), side.begin(), side.end() - 1);
      }

      /** Lattices, plain and with rings of cells. */
      void
      try_lattices()
      {
        const bool halving = 2 * n == n_cut && n % 2 == 0 && k > 2;
        if (n != n_cut && !halving)
          return;
        AreaMesh lattice =
          halving ? halving_lattice(sides) : mesh_structured_area(sides);
        const std::string  kind = halving ? "halved lattice" : "lattice";
        const unsigned int rows = halving ? k - 1 : k;
        add_pillowed(lattice, {}, kind);
        for (const unsigned int extent : {1u, 2u, 3u})
          {
            std::vector<Indices> blocks;
            for (const unsigned int corner : {0u, 1u})
              if (angles[corner] > obtuse && 2 * extent <= n && extent < rows)
                blocks.push_back(block(corner, extent, extent));
            if (!blocks.empty())
              add_pillowed(lattice,
                           blocks,
                           kind + " with rings of " + std::to_string(extent) +
                             " at corners");
          }
        if (std::max(angles[0], angles[1]) > obtuse)
          for (unsigned int q = 1; q < std::min(rows, 5u); ++q)
            add_pillowed(lattice,
                         {block(0, n, q)},
                         kind + " with a ring of " + std::to_string(q) +
                           " along the rim");
      }

      /** A mesh by gmsh, flat corners divided. */
      void
      try_gmsh(const MeshingJob &job)
      {
        PlanarArea area;
        area.name   = job.name;
        area.growth = settings.growth;
        AreaMesh candidate;
        try
          {
            candidate =
              mesh_unstructured_area(area, {loop}, settings.mesher, job);
          }
        catch (const RunError &)
          {
            ++result.n_tried; // lattices are still there
            ++result.n_invalid;
            return;
          }
        std::vector<Indices> blocks;
        for (const unsigned int c : {0u, 1u})
          {
            Indices around; // the corner; the loop begins with the rim
            for (unsigned int q = 0; q < candidate.quads.size(); ++q)
              if (std::count(candidate.quads[q].begin(),
                             candidate.quads[q].end(),
                             c == 0 ? 0 : n) != 0)
                around.push_back(q);
            if (angles[c] > settings.angle_of_two_cells && around.size() == 1)
              blocks.push_back(around);
          }
        if (blocks.empty())
          add(std::move(candidate), "gmsh");
        else
          add_pillowed(candidate, blocks, "gmsh with rings at corners");
      }

    private:
      /** Beyond this angle a second cell at a corner may be worth it. */
      static constexpr double obtuse = 110. * degree;

      const ZoneSettings         &settings;
      const Points                rim;
      const bool                  nodes_kept;
      const unsigned int          n, k, n_cut;
      const std::array<double, 2> angles; ///< at side a and side b
      const std::array<Points, 4> sides;
      Points                      loop;
      ZoneMeshes                 &result;

      /** Cells of the first q rows from the rim, p of each next to a corner. */
      Indices
      block(const unsigned int corner,
            const unsigned int p,
            const unsigned int q) const
      {
        Indices cells;
        for (unsigned int j = 0; j < q; ++j)
          for (unsigned int i = 0; i < p; ++i)
            cells.push_back(j * n + (corner == 0 ? i : n - 1 - i));
        return cells;
      }

      void
      add_pillowed(AreaMesh                    candidate,
                   const std::vector<Indices> &blocks,
                   const std::string          &how)
      {
        std::vector<bool> fixed(candidate.vertices.size(), false);
        std::fill(fixed.begin(), fixed.begin() + loop.size(), true);
        for (const Indices &cells : blocks)
          pillow(candidate.vertices, candidate.quads, fixed, cells);
        candidate.quality = optimise_quads(candidate.vertices,
                                           candidate.quads,
                                           fixed,
                                           settings.mesher.good_quality,
                                           10,
                                           100);
        add(std::move(candidate), how);
      }

      void
      add(AreaMesh candidate, const std::string &how)
      {
        ++result.n_tried;
        ZoneMesh entry;
        entry.mesh       = std::move(candidate);
        entry.rim        = rim;
        entry.nodes_kept = nodes_kept;
        bool flat        = false;
        for (const unsigned int c : {0u, 1u})
          {
            entry.corners[c].angle = angles[c];
            for (const Quad &quad : entry.mesh.quads)
              entry.corners[c].n_cells +=
                std::count(quad.begin(), quad.end(), c == 0 ? 0 : n);
            flat |= angles[c] > settings.angle_of_two_cells &&
                    entry.corners[c].n_cells < 2;
          }
        if (!(entry.mesh.quality > 0.))
          ++result.n_invalid;
        else if (flat)
          ++result.n_flat;
        else
          {
            std::ostringstream text;
            text << how << " of quality " << std::setprecision(3)
                 << entry.mesh.quality << ", " << n << " edges on the rim, "
                 << k << " on the sides, corners of "
                 << std::lround(angles[0] / degree) << " and "
                 << std::lround(angles[1] / degree) << " degrees with "
                 << entry.corners[0].n_cells << " and "
                 << entry.corners[1].n_cells << " cells";
            entry.description = text.str();
            entry.mesh.remark = entry.description;
            result.meshes.push_back(std::move(entry));
          }
      }
    };
  } // namespace



  ZoneMeshes
  mesh_zone(const GatheredMesh &mesh,
            const StripZone    &zone,
            const ZoneSettings &settings,
            const MeshingJob   &job)
  {
    const Points old_rim = positions_of(mesh, zone.rim);
    const Points cut     = positions_of(mesh, zone.cut);
    ZoneMeshes   result;
    for (const unsigned int n_rim : settings.rim_edges)
      {
        const unsigned int n = n_rim == 0 ? old_rim.size() - 1 : n_rim;
        if ((n + cut.size() - 1) % 2 != 0)
          continue; // no quads for an odd number of edges around
        const Points rim =
          n_rim == 0 ? old_rim : new_rim(old_rim, n, settings.rim_end_ratio);
        if (std::abs(area_below(rim) - area_below(old_rim)) >
            settings.largest_area_change)
          {
            result.too_coarse.push_back(n);
            continue;
          }
        ZoneMesher mesher(settings,
                          rim,
                          n_rim == 0,
                          positions_of(mesh, zone.side_a),
                          positions_of(mesh, zone.side_b),
                          cut,
                          result);
        mesher.try_lattices();
        // Lattices are preferred: gmsh is asked where they are not good.
        const bool good = std::any_of(result.meshes.begin(),
                                      result.meshes.end(),
                                      [&](const ZoneMesh &entry) {
                                        return entry.mesh.quality >=
                                               settings.mesher.good_quality;
                                      });
        if (!good)
          mesher.try_gmsh(n_rim == 0 ? job : job.part(std::to_string(n_rim)));
      }
    sort_best_first(result.meshes,
                    [](const ZoneMesh &entry) { return entry.mesh.quality; });
    return result;
  }
} // namespace alveolus
