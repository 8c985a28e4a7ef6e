// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_description_h
#define alveolus_mesh_mesh_description_h

#include <deal.II/base/point.h>

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * A line, quadrilateral or hexahedron of a mesh description, with vertices in
   * deal.II's lexicographic order.
   */
  template <int structdim>
  struct DescribedElement
  {
    /** In deal.II's order. */
    std::array<unsigned int, (1 << structdim)> vertices{};
    /** Id of the piece it belongs to, at least 1; a name stands for pieces. */
    unsigned int tag    = 0;
    std::size_t  number = 0; ///< its number in the file
    std::size_t  line   = 0; ///< its line in the file, 0 if there is none
  };

  /**
   * A mesh as read from a file or made by a generator, before it becomes a
   * triangulation: no iterators, no processes. Only named lines and quads are
   * listed. In 2D cells are quads, in 3D hexahedra.
   */
  template <int dim>
  struct MeshDescription
  {
    std::string                        source;   ///< file name, for messages
    std::vector<dealii::Point<dim>>    vertices; ///< [mm]
    std::vector<std::size_t>           vertex_numbers; ///< in the file
    std::vector<DescribedElement<dim>> cells; ///< with the tags of regions
    std::vector<DescribedElement<1>>   lines; ///< of named curves
    std::vector<DescribedElement<2>>   quads; ///< of named surfaces; 3D only

    std::map<std::string, unsigned int>           points;   ///< vertex index
    std::map<std::string, std::set<unsigned int>> curves;   ///< tags of lines
    std::map<std::string, std::set<unsigned int>> surfaces; ///< 3D only
    std::map<std::string, std::set<unsigned int>> regions;  ///< tags of cells

    /** "file" or "file, line 12" for the messages. */
    std::string
    place(const std::size_t line) const
    {
      return line == 0 ? source : source + ", line " + std::to_string(line);
    }
  };
} // namespace alveolus

#endif
