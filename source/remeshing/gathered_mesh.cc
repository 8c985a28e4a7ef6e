// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/remeshing/gathered_mesh.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/manifold.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    const std::string where = "Remeshing";

    // Lines of a cell, anticlockwise, and deal.II's numbers of them
    constexpr unsigned int ends[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};
    constexpr unsigned int face[4]    = {2, 1, 3, 0};

    /** What a process sends about its cells. */
    struct Parcel
    {
      std::vector<double> places; ///< X, x of every vertex
      std::vector<unsigned long long>
        ids; ///< nodes, material; ids of the lines

      template <class Archive>
      void
      serialize(Archive &archive, const unsigned int /*version*/)
      {
        archive &places &ids;
      }
    };

    Parcel
    own_cells(const Configuration<2> &configuration)
    {
      const NodalVector &initial   = configuration.initial_positions();
      const NodalVector  positions = configuration.positions();
      Parcel             parcel;
      for (const auto &cell : configuration.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            for (const unsigned int v : cell->vertex_indices())
              {
                parcel.ids.push_back(cell->vertex_dof_index(v, 0));
                for (const NodalVector *field : {&initial, &positions})
                  for (unsigned int c = 0; c < 2; ++c)
                    parcel.places.push_back(
                      (*field)(cell->vertex_dof_index(v, c)));
              }
            parcel.ids.push_back(cell->material_id());
            for (unsigned int k = 0; k < 4; ++k)
              {
                const auto line = cell->face(face[k]);
                if (line->has_children() ||
                    (!line->at_boundary() &&
                     cell->neighbor_is_coarser(face[k])))
                  throw RunError(where,
                                 "the mesh has hanging nodes",
                                 "refine all cells alike");
                parcel.ids.push_back(line->manifold_id());
                parcel.ids.push_back(line->at_boundary()
                                       ? line->boundary_id()
                                       : numbers::internal_face_boundary_id);
              }
          }
      return parcel;
    }

    bool
    before(const Point<2> &a, const Point<2> &b)
    {
      return a[0] != b[0] ? a[0] < b[0] : a[1] < b[1];
    }
  } // namespace



  bool
  LineIds::are_on(const std::string &curve, const NamedSets<2> &names) const
  {
    const auto c = names.curves.find(curve);
    const auto b = names.boundaries.find(curve);
    return (c != names.curves.end() && c->second.count(manifold) != 0) ||
           (b != names.boundaries.end() &&
            boundary != numbers::internal_face_boundary_id &&
            b->second.count(boundary) != 0);
  }



  GatheredMesh
  gather_mesh(const Configuration<2> &configuration)
  {
    if (configuration.degree != 1)
      throw RunError(where,
                     "a mesh of degree " +
                       std::to_string(configuration.degree) +
                       " cannot be remeshed",
                     "set Mesh / Degree = 1");
    const auto parcels =
      Utilities::MPI::all_gather(configuration.communicator(),
                                 own_cells(configuration));

    // Nodes by their global index first, then in the order of their places
    std::map<unsigned long long, std::pair<Point<2>, Point<2>>> nodes;
    for (const Parcel &parcel : parcels)
      for (std::size_t c = 0; c < parcel.ids.size() / 13; ++c)
        for (unsigned int v = 0; v < 4; ++v)
          {
            const double *x               = &parcel.places[4 * (4 * c + v)];
            nodes[parcel.ids[13 * c + v]] = {Point<2>(x[0], x[1]),
                                             Point<2>(x[2], x[3])};
          }
    using Entry = std::pair<unsigned long long, std::pair<Point<2>, Point<2>>>;
    std::vector<Entry> sorted(nodes.begin(), nodes.end());
    // Nodes at the same place, e.g. of parts in contact, lie apart later on.
    std::sort(sorted.begin(), sorted.end(), [](const Entry &a, const Entry &b) {
      return a.second.first != b.second.first
               ? before(a.second.first, b.second.first)
               : before(a.second.second, b.second.second);
    });
    GatheredMesh                               mesh;
    std::map<unsigned long long, unsigned int> index;
    for (const Entry &entry : sorted)
      {
        index[entry.first] = mesh.positions.size();
        mesh.initial.push_back(entry.second.first);
        mesh.positions.push_back(entry.second.second);
      }

    std::vector<std::pair<Quad, types::material_id>> cells;
    for (const Parcel &parcel : parcels)
      for (std::size_t c = 0; c < parcel.ids.size() / 13; ++c)
        {
          const auto *ids = &parcel.ids[13 * c];
          Quad        quad;
          for (unsigned int v = 0; v < 4; ++v)
            quad[v] = index.at(ids[v]);
          cells.emplace_back(quad, static_cast<types::material_id>(ids[4]));
          for (unsigned int k = 0; k < 4; ++k)
            {
              LineIds line;
              line.manifold = static_cast<types::manifold_id>(ids[5 + 2 * k]);
              line.boundary = static_cast<types::boundary_id>(ids[6 + 2 * k]);
              mesh
                .lines[GatheredMesh::line(quad[ends[k][0]], quad[ends[k][1]])] =
                line;
            }
        }
    std::sort(cells.begin(), cells.end());
    for (const auto &cell : cells)
      {
        mesh.cells.push_back(cell.first);
        mesh.materials.push_back(cell.second);
      }

    for (const auto &point : configuration.mesh.names.points)
      {
        unsigned int nearest  = 0;
        double       distance = std::numeric_limits<double>::max();
        for (unsigned int v = 0; v < mesh.initial.size(); ++v)
          if (mesh.initial[v].distance(point.second) < distance)
            {
              distance = mesh.initial[v].distance(point.second);
              nearest  = v;
            }
        if (distance > 1e-8 * (1. + point.second.norm()))
          throw RunError(where,
                         "the named point '" + point.first +
                           "' is no vertex of the mesh",
                         "");
        mesh.points[point.first] = nearest;
      }
    return mesh;
  }



  Mesh<2>
  build_named_mesh(const MeshDescription<2>              &description,
                   const std::map<unsigned int, LineIds> &ids,
                   const NamedSets<2>                    &names,
                   const MPI_Comm                        &communicator)
  {
    Mesh<2> mesh          = build_mesh(description, communicator);
    mesh.names.curves     = names.curves;
    mesh.names.boundaries = names.boundaries;
    mesh.names.regions    = names.regions;
    std::set<types::manifold_id> manifolds;
    // The lines carry their tags as manifold ids. All cells are coarse ones,
    // known to every process. Ids are changed once, from the first cell.
    std::vector<bool> done(mesh.triangulation->n_raw_lines(), false);
    for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
      for (const auto &line : cell->face_iterators())
        {
          if (done[line->index()])
            continue;
          done[line->index()] = true;
          const auto entry    = ids.find(line->manifold_id());
          if (line->manifold_id() == numbers::flat_manifold_id ||
              entry == ids.end())
            continue;
          line->set_manifold_id(entry->second.manifold);
          if (line->at_boundary())
            line->set_boundary_id(entry->second.boundary);
          manifolds.insert(entry->second.manifold);
        }
    for (const types::manifold_id id : manifolds)
      if (id != numbers::flat_manifold_id)
        mesh.triangulation->set_manifold(id, FlatManifold<2>());
    return mesh;
  }
} // namespace alveolus
