// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/spline_rule.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  SplineRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Open or closed curves, each fitted by itself.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter("Ends",
                      ends,
                      "End condition of open curves: not-a-knot (a cubic is "
                      "reproduced) or natural (no curvature at the ends).",
                      Patterns::Selection("not-a-knot|natural"));
    prm.add_parameter("Knots",
                      knots,
                      "Steps of the spline's parameter between nodes: their "
                      "distance, its square root (centripetal), or 1.",
                      Patterns::Selection("chord length|centripetal|uniform"));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  SplineRule<dim>::stage(const NamedSets<dim> & /*names*/,
                         const std::string & /*where*/) const
  {
    return Stage::lines;
  }

  template <int dim>
  CubicSpline<dim>
  SplineRule<dim>::fit(const std::vector<Point<dim>> &points,
                       const bool                     closed) const
  {
    using Spline = CubicSpline<dim>;
    return Spline(points,
                  closed                ? Spline::Ends::closed
                  : (ends == "natural") ? Spline::Ends::natural
                                        : Spline::Ends::not_a_knot,
                  knots == "uniform"       ? Spline::Knots::uniform
                  : knots == "centripetal" ? Spline::Knots::centripetal
                                           : Spline::Knots::chord_length);
  }

  template <int dim>
  void
  SplineRule<dim>::attach(const Nodes<dim>       &nodes,
                          const NodalVector      &positions,
                          const std::set<NodeId> &taken,
                          const std::string      &where)
  {
    require_names(on, where);
    curves.clear();
    touched.clear();
    for (const std::string &name : on)
      {
        AnchoredCurve curve(nodes.curve(name, where + "/On"), taken);
        // Here it is the mesh as given that has no spline, later on the run
        try
          {
            curve.keep(fit(nodes.gather(positions, curve.curve.nodes),
                           curve.curve.closed)
                         .arc_lengths());
          }
        catch (const RunError &error)
          {
            throw InputError(where + " / On",
                             "'" + name + "': " + error.what(),
                             "repair the mesh, or leave this curve out");
          }
        const auto free = curve.free_nodes();
        touched.insert(touched.end(), free.begin(), free.end());
        curves.push_back(curve);
      }
  }

  template <int dim>
  void
  SplineRule<dim>::apply(const Nodes<dim> &nodes,
                         const NodalVector & /*start*/,
                         const NodalVector &lagrangian,
                         NodalVector       &proposed,
                         RezoningReport & /*report*/) const
  {
    for (const AnchoredCurve &curve : curves)
      {
        auto       x  = nodes.gather(lagrangian, curve.curve.nodes);
        const auto at = nodes.gather(proposed, curve.curve.nodes);
        for (unsigned int i = 0; i < x.size(); ++i)
          if (curve.is_anchor(i))
            x[i] = at[i];
        const CubicSpline<dim> spline = fit(x, curve.curve.closed);
        for (unsigned int i = 0; i < x.size(); ++i)
          if (!curve.is_anchor(i) && nodes.is_owned(curve.curve.nodes[i]))
            nodes.set(proposed,
                      curve.curve.nodes[i],
                      spline.at_arc_length(
                        curve.station(i, spline.arc_lengths())));
      }
    proposed.update_ghost_values();
  }

  template class SplineRule<2>;
  template class SplineRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::SplineRule,
  "spline",
  "The nodes of each curve of `On` are relocated along the cubic spline through "
  "their Lagrangian positions to the relative arc lengths (s_i - s_a)/(s_b - "
  "s_a) they had at the start or at the last remesh. The end points a, b of an "
  "open curve and the first node of a closed one do not move, nor do nodes set "
  "by a rule of an earlier stage, which divide the curve; the spline goes "
  "through their proposed positions. `Knots` chooses the spline's parameter, "
  "`Ends` its end condition. Runs with the lines.")
