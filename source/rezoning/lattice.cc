// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/lattice.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  Lattice<dim>::Lattice(const Nodes<dim>  &mesh_nodes,
                        const std::string &name,
                        const std::string &where)
  {
    using Geometry                       = GeometryInfo<dim>;
    constexpr unsigned int n_vertices    = Geometry::vertices_per_cell;
    const auto            &configuration = mesh_nodes.configuration;
    const auto            &ids = configuration.mesh.names.region(name, where);

    // Nodes of all cells of the region, cell by cell
    std::vector<NodeId> mine, cells, of_cell;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        {
          mesh_nodes.cell_nodes(cell, of_cell);
          mine.insert(mine.end(), of_cell.begin(), of_cell.end());
        }
    for (const auto &part :
         Utilities::MPI::all_gather(configuration.communicator(), mine))
      cells.insert(cells.end(), part.begin(), part.end());
    const auto        &fe      = configuration.fe.base_element(0);
    const unsigned int stride  = fe.n_dofs_per_cell();
    const std::size_t  n_cells = cells.size() / stride;
    const auto         refuse  = [&](const std::string &found) {
      throw InputError(where,
                       "region '" + name + "' is no structured block: " + found,
                       "use another rule, e.g. 'Giuliani'");
    };
    if (n_cells == 0)
      refuse("it has no cells");

    using Face         = std::array<NodeId, Geometry::vertices_per_face>;
    const auto face_of = [&](const std::size_t cell, const unsigned int f) {
      Face face;
      for (unsigned int v = 0; v < face.size(); ++v)
        face[v] = cells[cell * stride + Geometry::face_to_cell_vertices(f, v)];
      std::sort(face.begin(), face.end());
      return face;
    };
    std::map<Face, std::vector<std::pair<std::size_t, unsigned int>>> sides;
    std::map<NodeId, unsigned int> n_cells_at;
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      {
        for (unsigned int f = 0; f < Geometry::faces_per_cell; ++f)
          sides[face_of(cell, f)].emplace_back(cell, f);
        for (unsigned int v = 0; v < n_vertices; ++v)
          ++n_cells_at[cells[cell * stride + v]];
      }
    const auto n_corners =
      std::count_if(n_cells_at.begin(), n_cells_at.end(), [](const auto &e) {
        return e.second == 1;
      });
    if (n_corners != n_vertices)
      refuse("it has " + std::to_string(n_corners) + " corners");

    // Coordinates spread from the first cell across faces: behind a face they
    // go on as they came.
    using Coordinates = std::array<int, dim>;
    std::map<NodeId, Coordinates> coordinates;
    std::vector<bool>             reached(n_cells, false);
    std::vector<std::size_t>      queue(1, 0);
    reached[0] = true;
    for (unsigned int v = 0; v < n_vertices; ++v)
      for (unsigned int a = 0; a < dim; ++a)
        coordinates[cells[v]][a] = (v >> a) & 1;
    for (std::size_t q = 0; q < queue.size(); ++q)
      for (unsigned int f = 0; f < Geometry::faces_per_cell; ++f)
        {
          const NodeId *here = &cells[queue[q] * stride];
          for (const auto &side : sides[face_of(queue[q], f)])
            {
              if (side.first == queue[q])
                continue;
              const NodeId      *there = &cells[side.first * stride];
              const unsigned int axis = f / 2, other_axis = side.second / 2;
              for (unsigned int i = 0; i < Geometry::vertices_per_face; ++i)
                {
                  const unsigned int v = Geometry::face_to_cell_vertices(f, i);
                  const NodeId       shared = here[v];
                  const NodeId       behind = here[v ^ (1u << axis)];
                  const unsigned int w =
                    std::find(there, there + n_vertices, shared) - there;
                  const NodeId ahead = there[w ^ (1u << other_axis)];
                  Coordinates  expected;
                  for (unsigned int a = 0; a < dim; ++a)
                    expected[a] =
                      2 * coordinates[shared][a] - coordinates[behind][a];
                  const auto entry = coordinates.emplace(ahead, expected);
                  if (entry.first->second != expected)
                    refuse("its cells do not form rows");
                }
              if (!reached[side.first])
                {
                  reached[side.first] = true;
                  queue.push_back(side.first);
                }
            }
        }
    if (queue.size() != n_cells)
      refuse("it consists of several parts");

    Coordinates low = coordinates.begin()->second, high = low;
    for (const auto &entry : coordinates)
      for (unsigned int a = 0; a < dim; ++a)
        {
          low[a]  = std::min(low[a], entry.second[a]);
          high[a] = std::max(high[a], entry.second[a]);
        }
    const unsigned int degree        = configuration.degree;
    std::size_t        n_block_cells = 1, n_nodes = 1;
    for (unsigned int a = 0; a < dim; ++a)
      {
        n[a] = degree * (high[a] - low[a]);
        n_block_cells *= high[a] - low[a];
        n_nodes *= n[a] + 1;
      }
    if (n_block_cells != n_cells)
      refuse("its cells do not fill a block");

    nodes.assign(n_nodes, numbers::invalid_dof_index);
    for (std::size_t cell = 0; cell < n_cells; ++cell)
      for (unsigned int k = 0; k < stride; ++k)
        {
          Index             index;
          const Point<dim> &unit = fe.get_unit_support_points()[k];
          for (unsigned int a = 0; a < dim; ++a)
            {
              double x = -low[a];
              for (unsigned int v = 0; v < n_vertices; ++v)
                x += Geometry::d_linear_shape_function(unit, v) *
                     coordinates[cells[cell * stride + v]][a];
              index[a] = static_cast<unsigned int>(std::lround(degree * x));
            }
          nodes[position(index)] = cells[cell * stride + k];
        }
    for (const NodeId node : nodes)
      if (node == numbers::invalid_dof_index)
        refuse("its cells do not fill a block");
  }

  template struct Lattice<2>;
  template struct Lattice<3>;
} // namespace alveolus
