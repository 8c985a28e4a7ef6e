// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_pair.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Simpson's rule. */
    constexpr std::array<double, 3> rule_points  = {{0., 0.5, 1.}};
    constexpr std::array<double, 3> rule_weights = {
      {1. / 6., 4. / 6., 1. / 6.}};
  } // namespace



  ContactPair::ContactPair(const Nodes<2>    &nodes,
                           const Parameters  &parameters,
                           const NodalVector &positions,
                           const std::string &slaves,
                           const std::string &masters,
                           const std::string &where)
    : parameters(parameters)
    , where(where)
    , slave(nodes, slaves, where + " / On")
    , master(nodes, masters, where + " / Against")
    , search_reach(parameters.reach)
  {
    std::set<std::pair<NodeId, NodeId>> lines;
    for (const auto &edge : slave.edges)
      lines.emplace(slave.nodes[edge.nodes[0]], slave.nodes[edge.nodes[1]]);
    for (const auto &edge : master.edges)
      if (lines.count(
            {master.nodes[edge.nodes[0]], master.nodes[edge.nodes[1]]}) > 0)
        throw InputError(where + " / Against",
                         "a boundary line is in `On`, too",
                         "a piece cannot be in contact with itself: name "
                         "other pieces");
    const auto x = slave.get(positions);
    if (search_reach == 0.)
      for (unsigned int e = 0; e < slave.n_edges(); ++e)
        search_reach = std::max(search_reach, 3. * slave.curve(e, x).length());
    coupled.resize(slave.n_edges());
    begin_step(positions);
  }



  void
  ContactPair::take_over(const ContactPair &old)
  {
    committed = old.committed;
    committed.forget_closed(old.slave);
    committed.forget_closed(slave);
  }



  void
  ContactPair::begin_step(const NodalVector &positions)
  {
    slave_n = slave_now = slave.get(positions);
    master_n = master_now = master.get(positions);
    n_augmented           = 0;
    points.clear();
    candidates.assign(slave.n_edges(), {});
    const double kink = parameters.kink * numbers::PI / 180.;
    slave_smooth      = ContactSurface::smooth_joints(slave, slave_n, kink);
    master_smooth     = ContactSurface::smooth_joints(master, master_n, kink);
    const ContactSurface   surface(master, master_n, master_smooth);
    const ContactSearch    search(surface);
    const ContactArcLength arc_length(slave, slave_n);
    bool                   new_couplings = false;
    for (unsigned int e = 0; e < slave.n_edges(); ++e)
      {
        const EdgeCurve curve = slave.curve(e, slave_n);
        candidates[e] =
          search.facing(search.near(curve, search_reach), curve.normal(0.5));
        if (candidates[e].empty())
          continue;
        place_points(e, surface, arc_length);
        for (const unsigned int c : candidates[e])
          new_couplings = new_couplings || coupled[e].count(c) == 0;
      }
    std::vector<bool> used;
    for (const auto &list : candidates)
      used.push_back(!list.empty());
    space = ContactMultiplierSpace(slave, used);
    pressure.assign(space.size(), 0.);
    shear.assign(space.size(), 0.);
    for (unsigned int e = 0; e < slave.n_edges(); ++e)
      for (const unsigned int end : {0, 1})
        if (used[e])
          {
            const auto old =
              committed.get(arc_length.chain[e], arc_length(e, end));
            pressure[space.index(e, end)] = old.pressure;
            shear[space.index(e, end)]    = old.shear;
          }

    if (!new_couplings)
      return;
    // With a margin, so that the matrix is not made anew in every step.
    for (unsigned int e = 0; e < slave.n_edges(); ++e)
      {
        const auto near =
          search.near(slave.curve(e, slave_n), 2. * search_reach);
        coupled[e] = {near.begin(), near.end()};
      }
    ++revision;
  }



  void
  ContactPair::place_points(const unsigned int      e,
                            const ContactSurface   &surface,
                            const ContactArcLength &arc_length)
  {
    const EdgeCurve  curve = slave.curve(e, slave_n);
    std::set<double> ends  = {0., 1.};
    // A straight line is deepest at an end of a piece, a parabola anywhere.
    if (slave.n_nodes_per_edge == 3)
      ends.insert({0.25, 0.5, 0.75});
    for (const unsigned int c : candidates[e])
      for (const unsigned int v : {0, 1})
        {
          const Point<2> &y  = master_n[master.edges[c].nodes[v]];
          const double    xi = curve.foot(y);
          if (xi > 1e-6 && xi < 1. - 1e-6 &&
              y.distance(curve.point(xi)) <= search_reach)
            ends.insert(xi);
        }
    for (auto end = std::next(ends.begin()); end != ends.end(); ++end)
      {
        // A master node between two lines is met twice, up to round-off.
        const double begin = *std::prev(end);
        if (*end - begin < 1e-9)
          continue;
        for (unsigned int q = 0; q < rule_points.size(); ++q)
          {
            SlavePoint point;
            point.edge = e;
            point.xi   = begin + (*end - begin) * rule_points[q];
            point.weight =
              rule_weights[q] * (*end - begin) * curve.tangent(point.xi).norm();
            const auto old =
              committed.get(arc_length.chain[e], arc_length(e, point.xi));
            point.old_slip = old.slip;
            if (parameters.sticks && old.touching > 0.5)
              point.anchor = surface.project(curve.point(point.xi),
                                             curve.normal(point.xi),
                                             candidates[e]);
            points.push_back(point);
          }
      }
  }



  void
  ContactPair::scatter(const SlavePoint     &point,
                       const ContactForces  &forces,
                       const AssemblyTarget &target) const
  {
    // The point follows the slave nodes; both bodies may share a node.
    std::vector<types::global_dof_index>                                  dofs;
    std::vector<std::pair<unsigned int, std::pair<unsigned int, double>>> map;
    const auto enter = [&](const types::global_dof_index dof,
                           const unsigned int            coordinate,
                           const double                  factor) {
      const auto found = std::find(dofs.begin(), dofs.end(), dof);
      map.emplace_back(found - dofs.begin(),
                       std::make_pair(coordinate, factor));
      if (found == dofs.end())
        dofs.push_back(dof);
    };
    const unsigned int n = slave.n_nodes_per_edge;
    const auto         N = EdgeCurve::shapes(point.xi, n);
    for (unsigned int d = 0; d < 2; ++d)
      {
        for (unsigned int a = 0; a < n; ++a)
          enter(slave.dofs[slave.edges[point.edge].nodes[a]][d], d, N[a]);
        for (unsigned int b = 0; b < forces.patch.nodes.size(); ++b)
          enter(master.dofs[forces.patch.nodes[b]][d], 2 + 2 * b + d, 1.);
      }

    Vector<double>     vector(dofs.size());
    FullMatrix<double> matrix(dofs.size(), dofs.size());
    for (const auto &[i, row] : map)
      {
        vector[i] += point.weight * row.second * forces.value[row.first];
        if (target.system != nullptr)
          for (const auto &[j, column] : map)
            matrix(i, j) += point.weight * row.second * column.second *
                            forces.matrix[row.first][column.first];
      }
    target.add_replicated(matrix, vector, dofs);
  }



  void
  ContactPair::add_forces(const NodalVector    &increment,
                          const AssemblyTarget &target)
  {
    const auto moved = [&](const ContactOutline        &outline,
                           const std::vector<Point<2>> &x_n,
                           std::vector<Point<2>>       &x) {
      x = outline.get(increment);
      for (unsigned int i = 0; i < x.size(); ++i)
        x[i] += x_n[i];
    };
    moved(slave, slave_n, slave_now);
    moved(master, master_n, master_now);
    const ContactSurface surface(master, master_now, master_smooth);
    const double         e = parameters.stiffness;
    // Bodies that just touch hold each other from the first iteration on.
    const double touching = -1e-6 * parameters.tolerance * e;
    for (auto &point : points)
      {
        const auto apply = [&](const ContactForces &forces) {
          point.in_contact = true;
          for (unsigned int d = 0; d < 2; ++d)
            point.traction[d] = -forces.value[d];
          scatter(point, forces, target);
        };
        point.in_contact = false;
        point.pressure = point.slip = point.shear_now = 0.;
        point.traction                                = Tensor<1, 2>();
        const double multiplier = space.value(pressure, point.edge, point.xi);
        const EdgeCurve curve   = slave.curve(point.edge, slave_now);
        const Point<2>  x       = curve.point(point.xi);
        if (point.anchor.found())
          {
            const ContactOffset offset(x,
                                       surface,
                                       point.anchor.edge,
                                       point.anchor.xi);
            const double        p = multiplier - e * offset.gap.value;
            if (p < touching)
              continue;
            point.pressure = std::max(p, 0.);
            point.slip     = point.old_slip + offset.slip.value;
            point.shear_now =
              space.value(shear, point.edge, point.xi) + e * point.slip;
            apply(sticking_forces(offset, point.pressure, point.shear_now, e));
          }
        else
          {
            const ContactProjection projection =
              surface.project(x,
                              curve.normal(point.xi),
                              candidates[point.edge]);
            if (!projection.found())
              continue;
            const double p = multiplier - e * projection.gap;
            if (p < touching)
              continue;
            point.pressure = std::max(p, 0.);
            apply(pressing_forces(ContactGap(x, surface, projection),
                                  point.pressure,
                                  e));
          }
      }
  }



  void
  ContactPair::add_couplings(DofGroups &couplings) const
  {
    const unsigned int n = slave.n_nodes_per_edge;
    for (unsigned int e = 0; e < slave.n_edges(); ++e)
      for (const unsigned int c : coupled[e])
        {
          std::set<types::global_dof_index> dofs;
          const auto enter = [&](const auto &outline, const auto edge) {
            if (edge != no_edge)
              for (unsigned int a = 0; a < n; ++a)
                for (const auto dof :
                     outline.dofs[outline.edges[edge].nodes[a]])
                  dofs.insert(dof);
          };
          // The normal depends on the neighbours, too.
          enter(slave, e);
          enter(master, c);
          enter(master, master.edges[c].previous);
          enter(master, master.edges[c].next);
          couplings.emplace_back(dofs.begin(), dofs.end());
        }
  }



  std::vector<double>
  ContactPair::projected(double SlavePoint::*quantity) const
  {
    std::vector<ContactMultiplierSpace::Sample> samples;
    for (const auto &point : points)
      samples.push_back({point.edge, point.xi, point.weight, point.*quantity});
    return space.project(samples);
  }



  bool
  ContactPair::augment()
  {
    const auto new_pressure = projected(&SlavePoint::pressure);
    const auto new_shear    = projected(&SlavePoint::shear_now);
    double     largest      = 0.; // change over the penalty
    for (unsigned int i = 0; i < space.size(); ++i)
      largest = std::max({largest,
                          std::abs(std::max(new_pressure[i], 0.) - pressure[i]),
                          std::abs(new_shear[i] - shear[i])});
    largest /= parameters.stiffness;
    if (largest > parameters.tolerance)
      {
        if (n_augmented == parameters.n_augmentations)
          {
            std::ostringstream text;
            text << "penetration or slip of " << largest << " mm after "
                 << n_augmented << " augmentations";
            throw RunError(where,
                           text.str(),
                           "raise `Stiffness` or `Augmentations`");
          }
        for (unsigned int i = 0; i < space.size(); ++i)
          pressure[i] = std::max(new_pressure[i], 0.);
        shear = new_shear;
        ++n_augmented;
        return true;
      }

    // Has the step been too large for the search at x_n?
    const ContactSurface surface(master, master_now, master_smooth);
    const ContactSearch  search(surface);
    for (unsigned int s = 0; s < slave.n_edges(); ++s)
      {
        const EdgeCurve curve = slave.curve(s, slave_now);
        for (const double xi : {0., 0.25, 0.5, 0.75, 1.})
          {
            const ContactProjection found =
              search.project(curve.point(xi), curve.normal(xi), search_reach);
            if (found.found() && found.gap < -parameters.tolerance &&
                std::find(candidates[s].begin(),
                          candidates[s].end(),
                          found.edge) == candidates[s].end())
              {
                std::ostringstream text;
                text << "near (" << curve.point(xi) << ") mm a line has got "
                     << -found.gap
                     << " mm into one that was farther than the search "
                        "distance at the beginning of the step";
                throw RunError(where,
                               text.str(),
                               "raise `Search distance` or take smaller steps");
              }
          }
      }
    return false;
  }



  void
  ContactPair::commit()
  {
    const ContactArcLength arc_length(slave, slave_now);
    std::vector<std::vector<ContactMultipliers::Sample>> samples(
      slave.chains.size());
    for (unsigned int s = 0; s < slave.n_edges(); ++s)
      if (candidates[s].empty())
        for (const double xi : {0., 1.})
          samples[arc_length.chain[s]].emplace_back(
            arc_length(s, xi), ContactMultipliers::Value());
    const auto new_pressure = projected(&SlavePoint::pressure);
    const auto new_shear    = projected(&SlavePoint::shear_now);
    for (const auto &point : points)
      {
        // Per length of x_{n+1}, so that the nodal forces stay
        const double stretch =
          slave.curve(point.edge, slave_now).tangent(point.xi).norm() /
          slave.curve(point.edge, slave_n).tangent(point.xi).norm();
        ContactMultipliers::Value value;
        value.pressure =
          std::max(space.value(new_pressure, point.edge, point.xi), 0.) /
          stretch;
        value.shear    = space.value(new_shear, point.edge, point.xi) / stretch;
        value.slip     = point.anchor.found() ? point.slip : 0.;
        value.touching = point.in_contact ? 1. : 0.;
        samples[arc_length.chain[point.edge]].emplace_back(
          arc_length(point.edge, point.xi), value);
      }
    for (unsigned int c = 0; c < samples.size(); ++c)
      committed.set(c, samples[c]);
  }



  void
  ContactPair::save(const std::string &prefix, BlockFile &blocks) const
  {
    committed.save(prefix, blocks);
    // What is coupled depends on earlier steps. It does not change forces, but
    // the last digits of solutions by the structure of the matrix.
    BlockFile::Integers list;
    for (const auto &edges : coupled)
      {
        list.push_back(edges.size());
        list.insert(list.end(), edges.begin(), edges.end());
      }
    blocks.put(prefix + "couplings", std::move(list));
  }



  void
  ContactPair::load(const std::string &prefix, const BlockFile &blocks)
  {
    committed.load(prefix, blocks);
    const std::string name = prefix + "couplings";
    const auto       &list = blocks.integers(name);
    std::size_t       next = 0;
    for (auto &edges : coupled)
      {
        edges.clear();
        const std::uint64_t n = next < list.size() ? list[next++] : 1;
        if (n > list.size() - next)
          blocks.refuse(name, "is shorter than the outline needs");
        for (std::uint64_t i = 0; i < n; ++i, ++next)
          {
            if (list[next] >= master.n_edges())
              blocks.refuse(name, "names a line that does not exist");
            edges.insert(list[next]);
          }
      }
    ++revision;
  }
} // namespace alveolus
