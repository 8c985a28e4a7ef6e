// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/line_reader.h>
#include <alveolus/mesh/msh_sections.h>

#include <array>
#include <cstdlib>

namespace alveolus
{
  namespace
  {
    /** Fills the sections from the text, for both versions. */
    class Parser
    {
    public:
      Parser(const std::string &text,
             const std::string &source,
             MshSections       &sections)
        : group_names(sections.group_names)
        , nodes(sections.nodes)
        , node_order(sections.node_order)
        , elements(sections.elements)
        , lines(text, source)
        , source(source)
      {
        read_all();
      }

    private:
      using Entity = std::pair<unsigned int, int>; ///< dimension and number

      std::map<Entity, std::string>            &group_names;
      std::unordered_map<std::size_t, MshNode> &nodes;
      std::vector<std::size_t>                 &node_order;
      std::vector<MshElement>                  &elements;

      LineReader                      lines;
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

      /** Go to the next line, which must be one of @p section. */
      void
      advance_in(const std::string &section)
      {
        if (!lines.advance())
          throw InputError(source + ", line " + std::to_string(lines.number),
                           "the file ends within " + section,
                           "it is truncated: make or copy it again");
        if (lines.all()[0] == '$')
          lines.fail("'" + std::string(lines.all().substr(0, 40)) +
                       "' within " + section,
                     "the section holds fewer lines than it announces");
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
        advance_in("$MeshFormat");
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
        advance_in("$PhysicalNames");
        const std::size_t n = lines.take_count("a number of names");
        for (std::size_t i = 0; i < n; ++i)
          {
            advance_in("$PhysicalNames");
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
        advance_in("$Entities");
        std::array<std::size_t, 4> n;
        for (std::size_t &n_of_dimension : n)
          n_of_dimension = lines.take_count("a number of entities");
        for (unsigned int d = 0; d < 4; ++d)
          for (std::size_t i = 0; i < n[d]; ++i)
            {
              advance_in("$Entities");
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
          nodes.emplace(number, MshNode{position, lines.number});
        if (!added.second)
          lines.fail("node " + std::to_string(number) + " was already given" +
                       " on line " + std::to_string(added.first->second.line),
                     "number every node once");
        node_order.push_back(number);
      }

      void
      read_nodes_2()
      {
        advance_in("$Nodes");
        const std::size_t n = lines.take_count("a number of nodes");
        for (std::size_t i = 0; i < n; ++i)
          {
            advance_in("$Nodes");
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
        advance_in("$Nodes");
        const std::size_t n_blocks = lines.take_count("a number of blocks");
        const std::size_t n_nodes  = lines.take_count("a number of nodes");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            advance_in("$Nodes");
            lines.take_count("a dimension");
            lines.take_id("an entity number");
            lines.take_id("a flag for parametric nodes");
            const std::size_t        n = lines.take_count("a number of nodes");
            std::vector<std::size_t> numbers;
            for (std::size_t i = 0; i < n; ++i)
              {
                advance_in("$Nodes");
                numbers.push_back(lines.take_count("a node number"));
                lines.end_of_line();
              }
            for (const std::size_t number : numbers)
              {
                advance_in("$Nodes");
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
      read_connectivity(MshElement &element)
      {
        const auto type = msh_element_types().find(element.type);
        if (type == msh_element_types().end())
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
        advance_in("$Elements");
        const std::size_t n = lines.take_count("a number of elements");
        for (std::size_t i = 0; i < n; ++i)
          {
            advance_in("$Elements");
            MshElement element;
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
        advance_in("$Elements");
        const std::size_t n_blocks   = lines.take_count("a number of blocks");
        const std::size_t n_elements = lines.take_count("a number of elements");
        for (std::size_t block = 0; block < n_blocks; ++block)
          {
            advance_in("$Elements");
            const unsigned int dimension = lines.take_count("a dimension");
            const int          entity    = lines.take_id("an entity number");
            const int          type      = lines.take_id("an element type");
            const std::size_t  n     = lines.take_count("a number of elements");
            const auto         known = msh_element_types().find(type);
            if (known != msh_element_types().end() &&
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
                advance_in("$Elements");
                MshElement element;
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
  } // namespace



  const std::map<int, MshElementType> &
  msh_element_types()
  {
    static const std::map<int, MshElementType> types = {
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



  MshSections
  read_msh_sections(const std::string &text, const std::string &source)
  {
    MshSections sections;
    Parser(text, source, sections);
    return sections;
  }
} // namespace alveolus
