// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/face_overlap.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Where a point is on the old curves. */
    struct Place
    {
      unsigned int curve    = 0;
      double       length   = 0.; ///< arc length from the begin of the curve
      double       distance = std::numeric_limits<double>::max();
      double       edge     = 0.; ///< chord of the old edge
    };

    /** Integrals by component, with the records as they are. */
    void
    integrate(const EdgeMap                    &map,
              const std::vector<double>        &breaks,
              const std::vector<BoundaryEdge>  &edges,
              const std::vector<BoundaryCurve> &curves,
              const unsigned int                n_components,
              std::vector<double>              &integral,
              double                           &length)
    {
      const unsigned int n = breaks.size() - 1;
      integral.assign(n_components, 0.);
      length = 0.;
      // In the order of the curves, not of the processes.
      for (const auto &curve : curves)
        for (const auto &link : curve.links)
          for (unsigned int q = 0; q < n; ++q)
            {
              const BoundaryEdge &edge = edges[link.edge];
              const double        l =
                map.length(edge.before, breaks[q], breaks[q + 1]);
              length += l;
              for (unsigned int c = 0; c < n_components; ++c)
                integral[c] += l * edge.values[q * n_components + c];
            }
    }
  } // namespace

  template <>
  FaceOverlap<2>::FaceOverlap(const Configuration<2> &old_configuration,
                              const FaceHistory<2>   &old_history)
    : n_points(old_history.n_points)
    , n_components(old_history.n_components)
    , breaks(segment_breaks(n_points))
  {
    const CellNodes<2> cells(old_configuration);
    const NodalVector  x = old_configuration.positions();
    unsigned int       first_own;
    map    = std::make_unique<EdgeMap>(cells);
    edges  = gather_edges(old_configuration.dof_handler,
                         cells,
                         old_history,
                         old_configuration.initial_positions(),
                         x,
                         x,
                         first_own);
    curves = find_curves(edges);
    for (const auto &curve : curves)
      lengths.push_back(
        arc_lengths(*map, breaks, curve, edges, &BoundaryEdge::before));
  }

  template <>
  FaceTransferReport
  FaceOverlap<2>::transfer(const Configuration<2> &new_configuration,
                           FaceHistory<2>         &new_history) const
  {
    const CellNodes<2>        cells(new_configuration);
    const NodalVector         x = new_configuration.positions();
    unsigned int              first_own;
    std::vector<BoundaryEdge> new_edges =
      gather_edges(new_configuration.dof_handler,
                   cells,
                   new_history,
                   new_configuration.initial_positions(),
                   x,
                   x,
                   first_own);
    if (new_history.n_points != n_points ||
        new_history.n_components != n_components ||
        edges.empty() != new_edges.empty())
      throw RunError("Transfer",
                     "the new boundary history has other points, components or "
                     "boundaries than the old one",
                     "remeshing must keep the names of boundaries");

    // Nearest point of all old curves.
    const auto locate = [&](const Point<2> &y) {
      Place best;
      for (unsigned int i = 0; i < curves.size(); ++i)
        for (unsigned int l = 0; l < curves[i].links.size(); ++l)
          {
            const auto         &link = curves[i].links[l];
            const BoundaryEdge &edge = edges[link.edge];
            // The nearest point is not nearer than this.
            const double chord =
              edge.before.front().distance(edge.before.back());
            if (y.distance(edge.before.front()) - 2. * chord > best.distance)
              continue;
            double       distance;
            const double s = map->project(edge.before, y, distance);
            if (distance < best.distance)
              best = {i,
                      lengths[i].ends[l * n_points] +
                        map->length(edge.before, link.reversed ? 1. : 0., s),
                      distance,
                      chord};
          }
      return best;
    };

    FaceTransferReport report;
    report.moved = true;
    for (const auto &curve : find_curves(new_edges))
      {
        int direction = 0; // +1 along the old curve, -1 against it
        for (const auto &link : curve.links)
          {
            BoundaryEdge &edge = new_edges[link.edge];
            const double  chord =
              edge.before.front().distance(edge.before.back());
            std::vector<Place> ends;
            for (const double s : breaks)
              {
                Point<2>     y;
                Tensor<1, 2> tangent;
                map->evaluate(edge.before, s, y, tangent);
                ends.push_back(locate(y));
                report.largest_distance =
                  std::max(report.largest_distance, ends.back().distance);
                if (!(ends.back().distance <=
                      0.5 * std::max(chord, ends.back().edge)))
                  throw RunError("Transfer",
                                 "a new boundary is " +
                                   std::to_string(ends.back().distance) +
                                   " mm from the old one that carries history",
                                 "let the new mesh follow the outline more "
                                 "closely, e.g. with a smaller element size");
              }
            for (unsigned int q = 0; q < n_points; ++q)
              {
                const unsigned int i     = ends[q].curve;
                const double       total = lengths[i].ends.back();
                double             a = ends[q].length, b = ends[q + 1].length;
                if (lengths[i].closed)
                  b -= std::round((b - a) / total) * total;
                if (link.reversed)
                  std::swap(a, b);
                if (std::abs(b - a) > 1e-12 * total)
                  {
                    const int here = b > a ? 1 : -1;
                    if (i != ends[q + 1].curve ||
                        (direction != 0 && direction != here))
                      throw RunError(
                        "Transfer",
                        "a new boundary does not follow the old one that "
                        "carries history",
                        "let the new mesh follow the outline more closely, "
                        "e.g. with a smaller element size");
                    direction = here;
                  }
                if (b < a)
                  std::swap(a, b);

                // One old value plus differences: constants stay exactly.
                double       *result = edge.values.data() + q * n_components;
                const double *first  = nullptr;
                lengths[i].pieces(
                  a, b, [&](const unsigned int s, const double part) {
                    const auto        &old = curves[i].links[s / n_points];
                    const unsigned int p =
                      old.reversed ? n_points - 1 - s % n_points : s % n_points;
                    const double *value =
                      edges[old.edge].values.data() + p * n_components;
                    if (first == nullptr)
                      {
                        first = value;
                        std::copy(first, first + n_components, result);
                      }
                    for (unsigned int c = 0; c < n_components; ++c)
                      result[c] += part * (value[c] - first[c]);
                  });
              }
          }
      }
    integrate(*map,
              breaks,
              edges,
              curves,
              n_components,
              report.integral_before,
              report.length_before);
    integrate(*map,
              breaks,
              new_edges,
              find_curves(new_edges),
              n_components,
              report.integral_after,
              report.length_after);
    for (unsigned int f = 0; f < new_history.faces().size(); ++f)
      std::copy(new_edges[first_own + f].values.begin(),
                new_edges[first_own + f].values.end(),
                new_history.old_record(f, 0));
    return report;
  }

  template class FaceOverlap<2>;
  template class FaceOverlap<3>;
} // namespace alveolus
