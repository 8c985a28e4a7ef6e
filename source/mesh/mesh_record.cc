// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/mesh_record.h>

#include <deal.II/base/mpi.h>
#include <deal.II/grid/manifold.h>
#include <deal.II/grid/tria.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** FNV-1a, 64 bits. */
    class Hash
    {
    public:
      template <class Number>
      void
      add(const Number number)
      {
        unsigned char bytes[sizeof(Number)];
        std::memcpy(bytes, &number, sizeof(Number));
        for (const unsigned char byte : bytes)
          value = (value ^ byte) * 1099511628211ull;
      }

      std::uint64_t value = 14695981039346656037ull;
    };

    /** Names with their ids, one pair a line: "id name". */
    template <class Id>
    std::string
    write_sets(const std::map<std::string, std::set<Id>> &sets)
    {
      std::ostringstream text;
      for (const auto &[name, ids] : sets)
        {
          text << ids.size();
          for (const Id id : ids)
            text << ' ' << id;
          text << ' ' << name << '\n';
        }
      return text.str();
    }

    template <class Id>
    std::map<std::string, std::set<Id>>
    read_sets(const BlockFile &blocks, const std::string &block)
    {
      std::map<std::string, std::set<Id>> sets;
      std::istringstream                  text(blocks.text(block));
      std::size_t                         n = 0;
      while (text >> n)
        {
          std::set<Id> ids;
          Id           id;
          for (std::size_t i = 0; i < n && text >> id; ++i)
            ids.insert(id);
          std::string name;
          text.get(); // the blank between
          if (!std::getline(text, name) || ids.size() != n)
            blocks.refuse(block, "is no list of names");
          sets[name] = ids;
        }
      return sets;
    }

    /** A line or face of the coarse mesh with its vertices and ids. */
    template <class Iterator>
    void
    append(const Iterator &object, BlockFile::Integers &list)
    {
      for (unsigned int v = 0; v < object->n_vertices(); ++v)
        list.push_back(object->vertex_index(v));
      list.push_back(object->boundary_id());
      list.push_back(object->manifold_id());
    }

    /** The inverse: elements of @p block. */
    template <int structdim>
    std::vector<CellData<structdim>>
    read_elements(const BlockFile   &blocks,
                  const std::string &block,
                  const std::size_t  n_vertices)
    {
      constexpr std::size_t n    = 1 << structdim;
      const auto           &list = blocks.integers(block);
      if (list.size() % (n + 2) != 0)
        blocks.refuse(block, "is no list of elements");
      std::vector<CellData<structdim>> elements;
      elements.reserve(list.size() / (n + 2));
      for (std::size_t begin = 0; begin < list.size(); begin += n + 2)
        {
          CellData<structdim> element(n);
          for (std::size_t v = 0; v < n; ++v)
            {
              if (list[begin + v] >= n_vertices)
                blocks.refuse(block, "names a vertex that does not exist");
              element.vertices[v] = list[begin + v];
            }
          element.material_id = list[begin + n]; // or boundary_id: the same
          element.manifold_id = list[begin + n + 1];
          elements.push_back(element);
        }
      return elements;
    }

    /** Whether all coarse cells are divided equally often. */
    template <class Triangulation>
    bool
    is_uniform(const Triangulation &triangulation)
    {
      std::uint64_t n = triangulation.n_cells(0);
      for (unsigned int level = 1; level < triangulation.n_global_levels();
           ++level)
        n *= 1u << Triangulation::dimension;
      return n == triangulation.n_global_active_cells();
    }

    /** Ids of all active cells, one a line, ascending (collective). */
    template <class Triangulation>
    std::string
    leaves_of(const Triangulation &triangulation)
    {
      std::vector<std::string> own, all;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          own.push_back(cell->id().to_string());
      for (const auto &part :
           Utilities::MPI::all_gather(triangulation.get_communicator(), own))
        all.insert(all.end(), part.begin(), part.end());
      std::sort(all.begin(), all.end());
      std::string text;
      for (const std::string &id : all)
        text += id + '\n';
      return text;
    }

    /** Divide coarse cells until the active ones are those (collective). */
    template <class Triangulation>
    void
    divide(Triangulation &triangulation, const std::string &leaves)
    {
      // Coarse cell and path: divided if that is how a leaf's path begins
      std::set<std::pair<std::string, std::string>> divided;
      const auto split = [](const std::string &id) {
        return std::make_pair(id.substr(0, id.find('_')),
                              id.substr(id.find(':') + 1));
      };
      std::istringstream lines(leaves);
      std::string        line;
      while (std::getline(lines, line))
        {
          auto id = split(line);
          while (!id.second.empty())
            {
              id.second.pop_back();
              divided.insert(id);
            }
        }
      for (;;)
        {
          unsigned int n = 0;
          for (const auto &cell : triangulation.active_cell_iterators())
            if (cell->is_locally_owned() &&
                divided.count(split(cell->id().to_string())) > 0)
              {
                cell->set_refine_flag();
                ++n;
              }
          if (Utilities::MPI::sum(n, triangulation.get_communicator()) == 0)
            return;
          triangulation.execute_coarsening_and_refinement();
        }
    }
  } // namespace



  template <int dim>
  std::uint64_t
  fingerprint(const Mesh<dim> &mesh)
  {
    // A sum, so that neither order nor owners of the cells matter.
    std::uint64_t sum = 0;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          Hash hash;
          for (const auto part : cell->id().template to_binary<dim>())
            hash.add(part);
          for (const unsigned int v : cell->vertex_indices())
            for (unsigned int d = 0; d < dim; ++d)
              hash.add(cell->vertex(v)[d]);
          hash.add(cell->material_id());
          hash.add(cell->manifold_id());
          for (const auto &face : cell->face_iterators())
            {
              hash.add(face->boundary_id());
              hash.add(face->manifold_id());
            }
          if (dim == 3)
            for (const unsigned int l : cell->line_indices())
              {
                hash.add(cell->line(l)->boundary_id());
                hash.add(cell->line(l)->manifold_id());
              }
          sum += hash.value;
        }
    return Utilities::MPI::sum(sum, mesh.triangulation->get_communicator());
  }



  template <int dim>
  bool
  can_be_stored(const Mesh<dim> &mesh)
  {
    const auto &triangulation = *mesh.triangulation;
    for (const auto id : triangulation.get_manifold_ids())
      if (dynamic_cast<const FlatManifold<dim> *>(
            &triangulation.get_manifold(id)) == nullptr)
        return false;
    return true;
  }



  template <int dim>
  void
  save_mesh(const Mesh<dim> &mesh, BlockFile &blocks)
  {
    // Coarse cells are on every process, and nothing of this needs others.
    const auto            &triangulation = *mesh.triangulation;
    BlockFile::Integers    cells, lines, quads;
    std::set<unsigned int> seen_lines, seen_quads;
    unsigned int           n_vertices = 0;
    for (const auto &cell : triangulation.cell_iterators_on_level(0))
      {
        for (const unsigned int v : cell->vertex_indices())
          {
            cells.push_back(cell->vertex_index(v));
            n_vertices = std::max(n_vertices, cell->vertex_index(v) + 1);
          }
        cells.push_back(cell->material_id());
        cells.push_back(cell->manifold_id());
        for (const unsigned int l : cell->line_indices())
          if (seen_lines.insert(cell->line(l)->index()).second)
            append(cell->line(l), lines);
        if constexpr (dim == 3)
          for (const unsigned int f : cell->face_indices())
            if (seen_quads.insert(cell->face(f)->index()).second)
              append(cell->face(f), quads);
      }
    BlockFile::Numbers vertices;
    for (unsigned int v = 0; v < n_vertices; ++v)
      for (unsigned int d = 0; d < dim; ++d)
        vertices.push_back(triangulation.get_vertices()[v][d]);
    blocks.put("mesh/vertices", std::move(vertices));
    blocks.put("mesh/cells", std::move(cells));
    blocks.put("mesh/lines", std::move(lines));
    if (dim == 3)
      blocks.put("mesh/quads", std::move(quads));
    blocks.put_integer("mesh/refinements",
                       is_uniform(triangulation)
                         ? triangulation.n_global_levels() - 1
                         : 0);
    if (!is_uniform(triangulation))
      blocks.put("mesh/leaves", leaves_of(triangulation));

    std::ostringstream points;
    BlockFile::Numbers coordinates;
    for (const auto &[name, point] : mesh.names.points)
      {
        points << name << '\n';
        for (unsigned int d = 0; d < dim; ++d)
          coordinates.push_back(point[d]);
      }
    blocks.put("mesh/names of points", points.str());
    blocks.put("mesh/points", std::move(coordinates));
    blocks.put("mesh/curves", write_sets(mesh.names.curves));
    blocks.put("mesh/boundaries", write_sets(mesh.names.boundaries));
    blocks.put("mesh/regions", write_sets(mesh.names.regions));
    blocks.put("mesh/description", mesh.description);
  }



  template <int dim>
  Mesh<dim>
  load_mesh(const BlockFile &blocks, const MPI_Comm &communicator)
  {
    const auto &coordinates = blocks.numbers("mesh/vertices");
    if (coordinates.size() % dim != 0)
      blocks.refuse("mesh/vertices", "is no list of points");
    std::vector<Point<dim>> vertices(coordinates.size() / dim);
    for (std::size_t v = 0; v < vertices.size(); ++v)
      for (unsigned int d = 0; d < dim; ++d)
        vertices[v][d] = coordinates[v * dim + d];
    const auto cells =
      read_elements<dim>(blocks, "mesh/cells", vertices.size());

    // Whatever is wrong with them, p4est would end the program.
    MeshDescription<dim> description;
    description.vertices = vertices;
    for (const auto &cell : cells)
      {
        DescribedElement<dim> element;
        std::copy(cell.vertices.begin(),
                  cell.vertices.end(),
                  element.vertices.begin());
        for (const double jacobian : corner_jacobians(description, element))
          if (!(jacobian > 0.)) // or not a number
            blocks.refuse("mesh/cells", "has an inverted cell");
      }

    // Flat parts of the inside need not be listed, and may not be in 3D.
    SubCellData named;
    const auto  matters = [](const auto &element) {
      return element.boundary_id != numbers::internal_face_boundary_id ||
             element.manifold_id != numbers::flat_manifold_id;
    };
    for (const auto &line :
         read_elements<1>(blocks, "mesh/lines", vertices.size()))
      if (matters(line))
        named.boundary_lines.push_back(line);
    if (dim == 3)
      for (const auto &quad :
           read_elements<2>(blocks, "mesh/quads", vertices.size()))
        if (matters(quad))
          named.boundary_quads.push_back(quad);

    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(communicator);
    try
      {
        mesh.triangulation->create_triangulation(vertices, cells, named);
      }
    catch (const ExceptionBase &error)
      {
        std::ostringstream message;
        error.print_info(message);
        blocks.refuse("mesh/cells", "makes no mesh: " + message.str());
      }
    const std::uint64_t refinements = blocks.integer("mesh/refinements");
    // Each node of the mesh has values, and each cell a node.
    const std::string nodal = "state/displacement";
    if (refinements > 20 ||
        (blocks.has(nodal) && std::ldexp(cells.size(), dim * refinements) >
                                blocks.numbers(nodal).size()))
      blocks.refuse("mesh/refinements", "is too large");
    mesh.triangulation->refine_global(refinements);
    if (blocks.has("mesh/leaves"))
      divide(*mesh.triangulation, blocks.text("mesh/leaves"));

    std::istringstream points(blocks.text("mesh/names of points"));
    const auto        &values = blocks.numbers("mesh/points");
    std::string        name;
    std::size_t        next = 0;
    while (std::getline(points, name))
      for (unsigned int d = 0; d < dim; ++d)
        {
          if (next == values.size())
            blocks.refuse("mesh/points", "is shorter than the names");
          mesh.names.points[name][d] = values[next++];
        }
    mesh.names.curves = read_sets<types::manifold_id>(blocks, "mesh/curves");
    mesh.names.boundaries =
      read_sets<types::boundary_id>(blocks, "mesh/boundaries");
    mesh.names.regions = read_sets<types::material_id>(blocks, "mesh/regions");
    for (const auto &curve : mesh.names.curves)
      for (const auto id : curve.second)
        mesh.triangulation->set_manifold(id, FlatManifold<dim>());
    mesh.description = blocks.text("mesh/description");
    return mesh;
  }

#define INSTANTIATE(dim)                                            \
  template std::uint64_t fingerprint(const Mesh<dim> &);            \
  template bool          can_be_stored(const Mesh<dim> &);          \
  template void          save_mesh(const Mesh<dim> &, BlockFile &); \
  template Mesh<dim>     load_mesh(const BlockFile &, const MPI_Comm &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
