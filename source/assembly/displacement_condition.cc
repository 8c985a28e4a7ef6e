// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/displacement_condition.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  std::vector<NodeId>
  nodes_on(const Nodes<dim>  &nodes,
           const std::string &list,
           const std::string &where)
  {
    const auto      &sets = nodes.configuration.mesh.names;
    std::set<NodeId> result;
    for (const auto &name : Utilities::split_string_list(list, ','))
      if (sets.boundaries.count(name) > 0)
        {
          const auto on = nodes.boundary(name, where);
          result.insert(on.begin(), on.end());
        }
      else if (sets.curves.count(name) > 0)
        {
          for (const NodeId node : nodes.curve(name, where).nodes)
            if (nodes.is_relevant(node))
              result.insert(node);
        }
      else if (sets.points.count(name) > 0)
        {
          const NodeId node = nodes.point(name, where);
          if (nodes.is_relevant(node))
            result.insert(node);
        }
      else
        nodes.boundary(name, where); // throws and lists the known names
    return {result.begin(), result.end()};
  }



  template <int dim>
  void
  DisplacementCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      parameters.on,
                      "Boundaries, curves or points, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter("Components",
                      parameters.components,
                      "Held components: a list of x, y, z, or all.",
                      Patterns::Anything());
    prm.add_parameter(
      "Function",
      parameters.function,
      "Displacement [mm] of the components in the order listed, as expressions "
      "in x, y(, z) [mm] (where the material came from) and t [T], separated by "
      "semicolons. Empty: held.",
      Patterns::Anything());
  }



  template <int dim>
  void
  DisplacementCondition<dim>::attach(const State<dim>  &state,
                                     const std::string &path)
  {
    this->where = path;
    components  = parse_components(parameters.components == "all"
                                    ? (dim == 2 ? "x, y" : "x, y, z")
                                    : parameters.components,
                                  dim,
                                  path);
    nodes = nodes_on(state.nodes, parameters.on, path + " / On");
    if (!parameters.function.empty())
      function = parse_function<dim>(parameters.function,
                                     components.size(),
                                     path + " / Function");
  }



  template <int dim>
  void
  DisplacementCondition<dim>::prescribe(const State<dim>     &state,
                                        const Interval       &interval,
                                        PrescribedIncrements &increments) const
  {
    Vector<double>    before(components.size()), after(components.size());
    const NodalVector positions = state.configuration.positions();
    for (const NodeId node : nodes)
      {
        if (function)
          {
            const Point<dim> X(state.nodes.get(positions, node) -
                               state.nodes.get(state.displacement, node));
            function->set_time(interval.begin);
            function->vector_value(X, before);
            function->set_time(interval.end);
            function->vector_value(X, after);
          }
        for (unsigned int i = 0; i < components.size(); ++i)
          increments.prescribe(state.nodes.dofs(node)[components[i]],
                               after[i] - before[i],
                               this->where);
      }
  }



  template <int dim>
  std::string
  DisplacementCondition<dim>::describe() const
  {
    return parameters.on + ": components " + parameters.components +
           (function ? " follow " + parameters.function : " held");
  }

  template std::vector<NodeId>
  nodes_on(const Nodes<2> &, const std::string &, const std::string &);
  template std::vector<NodeId>
  nodes_on(const Nodes<3> &, const std::string &, const std::string &);
  template class DisplacementCondition<2>;
  template class DisplacementCondition<3>;

  ALVEOLUS_REGISTER_DIM(
    Condition,
    DisplacementCondition,
    "displacement",
    "Prescribed components of the displacement, du = g(X, t_{n+1}) - g(X, t_n) "
    "with g from `Function` (held at du = 0 without one), on the boundaries, "
    "curves and points listed in `On`.")
} // namespace alveolus
