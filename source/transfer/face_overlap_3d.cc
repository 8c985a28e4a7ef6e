// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/box_tree.h>
#include <alveolus/geometry/convex_overlap.h>
#include <alveolus/transfer/face_overlap.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Corners = std::array<Point<3>, 4>;

    /** A quadrilateral in space as a plane one, and what is near it. */
    struct PlaneQuad
    {
      explicit PlaneQuad(const Corners &corners)
        : normal(0.5 * cross_product_3d(corners[2] - corners[0],
                                        corners[3] - corners[1]))
        , area(normal.norm())
        , size(std::sqrt(area))
      {
        normal /= area;
        for (const Point<3> &corner : corners)
          centre += corner / 4.;
        tangents[0] = corners[1] + corners[2] - corners[0] - corners[3];
        tangents[0] -= (tangents[0] * normal) * normal;
        tangents[0] /= tangents[0].norm();
        tangents[1] = cross_product_3d(normal, tangents[0]);
      }

      /** Corners in this one's plane. */
      ConvexPiece<2>
      project(const Corners &corners) const
      {
        ConvexPiece<2> piece;
        for (unsigned int k = 0; k < 4; ++k)
          for (unsigned int d = 0; d < 2; ++d)
            piece.corners[k][d] = (corners[k] - centre) * tangents[d];
        return piece;
      }

      /**
       * Whether @p other may be the same part of a surface: within a cell of
       * it, and turned by less than 60 degrees, which no two cells of a
       * smooth surface are that lie on each other, but the other wall of a
       * thin gap is.
       */
      bool
      lies_along(const PlaneQuad &other) const
      {
        return normal * other.normal > 0.5 &&
               std::abs((other.centre - centre) * normal) <=
                 std::max(size, other.size);
      }

      Tensor<1, 3>                normal;
      double                      area, size;
      Point<3>                    centre;
      std::array<Tensor<1, 3>, 2> tangents;
    };
  } // namespace



  template <>
  FaceOverlap<3>::FaceOverlap(const Configuration<3> &old_configuration,
                              const FaceHistory<3>   &old_history)
    : n_points(old_history.n_points)
    , n_components(old_history.n_components)
  {
    const NodalVector x = old_configuration.positions();
    unsigned int      first_own;
    faces   = gather_faces(old_configuration, old_history, x, x, first_own);
    surface = std::make_unique<BoundarySurface>(faces, n_points, n_components);
  }



  template <>
  FaceTransferReport
  FaceOverlap<3>::transfer(const Configuration<3> &new_configuration,
                           FaceHistory<3>         &new_history) const
  {
    const NodalVector x = new_configuration.positions();
    unsigned int      first_own;
    auto              new_faces =
      gather_faces(new_configuration, new_history, x, x, first_own);
    if (new_history.n_points != n_points ||
        new_history.n_components != n_components ||
        faces.empty() != new_faces.empty())
      throw RunError("Transfer",
                     "the new boundary history has other points, components or "
                     "boundaries than the old one",
                     "remeshing must keep the names of boundaries");
    const BoundarySurface new_surface(new_faces, n_points, n_components);

    std::vector<PlaneQuad>       old;
    std::vector<BoxTree<3>::Box> boxes;
    for (unsigned int s = 0; s < surface->n_subs(); ++s)
      {
        old.emplace_back(surface->places(s));
        boxes.push_back(BoxTree<3>::around(surface->places(s), 4));
      }
    const BoxTree<3> tree(boxes);
    const auto       values = [&](auto &of, const unsigned int s) {
      return of[s / n_points].values.data() + s % n_points * n_components;
    };

    FaceTransferReport report;
    report.moved = true;
    std::vector<unsigned int>                    near;
    std::vector<std::pair<unsigned int, double>> pieces;
    for (unsigned int s = 0; s < new_surface.n_subs(); ++s)
      {
        const Corners        corners = new_surface.places(s);
        const PlaneQuad      quad(corners);
        const ConvexPiece<2> own = quad.project(corners);
        BoxTree<3>::Box      box = BoxTree<3>::around(corners, 4);
        box.extend(quad.size);
        tree.meeting(box, near);
        double sum = 0.;
        pieces.clear();
        for (const unsigned int o : near)
          if (quad.lies_along(old[o]))
            {
              const double part =
                overlap(own, quad.project(surface->places(o))).volume;
              if (part > 0.)
                pieces.emplace_back(o, part);
              sum += part;
            }
        // Beyond the rim of the old surface, but for the round-off of edges
        // that touch: the nearest one that is close
        if (sum < 1e-6 * quad.area)
          {
            unsigned int nearest = numbers::invalid_unsigned_int;
            for (const unsigned int o : near)
              if (quad.lies_along(old[o]) &&
                  (nearest == numbers::invalid_unsigned_int ||
                   old[o].centre.distance(quad.centre) <
                     old[nearest].centre.distance(quad.centre)))
                nearest = o;
            if (nearest == numbers::invalid_unsigned_int)
              {
                std::ostringstream found;
                found << "a new boundary is not along the old one that carries "
                         "history near ("
                      << quad.centre << ") mm";
                throw RunError("Transfer",
                               found.str(),
                               "let the new mesh follow the surface more "
                               "closely, e.g. with smaller elements");
              }
            pieces = {{nearest, 1.}};
            sum    = 1.;
            ++report.n_beyond;
          }

        const auto largest = std::max_element(pieces.begin(),
                                              pieces.end(),
                                              [](const auto &a, const auto &b) {
                                                return a.second < b.second;
                                              });
        report.largest_distance =
          std::max(report.largest_distance,
                   std::abs((old[largest->first].centre - quad.centre) *
                            quad.normal));
        // One old value plus differences: constants stay exactly.
        double       *result = values(new_faces, s);
        const double *first  = values(faces, pieces[0].first);
        std::copy(first, first + n_components, result);
        for (const auto &[o, part] : pieces)
          for (unsigned int c = 0; c < n_components; ++c)
            result[c] += part / sum * (values(faces, o)[c] - first[c]);
      }
    report.length_before = surface->integrate(false, report.integral_before);
    report.length_after  = new_surface.integrate(false, report.integral_after);
    for (unsigned int f = 0; f < new_history.faces().size(); ++f)
      std::copy(new_faces[first_own + f].values.begin(),
                new_faces[first_own + f].values.end(),
                new_history.old_record(f, 0));
    return report;
  }
} // namespace alveolus
