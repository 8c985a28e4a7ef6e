// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/problems.h>
#include <alveolus/mesh/mesh_checks.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <sstream>

namespace alveolus
{
  namespace
  {
    constexpr unsigned int unused = std::numeric_limits<unsigned int>::max();

    /** Distances below this part of an edge count as zero. */
    constexpr double same_place = 1e-6;

    using Edge = std::array<unsigned int, 2>;

    template <int dim>
    using Face = std::array<unsigned int, (1 << (dim - 1))>;

    /** Faces of a cell, vertices in turn, seen from outside anticlockwise. */
    template <int dim>
    std::vector<Face<dim>>
    outward_faces(const DescribedElement<dim> &cell)
    {
      const auto &v = cell.vertices;
      if constexpr (dim == 2)
        return {{{v[0], v[1]}}, {{v[1], v[3]}}, {{v[3], v[2]}}, {{v[2], v[0]}}};
      else
        return {{{v[0], v[4], v[6], v[2]}},
                {{v[1], v[3], v[7], v[5]}},
                {{v[0], v[1], v[5], v[4]}},
                {{v[2], v[6], v[7], v[3]}},
                {{v[0], v[2], v[3], v[1]}},
                {{v[4], v[5], v[7], v[6]}}};
    }

    /** The same cycle, begun at the smallest vertex where it is a cycle. */
    template <std::size_t n>
    std::array<unsigned int, n>
    normalised(std::array<unsigned int, n> face)
    {
      if (n > 2)
        std::rotate(face.begin(),
                    std::min_element(face.begin(), face.end()),
                    face.end());
      return face;
    }

    template <std::size_t n>
    std::array<unsigned int, n>
    opposite(std::array<unsigned int, n> face)
    {
      std::reverse(face.begin(), face.end());
      return normalised(face);
    }

    template <std::size_t n>
    std::array<unsigned int, n>
    sorted(std::array<unsigned int, n> vertices)
    {
      std::sort(vertices.begin(), vertices.end());
      return vertices;
    }

    /** Edges of a cell in lexicographic vertex order. */
    template <int dim>
    std::vector<Edge>
    edges(const DescribedElement<dim> &cell)
    {
      std::vector<Edge> result;
      for (unsigned int v = 0; v < cell.vertices.size(); ++v)
        for (unsigned int d = 0; d < dim; ++d)
          if ((v & (1 << d)) == 0)
            result.push_back(
              sorted(Edge{{cell.vertices[v], cell.vertices[v | (1 << d)]}}));
      return result;
    }

    template <int dim>
    void
    turn_round(DescribedElement<dim> &cell)
    {
      if (dim == 2)
        std::swap(cell.vertices[1], cell.vertices[2]);
      else
        for (unsigned int v = 0; v < 4; ++v)
          std::swap(cell.vertices[v], cell.vertices[(v + 4) % (1 << dim)]);
    }

    /** The checks share what they find out about the mesh. */
    template <int dim>
    class Checks
    {
    public:
      explicit Checks(MeshDescription<dim> &mesh)
        : mesh(mesh)
      {}

      MeshRepairs      repairs;
      mutable Problems problems;

      void
      drop_unused_vertices()
      {
        const auto                old_numbers = mesh.vertex_numbers;
        std::vector<unsigned int> new_index(mesh.vertices.size(), unused);
        for (const auto &cell : mesh.cells)
          for (const unsigned int v : cell.vertices)
            new_index[v] = 0;
        unsigned int n = 0;
        for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
          if (new_index[v] != unused)
            {
              new_index[v]           = n;
              mesh.vertices[n]       = mesh.vertices[v];
              mesh.vertex_numbers[n] = mesh.vertex_numbers[v];
              ++n;
            }
        repairs.n_unused_vertices = mesh.vertices.size() - n;

        for (const auto &point : mesh.points)
          if (new_index[point.second] == unused)
            problems.add(mesh.source,
                         "the named point '" + point.first + "' (node " +
                           std::to_string(old_numbers[point.second]) +
                           ") is no corner of any cell",
                         "embed the point in the geometry, or remove it");
        for (auto &point : mesh.points)
          point.second = new_index[point.second];
        renumber(mesh.cells, new_index, "cell");
        renumber(mesh.lines, new_index, "line");
        renumber(mesh.quads, new_index, "quad");
        mesh.vertices.resize(n);
        mesh.vertex_numbers.resize(n);
      }

      void
      orient_cells()
      {
        for (auto &cell : mesh.cells)
          {
            auto               corners = corner_jacobians(mesh, cell);
            const unsigned int n_negative =
              std::count_if(corners.begin(), corners.end(), [](const double j) {
                return j < 0;
              });
            if (2 * n_negative > corners.size())
              {
                turn_round(cell);
                ++repairs.n_turned_cells;
                corners = corner_jacobians(mesh, cell);
              }
            const auto worst = std::min_element(corners.begin(), corners.end());
            // Written so that a NaN of coincident corners is refused too.
            if (!(*worst > 1e-10))
              problems.add(
                mesh.place(cell.line),
                "element " + std::to_string(cell.number) +
                  " is inverted or flat at node " +
                  number(cell.vertices[worst - corners.begin()]) + " " +
                  coordinates(cell.vertices[worst - corners.begin()]),
                "every corner of a cell must be convex: mesh again");
          }
      }

      void
      find_faces()
      {
        std::map<Face<dim>, std::size_t> owner;
        for (std::size_t c = 0; c < mesh.cells.size(); ++c)
          for (const Face<dim> &face : outward_faces(mesh.cells[c]))
            {
              const auto added = owner.emplace(normalised(face), c);
              if (!added.second)
                problems.add(
                  mesh.place(mesh.cells[c].line),
                  "elements " +
                    std::to_string(mesh.cells[added.first->second].number) +
                    " and " + std::to_string(mesh.cells[c].number) +
                    " overlap: they lie on the same side of the face with "
                    "nodes " +
                    number(face[0]) + " and " + number(face[1]),
                  "remove one of them or mesh again");
            }
        for (const auto &entry : owner)
          {
            all_faces.insert(sorted(entry.first));
            if (owner.count(opposite(entry.first)) == 0)
              boundary_faces.push_back(entry.first);
          }
      }

      void
      find_parts()
      {
        part.resize(mesh.vertices.size());
        std::iota(part.begin(), part.end(), 0);
        for (const auto &cell : mesh.cells)
          for (const unsigned int v : cell.vertices)
            part[root(v)] = root(cell.vertices[0]);
        for (unsigned int v = 0; v < part.size(); ++v)
          {
            part[v] = root(v);
            repairs.n_parts += part[v] == v;
          }
      }

      void
      check_named_elements() const
      {
        std::set<Edge> all_edges;
        for (const auto &cell : mesh.cells)
          for (const Edge &edge : edges(cell))
            all_edges.insert(edge);
        for (const auto &line : mesh.lines)
          if (all_edges.count(sorted(line.vertices)) == 0)
            problems.add(mesh.place(line.line),
                         "the line from node " + number(line.vertices[0]) +
                           " to node " + number(line.vertices[1]) +
                           " is no edge of any cell",
                         "embed the curve in the surface it lies in, or "
                         "mesh lines and cells together");
        if constexpr (dim == 3)
          for (const auto &quad : mesh.quads)
            if (all_faces.count(sorted(quad.vertices)) == 0)
              problems.add(mesh.place(quad.line),
                           "quad " + std::to_string(quad.number) +
                             " is no face of any hexahedron",
                           "mesh surfaces and volumes together");
      }

      void
      check_places(const bool allow_touching_parts) const
      {
        // Sorted by x, only neighbours in this order have to be compared.
        std::vector<unsigned int> order(mesh.vertices.size());
        std::iota(order.begin(), order.end(), 0);
        const auto before = [this](const unsigned int a, const unsigned int b) {
          return mesh.vertices[a][0] < mesh.vertices[b][0];
        };
        std::stable_sort(order.begin(), order.end(), before);
        check_coincident(order, allow_touching_parts);

        std::vector<bool> at_boundary(mesh.vertices.size(), false);
        for (const auto &face : boundary_faces)
          for (const unsigned int v : face)
            at_boundary[v] = true;
        order.erase(std::remove_if(order.begin(),
                                   order.end(),
                                   [&](const unsigned int v) {
                                     return !at_boundary[v];
                                   }),
                    order.end());
        check_hanging(order, allow_touching_parts);
      }

    private:
      MeshDescription<dim>     &mesh;
      std::set<Face<dim>>       all_faces;
      std::vector<Face<dim>>    boundary_faces;
      std::vector<unsigned int> part;

      std::string
      number(const unsigned int vertex) const
      {
        return std::to_string(mesh.vertex_numbers[vertex]);
      }

      std::string
      coordinates(const unsigned int vertex) const
      {
        std::ostringstream text;
        for (unsigned int d = 0; d < dim; ++d)
          text << (d == 0 ? "(" : ", ") << mesh.vertices[vertex][d];
        return text.str() + ")";
      }

      template <int structdim>
      void
      renumber(std::vector<DescribedElement<structdim>> &elements,
               const std::vector<unsigned int>          &new_index,
               const std::string                        &kind) const
      {
        for (auto &element : elements)
          for (unsigned int &v : element.vertices)
            {
              if (new_index[v] == unused)
                {
                  problems.add(mesh.place(element.line),
                               "the named " + kind + " " +
                                 std::to_string(element.number) +
                                 " has a node that belongs to no cell",
                               "embed the curve or surface in the cells, or "
                               "take it out of its Physical group");
                  break;
                }
              v = new_index[v];
            }
      }

      unsigned int
      root(unsigned int v)
      {
        while (part[v] != v)
          v = part[v] = part[part[v]];
        return v;
      }

      void
      check_coincident(const std::vector<unsigned int> &order,
                       const bool allow_touching_parts) const
      {
        double shortest = std::numeric_limits<double>::max();
        for (const auto &cell : mesh.cells)
          for (const Edge &edge : edges(cell))
            shortest =
              std::min(shortest,
                       mesh.vertices[edge[0]].distance(mesh.vertices[edge[1]]));
        for (std::size_t i = 0; i < order.size(); ++i)
          for (std::size_t j = i + 1;
               j < order.size() && !problems.full() &&
               mesh.vertices[order[j]][0] - mesh.vertices[order[i]][0] <=
                 same_place * shortest;
               ++j)
            if (mesh.vertices[order[i]].distance(mesh.vertices[order[j]]) <=
                  same_place * shortest &&
                !(allow_touching_parts && part[order[i]] != part[order[j]]))
              problems.add(mesh.source,
                           "nodes " + number(order[i]) + " and " +
                             number(order[j]) + " lie at the same place " +
                             coordinates(order[i]),
                           "make the geometry conforming (gmsh: Coherence; "
                           "or Coherence Mesh;)");
      }

      void
      check_hanging(const std::vector<unsigned int> &order,
                    const bool                       allow_touching_parts) const
      {
        std::set<Edge> boundary_edges;
        for (const auto &face : boundary_faces)
          for (std::size_t v = 0; v < face.size(); ++v)
            boundary_edges.insert(
              sorted(Edge{{face[v], face[(v + 1) % face.size()]}}));
        for (const Edge &edge : boundary_edges)
          {
            const dealii::Point<dim>    &a      = mesh.vertices[edge[0]];
            const dealii::Tensor<1, dim> ab     = mesh.vertices[edge[1]] - a;
            const double                 length = ab.norm();
            const double begin = std::min(a[0], a[0] + ab[0]) - length * 1e-3;
            const double end   = std::max(a[0], a[0] + ab[0]) + length * 1e-3;
            auto         v     = std::lower_bound(order.begin(),
                                      order.end(),
                                      begin,
                                      [this](const unsigned int vertex,
                                             const double       x) {
                                        return mesh.vertices[vertex][0] < x;
                                      });
            for (; v != order.end() && mesh.vertices[*v][0] <= end &&
                   !problems.full();
                 ++v)
              {
                const dealii::Tensor<1, dim> av = mesh.vertices[*v] - a;
                const double                 s  = (av * ab) / (length * length);
                if (*v != edge[0] && *v != edge[1] && s > same_place &&
                    s < 1. - same_place &&
                    (av - s * ab).norm() <= same_place * length &&
                    !(allow_touching_parts && part[*v] != part[edge[0]]))
                  problems.add(mesh.source,
                               "node " + number(*v) + " " + coordinates(*v) +
                                 " hangs on the edge between nodes " +
                                 number(edge[0]) + " and " + number(edge[1]),
                               "neighbouring cells must share whole "
                               "edges: make the geometry conforming");
              }
          }
      }
    };
  } // namespace



  template <int dim>
  std::array<double, (1 << dim)>
  corner_jacobians(const MeshDescription<dim>  &mesh,
                   const DescribedElement<dim> &cell)
  {
    std::array<double, (1 << dim)> result;
    for (unsigned int v = 0; v < result.size(); ++v)
      {
        dealii::Tensor<2, dim> matrix;
        double                 lengths = 1.;
        for (unsigned int d = 0; d < dim; ++d)
          {
            const double sign = (v & (1 << d)) == 0 ? 1. : -1.;
            matrix[d] = sign * (mesh.vertices[cell.vertices[v ^ (1 << d)]] -
                                mesh.vertices[cell.vertices[v]]);
            lengths *= matrix[d].norm();
          }
        result[v] = dealii::determinant(matrix) / lengths;
      }
    return result;
  }



  template <int dim>
  MeshRepairs
  check_description(MeshDescription<dim> &mesh, const bool allow_touching_parts)
  {
    Checks<dim> checks(mesh);
    // Each builds on the ones before it, and finds all that is wrong.
    const auto check = [&](const auto &action) {
      action();
      checks.problems.throw_if_any();
    };
    check([&]() { checks.drop_unused_vertices(); });
    check([&]() { checks.orient_cells(); });
    check([&]() { checks.find_faces(); });
    checks.find_parts();
    checks.check_named_elements();
    checks.check_places(allow_touching_parts);
    checks.problems.throw_if_any();
    return checks.repairs;
  }



  template std::array<double, 4>
  corner_jacobians<2>(const MeshDescription<2> &, const DescribedElement<2> &);
  template std::array<double, 8>
  corner_jacobians<3>(const MeshDescription<3> &, const DescribedElement<3> &);
  template MeshRepairs
  check_description<2>(MeshDescription<2> &, const bool);
  template MeshRepairs
  check_description<3>(MeshDescription<3> &, const bool);
} // namespace alveolus
