// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/follow_rule.h>
#include <alveolus/rezoning/node_sets.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  FollowRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Points, curves, boundaries or regions that follow.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter("Leader", leader_name, "Point that is followed.");
    prm.add_parameter("Components",
                      component_names,
                      "Components of the leader's displacement that are taken "
                      "over; none given: all.",
                      Patterns::List(Patterns::Selection("x|y|z")));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  FollowRule<dim>::stage(const NamedSets<dim> &names,
                         const std::string    &where) const
  {
    return stage_of(on, names, where);
  }

  template <int dim>
  void
  FollowRule<dim>::attach(const Nodes<dim> &nodes,
                          const NodalVector & /*positions*/,
                          const std::set<NodeId> &taken,
                          const std::string      &where)
  {
    components = parse_components<dim>(component_names, where);
    leader     = nodes.point(leader_name, where + "/Leader");
    followers  = nodes_of(on, nodes, taken, where);
    const unsigned int itself =
      std::count(followers.begin(), followers.end(), leader);
    // Not every process sees the leader, but all have to stop.
    if (Utilities::MPI::max(itself, nodes.configuration.communicator()) > 0)
      throw InputError(where + "/On",
                       "the leader '" + leader_name + "' is among them",
                       "a point cannot follow itself");
  }

  template <int dim>
  void
  FollowRule<dim>::apply(const Nodes<dim>  &nodes,
                         const NodalVector &start,
                         const NodalVector & /*lagrangian*/,
                         NodalVector &proposed,
                         RezoningReport & /*report*/) const
  {
    const Tensor<1, dim> displacement =
      nodes.gather(proposed, {leader})[0] - nodes.gather(start, {leader})[0];
    for (const NodeId node : followers)
      if (nodes.is_owned(node))
        {
          const auto &dofs = nodes.dofs(node);
          for (unsigned int c = 0; c < dim; ++c)
            if (components[c])
              proposed(dofs[c]) = start(dofs[c]) + displacement[c];
        }
    proposed.update_ghost_values();
  }

  template class FollowRule<2>;
  template class FollowRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::FollowRule,
  "follow",
  "The nodes `On` take the displacement of the point `Leader` over the step in "
  "the components c of `Components`: x_c = x_start,c + (x_leader,proposed - "
  "x_leader,start)_c. The other components are left to the material or to "
  "other rules. A leader moved by a rule that runs earlier counts with its "
  "proposed position. Runs with the points if all of `On` are points, with the "
  "lines if there are curves, with the surfaces (volumes) if there are "
  "boundaries in 3D (regions).")
