// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/boundary_curves.h>
#include <alveolus/transfer/boundary_surface.h>
#include <alveolus/transfer/face_transfer.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * The remap of one curve: ends of sub-segments in arc length of the old
     * curve, and overlaps.
     */
    class CurveRemap
    {
    public:
      CurveRemap(const EdgeMap             &map,
                 const std::vector<double> &breaks,
                 const BoundaryCurve       &curve,
                 std::vector<BoundaryEdge> &edges)
        : map(map)
        , breaks(breaks)
        , curve(curve)
        , edges(edges)
        , n(breaks.size() - 1)
        , lengths(arc_lengths(map, breaks, curve, edges, &BoundaryEdge::before))
        , ends(lengths.ends)
      {}

      /** Replace the values; returns the largest distance of a projection. */
      double
      run(const unsigned int n_components)
      {
        double              largest = 0.;
        const unsigned int  n_links = curve.links.size();
        std::vector<double> places;
        for (unsigned int l = 0; l < n_links; ++l)
          for (unsigned int k = 0; k < n + (l + 1 == n_links ? 1 : 0); ++k)
            places.push_back(place(l, k, largest));
        if (curve.closed)
          places.back() = places.front() + ends.back();

        std::vector<double> result(n_links * n * n_components);
        for (unsigned int s = 0; s < n_links * n; ++s)
          {
            if (places[s + 1] < places[s] - 1e-12 * ends.back())
              throw RunError("Transfer",
                             "nodes of a boundary that carries history are out "
                             "of order along the curve they came from",
                             "rezone more often, or with another rule there");
            overlap(s,
                    places[s],
                    places[s + 1],
                    n_components,
                    result.data() + s * n_components);
          }
        for (unsigned int s = 0; s < n_links * n; ++s)
          for (unsigned int c = 0; c < n_components; ++c)
            value(s, n_components)[c] = result[s * n_components + c];
        return largest;
      }

      /** Values of sub-segment @p s in the order of the curve. */
      double *
      value(const unsigned int s, const unsigned int n_components) const
      {
        const Link        &link = curve.links[s / n];
        const unsigned int q    = link.reversed ? n - 1 - s % n : s % n;
        return edges[link.edge].values.data() + q * n_components;
      }

    private:
      using Link = BoundaryCurve::Link;

      /** Unit coordinate on its edge of the k-th end along the curve. */
      double
      unit(const Link &link, const unsigned int k) const
      {
        return link.reversed ? breaks[n - k] : breaks[k];
      }

      /** Old arc length of the new end @p k of link @p l. */
      double
      place(const unsigned int l, const unsigned int k, double &largest) const
      {
        const int  n_links = curve.links.size();
        const auto edge_of = [&](const int i) -> const BoundaryEdge & {
          return edges[curve.links[((i % n_links) + n_links) % n_links].edge];
        };
        const auto link_of = [&](const int i) -> const Link & {
          return curve.links[((i % n_links) + n_links) % n_links];
        };
        if (edge_of(l).before == edge_of(l).after)
          return ends[l * n + k];

        Point<2>     y;
        Tensor<1, 2> tangent;
        map.evaluate(edge_of(l).after, unit(link_of(l), k), y, tangent);

        // Walk towards the neighbour as long as it is nearer. The curve may
        // come close to itself elsewhere, so it is not searched as a whole.
        int    here = l;
        double distance;
        double s = map.project(edge_of(here).before, y, distance);
        for (int step = 0; step < n_links; ++step)
          {
            const bool at_begin = s == (link_of(here).reversed ? 1. : 0.);
            const bool at_end   = s == (link_of(here).reversed ? 0. : 1.);
            if (!at_begin && !at_end)
              break;
            const int next = here + (at_end ? 1 : -1);
            if (!curve.closed && (next < 0 || next >= n_links))
              break;
            double       d;
            const double t = map.project(edge_of(next).before, y, d);
            if (!(d < distance))
              break;
            here     = next;
            s        = t;
            distance = d;
          }
        largest = std::max(largest, distance);

        // Arc length at the begin of that link, unwound on a closed curve.
        const int    turns = here < 0 ? -1 : (here >= n_links ? 1 : 0);
        const int    index = here - turns * n_links;
        const double begin = ends[index * n] + turns * ends.back();
        const Link  &link  = curve.links[index];
        return begin +
               map.length(edge_of(here).before, link.reversed ? 1. : 0., s);
      }

      /** Mean of the old values over the old arc length from @p a to @p b. */
      void
      overlap(const unsigned int own,
              const double       a,
              const double       b,
              const unsigned int n_components,
              double            *result) const
      {
        const double *own_value = value(own, n_components);
        for (unsigned int c = 0; c < n_components; ++c)
          result[c] = own_value[c];

        // Written as the change of the own value: constants stay exactly.
        lengths.pieces(a, b, [&](const unsigned int s, const double part) {
          if (s == own)
            return;
          const double *v = value(s, n_components);
          for (unsigned int c = 0; c < n_components; ++c)
            result[c] += part * (v[c] - own_value[c]);
        });
      }

      const EdgeMap             &map;
      const std::vector<double> &breaks;
      const BoundaryCurve       &curve;
      std::vector<BoundaryEdge> &edges;
      const unsigned int         n;       ///< sub-segments on an edge
      const ArcLengths           lengths; ///< of the old curve
      const std::vector<double> &ends;
    };
  } // namespace

  template <int dim>
  FaceTransfer<dim>::FaceTransfer(const Configuration<dim> &configuration)
    : configuration(configuration)
    , cells(configuration)
  {}

  template <>
  FaceTransferReport
  FaceTransfer<3>::transfer(FaceHistory<3>    &history,
                            const NodalVector &x_old,
                            const NodalVector &x_new) const
  {
    cells.check(x_old);
    cells.check(x_new);

    unsigned int first_own = 0;
    auto faces = gather_faces(configuration, history, x_old, x_new, first_own);
    BoundarySurface    surface(faces, history.n_points, history.n_components);
    FaceTransferReport report;
    report.length_before = surface.integrate(false, report.integral_before);
    for (const BoundaryFace &face : faces)
      report.moved = report.moved || face.before != face.after;
    if (report.moved)
      report.largest_distance = surface.transfer();
    report.length_after = surface.integrate(true, report.integral_after);
    for (unsigned int f = 0; f < history.faces().size(); ++f)
      std::copy(faces[first_own + f].values.begin(),
                faces[first_own + f].values.end(),
                history.old_record(f, 0));
    return report;
  }

  template <>
  FaceTransferReport
  FaceTransfer<2>::transfer(FaceHistory<2>    &history,
                            const NodalVector &x_old,
                            const NodalVector &x_new) const
  {
    cells.check(x_old);
    cells.check(x_new);

    unsigned int              first_own = 0;
    const std::vector<double> breaks    = segment_breaks(history.n_points);
    std::vector<BoundaryEdge> edges =
      gather_edges(configuration.dof_handler,
                   cells,
                   history,
                   configuration.initial_positions(),
                   x_old,
                   x_new,
                   first_own);

    FaceTransferReport report;
    report.integral_before.assign(history.n_components, 0.);
    report.integral_after.assign(history.n_components, 0.);
    const EdgeMap map(cells);
    for (const BoundaryCurve &curve : find_curves(edges))
      {
        const auto sum_up = [&](BoundaryEdge::Nodes BoundaryEdge::*nodes,
                                std::vector<double>               &integral,
                                double                            &length) {
          for (const auto &link : curve.links)
            for (unsigned int q = 0; q < history.n_points; ++q)
              {
                const BoundaryEdge &edge = edges[link.edge];
                const double        l =
                  map.length(edge.*nodes, breaks[q], breaks[q + 1]);
                length += l;
                for (unsigned int c = 0; c < history.n_components; ++c)
                  integral[c] += l * edge.values[q * history.n_components + c];
              }
        };
        bool moved = false;
        for (const auto &link : curve.links)
          moved = moved || edges[link.edge].before != edges[link.edge].after;
        sum_up(&BoundaryEdge::before,
               report.integral_before,
               report.length_before);
        if (moved)
          report.largest_distance = std::max(
            report.largest_distance,
            CurveRemap(map, breaks, curve, edges).run(history.n_components));
        report.moved = report.moved || moved;
        sum_up(&BoundaryEdge::after,
               report.integral_after,
               report.length_after);
      }

    for (unsigned int f = 0; f < history.faces().size(); ++f)
      std::copy(edges[first_own + f].values.begin(),
                edges[first_own + f].values.end(),
                history.old_record(f, 0));
    return report;
  }

  template class FaceTransfer<2>;
  template class FaceTransfer<3>;
} // namespace alveolus
