// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/geometry/convex_overlap.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    double
    cross(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    /** Each clip by a half-plane adds at most one corner: 4 + 4. */
    struct Polygon
    {
      std::array<Tensor<1, 2>, 9> corners;
      unsigned int                n = 0;
    };

    /** About the origin, by the fan of triangles at the first corner. */
    Moments<2>
    polygon_moments(const Polygon &polygon)
    {
      Moments<2> result;
      for (unsigned int i = 1; i + 1 < polygon.n; ++i)
        {
          const double area =
            0.5 * cross(polygon.corners[i] - polygon.corners[0],
                        polygon.corners[i + 1] - polygon.corners[0]);
          result.volume += area;
          result.first +=
            area / 3. *
            (polygon.corners[0] + polygon.corners[i] + polygon.corners[i + 1]);
        }
      // Touching edges may leave a sliver of either sign.
      return result.volume > 0. ? result : Moments<2>();
    }

    using Tetrahedron = std::array<Tensor<1, 3>, 4>;

    double
    signed_volume(const Tetrahedron &t)
    {
      return (t[1] - t[0]) * cross_product_3d(t[2] - t[0], t[3] - t[0]) / 6.;
    }

    void
    add_moments(const Tetrahedron &t, Moments<3> &sum)
    {
      // The parts of a cut tetrahedron come in either orientation.
      const double volume = std::abs(signed_volume(t));
      sum.volume += volume;
      sum.first += 0.25 * volume * (t[0] + t[1] + t[2] + t[3]);
    }

    /** A point of each face of @p t and its normal, of any length, inwards. */
    void
    faces(const Tetrahedron           &t,
          std::array<Tensor<1, 3>, 4> &origin,
          std::array<Tensor<1, 3>, 4> &normal)
    {
      for (unsigned int f = 0; f < 4; ++f)
        {
          origin[f] = t[(f + 1) % 4];
          normal[f] = cross_product_3d(t[(f + 2) % 4] - origin[f],
                                       t[(f + 3) % 4] - origin[f]);
          if ((t[f] - origin[f]) * normal[f] < 0.)
            normal[f] *= -1.;
        }
    }

    /** Whether @p other is beyond one of the faces of @p t. */
    bool
    separates(const Tetrahedron           &t,
              const Tetrahedron           &other,
              std::array<Tensor<1, 3>, 4> &origin,
              std::array<Tensor<1, 3>, 4> &normal)
    {
      faces(t, origin, normal);
      for (unsigned int f = 0; f < 4; ++f)
        {
          bool beyond = true;
          for (unsigned int i = 0; i < 4 && beyond; ++i)
            beyond = (other[i] - origin[f]) * normal[f] <= 0.;
          if (beyond)
            return true;
        }
      return false;
    }

    /**
     * Clip @p t with the half-spaces lambda_i >= 0, i = face, ..., 3, of the
     * barycentric coordinates lambda_i = (x - origin[i]) . normal[i], and add
     * what remains.
     */
    void
    clip(const Tetrahedron                 &t,
         const std::array<Tensor<1, 3>, 4> &origin,
         const std::array<Tensor<1, 3>, 4> &normal,
         const unsigned int                 face,
         Moments<3>                        &sum)
    {
      if (face == 4)
        {
          add_moments(t, sum);
          return;
        }
      std::array<double, 4>       height;
      std::array<unsigned int, 4> order; // inside ones first
      unsigned int                n_inside = 0, n_outside = 0;
      for (unsigned int i = 0; i < 4; ++i)
        {
          height[i] = (t[i] - origin[face]) * normal[face];
          if (height[i] >= 0.)
            order[n_inside++] = i;
          else
            order[3 - n_outside++] = i;
        }
      const auto cut = [&](const unsigned int i, const unsigned int j) {
        const unsigned int a = order[i], b = order[j];
        const double       s = height[a] / (height[a] - height[b]);
        return t[a] + s * (t[b] - t[a]);
      };
      const auto corner = [&](const unsigned int i) { return t[order[i]]; };
      const auto go_on  = [&](const Tensor<1, 3> &a,
                             const Tensor<1, 3> &b,
                             const Tensor<1, 3> &c,
                             const Tensor<1, 3> &d) {
        clip({{a, b, c, d}}, origin, normal, face + 1, sum);
      };
      // A prism with the triangles a and b is three tetrahedra.
      const auto prism = [&](const std::array<Tensor<1, 3>, 3> &a,
                             const std::array<Tensor<1, 3>, 3> &b) {
        go_on(a[0], a[1], a[2], b[0]);
        go_on(b[0], a[1], a[2], b[1]);
        go_on(b[0], b[1], a[2], b[2]);
      };
      switch (n_inside)
        {
          case 0:
            break;
          case 1:
            go_on(corner(0), cut(0, 1), cut(0, 2), cut(0, 3));
            break;
          case 2:
            prism({{corner(0), cut(0, 2), cut(0, 3)}},
                  {{corner(1), cut(1, 2), cut(1, 3)}});
            break;
          case 3:
            prism({{corner(0), corner(1), corner(2)}},
                  {{cut(0, 3), cut(1, 3), cut(2, 3)}});
            break;
          default:
            clip(t, origin, normal, face + 1, sum);
        }
    }
  } // namespace

  template <>
  Moments<2>
  moments(const ConvexPiece<2> &piece)
  {
    Polygon polygon;
    polygon.n = piece.n_corners;
    for (unsigned int i = 0; i < piece.n_corners; ++i)
      polygon.corners[i] = piece.corners[i] - piece.corners[0];
    return polygon_moments(polygon);
  }

  template <>
  Moments<3>
  moments(const ConvexPiece<3> &piece)
  {
    Tetrahedron t;
    for (unsigned int i = 0; i < 4; ++i)
      t[i] = piece.corners[i] - piece.corners[0];
    Moments<3> result;
    add_moments(t, result);
    return result;
  }

  template <>
  Moments<2>
  overlap(const ConvexPiece<2> &a, const ConvexPiece<2> &b)
  {
    // Relative to one corner: round-off is then relative to the body's size.
    Polygon current, next;
    current.n = a.n_corners;
    for (unsigned int i = 0; i < a.n_corners; ++i)
      current.corners[i] = a.corners[i] - a.corners[0];

    for (unsigned int e = 0; e < b.n_corners && current.n > 0; ++e)
      {
        const Tensor<1, 2> begin = b.corners[e] - a.corners[0];
        const Tensor<1, 2> edge =
          b.corners[(e + 1) % b.n_corners] - b.corners[e];
        next.n                = 0;
        Tensor<1, 2> previous = current.corners[current.n - 1];
        double       h        = cross(edge, previous - begin);
        for (unsigned int i = 0; i < current.n; ++i)
          {
            const Tensor<1, 2> &x   = current.corners[i];
            const double        h_x = cross(edge, x - begin);
            if ((h_x >= 0.) != (h >= 0.) && next.n < next.corners.size())
              next.corners[next.n++] =
                previous + h / (h - h_x) * (x - previous);
            if (h_x >= 0. && next.n < next.corners.size())
              next.corners[next.n++] = x;
            previous = x;
            h        = h_x;
          }
        std::swap(current, next);
      }
    return polygon_moments(current);
  }

  template <>
  Moments<3>
  overlap(const ConvexPiece<3> &a, const ConvexPiece<3> &b)
  {
    Tetrahedron t;
    for (unsigned int i = 0; i < 4; ++i)
      t[i] = a.corners[i] - a.corners[0];

    Tetrahedron other;
    for (unsigned int i = 0; i < 4; ++i)
      other[i] = b.corners[i] - a.corners[0];

    // Most pairs that are found are apart: a face of one of them tells.
    std::array<Tensor<1, 3>, 4> origin, normal;
    if (separates(t, other, origin, normal) ||
        separates(other, t, origin, normal))
      return {};
    Moments<3> result;
    clip(t, origin, normal, 0, result);
    return result;
  }
} // namespace alveolus
