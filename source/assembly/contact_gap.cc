// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_gap.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Row = ContactPatch::Row;

    void
    add(Row &row, const double factor, const Row &other)
    {
      for (unsigned int i = 0; i < row.size(); ++i)
        row[i] += factor * other[i];
    }

    /** v . (dx - N_b dy_b). */
    Row
    of_offset(const Tensor<1, 2>          &v,
              const std::array<double, 3> &N,
              const unsigned int           n_nodes)
    {
      Row row{};
      for (unsigned int d = 0; d < 2; ++d)
        {
          row[d] = v[d];
          for (unsigned int b = 0; b < n_nodes; ++b)
            row[2 + 2 * b + d] = -N[b] * v[d];
        }
      return row;
    }

    /** v . N_b' dy_b of the edge whose nodes are at @p places of the patch. */
    Row
    of_tangent(const Tensor<1, 2>              &v,
               const std::array<double, 3>     &dN,
               const std::vector<unsigned int> &places)
    {
      Row row{};
      for (unsigned int d = 0; d < 2; ++d)
        for (unsigned int b = 0; b < places.size(); ++b)
          row[2 + 2 * places[b] + d] += dN[b] * v[d];
      return row;
    }

    /** Where the nodes of an edge are in a patch. */
    std::vector<unsigned int>
    places(const ContactPatch   &patch,
           const ContactOutline &outline,
           const unsigned int    edge)
    {
      std::vector<unsigned int> result;
      for (unsigned int a = 0; a < outline.n_nodes_per_edge; ++a)
        result.push_back(std::find(patch.nodes.begin(),
                                   patch.nodes.end(),
                                   outline.edges[edge].nodes[a]) -
                         patch.nodes.begin());
      return result;
    }

    /**
     * Change of the mean normal at an end of an edge, by its component along
     * its perpendicular @p s; it is (n_1 + n_2)/|n_1 + n_2| where smoothed.
     */
    Row
    of_end_normal(const Tensor<1, 2>   &s,
                  const ContactPatch   &patch,
                  const ContactSurface &surface,
                  const unsigned int    edge,
                  const unsigned int    end)
    {
      const auto  &outline = surface.outline;
      Tensor<1, 2> sum;
      Row          row{};
      for (const auto &[e, xi] :
           {std::make_pair(edge, double(end)),
            std::make_pair(surface.smooth_neighbour(edge, end),
                           double(1 - end))})
        if (e != no_edge)
          {
            // dn = -t (n . dy')/|y'|
            const Tensor<1, 2> n = surface.curve(e).normal(xi);
            const Tensor<1, 2> y = surface.curve(e).tangent(xi);
            sum += n;
            add(row,
                -(s * y) / (y * y),
                of_tangent(
                  n,
                  EdgeCurve::shape_derivatives(xi, outline.n_nodes_per_edge),
                  places(patch, outline, e)));
          }
      Row result{};
      add(result, 1. / sum.norm(), row);
      return result;
    }
  } // namespace



  ContactPatch::ContactPatch(const ContactSurface &surface,
                             const unsigned int    edge,
                             const bool            alone)
    : n_nodes_of_edge(surface.outline.n_nodes_per_edge)
  {
    const auto &outline = surface.outline;
    for (const unsigned int e : {edge,
                                 surface.smooth_neighbour(edge, 0),
                                 surface.smooth_neighbour(edge, 1)})
      if (e != no_edge && (e == edge || !alone))
        for (unsigned int a = 0; a < outline.n_nodes_per_edge; ++a)
          if (const unsigned int node = outline.edges[e].nodes[a];
              std::find(nodes.begin(), nodes.end(), node) == nodes.end())
            nodes.push_back(node);
  }



  ContactGap::ContactGap(const Point<2>          &x,
                         const ContactSurface    &surface,
                         const ContactProjection &projection)
    : patch(surface, projection.edge)
    , shapes(EdgeCurve::shapes(projection.xi, surface.outline.n_nodes_per_edge))
    , shape_derivatives(
        EdgeCurve::shape_derivatives(projection.xi,
                                     surface.outline.n_nodes_per_edge))
  {
    const unsigned int edge = projection.edge;
    const double       xi   = projection.xi;
    const unsigned int n    = surface.outline.n_nodes_per_edge;
    const Tensor<1, 2> y_1  = surface.curve(edge).tangent(xi);
    // Beyond a sharp end the normal is that of this end.
    const bool         beyond = xi < 0. || xi > 1.;
    const double       part   = beyond ? (xi < 0. ? 0. : 1.) : xi;
    const Tensor<1, 2> m      = surface.normal(edge, xi);
    const Tensor<1, 2> m_1 =
      beyond ? Tensor<1, 2>()
             : surface.end_normal(edge, 1) - surface.end_normal(edge, 0);
    const double size = m.norm();
    normal            = m / size;
    gap               = normal * (x - surface.curve(edge).point(xi));
    const Tensor<1, 2> s({-normal[1], normal[0]});

    // s . dm at fixed xi; an end's normal turns along its own perpendicular.
    Row turn{};
    for (const unsigned int end : {0, 1})
      {
        const double weight = end == 0 ? 1. - part : part;
        if (weight == 0.)
          continue;
        const Tensor<1, 2> &n_end = surface.end_normal(edge, end);
        const Tensor<1, 2>  s_end({-n_end[1], n_end[0]});
        add(turn,
            weight * (s * s_end),
            of_end_normal(s_end, patch, surface, edge, end));
      }

    const double slope = s * y_1 + gap / size * (s * m_1);
    add(d_foot, 1. / slope, of_offset(s, shapes, n));
    add(d_foot, -gap / size / slope, turn);
    d_gap = of_offset(normal, shapes, n);
    add(d_gap, -(normal * y_1), d_foot);
    add(turn, s * m_1, d_foot);
    for (unsigned int d = 0; d < 2; ++d)
      add(d_normal[d], s[d] / size, turn);
  }



  ContactOffset::ContactOffset(const Point<2>       &x,
                               const ContactSurface &surface,
                               const unsigned int    edge,
                               const double          xi)
    : patch(surface, edge, /*alone*/ true)
  {
    const EdgeCurve    curve = surface.curve(edge);
    const auto         N     = EdgeCurve::shapes(xi, curve.n_nodes);
    const auto         dN    = EdgeCurve::shape_derivatives(xi, curve.n_nodes);
    const double       q     = curve.tangent(xi).norm();
    const Tensor<1, 2> t = curve.tangent(xi) / q, n = curve.normal(xi);
    const Tensor<1, 2> d   = x - curve.point(xi);
    const auto         own = places(patch, surface.outline, edge);
    const Row          ne  = of_offset(n, N, curve.n_nodes);
    const Row          te  = of_offset(t, N, curve.n_nodes);
    const Row          C   = of_tangent(n, dN, own);
    const Row          D   = of_tangent(t, dN, own);

    // dw = C/q turns the frame such that dt = n dw and dn = -t dw, and
    // ddw = -(C D* + D C*)/q^2.
    const double g = n * d, s = t * d;
    gap.value  = g;
    slip.value = s;
    for (unsigned int i = 0; i < patch.size(); ++i)
      {
        gap.gradient[i]  = ne[i] - s * C[i] / q;
        slip.gradient[i] = te[i] + g * C[i] / q;
      }
    for (unsigned int i = 0; i < patch.size(); ++i)
      for (unsigned int j = 0; j < patch.size(); ++j)
        {
          const double dw_i = C[i] / q, dw_j = C[j] / q;
          const double ddw  = -(C[i] * D[j] + D[i] * C[j]) / (q * q);
          gap.hessian[i][j] = -te[i] * dw_j - slip.gradient[j] * dw_i - s * ddw;
          slip.hessian[i][j] = ne[i] * dw_j + gap.gradient[j] * dw_i + g * ddw;
        }
  }
} // namespace alveolus
