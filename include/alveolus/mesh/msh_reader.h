// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_msh_reader_h
#define alveolus_mesh_msh_reader_h

#include <alveolus/mesh/mesh_description.h>

namespace alveolus
{
  /**
   * Read a mesh in gmsh's text format, version 2.2 or 4.1 (Geuzaine and
   * Remacle, Gmsh reference manual, "MSH file format"). deal.II's own reader
   * knows neither names nor named interior lines, both of which scenes need.
   *
   * Physical groups are the names: of dimension 0 points (one node each), 1
   * curves, 2 surfaces (3D), dim regions; a group without a name is known by
   * its number. One element may belong to several groups (version 2.2 then
   * lists it several times). Elements of the same elementary entity and the
   * same groups get one tag, which is the number of the entity where that is
   * unique. Every cell must be in a group; lines and surfaces without one are
   * left out. Nodes that belong to no element of the description are kept here;
   * check_description() drops them.
   *
   * @param text   content of the file
   * @param source name of the file for the messages
   * @throws InputError with file and line: other formats and versions, binary
   *         files, truncated or inconsistent sections, unknown nodes, any cell
   *         that is not a linear quad (2D) or hexahedron (3D), no cells, cells
   *         without a region, in 2D nodes out of the plane z = const.
   */
  template <int dim>
  MeshDescription<dim>
  read_msh(const std::string &text, const std::string &source);
} // namespace alveolus

#endif
