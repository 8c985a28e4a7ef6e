// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_lattice_h
#define alveolus_rezoning_lattice_h

#include <alveolus/mesh/nodes.h>

#include <array>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Nodes of a structured block by their integer coordinates, on every process.
   */
  template <int dim>
  struct Lattice
  {
    /** Steps from the first corner in each direction. */
    using Index = std::array<unsigned int, dim>;

    /**
     * Number the nodes of the region called @p name (collective): from one of
     * its corners, i.e. vertices with one cell, across the faces.
     * @throws InputError if the region is no structured block
     */
    Lattice(const Nodes<dim>  &nodes,
            const std::string &name,
            const std::string &where);

    /** The node at a place of the lattice. */
    NodeId
    at(const Index &index) const
    {
      return nodes[position(index)];
    }

    /** Coordinates of the node at place @p i of the list. */
    Index
    index(std::size_t i) const
    {
      Index result;
      for (unsigned int a = 0; a < dim; ++a)
        {
          result[a] = i % (n[a] + 1);
          i /= n[a] + 1;
        }
      return result;
    }

    /** Where this place is in `nodes`: the first index runs fastest. */
    std::size_t
    position(const Index &index) const
    {
      std::size_t i = 0;
      for (unsigned int a = dim; a-- > 0;)
        i = i * (n[a] + 1) + index[a];
      return i;
    }

    /** Whether a place is on a side of the lattice. */
    bool
    is_border(const Index &index) const
    {
      for (unsigned int a = 0; a < dim; ++a)
        if (index[a] == 0 || index[a] == n[a])
          return true;
      return false;
    }

    Index               n;     ///< steps between nodes in each direction
    std::vector<NodeId> nodes; ///< by position()
  };
} // namespace alveolus

#endif
