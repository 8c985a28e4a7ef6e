// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/material_rule.h>
#include <alveolus/rezoning/node_sets.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  MaterialRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Points, curves, boundaries or regions.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter(
      "Components",
      component_names,
      "Components that stay with the material; none given: all.",
      Patterns::List(Patterns::Selection("x|y|z")));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  MaterialRule<dim>::stage(const NamedSets<dim> &names,
                           const std::string    &where) const
  {
    return stage_of(on, names, where);
  }

  template <int dim>
  void
  MaterialRule<dim>::attach(const Nodes<dim> &nodes,
                            const NodalVector & /*positions*/,
                            const std::set<NodeId> &taken,
                            const std::string      &where)
  {
    components = parse_components<dim>(component_names, where);
    touched    = nodes_of(on, nodes, taken, where);
  }

  template <int dim>
  void
  MaterialRule<dim>::apply(const Nodes<dim> &nodes,
                           const NodalVector & /*start*/,
                           const NodalVector &lagrangian,
                           NodalVector       &proposed,
                           RezoningReport & /*report*/) const
  {
    copy_components<dim>(nodes, touched, components, lagrangian, proposed);
  }

  template class MaterialRule<2>;
  template class MaterialRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::MaterialRule,
  "material",
  "Lagrangian nodes: in the components c of `Components` the nodes `On` stay "
  "with the material, x_c = x_lagrangian,c. Nodes without a rule do so anyway; "
  "this one takes nodes away from rules of later stages, e.g. a point of a "
  "smoothed region. Stages as for `follow`.")
