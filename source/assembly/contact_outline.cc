// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/condition.h>
#include <alveolus/assembly/contact_outline.h>
#include <alveolus/base/errors.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** A node of a line, as its process tells the others. */
    struct LineNode
    {
      NodeId                                 id = 0;
      std::array<types::global_dof_index, 2> dofs;
      Point<2>                               place; ///< initially [mm]

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &id &dofs &place;
      }
    };

    /** Begin, end and middle (of degree 1: begin again). */
    using Line = std::array<LineNode, 3>;

    /**
     * The lines of all processes with one of the boundary @p ids, each with its
     * body on the left (collective).
     */
    std::vector<Line>
    lines_of(const Nodes<2> &nodes, const std::set<types::boundary_id> &ids)
    {
      // Vertices of the faces of a cell, the cell on the left.
      static constexpr unsigned int left[4][2]    = {{2, 0},
                                                     {1, 3},
                                                     {0, 1},
                                                     {3, 2}};
      const auto                   &configuration = nodes.configuration;
      std::vector<Line>             lines;
      std::vector<NodeId>           cell_nodes;
      for (const auto &[cell, f] : boundary_faces(configuration, ids))
        {
          nodes.cell_nodes(cell, cell_nodes);
          const std::array<NodeId, 3> id = {
            {cell_nodes[left[f][0]],
             cell_nodes[left[f][1]],
             cell_nodes[configuration.degree == 2 ? 4 + f : left[f][0]]}};
          lines.emplace_back();
          for (unsigned int a = 0; a < 3; ++a)
            lines.back()[a] = {id[a],
                               nodes.dofs(id[a]),
                               nodes.get(configuration.initial_positions(),
                                         id[a])};
        }
      const auto all =
        Utilities::MPI::all_gather(configuration.communicator(), lines);
      lines.clear();
      for (const auto &part : all)
        lines.insert(lines.end(), part.begin(), part.end());
      return lines;
    }
  } // namespace



  EdgeCurve::EdgeCurve(const std::array<Point<2>, 3> &nodes,
                       const unsigned int             n_nodes)
    : nodes(nodes)
    , n_nodes(n_nodes)
  {}



  std::array<double, 3>
  EdgeCurve::shapes(const double xi, const unsigned int n_nodes)
  {
    if (n_nodes == 2)
      return {{1. - xi, xi, 0.}};
    return {
      {(1. - xi) * (1. - 2. * xi), xi * (2. * xi - 1.), 4. * xi * (1. - xi)}};
  }



  std::array<double, 3>
  EdgeCurve::shape_derivatives(const double xi, const unsigned int n_nodes)
  {
    if (n_nodes == 2)
      return {{-1., 1., 0.}};
    return {{4. * xi - 3., 4. * xi - 1., 4. - 8. * xi}};
  }



  Point<2>
  EdgeCurve::point(const double xi) const
  {
    const auto N = shapes(xi, n_nodes);
    Point<2>   x;
    for (unsigned int a = 0; a < n_nodes; ++a)
      x += N[a] * nodes[a];
    return x;
  }



  Tensor<1, 2>
  EdgeCurve::tangent(const double xi) const
  {
    const auto   dN = shape_derivatives(xi, n_nodes);
    Tensor<1, 2> t;
    for (unsigned int a = 0; a < n_nodes; ++a)
      t += dN[a] * nodes[a];
    return t;
  }



  Tensor<1, 2>
  EdgeCurve::curvature() const
  {
    if (n_nodes == 2)
      return Tensor<1, 2>();
    return 4. * Tensor<1, 2>(nodes[0]) + 4. * Tensor<1, 2>(nodes[1]) -
           8. * Tensor<1, 2>(nodes[2]);
  }



  Tensor<1, 2>
  EdgeCurve::normal(const double xi) const
  {
    // cross_product_2d turns clockwise: to the right, out of the body.
    const Tensor<1, 2> t = tangent(xi);
    return cross_product_2d(t) / t.norm();
  }



  double
  EdgeCurve::length(const double a, const double b) const
  {
    if (n_nodes == 2)
      return (b - a) * (nodes[1] - nodes[0]).norm();
    static const QGauss<1> rule(4);
    double                 sum = 0.;
    for (unsigned int q = 0; q < rule.size(); ++q)
      sum += rule.weight(q) * (b - a) *
             tangent(a + (b - a) * rule.point(q)[0]).norm();
    return sum;
  }



  double
  EdgeCurve::foot(const Point<2> &x, const double start) const
  {
    double             xi = start;
    const Tensor<1, 2> c  = curvature();
    for (unsigned int i = 0; i < 30; ++i)
      {
        const Tensor<1, 2> d = x - point(xi);
        const Tensor<1, 2> t = tangent(xi);
        // Beyond the centre of curvature the full derivative points away from
        // the foot; t.t alone always descends.
        const double slope = std::max(t * t - d * c, 0.1 * (t * t));
        const double step  = (d * t) / slope;
        xi += std::min(std::max(step, -0.5), 0.5);
        if (n_nodes == 2)
          return start + step;
        if (std::abs(step) < 1e-8)
          break;
      }
    return xi;
  }



  double
  EdgeCurve::foot(const Point<2> &x) const
  {
    const Tensor<1, 2> chord = nodes[1] - nodes[0];
    const double       xi    = ((x - nodes[0]) * chord) / (chord * chord);
    return n_nodes == 2 ? xi : foot(x, std::min(std::max(xi, 0.), 1.));
  }



  ContactOutline::ContactOutline(const Nodes<2>    &mesh_nodes,
                                 const std::string &list,
                                 const std::string &where)
    : n_nodes_per_edge(mesh_nodes.configuration.degree + 1)
    , mesh_nodes(&mesh_nodes)
  {
    const auto                    &configuration = mesh_nodes.configuration;
    std::map<NodeId, unsigned int> number;
    std::map<unsigned int, unsigned int>   begins_at, ends_at;
    std::vector<Point<2>>                  initial;
    std::vector<Edge>                      found;
    std::vector<std::vector<unsigned int>> pieces; // edges of each name
    const auto before = [&](const unsigned int a, const unsigned int b) {
      const Point<2> x = initial[a], y = initial[b];
      return x[0] != y[0] ? x[0] < y[0] : x[1] < y[1];
    };
    for (const auto &name : Utilities::split_string_list(list, ','))
      {
        pieces.emplace_back();
        for (const auto &line :
             lines_of(mesh_nodes,
                      configuration.mesh.names.boundary(name, where)))
          {
            Edge edge;
            for (unsigned int a = 0; a < 3; ++a)
              {
                const auto added = number.emplace(line[a].id, nodes.size());
                if (added.second)
                  {
                    nodes.push_back(line[a].id);
                    dofs.push_back(line[a].dofs);
                    initial.push_back(line[a].place);
                  }
                edge.nodes[a] = added.first->second;
              }
            const auto begin = begins_at.find(edge.nodes[0]);
            if (begin != begins_at.end() &&
                found[begin->second].nodes == edge.nodes)
              continue; // a line that has two of the names
            const bool first =
              begins_at.emplace(edge.nodes[0], found.size()).second;
            if (!first || !ends_at.emplace(edge.nodes[1], found.size()).second)
              {
                std::ostringstream text;
                text << "more than two boundary lines meet at ("
                     << initial[edge.nodes[first ? 1 : 0]] << ")";
                throw InputError(where,
                                 text.str(),
                                 "leave one of the pieces out");
              }
            pieces.back().push_back(found.size());
            found.push_back(edge);
          }
      }
    for (const auto &[node, edge] : begins_at)
      {
        const auto ending = ends_at.find(node);
        if (ending != ends_at.end())
          {
            found[edge].previous       = ending->second;
            found[ending->second].next = edge;
          }
      }

    // Put the edges in order, piece by piece and chain by chain.
    std::vector<unsigned int> new_number(found.size(), no_edge);
    std::vector<unsigned int> order;
    for (auto &piece : pieces)
      {
        const std::set<unsigned int> mine(piece.begin(), piece.end());
        std::sort(piece.begin(),
                  piece.end(),
                  [&](const unsigned int a, const unsigned int b) {
                    return before(found[a].nodes[0], found[b].nodes[0]);
                  });
        for (const bool closed : {false, true})
          for (const unsigned int start : piece)
            {
              if (new_number[start] != no_edge ||
                  (!closed && mine.count(found[start].previous) > 0))
                continue;
              Chain chain;
              chain.first  = order.size();
              chain.closed = closed;
              for (unsigned int e = start;
                   mine.count(e) > 0 && new_number[e] == no_edge;
                   e = found[e].next)
                {
                  new_number[e] = order.size();
                  order.push_back(e);
                }
              chain.n_edges = order.size() - chain.first;
              chains.push_back(chain);
            }
      }
    for (const unsigned int e : order)
      {
        Edge edge = found[e];
        if (edge.previous != no_edge)
          edge.previous = new_number[edge.previous];
        if (edge.next != no_edge)
          edge.next = new_number[edge.next];
        edges.push_back(edge);
      }
  }



  std::vector<Point<2>>
  ContactOutline::get(const NodalVector &field) const
  {
    return mesh_nodes->gather(field, nodes);
  }



  EdgeCurve
  ContactOutline::curve(const unsigned int           edge,
                        const std::vector<Point<2>> &positions) const
  {
    const auto &n = edges[edge].nodes;
    return EdgeCurve({{positions[n[0]], positions[n[1]], positions[n[2]]}},
                     n_nodes_per_edge);
  }
} // namespace alveolus
