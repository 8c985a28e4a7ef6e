// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_surface.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** u x v, positive if v is on the left of u. */
    double
    cross(const Tensor<1, 2> &u, const Tensor<1, 2> &v)
    {
      return u[0] * v[1] - u[1] * v[0];
    }

    bool
    contains(const std::vector<unsigned int> &edges, const unsigned int edge)
    {
      return std::find(edges.begin(), edges.end(), edge) != edges.end();
    }
  } // namespace



  ContactSurface::ContactSurface(const ContactOutline        &outline,
                                 const std::vector<Point<2>> &positions,
                                 const std::vector<bool>     &smooth)
    : outline(outline)
    , positions(positions)
    , smooth(smooth)
    , end_normals(outline.n_edges())
  {
    for (unsigned int e = 0; e < outline.n_edges(); ++e)
      for (const unsigned int end : {0, 1})
        end_normals[e][end] = curve(e).normal(end);
    const auto own = end_normals;
    for (unsigned int e = 0; e < outline.n_edges(); ++e)
      for (const unsigned int end : {0, 1})
        if (const unsigned int other = smooth_neighbour(e, end);
            other != no_edge)
          {
            end_normals[e][end] += own[other][1 - end];
            end_normals[e][end] /= end_normals[e][end].norm();
          }
  }



  std::vector<bool>
  ContactSurface::smooth_joints(const ContactOutline        &outline,
                                const std::vector<Point<2>> &positions,
                                const double                 angle)
  {
    std::vector<bool> smooth(outline.n_edges(), false);
    for (unsigned int e = 0; e < outline.n_edges(); ++e)
      if (const unsigned int before = outline.edges[e].previous;
          before != no_edge)
        smooth[e] = outline.curve(e, positions).normal(0.) *
                      outline.curve(before, positions).normal(1.) >
                    std::cos(angle);
    return smooth;
  }



  unsigned int
  ContactSurface::smooth_neighbour(const unsigned int edge,
                                   const unsigned int end) const
  {
    if (end == 0)
      return smooth[edge] ? outline.edges[edge].previous : no_edge;
    const unsigned int next = outline.edges[edge].next;
    return next != no_edge && smooth[next] ? next : no_edge;
  }



  bool
  ContactSurface::foot(const Point<2>     &x,
                       const unsigned int  edge,
                       const Tensor<1, 2> &begin,
                       const Tensor<1, 2> &end,
                       double             &xi) const
  {
    const EdgeCurve y = curve(edge);
    xi                = y.foot(x);
    for (unsigned int i = 0; i < 20; ++i)
      {
        const Tensor<1, 2> n     = (1. - xi) * begin + xi * end;
        const Tensor<1, 2> d     = x - y.point(xi);
        const double       along = cross(y.tangent(xi), n);
        const double       slope = along - cross(d, end - begin);
        const double       step  = cross(d, n) / slope;
        xi += step;
        // Far away, beyond the centre of curvature, there need not be a foot.
        if (!(std::abs(xi - 0.5) < 3.) || slope * along <= 0.)
          return false;
        // Newton's method: what is left now is the square of it. Round-off of
        // the coordinates would not let the step itself become much smaller.
        if (std::abs(step) < 1e-8)
          return true;
      }
    return false;
  }



  ContactProjection
  ContactSurface::project(const Point<2>                  &x,
                          const Tensor<1, 2>              &outward,
                          const std::vector<unsigned int> &candidates) const
  {
    // Both edges of a joint may miss its foot by round-off.
    constexpr double  margin = 1e-10;
    ContactProjection best;
    const auto        offer = [&](const unsigned int edge, const double xi) {
      const Tensor<1, 2> n   = normal(edge, xi);
      const double       gap = (x - curve(edge).point(xi)) * n / n.norm();
      const bool         behind =
        gap < 0. && outward * n > -std::sqrt(0.5) * outward.norm() * n.norm();
      if (!behind && (!best.found() || std::abs(gap) < std::abs(best.gap)))
        {
          best.edge = edge;
          best.xi   = xi;
          best.gap  = gap;
        }
    };
    double xi = 0.;
    for (const unsigned int e : candidates)
      if (foot(x, e, end_normals[e][0], end_normals[e][1], xi) &&
          xi >= -margin && xi <= 1. + margin)
        offer(e, std::min(std::max(xi, 0.), 1.));

    for (const unsigned int e : candidates)
      {
        const unsigned int next = outline.edges[e].next;
        if (next == no_edge || smooth[next] || !contains(candidates, next))
          continue;
        const Tensor<1, 2> here  = end_normals[e][1],
                           there = end_normals[next][0];
        double xi_next           = 0.;
        if (!foot(x, e, here, here, xi) ||
            !foot(x, next, there, there, xi_next))
          continue;
        const double after  = (xi - 1.) * curve(e).tangent(1.).norm();
        const double before = -xi_next * curve(next).tangent(0.).norm();
        if (after > 0. && before > 0.)
          after < before ? offer(e, xi) : offer(next, xi_next);
      }
    return best;
  }
} // namespace alveolus
