// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/nodes.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Ids that put a line on a named curve. */
    struct CurveIds
    {
      std::set<types::manifold_id> manifolds;
      std::set<types::boundary_id> boundaries;
    };

    template <int dim>
    CurveIds
    curve_ids(const NamedSets<dim> &names,
              const std::string    &name,
              const std::string    &where)
    {
      CurveIds ids;
      // In 2D the faces of a boundary are lines; meshes of GridGenerator know
      // their curves by boundary ids alone.
      if (dim == 2)
        {
          const auto boundary = names.boundaries.find(name);
          if (boundary != names.boundaries.end())
            ids.boundaries = boundary->second;
        }
      if (ids.boundaries.empty() || names.curves.count(name) > 0)
        ids.manifolds = names.curve(name, where);
      return ids;
    }

    template <typename LineIterator>
    bool
    lies_on(const LineIterator &line, const CurveIds &ids)
    {
      // Then the halves are lines of finer cells.
      if (line->has_children())
        return false;
      if (ids.manifolds.count(line->manifold_id()) > 0)
        return true;
      // Lines in 3D never get here: they have no boundary ids to match.
      return !ids.boundaries.empty() && line->at_boundary() &&
             ids.boundaries.count(line->boundary_id()) > 0;
    }

    /** x first, then y, z; round-off does not count. */
    template <int dim>
    bool
    comes_before(const Point<dim> &a, const Point<dim> &b, const double epsilon)
    {
      for (unsigned int c = 0; c < dim; ++c)
        if (std::abs(a[c] - b[c]) > epsilon)
          return a[c] < b[c];
      return false;
    }

    /** A length [mm] far below any distance of nodes (collective). */
    template <int dim>
    double
    small_length(const Nodes<dim> &nodes, const double factor)
    {
      double largest = 0.;
      for (const double x : nodes.configuration.initial_positions())
        largest = std::max(largest, std::abs(x));
      return factor *
             Utilities::MPI::max(largest, nodes.configuration.communicator());
    }
  } // namespace

  template <int dim>
  Nodes<dim>::Nodes(const Configuration<dim> &configuration)
    : configuration(configuration)
  {
    if (configuration.degree < 1 || configuration.degree > 2)
      throw InputError("Polynomial degree of the mesh",
                       "found " + std::to_string(configuration.degree),
                       "choose 1 or 2");
    const auto                              &fe = configuration.fe;
    std::vector<types::global_dof_index>     dof_indices(fe.n_dofs_per_cell());
    std::array<types::global_dof_index, dim> dofs_of_node;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(dof_indices);
          for (unsigned int k = 0; k < fe.base_element(0).n_dofs_per_cell();
               ++k)
            {
              for (unsigned int c = 0; c < dim; ++c)
                dofs_of_node[c] =
                  dof_indices[fe.component_to_system_index(c, k)];
              components.emplace(dofs_of_node[0], dofs_of_node);
            }
        }
    for (const auto &entry : components)
      relevant_nodes.push_back(entry.first);
    std::sort(relevant_nodes.begin(), relevant_nodes.end());
  }

  template <int dim>
  bool
  Nodes<dim>::is_owned(const NodeId node) const
  {
    return configuration.locally_owned.is_element(node);
  }

  template <int dim>
  bool
  Nodes<dim>::is_relevant(const NodeId node) const
  {
    return components.count(node) > 0;
  }

  template <int dim>
  const std::array<types::global_dof_index, dim> &
  Nodes<dim>::dofs(const NodeId node) const
  {
    return components.at(node);
  }

  template <int dim>
  const std::vector<NodeId> &
  Nodes<dim>::relevant() const
  {
    return relevant_nodes;
  }

  template <int dim>
  Point<dim>
  Nodes<dim>::get(const NodalVector &field, const NodeId node) const
  {
    const auto &indices = dofs(node);
    Point<dim>  value;
    for (unsigned int c = 0; c < dim; ++c)
      value[c] = field(indices[c]);
    return value;
  }

  template <int dim>
  void
  Nodes<dim>::set(NodalVector      &field,
                  const NodeId      node,
                  const Point<dim> &value) const
  {
    const auto &indices = dofs(node);
    for (unsigned int c = 0; c < dim; ++c)
      field(indices[c]) = value[c];
  }

  template <int dim>
  std::vector<Point<dim>>
  Nodes<dim>::gather(const NodalVector         &field,
                     const std::vector<NodeId> &nodes) const
  {
    // Each value comes from one owner, all others add zero: the sum is exact.
    std::vector<double> values(dim * nodes.size(), 0.);
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (is_owned(nodes[i]))
        {
          const Point<dim> value = get(field, nodes[i]);
          for (unsigned int c = 0; c < dim; ++c)
            values[dim * i + c] = value[c];
        }
    if (!values.empty())
      Utilities::MPI::sum(values, configuration.communicator(), values);
    std::vector<Point<dim>> result(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (unsigned int c = 0; c < dim; ++c)
        result[i][c] = values[dim * i + c];
    return result;
  }

  template <int dim>
  void
  Nodes<dim>::cell_nodes(
    const typename DoFHandler<dim>::active_cell_iterator &cell,
    std::vector<NodeId>                                  &nodes) const
  {
    const auto                                       &fe = configuration.fe;
    thread_local std::vector<types::global_dof_index> dof_indices;
    dof_indices.resize(fe.n_dofs_per_cell());
    cell->get_dof_indices(dof_indices);
    nodes.resize(fe.base_element(0).n_dofs_per_cell());
    for (unsigned int k = 0; k < nodes.size(); ++k)
      nodes[k] = dof_indices[fe.component_to_system_index(0, k)];
  }

  template <int dim>
  NodeId
  Nodes<dim>::point(const std::string &name, const std::string &where) const
  {
    const Point<dim> location = configuration.mesh.names.point(name, where);
    const auto      &initial  = configuration.initial_positions();
    const double     epsilon  = small_length(*this, 1e-6);
    double           distance = std::numeric_limits<double>::max();
    NodeId           nearest  = numbers::invalid_dof_index;
    for (const NodeId node : relevant_nodes)
      if (is_owned(node))
        {
          const double d = get(initial, node).distance(location);
          if (d < distance)
            {
              distance = d;
              nearest  = node;
            }
        }
    const double smallest =
      Utilities::MPI::min(distance, configuration.communicator());
    if (!(smallest <= epsilon))
      throw InputError(where,
                       "no node of the mesh lies at point '" + name +
                         "', the nearest one is " + std::to_string(smallest) +
                         " mm away",
                       "let the mesh have a vertex there");
    if (distance > smallest)
      nearest = numbers::invalid_dof_index;
    return Utilities::MPI::min(nearest, configuration.communicator());
  }

  template <int dim>
  NodeCurve
  Nodes<dim>::curve(const std::string &name, const std::string &where) const
  {
    const CurveIds ids = curve_ids(configuration.mesh.names, name, where);

    // End, middle (or the end again for degree 1), end of each line
    std::vector<NodeId> mine, nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (unsigned int l = 0; l < GeometryInfo<dim>::lines_per_cell; ++l)
          if (lies_on(cell->line(l), ids))
            {
              cell_nodes(cell, nodes);
              const NodeId a =
                nodes[GeometryInfo<dim>::line_to_cell_vertices(l, 0)];
              const NodeId b =
                nodes[GeometryInfo<dim>::line_to_cell_vertices(l, 1)];
              const NodeId middle =
                configuration.degree == 2
                  ? nodes[GeometryInfo<dim>::vertices_per_cell + l]
                  : a;
              mine.insert(mine.end(), {std::min(a, b), middle, std::max(a, b)});
            }
    std::map<NodeId, std::map<NodeId, NodeId>> neighbours;
    std::size_t                                n_lines = 0;
    for (const auto &part :
         Utilities::MPI::all_gather(configuration.communicator(), mine))
      for (std::size_t i = 0; i < part.size(); i += 3)
        {
          if (neighbours[part[i]].emplace(part[i + 2], part[i + 1]).second)
            ++n_lines;
          neighbours[part[i + 2]].emplace(part[i], part[i + 1]);
        }
    if (neighbours.empty())
      throw InputError(where,
                       "no line of the mesh lies on curve '" + name + "'",
                       "");

    std::vector<NodeId> vertices;
    for (const auto &entry : neighbours)
      vertices.push_back(entry.first);
    const auto positions = gather(configuration.initial_positions(), vertices);
    std::map<NodeId, Point<dim>> position;
    for (std::size_t i = 0; i < vertices.size(); ++i)
      position[vertices[i]] = positions[i];
    const double epsilon = small_length(*this, 1e-10);
    const auto   before  = [&](const NodeId a, const NodeId b) {
      return comes_before(position[a], position[b], epsilon);
    };

    std::vector<NodeId> ends;
    for (const auto &entry : neighbours)
      {
        if (entry.second.size() > 2)
          {
            std::ostringstream at;
            at << position[entry.first];
            throw InputError(where,
                             "curve '" + name + "' branches at (" + at.str() +
                               ")",
                             "name its parts one by one");
          }
        if (entry.second.size() == 1)
          ends.push_back(entry.first);
      }
    const InputError in_parts(where,
                              "curve '" + name + "' consists of several parts",
                              "name them one by one");
    if (ends.size() > 2)
      throw in_parts;

    NodeCurve result;
    result.closed = ends.empty();
    NodeId here   = *std::min_element((result.closed ? vertices : ends).begin(),
                                    (result.closed ? vertices : ends).end(),
                                    before);
    const NodeId first = here;
    NodeId       last  = here; // where the walk came from
    std::size_t  n     = 0;
    while (true)
      {
        result.nodes.push_back(here);
        // The first step of a closed curve goes to the smaller neighbour.
        const auto next =
          std::min_element(neighbours[here].begin(),
                           neighbours[here].end(),
                           [&](const auto &a, const auto &b) {
                             if ((a.first == last) != (b.first == last))
                               return b.first == last;
                             return before(a.first, b.first);
                           });
        if (next->first == last)
          break;
        ++n;
        if (configuration.degree == 2)
          result.nodes.push_back(next->second);
        last = here;
        here = next->first;
        if (here == first)
          break;
      }
    if (n != n_lines)
      throw in_parts;
    return result;
  }

  template <int dim>
  std::vector<NodeId>
  Nodes<dim>::on_curve(const std::string &name, const std::string &where) const
  {
    const CurveIds      ids = curve_ids(configuration.mesh.names, name, where);
    NodalVector         marks = configuration.make_vector();
    std::vector<NodeId> nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (unsigned int l = 0; l < GeometryInfo<dim>::lines_per_cell; ++l)
          if (lies_on(cell->line(l), ids))
            {
              cell_nodes(cell, nodes);
              const auto mark = [&](const unsigned int k) {
                if (is_owned(nodes[k]))
                  marks(nodes[k]) = 1.;
              };
              mark(GeometryInfo<dim>::line_to_cell_vertices(l, 0));
              mark(GeometryInfo<dim>::line_to_cell_vertices(l, 1));
              if (configuration.degree == 2)
                mark(GeometryInfo<dim>::vertices_per_cell + l);
            }
    return collect(marks);
  }

  template <int dim>
  std::vector<NodeId>
  Nodes<dim>::boundary(const std::string &name, const std::string &where) const
  {
    const auto         &ids   = configuration.mesh.names.boundary(name, where);
    NodalVector         marks = configuration.make_vector();
    const auto         &fe    = configuration.fe.base_element(0);
    std::vector<NodeId> nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        for (const unsigned int f : cell->face_indices())
          if (cell->face(f)->at_boundary() &&
              ids.count(cell->face(f)->boundary_id()) > 0)
            {
              cell_nodes(cell, nodes);
              for (unsigned int k = 0; k < nodes.size(); ++k)
                if (fe.has_support_on_face(k, f) && is_owned(nodes[k]))
                  marks(nodes[k]) = 1.;
            }
    return collect(marks);
  }

  template <int dim>
  std::vector<NodeId>
  Nodes<dim>::region(const std::string &name, const std::string &where) const
  {
    const auto         &ids   = configuration.mesh.names.region(name, where);
    NodalVector         marks = configuration.make_vector();
    std::vector<NodeId> nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (!cell->is_artificial() && ids.count(cell->material_id()) > 0)
        {
          cell_nodes(cell, nodes);
          for (const NodeId node : nodes)
            if (is_owned(node))
              marks(node) = 1.;
        }
    return collect(marks);
  }

  template <int dim>
  std::vector<NodeId>
  Nodes<dim>::collect(NodalVector &marks) const
  {
    // Only the owner sees all cells at a node; the others are told by it.
    marks.update_ghost_values();
    std::vector<NodeId> result;
    for (const NodeId node : relevant_nodes)
      if (marks(node) != 0.)
        result.push_back(node);
    return result;
  }

  template class Nodes<2>;
  template class Nodes<3>;
} // namespace alveolus
