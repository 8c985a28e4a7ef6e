// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/copied_nodes.h>
#include <alveolus/rezoning/node_sets.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  CopiedNodes<dim>::CopiedNodes(const std::string &which, const Source source)
    : which(which)
    , source(source)
  {}

  template <int dim>
  void
  CopiedNodes<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Points, curves, boundaries or regions.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter("Components",
                      component_names,
                      "Components that " + which + "; none given: all.",
                      Patterns::List(Patterns::Selection("x|y|z")));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  CopiedNodes<dim>::stage(const NamedSets<dim> &names,
                          const std::string    &where) const
  {
    return stage_of(on, names, where);
  }

  template <int dim>
  void
  CopiedNodes<dim>::attach(const Nodes<dim> &nodes,
                           const NodalVector & /*positions*/,
                           const std::set<NodeId> &taken,
                           const std::string      &where)
  {
    components = parse_components<dim>(component_names, where);
    touched    = nodes_of(on, nodes, taken, where);
  }

  template <int dim>
  void
  CopiedNodes<dim>::apply(const Nodes<dim>  &nodes,
                          const NodalVector &start,
                          const NodalVector &lagrangian,
                          NodalVector       &proposed,
                          RezoningReport & /*report*/) const
  {
    copy_components<dim>(nodes,
                         touched,
                         components,
                         source == Source::start ? start : lagrangian,
                         proposed);
  }

  template <int dim>
  FixedRule<dim>::FixedRule()
    : CopiedNodes<dim>("are fixed", CopiedNodes<dim>::Source::start)
  {}

  template <int dim>
  MaterialRule<dim>::MaterialRule()
    : CopiedNodes<dim>("stay with the material",
                       CopiedNodes<dim>::Source::lagrangian)
  {}

  template class CopiedNodes<2>;
  template class CopiedNodes<3>;
  template class FixedRule<2>;
  template class FixedRule<3>;
  template class MaterialRule<2>;
  template class MaterialRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::FixedRule,
  "fixed",
  "Eulerian nodes: in the components c of `Components` the nodes `On` go back "
  "to where they were before the step, x_c = x_start,c, and the material flows "
  "through the mesh. Stages as for `follow`.")

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::MaterialRule,
  "material",
  "Lagrangian nodes: in the components c of `Components` the nodes `On` stay "
  "with the material, x_c = x_lagrangian,c. Nodes without a rule do so anyway; "
  "this one takes nodes away from rules of later stages, e.g. a point of a "
  "smoothed region. Stages as for `follow`.")
