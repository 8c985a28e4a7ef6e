// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/msh_reader.h>
#include <alveolus/mesh/msh_sections.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace alveolus
{
  namespace
  {
    constexpr int point_type = 15, line_type = 1, quad_type = 3, hex_type = 5;

    /** Refuse every element that can be no cell of this program. */
    template <int dim>
    void
    refuse_other_shapes(const MshSections &sections, const std::string &source)
    {
      std::map<int, std::pair<std::size_t, const MshElement *>> others;
      std::size_t                                               n_cells = 0;
      for (const MshElement &element : sections.elements)
        {
          n_cells += element.type == (dim == 2 ? quad_type : hex_type);
          if (element.type != point_type && element.type != line_type &&
              element.type != quad_type &&
              !(element.type == hex_type && dim == 3))
            {
              auto &entry = others[element.type];
              if (entry.first++ == 0)
                entry.second = &element;
            }
        }
      for (const auto &entry : others)
        {
          const MshElementType &type    = msh_element_types().at(entry.first);
          const std::size_t     n       = entry.second.first;
          const MshElement     &element = *entry.second.second;
          if (dim == 2 && type.dimension == 3)
            throw InputError(source,
                             "a three-dimensional mesh in a two-dimensional "
                             "scene (" +
                               std::to_string(n) + " " +
                               (n == 1 ? type.name : type.names) + ")",
                             "set the scene's dimension to 3 or take another "
                             "mesh");
          throw InputError(
            source,
            std::string("a mesh with a ") + type.name + ": " +
              std::to_string(n) + " " + (n == 1 ? type.name : type.names) +
              ", first one element " + std::to_string(element.number) +
              " at line " + std::to_string(element.line),
            entry.first == 2 || entry.first == 4 || entry.first == 6 ||
                entry.first == 7
              ? "recombine it to " +
                  std::string(dim == 2 ? "quads" : "hexahedra") +
                  " (gmsh: Recombine Surface {:}; or Mesh.RecombineAll = 1;)"
              : "save linear elements (gmsh: Mesh.ElementOrder = 1;)");
        }
      if (n_cells == 0)
        throw InputError(source,
                         std::string("the mesh has no cells (") +
                           (dim == 2 ? "quads)" : "hexahedra)"),
                         "put the " +
                           std::string(dim == 2 ? "surfaces" : "volumes") +
                           " into Physical groups and mesh in " +
                           std::to_string(dim) + "D");
    }

    /** Put copies of one element, one per group (2.2), together. */
    std::vector<MshElement>
    merge_copies(const std::vector<MshElement> &elements)
    {
      std::map<std::pair<int, std::vector<std::size_t>>, std::size_t> first;
      std::vector<MshElement>                                         result;
      for (const MshElement &element : elements)
        {
          auto key = std::make_pair(element.type, element.nodes);
          std::sort(key.second.begin(), key.second.end());
          const auto [position, is_new] =
            first.emplace(std::move(key), result.size());
          if (is_new)
            result.push_back(element);
          else
            result[position->second].groups.insert(element.groups.begin(),
                                                   element.groups.end());
        }
      return result;
    }

    /**
     * One tag for all elements of one dimension with the same entity and
     * groups: the entity's number for the first such set, a free number above
     * all entities for others.
     */
    class Tags
    {
    public:
      explicit Tags(const std::vector<MshElement> &elements)
      {
        for (const MshElement &element : elements)
          next = std::max<long long>(next, element.entity + 1LL);
      }

      unsigned int
      operator()(const MshElement &element)
      {
        const auto key =
          std::make_tuple(msh_element_types().at(element.type).dimension,
                          element.entity,
                          element.groups);
        const auto found = tags.find(key);
        if (found != tags.end())
          return found->second;
        const std::pair<unsigned int, int> entity(std::get<0>(key),
                                                  element.entity);
        const bool                         entity_is_free =
          element.entity >= 1 && used.insert(entity).second;
        return tags[key] = entity_is_free ? element.entity : next++;
      }

    private:
      std::map<std::tuple<unsigned int, int, std::set<int>>, unsigned int> tags;
      std::set<std::pair<unsigned int, int>>                               used;
      long long next = 1;
    };

    /** Lexicographic order of the vertices of gmsh's element. */
    template <int structdim>
    std::array<unsigned int, (1 << structdim)>
    lexicographic()
    {
      if constexpr (structdim == 1)
        return {{0, 1}};
      else if constexpr (structdim == 2)
        return {{0, 1, 3, 2}};
      else
        return {{0, 1, 3, 2, 4, 5, 7, 6}};
    }
  } // namespace



  template <int dim>
  MeshDescription<dim>
  read_msh(const std::string &text, const std::string &source)
  {
    const MshSections sections = read_msh_sections(text, source);
    refuse_other_shapes<dim>(sections, source);

    MeshDescription<dim>                          mesh;
    std::unordered_map<std::size_t, unsigned int> index;
    mesh.source         = source;
    mesh.vertex_numbers = sections.node_order;
    double smallest     = std::numeric_limits<double>::max();
    double largest      = -smallest;
    for (const std::size_t number : sections.node_order)
      {
        const dealii::Point<3> &position = sections.nodes.at(number).position;
        dealii::Point<dim>      vertex;
        for (unsigned int d = 0; d < dim; ++d)
          {
            vertex[d] = position[d];
            smallest  = std::min(smallest, position[d]);
            largest   = std::max(largest, position[d]);
          }
        index[number] = mesh.vertices.size();
        mesh.vertices.push_back(vertex);
      }

    const auto name_of = [&sections](const unsigned int dimension,
                                     const int          group) {
      const auto name = sections.group_names.find({dimension, group});
      return name == sections.group_names.end() ? std::to_string(group)
                                                : name->second;
    };
    const auto make =
      [&index](auto &element, const MshElement &raw, const unsigned int tag) {
        constexpr unsigned int n =
          std::tuple_size<std::decay_t<decltype(element.vertices)>>::value;
        constexpr int structdim = n == 2 ? 1 : (n == 4 ? 2 : 3);
        for (unsigned int v = 0; v < n; ++v)
          element.vertices[v] =
            index.at(raw.nodes[lexicographic<structdim>()[v]]);
        element.tag    = tag;
        element.number = raw.number;
        element.line   = raw.line;
      };

    const std::vector<MshElement> elements = merge_copies(sections.elements);
    Tags                          tags(elements);
    std::size_t                   n_without_region = 0;
    const MshElement             *without_region   = nullptr;
    for (const MshElement &raw : elements)
      {
        const unsigned int dimension =
          msh_element_types().at(raw.type).dimension;
        for (const std::size_t node : raw.nodes)
          {
            const MshNode &raw_node = sections.nodes.at(node);
            if (dim == 2 &&
                std::abs(raw_node.position[2]) > 1e-10 * (largest - smallest))
              throw InputError(mesh.place(raw_node.line),
                               "node " + std::to_string(node) +
                                 " lies outside the plane z = 0",
                               "a two-dimensional mesh must lie in it");
          }
        if (raw.groups.empty())
          {
            if (dimension == dim && n_without_region++ == 0)
              without_region = &raw;
            continue;
          }
        if (raw.type == point_type)
          {
            for (const int group : raw.groups)
              {
                const std::string  name   = name_of(0, group);
                const unsigned int vertex = index.at(raw.nodes[0]);
                if (mesh.points.emplace(name, vertex).first->second != vertex)
                  throw InputError(mesh.place(raw.line),
                                   "a second node for the point '" + name + "'",
                                   "a named point is one node");
              }
            continue;
          }

        const unsigned int tag  = tags(raw);
        auto              &sets = dimension == dim ? mesh.regions
                                  : dimension == 1 ? mesh.curves
                                                   : mesh.surfaces;
        for (const int group : raw.groups)
          sets[name_of(dimension, group)].insert(tag);
        if (dimension == dim)
          make(mesh.cells.emplace_back(), raw, tag);
        else if (dimension == 1)
          make(mesh.lines.emplace_back(), raw, tag);
        else
          make(mesh.quads.emplace_back(), raw, tag);
      }
    if (n_without_region > 0)
      throw InputError(mesh.place(without_region->line),
                       std::to_string(n_without_region) +
                         " cells without a region, first one element " +
                         std::to_string(without_region->number),
                       "put every " +
                         std::string(dim == 2 ? "surface" : "volume") +
                         " into a Physical group with a name");
    return mesh;
  }



  template MeshDescription<2>
  read_msh<2>(const std::string &, const std::string &);
  template MeshDescription<3>
  read_msh<3>(const std::string &, const std::string &);
} // namespace alveolus
