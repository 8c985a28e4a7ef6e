// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/node_sets.h>

#include <algorithm>
#include <unordered_set>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <int dim>
    using Stage = typename RezoningRule<dim>::Stage;

    template <int dim>
    Stage<dim>
    stage_of_name(const std::string    &name,
                  const NamedSets<dim> &sets,
                  const std::string    &where)
    {
      const bool boundary = sets.boundaries.count(name) > 0;
      const bool point    = sets.points.count(name) > 0;
      const bool curve = sets.curves.count(name) > 0 || (dim == 2 && boundary);
      const bool surface = dim == 3 && boundary;
      const bool region  = sets.regions.count(name) > 0;
      const int  kinds   = point + curve + surface + region;
      if (kinds > 1)
        throw InputError(where + "/On",
                         "'" + name + "' is the name of sets of several kinds",
                         "rename one of them in the mesh");
      if (kinds == 0)
        {
          std::set<std::string> known;
          for (const auto &set : sets.points)
            known.insert(set.first);
          for (const auto &set : sets.curves)
            known.insert(set.first);
          for (const auto &set : sets.boundaries)
            known.insert(set.first);
          for (const auto &set : sets.regions)
            known.insert(set.first);
          std::string list;
          for (const std::string &k : known)
            list += (list.empty() ? "" : ", ") + k;
          throw InputError(where + "/On",
                           "the mesh has no set '" + name + "'",
                           "known are: " + list);
        }
      return point     ? Stage<dim>::points
             : curve   ? Stage<dim>::lines
             : surface ? Stage<dim>::surfaces
                       : Stage<dim>::volumes;
    }
  } // namespace

  void
  require_names(const std::vector<std::string> &names, const std::string &where)
  {
    if (names.empty())
      throw InputError(where + "/On",
                       "the list is empty",
                       "name the sets of nodes the rule acts on");
  }

  template <int dim>
  Stage<dim>
  stage_of(const std::vector<std::string> &names,
           const NamedSets<dim>           &sets,
           const std::string              &where)
  {
    require_names(names, where);
    Stage<dim> latest = Stage<dim>::points;
    for (const std::string &name : names)
      latest = std::max(latest, stage_of_name(name, sets, where));
    return latest;
  }

  template <int dim>
  std::vector<NodeId>
  nodes_of(const std::vector<std::string> &names,
           const Nodes<dim>               &nodes,
           const std::set<NodeId>         &taken,
           const std::string              &where)
  {
    const std::string   on = where + "/On";
    std::vector<NodeId> result;
    for (const std::string &name : names)
      {
        std::vector<NodeId> more;
        switch (stage_of_name(name, nodes.configuration.mesh.names, where))
          {
              case Stage<dim>::points: {
                const NodeId node = nodes.point(name, on);
                if (nodes.is_relevant(node))
                  more = {node};
                break;
              }
            case Stage<dim>::lines:
              more = nodes.on_curve(name, on);
              break;
            case Stage<dim>::surfaces:
              more = nodes.boundary(name, on);
              break;
            case Stage<dim>::volumes:
              more = nodes.region(name, on);
              break;
          }
        result.insert(result.end(), more.begin(), more.end());
      }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    result.erase(std::remove_if(result.begin(),
                                result.end(),
                                [&](const NodeId node) {
                                  return taken.count(node) > 0;
                                }),
                 result.end());
    return result;
  }

  template <int dim>
  std::vector<NodeId>
  inner_nodes(const std::string      &name,
              const Nodes<dim>       &nodes,
              const std::set<NodeId> &taken,
              const std::string      &where)
  {
    const auto &configuration = nodes.configuration;
    const auto &fe            = configuration.fe.base_element(0);
    const auto &ids = configuration.mesh.names.region(name, where + "/On");

    // The owner of a node sees all cells around it.
    std::unordered_set<NodeId> border;
    std::set<NodeId>           inside;
    std::vector<NodeId>        cell_nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          nodes.cell_nodes(cell, cell_nodes);
          if (ids.count(cell->material_id()) == 0)
            {
              border.insert(cell_nodes.begin(), cell_nodes.end());
              continue;
            }
          inside.insert(cell_nodes.begin(), cell_nodes.end());
          for (const unsigned int f : cell->face_indices())
            if (cell->face(f)->at_boundary())
              for (unsigned int k = 0; k < cell_nodes.size(); ++k)
                if (fe.has_support_on_face(k, f))
                  border.insert(cell_nodes[k]);
        }
    std::vector<NodeId> result;
    for (const NodeId node : inside)
      if (nodes.is_owned(node) && border.count(node) == 0 &&
          taken.count(node) == 0)
        result.push_back(node);
    return result;
  }

  template <int dim>
  std::bitset<dim>
  parse_components(const std::vector<std::string> &list,
                   const std::string              &where)
  {
    std::bitset<dim> components;
    for (const std::string &c : list)
      {
        if (c == "z" && dim == 2)
          throw InputError(where + "/Components",
                           "there is no z in two dimensions",
                           "choose from x, y");
        components.set(c == "x" ? 0 : c == "y" ? 1 : dim - 1);
      }
    if (list.empty())
      components.set();
    return components;
  }

  template <int dim>
  void
  copy_components(const Nodes<dim>          &nodes,
                  const std::vector<NodeId> &which,
                  const std::bitset<dim>    &components,
                  const NodalVector         &from,
                  NodalVector               &to)
  {
    for (const NodeId node : which)
      if (nodes.is_owned(node))
        {
          const auto &dofs = nodes.dofs(node);
          for (unsigned int c = 0; c < dim; ++c)
            if (components[c])
              to(dofs[c]) = from(dofs[c]);
        }
    to.update_ghost_values();
  }

#define ALVEOLUS_INSTANTIATE(dim)                                              \
  template Stage<dim>          stage_of<dim>(const std::vector<std::string> &, \
                                    const NamedSets<dim> &,           \
                                    const std::string &);             \
  template std::vector<NodeId> nodes_of<dim>(const std::vector<std::string> &, \
                                             const Nodes<dim> &,               \
                                             const std::set<NodeId> &,         \
                                             const std::string &);             \
  template std::vector<NodeId> inner_nodes<dim>(const std::string &,           \
                                                const Nodes<dim> &,            \
                                                const std::set<NodeId> &,      \
                                                const std::string &);          \
  template std::bitset<dim>    parse_components<dim>(                          \
    const std::vector<std::string> &, const std::string &);                 \
  template void copy_components<dim>(const Nodes<dim> &,                       \
                                     const std::vector<NodeId> &,              \
                                     const std::bitset<dim> &,                 \
                                     const NodalVector &,                      \
                                     NodalVector &);

  ALVEOLUS_INSTANTIATE(2)
  ALVEOLUS_INSTANTIATE(3)
#undef ALVEOLUS_INSTANTIATE
} // namespace alveolus
