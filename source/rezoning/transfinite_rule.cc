// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/lattice.h>
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/transfinite_rule.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** The border of a lattice with its positions, on every process. */
    template <int dim>
    struct Border
    {
      using Index = typename Lattice<dim>::Index;

      Border(const Lattice<dim> &lattice)
        : lattice(lattice)
      {
        for (std::size_t i = 0; i < lattice.nodes.size(); ++i)
          if (lattice.is_border(lattice.index(i)))
            {
              place.emplace(lattice.nodes[i], nodes.size());
              nodes.push_back(lattice.nodes[i]);
            }
      }

      unsigned int
      at(const Index &index) const
      {
        return place.at(lattice.at(index));
      }

      const Lattice<dim>                      &lattice;
      std::vector<NodeId>                      nodes;
      std::vector<Point<dim>>                  x;
      std::unordered_map<NodeId, unsigned int> place;
    };

    /** Relative lengths along the edges of each direction [direction][edge]. */
    template <int dim>
    using EdgeStations =
      std::array<std::array<std::vector<double>, 1u << (dim - 1)>, dim>;

    /** Bit e of the end of direction @p b for edge @p e of direction @p a. */
    inline unsigned int
    end_bit(const unsigned int e, const unsigned int a, const unsigned int b)
    {
      return (e >> (b < a ? b : b - 1)) & 1u;
    }

    template <int dim>
    EdgeStations<dim>
    edge_stations(const Border<dim> &border)
    {
      EdgeStations<dim> stations;
      const auto       &n = border.lattice.n;
      for (unsigned int a = 0; a < dim; ++a)
        for (unsigned int e = 0; e < stations[a].size(); ++e)
          {
            typename Lattice<dim>::Index index;
            for (unsigned int b = 0; b < dim; ++b)
              index[b] = b != a && end_bit(e, a, b) ? n[b] : 0;
            std::vector<double> &s        = stations[a][e];
            Point<dim>           previous = border.x[border.at(index)];
            s.push_back(0.);
            while (index[a] < n[a])
              {
                ++index[a];
                const Point<dim> next = border.x[border.at(index)];
                s.push_back(s.back() + next.distance(previous));
                previous = next;
              }
            for (double &value : s)
              value /= s.back();
            s.back() = 1.;
          }
      return stations;
    }

    /** Parameters xi of the node at @p index, blended between the edges. */
    template <int dim>
    Point<dim>
    parameters(const EdgeStations<dim>            &stations,
               const typename Lattice<dim>::Index &index)
    {
      Point<dim> xi;
      for (unsigned int a = 0; a < dim; ++a)
        xi[a] = stations[a][0][index[a]];
      // xi_a depends linearly on the others, which makes this a contraction
      // unless opposite edges are graded against each other extremely; the
      // residual makes up for what is left.
      for (unsigned int iteration = 0; iteration < 50; ++iteration)
        for (unsigned int a = 0; a < dim; ++a)
          {
            double value = 0.;
            for (unsigned int e = 0; e < stations[a].size(); ++e)
              {
                double weight = 1.;
                for (unsigned int b = 0; b < dim; ++b)
                  if (b != a)
                    weight *= end_bit(e, a, b) ? xi[b] : 1. - xi[b];
                value += weight * stations[a][e][index[a]];
              }
            xi[a] = value;
          }
      return xi;
    }
  } // namespace

  template <int dim>
  void
  TransfiniteRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Regions, each of which is one structured block.",
                      Patterns::List(Patterns::Anything()));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  TransfiniteRule<dim>::stage(const NamedSets<dim> & /*names*/,
                              const std::string & /*where*/) const
  {
    return Stage::volumes;
  }

  template <int dim>
  typename TransfiniteRule<dim>::Block
  TransfiniteRule<dim>::make_block(const Nodes<dim>       &nodes,
                                   const NodalVector      &positions,
                                   const std::set<NodeId> &taken,
                                   const std::string      &name,
                                   const std::string      &where) const
  {
    const Lattice<dim> lattice(nodes, name, where + "/On");
    Border<dim>        border(lattice);
    border.x            = nodes.gather(positions, border.nodes);
    const auto stations = edge_stations(border);

    Block        block;
    unsigned int n_degenerate = 0;
    block.border              = border.nodes;
    for (std::size_t i = 0; i < lattice.nodes.size(); ++i)
      {
        const auto   index = lattice.index(i);
        const NodeId node  = lattice.nodes[i];
        if (lattice.is_border(index) || !nodes.is_owned(node) ||
            taken.count(node) > 0)
          continue;
        const Point<dim> xi = parameters<dim>(stations, index);

        // Boolean sum of the projectors: each direction is either left alone
        // (digit 0) or taken at its lower or upper side (1, 2).
        std::unordered_map<unsigned int, double> weights;
        const unsigned int                       n_terms = dim == 2 ? 9 : 27;
        for (unsigned int term = 1; term < n_terms; ++term)
          {
            auto   side   = index;
            double weight = -1.;
            for (unsigned int a = 0, digits = term; a < dim; ++a, digits /= 3)
              if (digits % 3 != 0)
                {
                  const bool upper = digits % 3 == 2;
                  side[a]          = upper ? lattice.n[a] : 0;
                  weight *= -(upper ? xi[a] : 1. - xi[a]);
                }
            weights[border.at(side)] += weight;
          }

        Tensor<1, dim> residual = nodes.get(positions, node);
        for (const auto &parent : weights)
          residual -= parent.second * border.x[parent.first];
        Tensor<2, dim>                                         between;
        std::array<std::pair<unsigned int, unsigned int>, dim> sides;
        for (unsigned int a = 0; a < dim; ++a)
          {
            auto lower = index, upper = index;
            lower[a] = 0;
            upper[a] = lattice.n[a];
            sides[a] = {border.at(lower), border.at(upper)};
            const Tensor<1, dim> across =
              border.x[sides[a].second] - border.x[sides[a].first];
            for (unsigned int c = 0; c < dim; ++c)
              between[c][a] = across[c];
          }
        if (!(std::abs(determinant(between)) >
              1e-12 * std::pow(between.norm(), dim)))
          {
            ++n_degenerate;
            continue;
          }
        const Tensor<1, dim> alpha = invert(between) * residual;
        for (unsigned int a = 0; a < dim; ++a)
          {
            weights[sides[a].first] -= alpha[a];
            weights[sides[a].second] += alpha[a];
          }

        InnerNode inner;
        inner.node = node;
        for (const auto &parent : weights)
          inner.parents.emplace_back(parent.second, parent.first);
        // In the order of the lattice, whatever the hash
        std::sort(inner.parents.begin(),
                  inner.parents.end(),
                  [](const auto &p, const auto &q) {
                    return p.second < q.second;
                  });
        block.inner.push_back(inner);
      }
    if (Utilities::MPI::sum(n_degenerate, nodes.configuration.communicator()) >
        0)
      throw InputError(
        where + "/On",
        "the block '" + name +
          "' is folded: lines between opposite sides are parallel",
        "use another rule, e.g. 'Giuliani'");
    return block;
  }

  template <int dim>
  void
  TransfiniteRule<dim>::attach(const Nodes<dim>       &nodes,
                               const NodalVector      &positions,
                               const std::set<NodeId> &taken,
                               const std::string      &where)
  {
    require_names(on, where);
    blocks.clear();
    touched.clear();
    for (const std::string &name : on)
      {
        blocks.push_back(make_block(nodes, positions, taken, name, where));
        for (const InnerNode &inner : blocks.back().inner)
          touched.push_back(inner.node);
      }
  }

  template <int dim>
  void
  TransfiniteRule<dim>::apply(const Nodes<dim> &nodes,
                              const NodalVector & /*start*/,
                              const NodalVector & /*lagrangian*/,
                              NodalVector &proposed,
                              RezoningReport & /*report*/) const
  {
    for (const Block &block : blocks)
      {
        const auto x = nodes.gather(proposed, block.border);
        for (const InnerNode &inner : block.inner)
          {
            Point<dim> sum;
            for (const auto &parent : inner.parents)
              sum += parent.first * x[parent.second];
            nodes.set(proposed, inner.node, sum);
          }
      }
    proposed.update_ghost_values();
  }

  template class TransfiniteRule<2>;
  template class TransfiniteRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::TransfiniteRule,
  "transfinite",
  "The nodes inside each region of `On`, a structured block, follow its edges "
  "(faces in 3D) by transfinite interpolation: with P_a = (1-xi_a) x(lower "
  "side) + xi_a x(upper side) across direction a, x = P_1 + P_2 - P_1 P_2 "
  "(Boolean sum of P_1, P_2, P_3 in 3D), plus alpha_a times the vectors between "
  "opposite sides. The parameters xi and alpha are those of the mesh at the "
  "start or after the last remesh, so that an undeformed block stays as it is "
  "and affine motions of the border are followed exactly. The border keeps "
  "what line and surface rules or the material gave. Runs with the volumes.")
