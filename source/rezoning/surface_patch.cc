// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/rezoning/surface_patch.h>

#include <deal.II/base/mpi.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/full_matrix.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  SurfacePatch::SurfacePatch(const Nodes<3>         &mesh_nodes,
                             const NodalVector      &positions,
                             const std::set<NodeId> &taken,
                             const std::string      &name,
                             const std::string      &where)
  {
    find_nodes(mesh_nodes, name, where);
    initial = mesh_nodes.gather(positions, nodes);

    ring.resize(nodes.size());
    corners.resize(nodes.size());
    for (unsigned int k = 0; k < quads.size(); ++k)
      for (unsigned int v = 0; v < 4; ++v)
        corners[quads[k][v]].emplace_back(k, v);
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> edges;
    for (const auto &quad : quads)
      {
        for (const unsigned int a : quad)
          for (const unsigned int b : quad)
            if (a != b)
              ring[a].push_back(b);
        for (const auto &edge : {std::make_pair(quad[0], quad[1]),
                                 std::make_pair(quad[2], quad[3]),
                                 std::make_pair(quad[0], quad[2]),
                                 std::make_pair(quad[1], quad[3])})
          ++edges[std::minmax(edge.first, edge.second)];
      }
    for (auto &around : ring)
      {
        std::sort(around.begin(), around.end());
        around.erase(std::unique(around.begin(), around.end()), around.end());
      }
    is_free.assign(nodes.size(), true);
    for (const auto &edge : edges)
      if (edge.second == 1)
        is_free[edge.first.first] = is_free[edge.first.second] = false;
    for (unsigned int i = 0; i < nodes.size(); ++i)
      if (taken.count(nodes[i]) > 0)
        is_free[i] = false;
  }



  void
  SurfacePatch::find_nodes(const Nodes<3>    &mesh_nodes,
                           const std::string &name,
                           const std::string &where)
  {
    const auto                  &configuration = mesh_nodes.configuration;
    const auto                  &sets          = configuration.mesh.names;
    const std::size_t            bar           = name.find('|');
    std::set<types::material_id> one, other;
    std::set<types::boundary_id> boundary;
    if (bar == std::string::npos)
      boundary = sets.boundary(name, where);
    else
      {
        one   = sets.region(Utilities::trim(name.substr(0, bar)), where);
        other = sets.region(Utilities::trim(name.substr(bar + 1)), where);
      }

    // Four nodes of each quadrilateral, one after the other
    const unsigned int  degree = configuration.degree;
    const auto         &fe     = configuration.fe.base_element(0);
    std::vector<NodeId> mine, of_cell, all;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        for (const unsigned int f : cell->face_indices())
          {
            if (cell->at_boundary(f)
                  ? boundary.count(cell->face(f)->boundary_id()) == 0
                  : one.count(cell->material_id()) == 0 ||
                      other.count(cell->neighbor(f)->material_id()) == 0)
              continue;
            mesh_nodes.cell_nodes(cell, of_cell);
            std::vector<NodeId> lattice((degree + 1) * (degree + 1));
            for (unsigned int k = 0; k < of_cell.size(); ++k)
              if (fe.has_support_on_face(k, f))
                {
                  const Point<3>    &unit  = fe.get_unit_support_points()[k];
                  const unsigned int axis  = f / 2;
                  const auto         place = [&](const unsigned int d) {
                    return static_cast<unsigned int>(
                      std::lround(degree * unit[d]));
                  };
                  lattice[place(axis == 0 ? 1 : 0) +
                          (degree + 1) * place(axis == 2 ? 1 : 2)] = of_cell[k];
                }
            for (unsigned int j = 0; j < degree; ++j)
              for (unsigned int i = 0; i < degree; ++i)
                for (unsigned int v = 0; v < 4; ++v)
                  mine.push_back(
                    lattice[i + (v & 1) + (degree + 1) * (j + (v >> 1))]);
          }
    for (const auto &part :
         Utilities::MPI::all_gather(configuration.communicator(), mine))
      all.insert(all.end(), part.begin(), part.end());
    if (all.empty())
      throw InputError(where,
                       "the surface '" + name + "' has no faces",
                       "name a boundary, or two regions that touch, as a|b");

    nodes = all;
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    quads.resize(all.size() / 4);
    for (std::size_t k = 0; k < all.size(); ++k)
      quads[k / 4][k % 4] =
        std::lower_bound(nodes.begin(), nodes.end(), all[k]) - nodes.begin();
  }



  void
  SurfacePatch::factorise()
  {
    const unsigned int                          n = nodes.size();
    std::vector<std::map<unsigned int, double>> weights(n);
    for (const auto &quad : quads)
      for (unsigned int v = 0; v < 4; ++v)
        {
          // Row of P of the stiffness of the triangle P A B, by its metric
          const unsigned int P = quad[v], A = quad[v ^ 1], B = quad[v ^ 2];
          const Tensor<1, 3> a = initial[A] - initial[P];
          const Tensor<1, 3> b = initial[B] - initial[P];
          const double       area =
            std::sqrt((a * a) * (b * b) - (a * b) * (a * b)); // doubled
          weights[P][A] += (b * b - a * b) / area;
          weights[P][B] += (a * a - a * b) / area;
        }
    DynamicSparsityPattern entries(n, n);
    for (unsigned int i = 0; i < n; ++i)
      {
        entries.add(i, i);
        if (is_free[i])
          for (const auto &w : weights[i])
            entries.add(i, w.first);
      }
    matrix = std::make_unique<CsrMatrix>();
    matrix->reinit(entries);
    for (unsigned int i = 0; i < n; ++i)
      {
        double sum = 0.;
        for (const auto &w : weights[i])
          sum += w.second;
        matrix->values[matrix->position(i, i)] = 1.;
        if (is_free[i])
          for (const auto &w : weights[i])
            matrix->values[matrix->position(i, w.first)] = -w.second / sum;
      }
    factors = std::make_unique<Umfpack>();
    factors->factorize(*matrix);
  }



  void
  SurfacePatch::harmonic(const std::vector<Place> &held,
                         const unsigned int        c,
                         std::vector<Place>       &x) const
  {
    Vector<double> given(nodes.size()), displacement(nodes.size());
    for (unsigned int i = 0; i < nodes.size(); ++i)
      given[i] = is_free[i] ? 0. : held[i][c] - initial[i][c];
    factors->solve(displacement, given);
    for (unsigned int i = 0; i < nodes.size(); ++i)
      x[i][c] = is_free[i] ? initial[i][c] + displacement[i] : held[i][c];
  }



  SurfacePatch::Frame
  SurfacePatch::fit(const std::vector<Place> &x, const unsigned int i) const
  {
    Frame frame{x[i], {}, {}, {}};
    for (const auto &[k, v] : corners[i])
      {
        const Tensor<1, 3> more = cross_product_3d(x[quads[k][v ^ 1]] - x[i],
                                                   x[quads[k][v ^ 2]] - x[i]);
        frame.normal += frame.normal * more < 0. ? -more : more;
      }
    frame.normal /= frame.normal.norm();
    unsigned int least = 0;
    for (unsigned int c = 1; c < 3; ++c)
      if (std::abs(frame.normal[c]) < std::abs(frame.normal[least]))
        least = c;
    frame.tangents[0] =
      cross_product_3d(frame.normal, Point<3>::unit_vector(least));
    frame.tangents[0] /= frame.tangents[0].norm();
    frame.tangents[1] = cross_product_3d(frame.normal, frame.tangents[0]);

    std::set<unsigned int> around(ring[i].begin(), ring[i].end());
    for (const unsigned int j : ring[i])
      around.insert(ring[j].begin(), ring[j].end());
    around.erase(i);
    double size = 0.;
    for (const unsigned int j : ring[i])
      size = std::max(size, x[j].distance(x[i]));

    // Weighted least squares, in units of the size of the cells
    FullMatrix<double> normal_matrix(5, 5);
    Vector<double>     right(5), solution(5);
    for (const unsigned int j : around)
      {
        const Tensor<1, 3>          way    = (x[j] - x[i]) / size;
        const double                t1     = way * frame.tangents[0];
        const double                t2     = way * frame.tangents[1];
        const double                height = way * frame.normal;
        const double                weight = 1. / way.norm_square();
        const std::array<double, 5> row{
          {t1, t2, 0.5 * t1 * t1, t1 * t2, 0.5 * t2 * t2}};
        for (unsigned int a = 0; a < 5; ++a)
          {
            right[a] += weight * row[a] * height;
            for (unsigned int b = 0; b < 5; ++b)
              normal_matrix(a, b) += weight * row[a] * row[b];
          }
      }
    normal_matrix.gauss_jordan();
    normal_matrix.vmult(solution, right);
    for (unsigned int a = 0; a < 5; ++a)
      frame.h[a] = a < 2 ? solution[a] : solution[a] / size;
    return frame;
  }



  void
  SurfacePatch::project(const std::vector<Place> &surface,
                        const unsigned int        begin,
                        const unsigned int        end,
                        std::vector<Place>       &x) const
  {
    std::map<unsigned int, Frame> frames;
    for (unsigned int i = begin; i < end; ++i)
      if (is_free[i])
        {
          unsigned int nearest = i;
          for (bool moved = true; moved;)
            {
              moved = false;
              for (const unsigned int j : ring[nearest])
                if (surface[j].distance(x[i]) < surface[nearest].distance(x[i]))
                  {
                    nearest = j;
                    moved   = true;
                    break;
                  }
            }
          auto frame = frames.find(nearest);
          if (frame == frames.end())
            frame = frames.emplace(nearest, fit(surface, nearest)).first;
          const Frame       &f   = frame->second;
          const Tensor<1, 3> way = x[i] - f.origin;
          const double       t1 = way * f.tangents[0], t2 = way * f.tangents[1];
          const double       height = f.h[0] * t1 + f.h[1] * t2 +
                                0.5 * f.h[2] * t1 * t1 + f.h[3] * t1 * t2 +
                                0.5 * f.h[4] * t2 * t2;
          x[i] = f.origin + t1 * f.tangents[0] + t2 * f.tangents[1] +
                 height * f.normal;
        }
  }
} // namespace alveolus
