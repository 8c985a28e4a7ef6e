// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/face_transfer.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    /** A boundary edge with all that is needed of it, on every process. */
    struct Edge
    {
      std::array<types::global_dof_index, 2> vertex;  ///< ids of the two ends
      std::array<Point<2>, 2>                initial; ///< where they began
      std::vector<Point<2>> before, after; ///< nodes, in the face's direction
      std::vector<double>   values;        ///< by sub-segment and component

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &vertex &initial &before &after &values;
      }
    };

    /** The place of an edge in its curve. */
    struct Link
    {
      unsigned int edge;
      bool         reversed;
    };

    struct Curve
    {
      std::vector<Link> links;
      bool              closed = false;
    };

    bool
    is_before(const Point<2> &a, const Point<2> &b)
    {
      return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
    }

    /** Put edges in order; see FaceTransfer. */
    std::vector<Curve>
    find_curves(const std::vector<Edge> &edges)
    {
      using Id = types::global_dof_index;
      std::map<Id, std::vector<unsigned int>> around;
      std::map<Id, Point<2>>                  place;
      for (unsigned int e = 0; e < edges.size(); ++e)
        for (unsigned int v = 0; v < 2; ++v)
          {
            around[edges[e].vertex[v]].push_back(e);
            place[edges[e].vertex[v]] = edges[e].initial[v];
          }
      for (const auto &[vertex, at] : around)
        if (at.size() > 2)
          throw RunError("Transfer",
                         "a boundary that carries history branches",
                         "give its branches different names");

      // Geometric order, since node numbers depend on the number of processes.
      std::vector<Id> starts;
      for (const auto &[vertex, at] : around)
        starts.push_back(vertex);
      std::sort(starts.begin(), starts.end(), [&](const Id a, const Id b) {
        const bool open_a = around[a].size() == 1,
                   open_b = around[b].size() == 1;
        return open_a != open_b ? open_a : is_before(place[a], place[b]);
      });

      std::vector<bool>  used(edges.size(), false);
      std::vector<Curve> curves;
      for (const Id start : starts)
        {
          const auto other_end = [&](const unsigned int e, const Id v) {
            return edges[e].vertex[0] == v ? edges[e].vertex[1]
                                           : edges[e].vertex[0];
          };
          unsigned int next = none;
          for (const unsigned int e : around[start])
            if (!used[e] &&
                (next == none || is_before(place[other_end(e, start)],
                                           place[other_end(next, start)])))
              next = e;
          if (next == none)
            continue;
          Curve curve;
          Id    vertex = start;
          while (next != none)
            {
              used[next] = true;
              curve.links.push_back({next, edges[next].vertex[0] != vertex});
              vertex = other_end(next, vertex);
              next   = none;
              for (const unsigned int e : around[vertex])
                if (!used[e])
                  next = e;
            }
          curve.closed = vertex == start;
          curves.push_back(std::move(curve));
        }
      return curves;
    }

    /** The polynomial through the nodes of an edge and its derivative. */
    class EdgeMap
    {
    public:
      explicit EdgeMap(const CellNodes<2> &cells)
        : cells(cells)
        , gauss(cells.degree == 1 ? 1 : 8)
      {}

      void
      evaluate(const std::vector<Point<2>> &nodes,
               const double                 s,
               Point<2>                    &x,
               Tensor<1, 2>                &tangent) const
      {
        std::array<double, CellNodes<2>::max_degree + 1> value, derivative;
        cells.shape_1d(s, value, derivative);
        x       = Point<2>();
        tangent = 0;
        for (unsigned int i = 0; i < nodes.size(); ++i)
          {
            x += value[i] * nodes[i];
            tangent += derivative[i] * nodes[i];
          }
      }

      /** Length between two unit coordinates. */
      double
      length(const std::vector<Point<2>> &nodes,
             const double                 from,
             const double                 to) const
      {
        Point<2>     x;
        Tensor<1, 2> tangent;
        double       sum = 0.;
        for (unsigned int g = 0; g < gauss.size(); ++g)
          {
            evaluate(nodes, from + (to - from) * gauss.point(g)[0], x, tangent);
            sum += gauss.weight(g) * tangent.norm();
          }
        return sum * std::abs(to - from);
      }

      /** Unit coordinate of the nearest point, and its distance. */
      double
      project(const std::vector<Point<2>> &nodes,
              const Point<2>              &y,
              double                      &distance) const
      {
        const Tensor<1, 2> chord = nodes.back() - nodes.front();
        double s = ((y - nodes.front()) * chord) / chord.norm_square();
        s        = std::min(1., std::max(0., s));
        Point<2>     x;
        Tensor<1, 2> tangent;
        if (nodes.size() > 2)
          for (unsigned int iteration = 0; iteration < 50; ++iteration)
            {
              evaluate(nodes, s, x, tangent);
              const double old = s;
              s += ((y - x) * tangent) / tangent.norm_square();
              s = std::min(1., std::max(0., s));
              if (std::abs(s - old) < 1e-15)
                break;
            }
        evaluate(nodes, s, x, tangent);
        distance = y.distance(x);
        return s;
      }

    private:
      const CellNodes<2> &cells;
      const QGauss<1>     gauss;
    };

    /** Nodes of face @p f of a cell in the face's direction. */
    std::vector<unsigned int>
    face_nodes(const unsigned int f, const unsigned int degree)
    {
      std::vector<unsigned int> result;
      for (unsigned int t = 0; t <= degree; ++t)
        result.push_back(f / 2 == 0 ? (f % 2) * degree + t * (degree + 1)
                                    : t + (f % 2) * degree * (degree + 1));
      return result;
    }

    /**
     * The remap of one curve: ends of sub-segments in arc length of the old
     * curve, and overlaps.
     */
    class CurveRemap
    {
    public:
      CurveRemap(const EdgeMap             &map,
                 const std::vector<double> &breaks,
                 const Curve               &curve,
                 std::vector<Edge>         &edges)
        : map(map)
        , breaks(breaks)
        , curve(curve)
        , edges(edges)
        , n(breaks.size() - 1)
      {
        ends.push_back(0.);
        for (const Link &link : curve.links)
          for (unsigned int k = 0; k < n; ++k)
            ends.push_back(ends.back() + map.length(edges[link.edge].before,
                                                    unit(link, k),
                                                    unit(link, k + 1)));
      }

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

      std::vector<double> ends; ///< of the old sub-segments in arc length

    private:
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
        const auto edge_of = [&](const int i) -> const Edge & {
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
        const unsigned int n_segments = ends.size() - 1;
        const double       total      = ends.back();
        const double      *own_value  = value(own, n_components);
        for (unsigned int c = 0; c < n_components; ++c)
          result[c] = own_value[c];

        // Written as the change of the own value: constants stay exactly.
        const auto add = [&](const unsigned int s, const double part) {
          const double *v = value(s, n_components);
          for (unsigned int c = 0; c < n_components; ++c)
            result[c] += part * (v[c] - own_value[c]);
        };
        const auto segment_at = [&](const double x) {
          const auto upper = std::upper_bound(ends.begin(), ends.end(), x);
          const int  s     = static_cast<int>(upper - ends.begin()) - 1;
          return static_cast<unsigned int>(
            std::min<int>(n_segments - 1, std::max(0, s)));
        };

        if (b - a <= 1e-13 * total)
          {
            double x = 0.5 * (a + b);
            if (curve.closed)
              x -= std::floor(x / total) * total;
            add(segment_at(x), 1.);
            return;
          }
        for (int turn = curve.closed ? -1 : 0; turn <= (curve.closed ? 1 : 0);
             ++turn)
          {
            const double from = a - turn * total, to = b - turn * total;
            for (unsigned int s = segment_at(from);
                 s < n_segments && ends[s] < to;
                 ++s)
              {
                // The last values go on beyond the ends of an open curve.
                const bool first   = !curve.closed && s == 0,
                           last    = !curve.closed && s + 1 == n_segments;
                const double lower = first ? from : std::max(from, ends[s]);
                const double upper = last ? to : std::min(to, ends[s + 1]);
                if (upper > lower && s != own)
                  add(s, (upper - lower) / (b - a));
              }
          }
      }

      const EdgeMap             &map;
      const std::vector<double> &breaks;
      const Curve               &curve;
      std::vector<Edge>         &edges;
      const unsigned int         n; ///< sub-segments on an edge
    };
  } // namespace

  template <int dim>
  FaceTransfer<dim>::FaceTransfer(const Configuration<dim> &configuration)
    : configuration(configuration)
    , cells(configuration)
  {}

  template <>
  FaceTransferReport
  FaceTransfer<3>::transfer(FaceHistory<3> &,
                            const NodalVector &,
                            const NodalVector &) const
  {
    throw RunError("Transfer",
                   "history of a boundary cannot be moved along a surface yet",
                   "use a two-dimensional model, a mesh that is not rezoned on "
                   "this boundary, or the volume model of the interface");
  }

  template <>
  FaceTransferReport
  FaceTransfer<2>::transfer(FaceHistory<2>    &history,
                            const NodalVector &x_old,
                            const NodalVector &x_new) const
  {
    cells.check(x_old);
    cells.check(x_new);
    const MPI_Comm communicator = configuration.communicator();

    std::vector<double> breaks(1, 0.);
    const QGauss<1>     gauss(history.n_points);
    for (unsigned int q = 0; q + 1 < history.n_points; ++q)
      breaks.push_back(breaks.back() + gauss.weight(q));
    breaks.push_back(1.);

    std::vector<Edge>                    own;
    CellNodes<2>::NodeTensors            before, after;
    std::vector<types::global_dof_index> dofs(
      configuration.fe.n_dofs_per_cell());
    for (const auto &face : history.faces())
      {
        const unsigned int c = face.cell->active_cell_index();
        cells.gather(x_old, c, before);
        cells.gather(x_new, c, after);
        const auto &partitioner = *x_old.get_partitioner();
        Edge        edge;
        const auto  nodes = face_nodes(face.face_no, cells.degree);
        for (const unsigned int i : nodes)
          {
            edge.before.emplace_back(before[i]);
            edge.after.emplace_back(after[i]);
          }
        for (unsigned int v = 0; v < 2; ++v)
          {
            const unsigned int *entry =
              cells.local_entries(c, v == 0 ? nodes.front() : nodes.back());
            edge.vertex[v] = partitioner.local_to_global(entry[0]);
            for (unsigned int d = 0; d < 2; ++d)
              edge.initial[v][d] =
                configuration.initial_positions().local_element(entry[d]);
          }
        const unsigned int f = own.size();
        edge.values.assign(history.old_record(f, 0),
                           history.old_record(f, 0) +
                             history.n_points * history.n_components);
        own.push_back(std::move(edge));
      }

    std::vector<Edge> edges;
    unsigned int      first_own = 0;
    const auto        all       = Utilities::MPI::all_gather(communicator, own);
    for (unsigned int r = 0; r < all.size(); ++r)
      {
        if (r == Utilities::MPI::this_mpi_process(communicator))
          first_own = edges.size();
        edges.insert(edges.end(), all[r].begin(), all[r].end());
      }

    FaceTransferReport report;
    report.integral_before.assign(history.n_components, 0.);
    report.integral_after.assign(history.n_components, 0.);
    const EdgeMap map(cells);
    for (const Curve &curve : find_curves(edges))
      {
        const auto sum_up = [&](std::vector<Point<2>> Edge::*nodes,
                                std::vector<double>         &integral,
                                double                      &length) {
          for (const Link &link : curve.links)
            for (unsigned int q = 0; q < history.n_points; ++q)
              {
                const Edge  &edge = edges[link.edge];
                const double l =
                  map.length(edge.*nodes, breaks[q], breaks[q + 1]);
                length += l;
                for (unsigned int c = 0; c < history.n_components; ++c)
                  integral[c] += l * edge.values[q * history.n_components + c];
              }
        };
        bool moved = false;
        for (const Link &link : curve.links)
          moved = moved || edges[link.edge].before != edges[link.edge].after;
        sum_up(&Edge::before, report.integral_before, report.length_before);
        if (moved)
          report.largest_distance = std::max(
            report.largest_distance,
            CurveRemap(map, breaks, curve, edges).run(history.n_components));
        report.moved = report.moved || moved;
        sum_up(&Edge::after, report.integral_after, report.length_after);
      }

    for (unsigned int f = 0; f < own.size(); ++f)
      std::copy(edges[first_own + f].values.begin(),
                edges[first_own + f].values.end(),
                history.old_record(f, 0));
    return report;
  }

  template class FaceTransfer<2>;
  template class FaceTransfer<3>;
} // namespace alveolus
