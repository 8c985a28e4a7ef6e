// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_node_sets_h
#define alveolus_rezoning_node_sets_h

#include <alveolus/rezoning/rezoning_rule.h>

#include <bitset>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Stage of a rule that acts on the sets called @p names, whatever their
   * kind: points, lines (curves; in 2D also boundaries), surfaces (boundaries
   * in 3D), volumes (regions); of different kinds the latest.
   * @throws InputError if the list is empty, or a name is unknown or stands for
   * sets of several kinds
   */
  template <int dim>
  typename RezoningRule<dim>::Stage
  stage_of(const std::vector<std::string> &names,
           const NamedSets<dim>           &sets,
           const std::string              &where);

  /**
   * Relevant nodes of the sets called @p names, ascending, without those in
   * @p taken (collective). @throws InputError as above
   */
  template <int dim>
  std::vector<NodeId>
  nodes_of(const std::vector<std::string> &names,
           const Nodes<dim>               &nodes,
           const std::set<NodeId>         &taken,
           const std::string              &where);

  /**
   * Owned nodes inside the region called @p name, ascending: neither at the
   * boundary of the domain, nor shared with another region, nor in @p taken.
   * @throws InputError if there is no such region
   */
  template <int dim>
  std::vector<NodeId>
  inner_nodes(const std::string      &name,
              const Nodes<dim>       &nodes,
              const std::set<NodeId> &taken,
              const std::string      &where);

  /** @throws InputError if @p names is empty. */
  void
  require_names(const std::vector<std::string> &names,
                const std::string              &where);

  /**
   * Components in a list of x, y, z; an empty list means all.
   * @throws InputError for z in 2D
   */
  template <int dim>
  std::bitset<dim>
  parse_components(const std::vector<std::string> &list,
                   const std::string              &where);

  /** Copy the chosen components of @p nodes that are owned. */
  template <int dim>
  void
  copy_components(const Nodes<dim>          &nodes,
                  const std::vector<NodeId> &which,
                  const std::bitset<dim>    &components,
                  const NodalVector         &from,
                  NodalVector               &to);
} // namespace alveolus

#endif
