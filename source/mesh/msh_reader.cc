// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/msh_reader.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <tuple>
#include <unordered_map>

namespace alveolus
{
  namespace
  {
    /** What the format says of an element type; linear ones matter only. */
    struct ElementType
    {
      unsigned int dimension;
      unsigned int n_nodes;
      const char  *name; ///< singular
      const char  *names;
    };

    /** Gmsh's element types by number. */
    const std::map<int, ElementType> &
    element_types()
    {
      static const std::map<int, ElementType> types = {
        {1, {1, 2, "line", "lines"}},
        {2, {2, 3, "triangle", "triangles"}},
        {3, {2, 4, "quad", "quads"}},
        {4, {3, 4, "tetrahedron", "tetrahedra"}},
        {5, {3, 8, "hexahedron", "hexahedra"}},
        {6, {3, 6, "prism", "prisms"}},
        {7, {3, 5, "pyramid", "pyramids"}},
        {8, {1, 3, "quadratic line", "quadratic lines"}},
        {9, {2, 6, "quadratic triangle", "quadratic triangles"}},
        {10, {2, 9, "quadratic quad", "quadratic quads"}},
        {11, {3, 10, "quadratic tetrahedron", "quadratic tetrahedra"}},
        {12, {3, 27, "quadratic hexahedron", "quadratic hexahedra"}},
        {13, {3, 18, "quadratic prism", "quadratic prisms"}},
        {14, {3, 14, "quadratic pyramid", "quadratic pyramids"}},
        {15, {0, 1, "point", "points"}},
        {16, {2, 8, "quadratic quad", "quadratic quads"}},
        {17, {3, 20, "quadratic hexahedron", "quadratic hexahedra"}},
        {18, {3, 15, "quadratic prism", "quadratic prisms"}},
        {19, {3, 13, "quadratic pyramid", "quadratic pyramids"}}};
      return types;
    }

    constexpr int point_type = 15, line_type = 1, quad_type = 3, hex_type = 5;

    /** Lines of a text, counted, with numbers taken out of them. */
    class Lines
    {
    public:
      Lines(const std::string &text, const std::string &source)
        : text(text)
        , source(source)
      {}

      std::size_t number = 0; ///< of the current line, from 1

      /** Go to the next line that is not blank; false at the end. */
      bool
      advance()
      {
        while (position < text.size())
          {
            const std::size_t end =
              std::min(text.find('\n', position), text.size());
            current  = std::string_view(text).substr(position, end - position);
            position = end + 1;
            ++number;
            while (!current.empty() && is_blank(current.back()))
              current.remove_suffix(1);
            rest = current;
            skip_blanks();
            if (!rest.empty())
              {
                current = rest;
                return true;
              }
          }
        return false;
      }

      /** The same, where @p section must not end yet. */
      void
      advance_in(const std::string &section)
      {
        if (!advance())
          throw InputError(source + ", line " + std::to_string(number),
                           "the file ends within " + section,
                           "it is truncated: make or copy it again");
        if (current[0] == '$')
          fail("'" + std::string(current.substr(0, 40)) + "' within " + section,
               "the section holds fewer lines than it announces");
      }

      std::string_view
      all() const
      {
        return current;
      }

      template <class Number>
      Number
      take(const char *what)
      {
        skip_blanks();
        Number      value{};
        const char *begin = rest.data();
        const char *end   = begin + rest.size();
        if (begin != end && *begin == '+')
          ++begin;
        const auto [stop, error] = std::from_chars(begin, end, value);
        if (rest.empty() || error != std::errc() ||
            (stop != end && !is_blank(*stop)))
          fail(rest.empty() ? std::string("the line ends before ") + what
                            : "'" + first_word() + "' is not " + what,
               "");
        rest.remove_prefix(stop - rest.data());
        return value;
      }

      /** A number of things, never negative. */
      std::size_t
      take_count(const char *what)
      {
        const long long value = take<long long>(what);
        if (value < 0)
          fail(std::string(what) + " is negative", "");
        return value;
      }

      int
      take_id(const char *what)
      {
        const int value = take<int>(what);
        // Signs are dropped here and there: keep to numbers where that works.
        if (value == std::numeric_limits<int>::min())
          fail(std::string(what) + " is too large", "");
        return value;
      }

      double
      take_coordinate()
      {
        const double value = take<double>("a coordinate");
        if (!std::isfinite(value) || std::abs(value) > 1e100)
          fail("a coordinate is not a finite number", "");
        return value;
      }

      void
      end_of_line()
      {
        skip_blanks();
        if (!rest.empty())
          fail("'" + first_word() + "' is more than this line should hold", "");
      }

      std::string_view
      remainder()
      {
        skip_blanks();
        return rest;
      }

      [[noreturn]] void
      fail(const std::string &found, const std::string &advice) const
      {
        throw InputError(source + ", line " + std::to_string(number),
                         found,
                         advice);
      }

    private:
      static bool
      is_blank(const char c)
      {
        return c == ' ' || c == '\t' || c == '\r';
      }

      void
      skip_blanks()
      {
        while (!rest.empty() && is_blank(rest.front()))
          rest.remove_prefix(1);
      }

      std::string
      first_word() const
      {
        return std::string(
          rest.substr(0, std::min<std::size_t>(rest.find_first_of(" \t"), 40)));
      }

      const std::string &text;
      const std::string &source;
      std::size_t        position = 0;
      std::string_view   current, rest;
    };

    struct RawNode
    {
      dealii::Point<3> position;
      std::size_t      line;
    };

    struct RawElement
    {
      int                      type;
      std::size_t              number, line;
      int                      entity;
      std::set<int>            groups;
      std::vector<std::size_t> nodes;
    };

    /** The sections of a file as they stand, for both versions. */
    class Sections
    {
    public:
      Sections(const std::string &text, const std::string &source)
        : lines(text, source)
        , source(source)
      {
        read_all();
      }

      using Entity = std::pair<unsigned int, int>; ///< dimension and number

      std::map<Entity, std::string>            group_names;
      std::unordered_map<std::size_t, RawNode> nodes;
      std::vector<std::size_t> node_order; ///< numbers in the file's order
      std::vector<RawElement>  elements;

    private:
      Lines                           lines;
      const std::string              &source;
      bool                            version_4 = false;
      std::map<Entity, std::set<int>> entity_groups;

      void
      read_all()
      {
        std::set<std::string> seen;
        while (lines.advance())
          {
            const std::string section(lines.all());
            if (section[0] != '$')
              lines.fail("'" + section.substr(0, 40) +
                           "' stands outside any section",
                         "the file is no gmsh mesh (.msh), or damaged");
            if (seen.empty() && section != "$MeshFormat" &&
                section != "$Comments")
              lines.fail("the file begins with '" + section.substr(0, 40) +
                           "', not with $MeshFormat",
                         "save the mesh in gmsh's format 4.1 or 2.2 (ASCII)");
            if (section != "$Comments" && !seen.insert(section).second)
              lines.fail("a second section " + section.substr(0, 40), "");

            if (section == "$MeshFormat")
              read_format();
            else if (section == "$PhysicalNames")
              read_names();
            else if (section == "$Entities" && version_4)
              read_entities();
            else if (section == "$Nodes")
              version_4 ? read_nodes_4() : read_nodes_2();
            else if (section == "$Elements")
              {
                if (seen.count("$Nodes") == 0)
                  lines.fail("$Elements come before $Nodes", "");
                version_4 ? read_elements_4(seen.count("$Entities") != 0)
                          : read_elements_2();
              }
            else
              {
                skip(section);
                continue;
              }
            read_end(section);
          }
        for (const char *needed : {"$MeshFormat", "$Nodes", "$Elements"})
          if (seen.count(needed) == 0)
            throw InputError(source,
                             std::string("there is no section ") + needed,
                             "the file is truncated or no gmsh mesh (.msh)");
      }

      static std::string
      end_of(const std::string &section)
      {
        return "$End" + section.substr(1);
      }

      void
      read_end(const std::string &section)
      {
        if (!lines.advance())
          throw InputError(source + ", line " + std::to_string(lines.number),
                           "the file ends before " + end_of(section),
                           "it is truncated: make or copy it again");
        if (lines.all() != end_of(section))
          lines.fail("'" + std::string(lines.all().substr(0, 40)) +
                       "' instead of " + end_of(section),
                     "the section holds more lines than it announces");
      }

      void
      skip(const std::string &section)
      {
        const std::size_t begin = lines.number;
        while (lines.advance())
          if (lines.all() == end_of(section))
            return;
        throw InputError(source + ", line " + std::to_string(begin),
                         "the section " + section.substr(0, 40) + " has no end",
                         "the file is truncated: make or copy it again");
      }

      void
      read_format()
      {
        lines.advance_in("$MeshFormat");
        const std::string version(
          lines.all().substr(0, lines.all().find_first_of(" \t")));
        lines.take<double>("a version");
        const int binary = lines.take_id("a file type");
        lines.take_id("a data size");
        if (version != "2.2" && version != "4.1")
          lines.fail("format version " + version,
                     "save the mesh as version 4.1 or 2.2 (gmsh: "
                     "Mesh.MshFileVersion = 4.1)");
        if (binary != 0)
          lines.fail("a binary mesh",
                     "save it as text (gmsh: Mesh.Binary = 0)");
        version_4 = version == "4.1";
      }

      void
      read_names()
      {
        lines.advance_in("$PhysicalNames");
        const std::size_t n = lines.take_count("a number of names");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.advance_in("$PhysicalNames");
            const std::size_t      dimension = lines.take_count("a dimension");
            const int              tag       = lines.take_id("a group number");
            const std::string_view quoted    = lines.remainder();
            if (dimension > 3)
              lines.fail("a dimension above 3", "");
            if (quoted.size() < 3 || quoted.front() != '"' ||
                quoted.back() != '"')
              lines.fail("a name must stand in quotation marks",
                         "e.g. 1 2 \"root\"");
            const std::string name(quoted.substr(1, quoted.size() - 2));
            if (!group_names.emplace(Entity(dimension, tag), name).second)
              lines.fail("a second name for group " + std::to_string(tag) +
                           " of dimension " + std::to_string(dimension),
                         "");
          }
      }

      void
      read_entities()
      {
        lines.advance_in("$Entities");
        std::array<std::size_t, 4> n;
        for (std::size_t &n_of_dimension : n)
          n_of_dimension = lines.take_count("a number of entities");
        for (unsigned int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < n[d]; ++i)
            {
              lines.advance_in("$Entities");
              const int tag = lines.take_id("an entity number");
              for (unsigned int c = 0; c < (d == 0 ? 3 : 6); ++c)
                lines.take<double>("a coordinate");
              const std::size_t n_groups =
                lines.take_count("a number of groups");
              std::set<int> &groups = entity_groups[{d, tag}];
              for (std::size_t g = 0; g < n_groups; ++g)
                // A minus sign turns the orientation, not the group.
                groups.insert(std::abs(lines.take_id("a group number")));
            }
      }

      void
      add_node(const std::size_t number, const dealii::Point<3> &position)
      {
        const auto added =
          nodes.emplace(number, RawNode{position, lines.number});
        if (!added.second)
          lines.fail("node " + std::to_string(number) + " was already given" +
                       " on line " + std::to_string(added.first->second.line),
                     "number every node once");
        node_order.push_back(number);
      }

      void
      read_nodes_2()
      {
        lines.advance_in("$Nodes");
        const std::size_t n = lines.take_count("a number of nodes");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.advance_in("$Nodes");
            const std::size_t number = lines.take_count("a node number");
            dealii::Point<3>  position;
            for (unsigned int d = 0; d < 3; ++d)
              position[d] = lines.take_coordinate();
            lines.end_of_line();
            add_node(number, position);
          }
      }

      void
      read_nodes_4()
      {
        lines.advance_in("$Nodes");
        const std::size_t n_blocks = lines.take_count("a number of blocks");
        const std::size_t n_nodes  = lines.take_count("a number of nodes");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            lines.advance_in("$Nodes");
            lines.take_count("a dimension");
            lines.take_id("an entity number");
            lines.take_id("a flag for parametric nodes");
            const std::size_t        n = lines.take_count("a number of nodes");
            std::vector<std::size_t> numbers;
            for (std::size_t i = 0; i < n; ++i)
              {
                lines.advance_in("$Nodes");
                numbers.push_back(lines.take_count("a node number"));
                lines.end_of_line();
              }
            for (const std::size_t number : numbers)
              {
                lines.advance_in("$Nodes");
                dealii::Point<3> position;
                for (unsigned int d = 0; d < 3; ++d)
                  position[d] = lines.take_coordinate();
                add_node(number, position); // parameters may follow
              }
          }
        if (nodes.size() != n_nodes)
          lines.fail(std::to_string(n_nodes) + " nodes are announced, " +
                       std::to_string(nodes.size()) + " are given",
                     "");
      }

      void
      read_connectivity(RawElement &element)
      {
        const auto type = element_types().find(element.type);
        if (type == element_types().end())
          lines.fail("element " + std::to_string(element.number) +
                       " is of gmsh's type " + std::to_string(element.type),
                     "only linear lines, quads and hexahedra are supported");
        for (unsigned int v = 0; v < type->second.n_nodes; ++v)
          {
            const std::size_t node = lines.take_count("a node number");
            if (nodes.count(node) == 0)
              lines.fail("element " + std::to_string(element.number) +
                           " has the unknown node " + std::to_string(node),
                         "every node must be listed in $Nodes");
            element.nodes.push_back(node);
          }
        lines.end_of_line();
        elements.push_back(std::move(element));
      }

      void
      read_elements_2()
      {
        lines.advance_in("$Elements");
        const std::size_t n = lines.take_count("a number of elements");
        for (std::size_t i = 0; i < n; ++i)
          {
            lines.advance_in("$Elements");
            RawElement element;
            element.line             = lines.number;
            element.number           = lines.take_count("an element number");
            element.type             = lines.take_id("an element type");
            const std::size_t n_tags = lines.take_count("a number of tags");
            std::vector<int>  tags;
            for (std::size_t t = 0; t < n_tags; ++t)
              tags.push_back(lines.take_id("a tag"));
            if (n_tags > 0 && tags[0] != 0)
              element.groups.insert(std::abs(tags[0]));
            element.entity = n_tags > 1 ? tags[1] : 0;
            read_connectivity(element);
          }
      }

      void
      read_elements_4(const bool entities_are_listed)
      {
        lines.advance_in("$Elements");
        const std::size_t n_blocks   = lines.take_count("a number of blocks");
        const std::size_t n_elements = lines.take_count("a number of elements");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            lines.advance_in("$Elements");
            const unsigned int dimension = lines.take_count("a dimension");
            const int          entity    = lines.take_id("an entity number");
            const int          type      = lines.take_id("an element type");
            const std::size_t  n     = lines.take_count("a number of elements");
            const auto         known = element_types().find(type);
            if (known != element_types().end() &&
                known->second.dimension != dimension)
              lines.fail(std::string(known->second.names) +
                           " on an entity of dimension " +
                           std::to_string(dimension),
                         "");
            const auto groups = entity_groups.find({dimension, entity});
            if (groups == entity_groups.end() && entities_are_listed)
              lines.fail("elements of entity " + std::to_string(entity) +
                           " of dimension " + std::to_string(dimension) +
                           ", which $Entities does not list",
                         "");
            for (std::size_t i = 0; i < n; ++i)
              {
                lines.advance_in("$Elements");
                RawElement element;
                element.line   = lines.number;
                element.number = lines.take_count("an element number");
                element.type   = type;
                element.entity = entity;
                if (groups != entity_groups.end())
                  element.groups = groups->second;
                read_connectivity(element);
              }
          }
        if (elements.size() != n_elements)
          lines.fail(std::to_string(n_elements) + " elements are announced, " +
                       std::to_string(elements.size()) + " are given",
                     "");
      }
    };

    /** Refuse every element that can be no cell of this program. */
    template <int dim>
    void
    refuse_other_shapes(const Sections &sections, const std::string &source)
    {
      std::map<int, std::pair<std::size_t, const RawElement *>> others;
      std::size_t                                               n_cells = 0;
      for (const RawElement &element : sections.elements)
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
          const ElementType &type    = element_types().at(entry.first);
          const std::size_t  n       = entry.second.first;
          const RawElement  &element = *entry.second.second;
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
    std::vector<RawElement>
    merge_copies(const std::vector<RawElement> &elements)
    {
      std::map<std::pair<int, std::vector<std::size_t>>, std::size_t> first;
      std::vector<RawElement>                                         result;
      for (const RawElement &element : elements)
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
      explicit Tags(const std::vector<RawElement> &elements)
      {
        for (const RawElement &element : elements)
          next = std::max<long long>(next, element.entity + 1LL);
      }

      unsigned int
      operator()(const RawElement &element)
      {
        const auto key =
          std::make_tuple(element_types().at(element.type).dimension,
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
    Sections sections(text, source);
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
      [&index](auto &element, const RawElement &raw, const unsigned int tag) {
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

    const std::vector<RawElement> elements = merge_copies(sections.elements);
    Tags                          tags(elements);
    std::size_t                   n_without_region = 0;
    const RawElement             *without_region   = nullptr;
    for (const RawElement &raw : elements)
      {
        const unsigned int dimension = element_types().at(raw.type).dimension;
        for (const std::size_t node : raw.nodes)
          {
            const RawNode &raw_node = sections.nodes.at(node);
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
