// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/describe_mesh.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** An active cell, in a form that can be sent. */
    template <int dim>
    struct CellData
    {
      static constexpr unsigned int n = 1 << dim;

      std::string                            id; ///< sorts the cells
      std::array<NodeId, n>                  nodes;
      std::array<std::array<double, dim>, n> places;
      unsigned int                           material = 0;
      std::vector<std::pair<unsigned int, unsigned int>> lines; ///< number, tag
      std::vector<std::pair<unsigned int, unsigned int>> faces; ///< 3D
      bool                                               foreign_tag = false;

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int)
      {
        archive &id &nodes &places &material &lines &faces &foreign_tag;
      }
    };

    /** So that the order of the strings is that of the cells. */
    std::string
    sortable(const CellId &id)
    {
      const auto        binary = id.to_binary<2>();
      std::string       text;
      const char *const digits = "0123456789abcdef";
      for (const unsigned int part :
           {binary[0], binary[2], binary[3], binary[1]})
        for (int shift = 28; shift >= 0; shift -= 4)
          text += digits[(part >> shift) & 15];
      return text;
    }
  } // namespace



  template <int dim>
  MeshDescription<dim>
  describe_mesh(const Nodes<dim>  &nodes,
                const NodalVector &positions,
                const std::string &where)
  {
    const auto &configuration = nodes.configuration;
    const auto &names         = configuration.mesh.names;
    if (configuration.mesh.triangulation->has_hanging_nodes())
      throw InputError(where,
                       "the mesh has hanging nodes",
                       "remesh meshes that are refined as a whole only");

    std::vector<CellData<dim>> mine;
    std::vector<NodeId>        cell_nodes;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          CellData<dim> data;
          data.id       = sortable(cell->id());
          data.material = cell->material_id();
          nodes.cell_nodes(cell, cell_nodes);
          for (unsigned int v = 0; v < data.n; ++v)
            {
              data.nodes[v]      = cell_nodes[v];
              const Point<dim> p = nodes.get(positions, cell_nodes[v]);
              for (unsigned int d = 0; d < dim; ++d)
                data.places[v][d] = p[d];
            }
          for (unsigned int l = 0; l < cell->n_lines(); ++l)
            {
              const auto         line     = cell->line(l);
              const auto         manifold = line->manifold_id();
              const bool         outside  = dim == 2 && line->at_boundary();
              const auto         boundary = outside ? line->boundary_id() : 0;
              const unsigned int tag =
                manifold != numbers::flat_manifold_id ? manifold : boundary;
              if (tag != 0)
                data.lines.emplace_back(l, tag);
              data.foreign_tag = data.foreign_tag ||
                                 (outside && boundary != 0 && boundary != tag);
            }
          if (dim == 3)
            for (const unsigned int f : cell->face_indices())
              if (cell->at_boundary(f) && cell->face(f)->boundary_id() != 0)
                data.faces.emplace_back(f, cell->face(f)->boundary_id());
          mine.push_back(std::move(data));
        }
    std::vector<CellData<dim>> cells;
    for (auto &part :
         Utilities::MPI::all_gather(configuration.communicator(), mine))
      std::move(part.begin(), part.end(), std::back_inserter(cells));
    std::sort(cells.begin(),
              cells.end(),
              [](const CellData<dim> &a, const CellData<dim> &b) {
                return a.id < b.id;
              });

    MeshDescription<dim> mesh;
    mesh.source = "mesh";
    std::unordered_map<NodeId, unsigned int>              vertex;
    std::map<std::pair<unsigned int, unsigned int>, bool> seen;
    for (const auto &data : cells)
      {
        if (data.foreign_tag)
          throw InputError(where,
                           "the mesh has boundaries whose numbers are not "
                           "those of their curves",
                           "use a mesh from a file or from a mesh source of "
                           "its own");
        DescribedElement<dim> cell;
        for (unsigned int v = 0; v < data.n; ++v)
          {
            const auto entry =
              vertex.emplace(data.nodes[v], mesh.vertices.size());
            if (entry.second)
              {
                Point<dim> p;
                for (unsigned int d = 0; d < dim; ++d)
                  p[d] = data.places[v][d];
                mesh.vertices.push_back(p);
                mesh.vertex_numbers.push_back(mesh.vertices.size());
              }
            cell.vertices[v] = entry.first->second;
          }
        cell.tag    = data.material;
        cell.number = mesh.cells.size() + 1;
        mesh.cells.push_back(cell);
        for (const auto &[l, tag] : data.lines)
          {
            DescribedElement<1> line;
            for (unsigned int v = 0; v < 2; ++v)
              line.vertices[v] =
                cell.vertices[GeometryInfo<dim>::line_to_cell_vertices(l, v)];
            if (!seen
                   .emplace(std::minmax(line.vertices[0], line.vertices[1]),
                            true)
                   .second)
              continue;
            line.tag    = tag;
            line.number = mesh.lines.size() + 1;
            mesh.lines.push_back(line);
          }
        if constexpr (dim == 3)
          for (const auto &[f, tag] : data.faces)
            {
              DescribedElement<2> quad;
              for (unsigned int v = 0; v < 4; ++v)
                quad.vertices[v] =
                  cell.vertices[GeometryInfo<dim>::face_to_cell_vertices(f, v)];
              quad.tag    = tag;
              quad.number = mesh.quads.size() + 1;
              mesh.quads.push_back(quad);
            }
      }
    for (const auto &point : names.points)
      mesh.points[point.first] = vertex.at(nodes.point(point.first, where));
    for (const auto &curve : names.curves)
      mesh.curves[curve.first].insert(curve.second.begin(), curve.second.end());
    for (const auto &piece : names.boundaries)
      (dim == 2 ? mesh.curves : mesh.surfaces)[piece.first].insert(
        piece.second.begin(), piece.second.end());
    for (const auto &region : names.regions)
      mesh.regions[region.first].insert(region.second.begin(),
                                        region.second.end());
    return mesh;
  }

  template MeshDescription<2>
  describe_mesh(const Nodes<2> &, const NodalVector &, const std::string &);
  template MeshDescription<3>
  describe_mesh(const Nodes<3> &, const NodalVector &, const std::string &);
} // namespace alveolus
