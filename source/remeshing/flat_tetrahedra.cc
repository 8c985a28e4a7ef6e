// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remeshing/flat_tetrahedra.h>

#include <deal.II/base/tensor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Triple      = std::array<unsigned int, 3>;
    using Tetrahedron = std::array<unsigned int, 4>;
    using Edge        = std::pair<unsigned int, unsigned int>;

    // Faces of a tetrahedron, seen from inside counterclockwise, so that each
    // with a vertex inside makes a tetrahedron of positive orientation
    constexpr unsigned int faces[4][3] = {{0, 1, 2},
                                          {0, 3, 1},
                                          {0, 2, 3},
                                          {1, 3, 2}};

    Triple
    sorted(Triple triple)
    {
      std::sort(triple.begin(), triple.end());
      return triple;
    }

    class Division
    {
    public:
      Division(Tetrahedra                      &mesh,
               const std::vector<Triple>       &triangles,
               const std::vector<unsigned int> &patches)
        : mesh(mesh)
      {
        std::map<Edge, std::vector<unsigned int>> of_edge;
        for (unsigned int t = 0; t < triangles.size(); ++t)
          for (unsigned int i = 0; i < 3; ++i)
            of_edge[std::minmax(triangles[t][i], triangles[t][(i + 1) % 3])]
              .push_back(patches[t]);
        for (const auto &entry : of_edge)
          if (entry.second.size() == 2 && entry.second[0] == entry.second[1])
            at_edge[entry.first] = {};
        for (const Tetrahedron &cell : mesh.cells)
          cells.push_back(cell);
        alive.assign(cells.size(), true);
        for (unsigned int c = 0; c < cells.size(); ++c)
          enter(c);
      }

      FlatTetrahedra
      run()
      {
        FlatTetrahedra report;
        for (const auto &entry : at_edge)
          if (entry.second.size() == 1)
            {
              if (divide(entry.first, *entry.second.begin()))
                ++report.n_divided;
              else
                ++report.n_left;
            }
        mesh.cells.clear();
        for (unsigned int c = 0; c < cells.size(); ++c)
          if (alive[c])
            mesh.cells.push_back(cells[c]);
        return report;
      }

    private:
      Tetrahedra              &mesh;
      std::vector<Tetrahedron> cells;
      std::vector<bool>        alive;
      /** Tetrahedra at edges inside of patches, and at faces. */
      std::map<Edge, std::set<unsigned int>>   at_edge;
      std::map<Triple, std::set<unsigned int>> at_face;

      static Triple
      face(const Tetrahedron &cell, const unsigned int f)
      {
        return {{cell[faces[f][0]], cell[faces[f][1]], cell[faces[f][2]]}};
      }

      void
      enter(const unsigned int c)
      {
        for (unsigned int f = 0; f < 4; ++f)
          at_face[sorted(face(cells[c], f))].insert(c);
        for (unsigned int i = 0; i < 4; ++i)
          for (unsigned int j = i + 1; j < 4; ++j)
            {
              const auto edge =
                at_edge.find(std::minmax(cells[c][i], cells[c][j]));
              if (edge != at_edge.end())
                edge->second.insert(c);
            }
      }

      void
      leave(const unsigned int c)
      {
        alive[c] = false;
        for (unsigned int f = 0; f < 4; ++f)
          at_face.at(sorted(face(cells[c], f))).erase(c);
        for (unsigned int i = 0; i < 4; ++i)
          for (unsigned int j = i + 1; j < 4; ++j)
            {
              const auto edge =
                at_edge.find(std::minmax(cells[c][i], cells[c][j]));
              if (edge != at_edge.end())
                edge->second.erase(c);
            }
      }

      /** Six times the volume over the cube of the mean length of edges. */
      double
      quality(const Triple &base, const Point<3> &top) const
      {
        const Point<3> &a = mesh.vertices[base[0]], &b = mesh.vertices[base[1]],
                       &c    = mesh.vertices[base[2]];
        const double squares = a.distance_square(b) + b.distance_square(c) +
                               c.distance_square(a) + a.distance_square(top) +
                               b.distance_square(top) + c.distance_square(top);
        return cross_product_3d(b - a, c - a) * (top - a) /
               std::pow(squares / 6., 1.5);
      }

      bool
      divide(const Edge &ridge, const unsigned int flat)
      {
        // All tetrahedra around the opposite edge
        std::vector<unsigned int> below;
        for (const unsigned int v : cells[flat])
          if (v != ridge.first && v != ridge.second)
            below.push_back(v);
        std::set<unsigned int>    cavity{flat};
        std::vector<unsigned int> front{flat};
        while (!front.empty())
          {
            const unsigned int at = front.back();
            front.pop_back();
            for (unsigned int f = 0; f < 4; ++f)
              {
                const Triple triple = sorted(face(cells[at], f));
                if (std::count(triple.begin(), triple.end(), below[0]) != 0 &&
                    std::count(triple.begin(), triple.end(), below[1]) != 0)
                  for (const unsigned int c : at_face.at(triple))
                    if (cavity.insert(c).second)
                      front.push_back(c);
              }
          }
        std::vector<Triple>    outer;
        std::set<unsigned int> corners;
        for (const unsigned int c : cavity)
          {
            corners.insert(cells[c].begin(), cells[c].end());
            for (unsigned int f = 0; f < 4; ++f)
              {
                unsigned int n = 0;
                for (const unsigned int other :
                     at_face.at(sorted(face(cells[c], f))))
                  n += cavity.count(other);
                if (n == 1)
                  outer.push_back(face(cells[c], f));
              }
          }
        // From the middle of that edge, where it would cut all of them in two,
        // towards the middle of the cavity and beyond
        Tensor<1, 3> start, middle;
        for (const unsigned int v : below)
          start += 0.5 * mesh.vertices[v];
        for (const unsigned int v : corners)
          middle += mesh.vertices[v] / double(corners.size());
        double   best = 0.02; // of a tetrahedron with equal edges: 0.7
        Point<3> place;
        for (unsigned int k = 1; k <= 8; ++k)
          {
            const Point<3> x(start + 0.25 * k * (middle - start));
            double         worst = std::numeric_limits<double>::max();
            for (const Triple &triple : outer)
              worst = std::min(worst, quality(triple, x));
            if (worst > best + 1e-9)
              {
                best  = worst;
                place = x;
              }
          }
        if (best <= 0.02)
          return false;
        for (const unsigned int c : cavity)
          leave(c);
        const unsigned int top = mesh.vertices.size();
        mesh.vertices.push_back(place);
        for (const Triple &triple : outer)
          {
            cells.push_back({{triple[0], triple[1], triple[2], top}});
            alive.push_back(true);
            enter(cells.size() - 1);
          }
        return true;
      }
    };
  } // namespace



  FlatTetrahedra
  divide_flat_tetrahedra(Tetrahedra                      &mesh,
                         const std::vector<Triple>       &triangles,
                         const std::vector<unsigned int> &patches)
  {
    return Division(mesh, triangles, patches).run();
  }
} // namespace alveolus
