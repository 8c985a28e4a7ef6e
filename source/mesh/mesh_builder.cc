// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>

#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <iomanip>
#include <limits>
#include <sstream>

namespace alveolus
{
  namespace
  {
    using Ids = std::set<unsigned int>;

    /** Faces of the mesh with one cell only, as sorted vertex lists. */
    template <int dim>
    std::set<std::set<unsigned int>>
    boundary_faces(const MeshDescription<dim> &description)
    {
      std::map<Ids, unsigned int> n_cells;
      for (const auto &cell : description.cells)
        for (unsigned int d = 0; d < dim; ++d)
          for (const unsigned int side : {0, 1})
            {
              Ids face;
              for (unsigned int v = 0; v < cell.vertices.size(); ++v)
                if (((v >> d) & 1) == side)
                  face.insert(cell.vertices[v]);
              ++n_cells[face];
            }
      std::set<Ids> result;
      for (const auto &entry : n_cells)
        if (entry.second == 1)
          result.insert(entry.first);
      return result;
    }

    /** The sets @p all, without ids that are not in @p present. */
    std::map<std::string, std::set<dealii::types::boundary_id>>
    only(const std::map<std::string, Ids> &all, const Ids &present)
    {
      std::map<std::string, std::set<dealii::types::boundary_id>> result;
      for (const auto &entry : all)
        for (const unsigned int id : entry.second)
          if (present.count(id) != 0)
            result[entry.first].insert(id);
      return result;
    }

    std::string
    count(const std::size_t n, const std::string &noun)
    {
      return std::to_string(n) + " " + noun + (n == 1 ? "" : "s");
    }
  } // namespace



  template <int dim>
  Mesh<dim>
  build_mesh(const MeshDescription<dim> &description,
             const MPI_Comm             &communicator)
  {
    std::vector<dealii::CellData<dim>> cells(description.cells.size());
    for (std::size_t c = 0; c < cells.size(); ++c)
      {
        cells[c].vertices.assign(description.cells[c].vertices.begin(),
                                 description.cells[c].vertices.end());
        cells[c].material_id = description.cells[c].tag;
      }

    const std::set<Ids> at_boundary = boundary_faces(description);
    const auto          is_boundary = [&at_boundary](const auto &element) {
      return at_boundary.count(
               Ids(element.vertices.begin(), element.vertices.end())) != 0;
    };
    // In 3D deal.II wants to be told which lines are inside. Of a boundary quad
    // all pairs of vertices are listed: a diagonal is no line of the mesh.
    std::set<std::pair<unsigned int, unsigned int>> boundary_lines;
    for (const Ids &face : at_boundary)
      for (const unsigned int a : face)
        for (const unsigned int b : face)
          boundary_lines.emplace(a, b);

    dealii::SubCellData named;
    Ids                 manifold_ids, boundary_ids;
    for (const auto &line : description.lines)
      {
        dealii::CellData<1> data(2);
        data.vertices.assign(line.vertices.begin(), line.vertices.end());
        data.manifold_id = line.tag;
        manifold_ids.insert(line.tag);
        if (boundary_lines.count({line.vertices[0], line.vertices[1]}) == 0)
          data.boundary_id = dealii::numbers::internal_face_boundary_id;
        else if (dim == 2)
          {
            data.boundary_id = line.tag;
            boundary_ids.insert(line.tag);
          }
        else
          data.boundary_id = 0; // names are given to boundary quads
        named.boundary_lines.push_back(data);
      }
    for (const auto &quad : description.quads)
      if (is_boundary(quad))
        {
          dealii::CellData<2> data(4);
          data.vertices.assign(quad.vertices.begin(), quad.vertices.end());
          data.boundary_id = quad.tag;
          boundary_ids.insert(quad.tag);
          named.boundary_quads.push_back(data);
        }

    dealii::GridTools::consistently_order_cells(cells);

    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<dealii::parallel::distributed::Triangulation<dim>>(
        communicator);
    mesh.triangulation->create_triangulation(description.vertices,
                                             cells,
                                             named);
    for (const unsigned int id : manifold_ids)
      mesh.triangulation->set_manifold(id, dealii::FlatManifold<dim>());

    for (const auto &point : description.points)
      mesh.names.points[point.first] = description.vertices[point.second];
    for (const auto &curve : description.curves)
      mesh.names.curves[curve.first].insert(curve.second.begin(),
                                            curve.second.end());
    for (const auto &region : description.regions)
      mesh.names.regions[region.first].insert(region.second.begin(),
                                              region.second.end());
    mesh.names.boundaries =
      only(dim == 2 ? description.curves : description.surfaces, boundary_ids);

    std::ostringstream text;
    text << description.source << ": "
         << count(description.cells.size(), "cell") << ", "
         << description.vertices.size() << " vertices, "
         << count(mesh.names.regions.size(), "region") << ", "
         << count(mesh.names.boundaries.size(), "named boundary piece") << ", "
         << count(mesh.names.curves.size(), "named curve") << ", "
         << count(mesh.names.points.size(), "named point")
         << ", smallest scaled Jacobian " << std::setprecision(3)
         << smallest_scaled_jacobian(description);
    mesh.description = text.str();
    return mesh;
  }



  template <int dim>
  double
  smallest_scaled_jacobian(const MeshDescription<dim> &description)
  {
    double smallest = std::numeric_limits<double>::max();
    for (const auto &cell : description.cells)
      for (const double jacobian : corner_jacobians(description, cell))
        smallest = std::min(smallest, jacobian);
    return smallest;
  }



  template Mesh<2>
  build_mesh<2>(const MeshDescription<2> &, const MPI_Comm &);
  template Mesh<3>
  build_mesh<3>(const MeshDescription<3> &, const MPI_Comm &);
  template double
  smallest_scaled_jacobian<2>(const MeshDescription<2> &);
  template double
  smallest_scaled_jacobian<3>(const MeshDescription<3> &);
} // namespace alveolus
