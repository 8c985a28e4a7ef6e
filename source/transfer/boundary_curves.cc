// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/boundary_curves.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    bool
    is_before(const Point<2> &a, const Point<2> &b)
    {
      return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
    }

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

  } // namespace

  std::vector<BoundaryCurve>
  find_curves(const std::vector<BoundaryEdge> &edges)
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
      const bool open_a = around[a].size() == 1, open_b = around[b].size() == 1;
      return open_a != open_b ? open_a : is_before(place[a], place[b]);
    });

    std::vector<bool>          used(edges.size(), false);
    std::vector<BoundaryCurve> curves;
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
        BoundaryCurve curve;
        Id            vertex = start;
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


  std::vector<BoundaryEdge>
  gather_edges(const DoFHandler<2>  &dof_handler,
               const CellNodes<2>   &cells,
               const FaceHistory<2> &history,
               const NodalVector    &x_initial,
               const NodalVector    &x_before,
               const NodalVector    &x_after,
               unsigned int         &first_own)
  {
    const MPI_Comm            communicator = dof_handler.get_communicator();
    const auto               &partitioner  = *x_before.get_partitioner();
    std::vector<BoundaryEdge> own;
    CellNodes<2>::NodeTensors before, after;
    for (const auto &face : history.faces())
      {
        const unsigned int c = face.cell->active_cell_index();
        cells.gather(x_before, c, before);
        cells.gather(x_after, c, after);
        BoundaryEdge edge;
        const auto   nodes = face_nodes(face.face_no, cells.degree);
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
              edge.initial[v][d] = x_initial.local_element(entry[d]);
          }
        const unsigned int f = own.size();
        edge.values.assign(history.old_record(f, 0),
                           history.old_record(f, 0) +
                             history.n_points * history.n_components);
        own.push_back(std::move(edge));
      }

    std::vector<BoundaryEdge> edges;
    first_own      = 0;
    const auto all = Utilities::MPI::all_gather(communicator, own);
    for (unsigned int r = 0; r < all.size(); ++r)
      {
        if (r == Utilities::MPI::this_mpi_process(communicator))
          first_own = edges.size();
        edges.insert(edges.end(), all[r].begin(), all[r].end());
      }
    return edges;
  }

  EdgeMap::EdgeMap(const CellNodes<2> &cells)
    : cells(cells)
    , gauss(cells.degree == 1 ? 1 : 8)
  {}

  void
  EdgeMap::evaluate(const BoundaryEdge::Nodes &nodes,
                    const double               s,
                    Point<2>                  &x,
                    Tensor<1, 2>              &tangent) const
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

  double
  EdgeMap::length(const BoundaryEdge::Nodes &nodes,
                  const double               from,
                  const double               to) const
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

  double
  EdgeMap::project(const BoundaryEdge::Nodes &nodes,
                   const Point<2>            &y,
                   double                    &distance) const
  {
    const Tensor<1, 2> chord = nodes.back() - nodes.front();
    double             s = ((y - nodes.front()) * chord) / chord.norm_square();
    s                    = std::min(1., std::max(0., s));
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


  std::vector<double>
  segment_breaks(const unsigned int n_points)
  {
    std::vector<double> breaks(1, 0.);
    const QGauss<1>     gauss(n_points);
    for (unsigned int q = 0; q + 1 < n_points; ++q)
      breaks.push_back(breaks.back() + gauss.weight(q));
    breaks.push_back(1.);
    return breaks;
  }

  unsigned int
  ArcLengths::segment_at(const double x) const
  {
    const auto upper = std::upper_bound(ends.begin(), ends.end(), x);
    const int  s     = static_cast<int>(upper - ends.begin()) - 1;
    return std::min<int>(ends.size() - 2, std::max(0, s));
  }

  void
  ArcLengths::pieces(const double                                     a,
                     const double                                     b,
                     const std::function<void(unsigned int, double)> &add) const
  {
    const unsigned int n_segments = ends.size() - 1;
    const double       total      = ends.back();
    if (b - a <= 1e-13 * total)
      {
        double x = 0.5 * (a + b);
        if (closed)
          x -= std::floor(x / total) * total;
        add(segment_at(x), 1.);
        return;
      }
    for (int turn = closed ? -1 : 0; turn <= (closed ? 1 : 0); ++turn)
      {
        const double from = a - turn * total, to = b - turn * total;
        for (unsigned int s = segment_at(from); s < n_segments && ends[s] < to;
             ++s)
          {
            // The last values go on beyond the ends of an open curve.
            const bool first   = !closed && s == 0,
                       last    = !closed && s + 1 == n_segments;
            const double lower = first ? from : std::max(from, ends[s]);
            const double upper = last ? to : std::min(to, ends[s + 1]);
            if (upper > lower)
              add(s, (upper - lower) / (b - a));
          }
      }
  }

  ArcLengths
  arc_lengths(const EdgeMap                   &map,
              const std::vector<double>       &breaks,
              const BoundaryCurve             &curve,
              const std::vector<BoundaryEdge> &edges,
              BoundaryEdge::Nodes BoundaryEdge::*nodes)
  {
    const unsigned int n = breaks.size() - 1;
    ArcLengths         result;
    result.closed = curve.closed;
    result.ends.push_back(0.);
    for (const auto &link : curve.links)
      for (unsigned int k = 0; k < n; ++k)
        result.ends.push_back(
          result.ends.back() +
          map.length(edges[link.edge].*nodes,
                     link.reversed ? breaks[n - k] : breaks[k],
                     link.reversed ? breaks[n - k - 1] : breaks[k + 1]));
    return result;
  }
} // namespace alveolus
