// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/straight_rule.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  StraightRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Curves that stay straight, each by itself.",
                      Patterns::List(Patterns::Anything()));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  StraightRule<dim>::stage(const NamedSets<dim> & /*names*/,
                           const std::string & /*where*/) const
  {
    return Stage::lines;
  }

  template <int dim>
  void
  StraightRule<dim>::attach(const Nodes<dim>       &nodes,
                            const NodalVector      &positions,
                            const std::set<NodeId> &taken,
                            const std::string      &where)
  {
    require_names(on, where);
    lines.clear();
    touched.clear();
    for (const std::string &name : on)
      {
        AnchoredCurve line(nodes.curve(name, where + "/On"), taken);
        if (line.n_anchors() < 2)
          throw InputError(where + "/On",
                           "curve '" + name + "' is closed",
                           "use the rule 'spline'");
        const auto          x = nodes.gather(positions, line.curve.nodes);
        std::vector<double> lengths(1, 0.);
        for (unsigned int i = 1; i < x.size() + (line.curve.closed ? 1 : 0);
             ++i)
          lengths.push_back(lengths.back() +
                            x[i % x.size()].distance(x[i - 1]));
        line.keep(lengths);
        const auto free = line.free_nodes();
        touched.insert(touched.end(), free.begin(), free.end());
        lines.push_back(line);
      }
  }

  template <int dim>
  void
  StraightRule<dim>::apply(const Nodes<dim> &nodes,
                           const NodalVector & /*start*/,
                           const NodalVector & /*lagrangian*/,
                           NodalVector &proposed,
                           RezoningReport & /*report*/) const
  {
    for (const AnchoredCurve &line : lines)
      {
        const auto x = nodes.gather(proposed, line.curve.nodes);
        for (unsigned int i = 0; i < x.size(); ++i)
          if (!line.is_anchor(i) && nodes.is_owned(line.curve.nodes[i]))
            {
              const auto   ends = line.anchors(i);
              const double r    = line.relative(i);
              nodes.set(proposed,
                        line.curve.nodes[i],
                        Point<dim>((1. - r) * x[ends.first] +
                                   r * x[ends.second]));
            }
      }
    proposed.update_ghost_values();
  }

  template class StraightRule<2>;
  template class StraightRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::StraightRule,
  "straight",
  "Each curve of `On` stays straight: its nodes lie on the segment between the "
  "proposed positions of its ends, x = (1-r) x_a + r x_b, with the relative "
  "lengths r they had at the start or at the last remesh. Nodes of the curve "
  "that a rule of an earlier stage sets divide it into segments. The ends are "
  "not moved. Runs with the lines.")
