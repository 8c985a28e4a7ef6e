// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remeshing/hex_optimiser.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    class Optimiser
    {
    public:
      Optimiser(HexMesh &mesh, const SurfaceMesh &surface, const double good)
        : mesh(mesh)
        , surface(surface)
        , good(good)
        , x(mesh.description.vertices)
        , cells_of(x.size())
      {
        for (unsigned int c = 0; c < mesh.description.cells.size(); ++c)
          for (unsigned int k = 0; k < 8; ++k)
            {
              const unsigned int v = mesh.description.cells[c].vertices[k];
              cells_of[v].emplace_back(c, k);
            }
        for (unsigned int v = 0; v < x.size(); ++v)
          if (mesh.is_inside[v])
            inside.push_back({v, corners_changed_by({v})});
        for (unsigned int s = 0; s < mesh.sliders.size(); ++s)
          {
            std::vector<unsigned int> nodes;
            for (const auto &node : mesh.sliders[s].nodes)
              nodes.push_back(node.node);
            sliding.push_back({s, corners_changed_by(nodes)});
          }
      }

      /** The smallest values of all corners. */
      HexQuality
      smallest() const
      {
        HexQuality result;
        for (unsigned int c = 0; c < mesh.description.cells.size(); ++c)
          for (unsigned int k = 0; k < 8; ++k)
            {
              const HexQuality is = corner(c, k);
              result.jacobian     = std::min(result.jacobian, is.jacobian);
              result.shape        = std::min(result.shape, is.shape);
            }
        return result;
      }

      /** @return the largest motion relative to the edges */
      bool
      sweep()
      {
        bool moved = false;
        for (const Movable &movable : sliding)
          moved = slide(movable) || moved;
        for (const Movable &movable : inside)
          moved = move(movable) || moved;
        return moved;
      }

    private:
      using Corners = std::vector<std::pair<unsigned int, unsigned int>>;
      struct Movable
      {
        unsigned int index;
        Corners      corners;
      };

      HexMesh               &mesh;
      const SurfaceMesh     &surface;
      const double           good;
      std::vector<Point<3>> &x;
      std::vector<Corners>   cells_of;
      std::vector<Movable>   inside, sliding;

      /** Corners at the nodes, and at the other ends of their edges. */
      Corners
      corners_changed_by(const std::vector<unsigned int> &nodes) const
      {
        std::set<std::pair<unsigned int, unsigned int>> result;
        for (const unsigned int v : nodes)
          for (const auto &[c, k] : cells_of[v])
            for (const unsigned int bit : {0u, 1u, 2u, 4u})
              result.emplace(c, k ^ bit);
        return {result.begin(), result.end()};
      }

      /** Cells of layers are thin; they have no node inside a part. */
      bool
      is_thin(const unsigned int c) const
      {
        return !mesh.is_inside[mesh.description.cells[c].vertices[7]];
      }

      HexQuality
      corner(const unsigned int c, const unsigned int k) const
      {
        const auto        &v  = mesh.description.cells[c].vertices;
        const Point<3>    &at = x[v[k]];
        const Tensor<1, 3> a = x[v[k ^ 1]] - at, b = x[v[k ^ 2]] - at,
                           d = x[v[k ^ 4]] - at;
        // Towards smaller coordinates edges point the other way
        const int    sign = ((k ^ (k >> 1) ^ (k >> 2)) & 1) != 0 ? -1 : 1;
        const double aa = a.norm_square(), bb = b.norm_square(),
                     dd      = d.norm_square();
        const double lengths = std::sqrt(aa * bb * dd);
        if (!(lengths > 0.))
          return {-1., -1.};
        const double det  = sign * (cross_product_3d(a, b) * d);
        const double size = std::cbrt(det);
        return {det / lengths,
                is_thin(c)
                  ? 1.
                  : std::copysign(3. * size * size / (aa + bb + dd), det)};
      }

      double
      badness(const Corners &corners) const
      {
        double sum = 0.;
        for (const auto &[c, k] : corners)
          {
            const HexQuality is = corner(c, k);
            for (const double value : {is.jacobian, is.shape})
              if (value < good)
                sum += std::pow(good - value, 4);
          }
        return sum;
      }

      /** Mean length of the edges at a node. */
      double
      edge_length(const unsigned int v) const
      {
        double sum = 0.;
        for (const auto &[c, k] : cells_of[v])
          for (const unsigned int bit : {1u, 2u, 4u})
            sum +=
              x[v].distance(x[mesh.description.cells[c].vertices[k ^ bit]]);
        return sum / (3. * cells_of[v].size());
      }

      /** Down the slope of badness as a function of the place. */
      template <class Put>
      bool
      descend(const Corners                   &corners,
              const Point<3>                  &start,
              const std::vector<Tensor<1, 3>> &directions,
              const double                     length,
              const Put                       &put)
      {
        const double before = badness(corners);
        if (before < 1e-12)
          return false;
        Tensor<1, 3> slope;
        const double eps = 1e-4 * length;
        for (const Tensor<1, 3> &e : directions)
          {
            put(start + eps * e);
            const double ahead = badness(corners);
            put(start - eps * e);
            slope += (ahead - badness(corners)) * e;
          }
        put(start);
        if (!(slope.norm() > 0.))
          return false;
        slope /= -slope.norm();
        for (double step = 0.2 * length; step > 2e-3 * length; step *= 0.5)
          {
            put(start + step * slope);
            if (badness(corners) < (1. - 1e-3) * before)
              return true;
          }
        put(start);
        return false;
      }

      bool
      move(const Movable &movable)
      {
        static const std::vector<Tensor<1, 3>> axes{Point<3>::unit_vector(0),
                                                    Point<3>::unit_vector(1),
                                                    Point<3>::unit_vector(2)};
        const unsigned int                     v     = movable.index;
        const Point<3>                         start = x[v];
        return descend(movable.corners,
                       start,
                       axes,
                       edge_length(v),
                       [&](const Point<3> &place) { x[v] = place; });
      }

      bool
      slide(const Movable &movable)
      {
        HexMesh::Slider          &slider = mesh.sliders[movable.index];
        const SurfaceMesh::Vertex before = slider.vertex;
        const unsigned int        part = surface.body.parts_of(before.index)[0];
        if (badness(movable.corners) < 1e-12)
          return false;
        const auto put_vertex = [&](const SurfaceMesh::Vertex &vertex) {
          slider.vertex = vertex;
          for (const auto &node : slider.nodes)
            x[node.node] = slider.place(node, vertex);
        };
        // The plane of the old triangle is near enough to the tangent plane
        const auto  &triangle = surface.body.triangles[before.place.triangle];
        const auto  &old      = surface.body.body.places[part];
        Tensor<1, 3> e1       = old[triangle.nodes[1]] - old[triangle.nodes[0]];
        const Tensor<1, 3> n =
          cross_product_3d(e1, old[triangle.nodes[2]] - old[triangle.nodes[0]]);
        e1 /= e1.norm();
        const Tensor<1, 3> e2 = cross_product_3d(n / n.norm(), e1);
        const bool         moved =
          descend(movable.corners,
                  before.x[part],
                  {e1, e2},
                  edge_length(slider.nodes[0].node),
                  [&](const Point<3> &place) {
                    put_vertex(surface.patch_vertex(before.index, place));
                  });
        if (!moved)
          put_vertex(before); // to the last bit
        return moved;
      }
    };
  } // namespace



  HexOptimiserReport
  optimise_hexahedra(HexMesh           &mesh,
                     const SurfaceMesh &surface,
                     const double       good,
                     const unsigned int n_sweeps)
  {
    Optimiser          optimiser(mesh, surface, good);
    HexOptimiserReport report;
    report.before = optimiser.smallest();
    while (report.n_sweeps < n_sweeps)
      {
        ++report.n_sweeps;
        if (!optimiser.sweep())
          break;
      }
    report.after = optimiser.smallest();
    return report;
  }
} // namespace alveolus
