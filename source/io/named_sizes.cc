// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/io/named_sizes.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <class Object>
    void
    gather(std::vector<Object> &objects, const MPI_Comm &communicator)
    {
      const auto all = Utilities::MPI::gather(communicator, objects, 0);
      objects.clear();
      for (const auto &some : all)
        objects.insert(objects.end(), some.begin(), some.end());
    }

    double
    area(const std::array<Point<3>, 4> &p)
    {
      return 0.5 * cross_product_3d(p[2] - p[0], p[3] - p[1]).norm();
    }

    template <int dim>
    std::vector<NamedSize>
    sizes_of(const NamedSets<dim> &names, const GatheredPieces<dim> &mesh)
    {
      std::vector<NamedSize> list;
      for (const auto &region : names.regions)
        {
          NamedSize entry{region.first, "region", 0, 0.};
          for (const types::material_id id : region.second)
            if (mesh.cells.count(id) > 0)
              {
                entry.n_members += mesh.cells.at(id).first;
                entry.size += mesh.cells.at(id).second;
              }
          list.push_back(entry);
        }
      if constexpr (dim == 2)
        {
          std::vector<NamedSize> inside;
          std::set<std::string>  all;
          for (const auto &entry : names.boundaries)
            all.insert(entry.first);
          for (const auto &entry : names.curves)
            all.insert(entry.first);
          for (const std::string &name : all)
            {
              const auto lines  = lines_of(name, names, mesh);
              double     number = 0., length = 0.;
              for (const NamedLine *const line : lines.first)
                {
                  number += line->weight;
                  length += line->weight * line->a.distance(line->b);
                }
              NamedSize entry{name,
                              lines.second ? "boundary" : "curve",
                              static_cast<unsigned int>(std::lround(number)),
                              length};
              (lines.second ? list : inside).push_back(entry);
            }
          list.insert(list.end(), inside.begin(), inside.end());
        }
      else
        for (const auto &boundary : names.boundaries)
          {
            NamedSize entry{boundary.first, "boundary", 0, 0.};
            for (const MeshPiece<dim> &piece : mesh.pieces)
              if (boundary.second.count(piece.boundary) > 0)
                {
                  ++entry.n_members;
                  entry.size += area(piece.corners);
                }
            list.push_back(entry);
          }
      for (const auto &point : names.points)
        list.push_back({point.first, "point", 1, 0.});
      return list;
    }
  } // namespace



  template <int dim>
  GatheredPieces<dim>
  gather_pieces(const Mesh<dim> &mesh)
  {
    const auto         &triangulation = *mesh.triangulation;
    GatheredPieces<dim> result;
    for (const auto &cell : triangulation.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          auto &entry = result.cells[cell->material_id()];
          ++entry.first;
          entry.second += cell->measure();
          if constexpr (dim == 2)
            {
              MeshPiece<2> piece;
              for (unsigned int k = 0; k < 4; ++k)
                piece.corners[k] = cell->vertex(k < 2 ? k : 5 - k);
              piece.material = cell->material_id();
              result.pieces.push_back(piece);
            }
          for (const unsigned int f : cell->face_indices())
            {
              const auto face = cell->face(f);
              if (face->has_children())
                continue; // those see it from the other side
              if constexpr (dim == 2)
                {
                  NamedLine line;
                  line.a        = face->vertex(0);
                  line.b        = face->vertex(1);
                  line.manifold = face->manifold_id();
                  line.boundary = face->boundary_id();
                  line.weight =
                    face->at_boundary() || cell->neighbor_is_coarser(f) ? 1.
                                                                        : 0.5;
                  if (face->at_boundary() ||
                      line.manifold != numbers::flat_manifold_id)
                    result.lines.push_back(line);
                }
              else if (face->at_boundary())
                {
                  MeshPiece<dim> piece;
                  for (unsigned int k = 0; k < 4; ++k)
                    piece.corners[k] = face->vertex(k < 2 ? k : 5 - k);
                  piece.material = cell->material_id();
                  piece.boundary = face->boundary_id();
                  result.pieces.push_back(piece);
                }
            }
        }
    const MPI_Comm communicator = triangulation.get_communicator();
    gather(result.pieces, communicator);
    gather(result.lines, communicator);
    const auto all = Utilities::MPI::gather(communicator, result.cells, 0);
    result.cells.clear();
    for (const auto &some : all)
      for (const auto &entry : some)
        {
          result.cells[entry.first].first += entry.second.first;
          result.cells[entry.first].second += entry.second.second;
        }
    return result;
  }

  /** The lines of a name, and whether all of them are at the boundary. */
  std::pair<std::vector<const NamedLine *>, bool>
  lines_of(const std::string       &name,
           const NamedSets<2>      &names,
           const GatheredPieces<2> &mesh)
  {
    std::pair<std::vector<const NamedLine *>, bool> result({}, true);
    const auto curve    = names.curves.find(name);
    const auto boundary = names.boundaries.find(name);
    for (const NamedLine &line : mesh.lines)
      {
        const bool at_boundary =
          line.boundary != numbers::internal_face_boundary_id;
        if ((curve != names.curves.end() &&
             curve->second.count(line.manifold) > 0) ||
            (boundary != names.boundaries.end() && at_boundary &&
             boundary->second.count(line.boundary) > 0))
          {
            result.first.push_back(&line);
            result.second = result.second && at_boundary;
          }
      }
    return result;
  }

  template <int dim>
  std::vector<NamedSize>
  named_sizes(const Mesh<dim> &mesh)
  {
    const GatheredPieces<dim> all = gather_pieces(mesh);
    if (Utilities::MPI::this_mpi_process(
          mesh.triangulation->get_communicator()) != 0)
      return {};
    return sizes_of(mesh.names, all);
  }



  template GatheredPieces<2>
  gather_pieces(const Mesh<2> &);
  template GatheredPieces<3>
  gather_pieces(const Mesh<3> &);
  template std::vector<NamedSize>
  named_sizes(const Mesh<2> &);
  template std::vector<NamedSize>
  named_sizes(const Mesh<3> &);
} // namespace alveolus
