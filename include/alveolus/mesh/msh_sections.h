// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_msh_sections_h
#define alveolus_mesh_msh_sections_h

#include <deal.II/base/point.h>

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace alveolus
{
  /** What gmsh's format says of an element type. */
  struct MshElementType
  {
    unsigned int dimension; ///< of space: 0 for a point
    unsigned int n_nodes;   ///< of one element
    const char  *name;      ///< singular
    const char  *names;     ///< plural
  };

  /** Gmsh's element types by number, up to second order. */
  const std::map<int, MshElementType> &
  msh_element_types();

  /** A node with the line of the file it stands in. */
  struct MshNode
  {
    dealii::Point<3> position; ///< [mm]
    std::size_t      line;     ///< in the file
  };

  /** An element as it stands in the file. */
  struct MshElement
  {
    int                      type;   ///< gmsh's number of the kind
    std::size_t              number; ///< in the file
    std::size_t              line;   ///< of the file where it stands
    int                      entity; ///< number of the elementary entity
    std::set<int>            groups; ///< numbers of the physical groups
    std::vector<std::size_t> nodes;  ///< numbers, all of them known
  };

  /** The content of a mesh file, whatever the version, not yet judged. */
  struct MshSections
  {
    /** Names of physical groups by dimension and number. */
    std::map<std::pair<unsigned int, int>, std::string> group_names;
    std::unordered_map<std::size_t, MshNode>            nodes; ///< by number
    std::vector<std::size_t> node_order; ///< numbers in the file's order
    std::vector<MshElement>  elements;   ///< in the file's order
  };

  /**
   * Read the sections $MeshFormat, $PhysicalNames, $Entities, $Nodes and
   * $Elements of a text mesh of version 2.2 or 4.1 (Gmsh reference manual, "MSH
   * file format"); others are passed over. In version 2.2 an element has one
   * group here and is listed once for each of them.
   * @param source name of the file for the messages
   * @throws InputError with file and line for whatever does not follow the
   *         format, also for unknown nodes
   */
  MshSections
  read_msh_sections(const std::string &text, const std::string &source);
} // namespace alveolus

#endif
