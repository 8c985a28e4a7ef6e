// SPDX-License-Identifier: LGPL-2.1-or-later
// What a contact pair tells of itself.
#include <alveolus/assembly/contact_pair.h>

namespace alveolus
{
  using namespace dealii;

  ContactPair::Summary
  ContactPair::summary() const
  {
    Summary      sum;
    Tensor<1, 2> moment; // of pressure
    double       total           = 0.;
    const auto   smooth_pressure = projected(&SlavePoint::pressure);
    for (const auto &point : points)
      if (point.pressure > 0.)
        {
          const EdgeCurve curve = slave.curve(point.edge, slave_now);
          const double    stretch =
            curve.tangent(point.xi).norm() /
            slave.curve(point.edge, slave_n).tangent(point.xi).norm();
          sum.length += point.weight * stretch;
          sum.pressure =
            std::max(sum.pressure,
                     space.value(smooth_pressure, point.edge, point.xi) /
                       stretch);
          total += point.weight * point.pressure;
          moment +=
            point.weight * point.pressure * Tensor<1, 2>(curve.point(point.xi));
          sum.force += point.weight * point.traction;
        }
    if (total > 0.)
      sum.centre = Point<2>(moment / total);

    const ContactSurface master_surface(master, master_now, master_smooth);
    const ContactSurface slave_surface(slave, slave_now, slave_smooth);
    const ContactSearch  on_master(master_surface), on_slave(slave_surface);
    sum.slave_penetration = std::max(0., -smallest_gap(on_master));
    std::vector<Tensor<1, 2>> normals(master.nodes.size());
    for (unsigned int e = 0; e < master.n_edges(); ++e)
      for (unsigned int a = 0; a < master.n_nodes_per_edge; ++a)
        normals[master.edges[e].nodes[a]] +=
          master_surface.curve(e).normal(a == 2 ? 0.5 : a);
    const std::set<NodeId> shared(slave.nodes.begin(), slave.nodes.end());
    for (unsigned int i = 0; i < master.nodes.size(); ++i)
      if (shared.count(master.nodes[i]) == 0)
        {
          const ContactProjection found =
            on_slave.project(master_now[i],
                             normals[i] / normals[i].norm(),
                             search_reach);
          if (found.found())
            sum.master_penetration =
              std::max(sum.master_penetration, -found.gap);
        }
    return sum;
  }



  double
  ContactPair::smallest_gap(const ContactSearch &search) const
  {
    constexpr unsigned int n_samples = 16; // of a line
    double                 smallest  = 0.;
    for (unsigned int s = 0; s < slave.n_edges(); ++s)
      {
        const EdgeCurve curve = slave.curve(s, slave_now);
        for (unsigned int i = 0; i <= n_samples; ++i)
          {
            const double            xi = double(i) / n_samples;
            const ContactProjection found =
              search.project(curve.point(xi), curve.normal(xi), search_reach);
            if (found.found())
              smallest = std::min(smallest, found.gap);
          }
      }
    return smallest;
  }
} // namespace alveolus
