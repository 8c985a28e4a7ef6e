// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/boundary_curves.h>
#include <alveolus/transfer/boundary_surface.h>

#include <deal.II/base/mpi.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = numbers::invalid_unsigned_int;

    /** Area times normal of a quadrilateral by its corners, going round. */
    Tensor<1, 3>
    area_vector(const Point<3> &a,
                const Point<3> &b,
                const Point<3> &c,
                const Point<3> &d)
    {
      return 0.5 * cross_product_3d(c - a, d - b);
    }

    /** Lines that divide a face of @p n_points sub-quadrilaterals. */
    std::vector<double>
    grid_lines(const unsigned int n_points)
    {
      return segment_breaks(std::lround(std::sqrt(n_points)));
    }
  } // namespace



  std::vector<BoundaryFace>
  gather_faces(const Configuration<3> &configuration,
               const FaceHistory<3>   &history,
               const NodalVector      &x_before,
               const NodalVector      &x_after,
               unsigned int           &first_own)
  {
    const auto           &fe    = configuration.fe;
    const auto            lines = grid_lines(history.n_points);
    const unsigned int    n     = lines.size();
    std::vector<Point<2>> grid;
    for (const double t : lines)
      for (const double s : lines)
        grid.emplace_back(s, t);
    // Grid points in the coordinates of the face, however its cell sees it
    const Quadrature<2> points(grid, std::vector<double>(n * n, 1. / (n * n)));
    FEFaceValues<3>     values(fe, points, update_values);

    std::vector<BoundaryFace>            own;
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &face : history.faces())
      {
        const typename DoFHandler<3>::active_cell_iterator cell(
          configuration.mesh.triangulation.get(),
          face.cell->level(),
          face.cell->index(),
          &configuration.dof_handler);
        values.reinit(cell, face.face_no);
        cell->get_dof_indices(dofs);
        BoundaryFace result;
        result.before.resize(grid.size());
        result.after.resize(grid.size());
        for (unsigned int g = 0; g < grid.size(); ++g)
          for (unsigned int i = 0; i < dofs.size(); ++i)
            {
              const unsigned int d = fe.system_to_component_index(i).first;
              result.before[g][d] +=
                values.shape_value(i, g) * x_before(dofs[i]);
              result.after[g][d] += values.shape_value(i, g) * x_after(dofs[i]);
            }
        const std::array<unsigned int, 4> at{
          {0, n - 1, n * (n - 1), n * n - 1}};
        for (unsigned int v = 0; v < 4; ++v)
          for (unsigned int i = 0; i < dofs.size(); ++i)
            if (fe.system_to_component_index(i).first == 0 &&
                values.shape_value(i, at[v]) > 0.5)
              result.vertex[v] = dofs[i];
        for (unsigned int v = 0; v < GeometryInfo<3>::vertices_per_cell; ++v)
          for (unsigned int d = 0; d < 3; ++d)
            result.inside[d] +=
              x_before(dofs[fe.component_to_system_index(d, v)]) / 8.;
        const double *record = history.old_record(own.size(), 0);
        result.values.assign(record,
                             record + history.n_points * history.n_components);
        own.push_back(std::move(result));
      }

    std::vector<BoundaryFace> faces;
    first_own = 0;
    const auto all =
      Utilities::MPI::all_gather(configuration.communicator(), own);
    for (unsigned int r = 0; r < all.size(); ++r)
      {
        if (r == Utilities::MPI::this_mpi_process(configuration.communicator()))
          first_own = faces.size();
        faces.insert(faces.end(), all[r].begin(), all[r].end());
      }
    return faces;
  }



  BoundarySurface::BoundarySurface(std::vector<BoundaryFace> &faces,
                                   const unsigned int         n_points,
                                   const unsigned int         n_components)
    : faces(faces)
    , n_points(n_points)
    , n_components(n_components)
  {
    // Corners on edges of faces are known by the ends of the edge and the
    // number of the grid line, counted from the end with the smaller id.
    const unsigned int n = grid_lines(n_points).size();
    std::map<std::array<types::global_dof_index, 3>, unsigned int> known;
    std::map<std::pair<unsigned int, unsigned int>, unsigned int>  edge_of;
    std::vector<unsigned int>                                      grid(n * n);
    const auto number = [&](const BoundaryFace &face,
                            const unsigned int  i,
                            const unsigned int  j) {
      const unsigned int new_corner = before.size();
      const bool on_i = i == 0 || i == n - 1, on_j = j == 0 || j == n - 1;
      const auto at = [&](const unsigned int k, const unsigned int l) {
        return face.vertex[(k == 0 ? 0 : 1) + (l == 0 ? 0 : 2)];
      };
      std::array<types::global_dof_index, 3> key;
      if (on_i && on_j)
        key = {{at(i, j), at(i, j), 0}};
      else if (on_i || on_j)
        {
          auto         a = on_i ? at(i, 0) : at(0, j);
          auto         b = on_i ? at(i, n - 1) : at(n - 1, j);
          unsigned int k = on_i ? j : i;
          if (b < a)
            {
              std::swap(a, b);
              k = n - 1 - k;
            }
          key = {{a, b, k}};
        }
      const bool inside = !on_i && !on_j;
      if (!inside)
        {
          const auto found = known.emplace(key, new_corner);
          if (!found.second)
            return found.first->second;
        }
      before.push_back(face.before[i + n * j]);
      after.push_back(face.after[i + n * j]);
      return new_corner;
    };

    for (const BoundaryFace &face : faces)
      {
        for (unsigned int j = 0; j < n; ++j)
          for (unsigned int i = 0; i < n; ++i)
            grid[i + n * j] = number(face, i, j);
        for (unsigned int j = 0; j + 1 < n; ++j)
          for (unsigned int i = 0; i + 1 < n; ++i)
            {
              std::array<unsigned int, 4> round{{grid[i + n * j],
                                                 grid[i + 1 + n * j],
                                                 grid[i + 1 + n * (j + 1)],
                                                 grid[i + n * (j + 1)]}};
              if (area_vector(before[round[0]],
                              before[round[1]],
                              before[round[2]],
                              before[round[3]]) *
                    (before[round[0]] - face.inside) <
                  0.)
                std::swap(round[1], round[3]);
              const unsigned int sub = corners.size();
              corners.push_back(round);
              edges_of.emplace_back();
              for (unsigned int k = 0; k < 4; ++k)
                {
                  const unsigned int a = round[k], b = round[(k + 1) % 4];
                  const auto         found =
                    edge_of.emplace(std::minmax(a, b), edges.size());
                  edges_of.back()[k] = found.first->second;
                  if (found.second)
                    {
                      edges.push_back({{{a, b}}, {{sub, none}}});
                      continue;
                    }
                  Edge &edge = edges[found.first->second];
                  if (edge.side[1] != none || edge.corner[0] != b)
                    throw RunError("Transfer",
                                   "a surface that carries history branches",
                                   "give its branches different names");
                  edge.side[1] = sub;
                }
            }
      }
  }



  Point<3>
  BoundarySurface::place(const unsigned int corner, const double fraction) const
  {
    return before[corner] + fraction * (after[corner] - before[corner]);
  }



  Tensor<1, 3>
  BoundarySurface::area(const unsigned int sub, const double fraction) const
  {
    const auto &c = corners[sub];
    return area_vector(place(c[0], fraction),
                       place(c[1], fraction),
                       place(c[2], fraction),
                       place(c[3], fraction));
  }



  double
  BoundarySurface::integrate(const bool           at_end,
                             std::vector<double> &integral) const
  {
    double sum = 0.;
    integral.assign(n_components, 0.);
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      {
        const double  a = area(sub, at_end ? 1. : 0.).norm();
        const double *v =
          faces[sub / n_points].values.data() + sub % n_points * n_components;
        sum += a;
        for (unsigned int c = 0; c < n_components; ++c)
          integral[c] += a * v[c];
      }
    return sum;
  }



  double
  BoundarySurface::gain(const unsigned int sub, const unsigned int k) const
  {
    const unsigned int e = edges_of[sub][k];
    return edges[e].side[0] == sub ? swept[e] : -swept[e];
  }



  double
  BoundarySurface::sweep(const double from, const double to)
  {
    std::vector<Tensor<1, 3>> normals(corners.size());
    sizes.resize(corners.size());
    swept.resize(edges.size());
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      {
        normals[sub] = area(sub, from);
        sizes[sub]   = normals[sub].norm();
        normals[sub] /= sizes[sub];
      }
    for (unsigned int e = 0; e < edges.size(); ++e)
      {
        const auto &[a, b]  = edges[e].corner;
        const auto  &side   = edges[e].side;
        Tensor<1, 3> normal = normals[side[0]];
        if (side[1] != none)
          {
            normal += normals[side[1]];
            normal /= normal.norm();
          }
        // With the surface on its left, an edge that moves to the right makes
        // its first side larger.
        swept[e] = -(normal * area_vector(place(a, from),
                                          place(b, from),
                                          place(b, to),
                                          place(a, to)));
      }
    double largest = 0.;
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      {
        double given = 0.;
        for (unsigned int k = 0; k < 4; ++k)
          given += std::max(0., -gain(sub, k));
        // Not std::max, which would swallow a NaN.
        if (!(given / sizes[sub] <= largest))
          largest = given / sizes[sub];
      }
    return largest;
  }



  double
  BoundarySurface::transfer()
  {
    // Up to 1 there are no new extrema; half keeps areas far from zero.
    constexpr double largest_given = 0.5;
    // More would be a way of hundreds of cells: a mistake of the rules
    constexpr unsigned int most_parts = 1000;
    const double           given      = sweep(0., 1.);
    if (!(given / largest_given < most_parts))
      throw RunError("Transfer",
                     "a sub-quadrilateral of a boundary that carries history "
                     "would lose " +
                       std::to_string(given) + " times its area",
                     "rezone more often, or with another rule there");
    const unsigned int parts =
      std::max(1., std::ceil(given / largest_given - 1e-10));

    std::vector<double> values(corners.size() * n_components), old;
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      std::copy_n(faces[sub / n_points].values.data() +
                    sub % n_points * n_components,
                  n_components,
                  values.data() + sub * n_components);
    for (unsigned int part = 0; part < parts; ++part)
      {
        sweep(1. * part / parts, (part + 1.) / parts);
        old = values;
        for (unsigned int sub = 0; sub < corners.size(); ++sub)
          {
            double size = sizes[sub];
            for (unsigned int k = 0; k < 4; ++k)
              size += gain(sub, k);
            if (!(size > 0.))
              throw RunError("Transfer",
                             "a sub-quadrilateral of a boundary that carries "
                             "history vanishes on the way of the mesh",
                             "rezone more often, or with another rule there");
            // As a change of the own value, so that constants stay exactly
            const double *own = old.data() + sub * n_components;
            for (unsigned int k = 0; k < 4; ++k)
              {
                const auto        &side  = edges[edges_of[sub][k]].side;
                const unsigned int giver = side[side[0] == sub ? 1 : 0];
                const double       share = gain(sub, k) / size;
                if (giver != none && share > 0.)
                  for (unsigned int c = 0; c < n_components; ++c)
                    values[sub * n_components + c] +=
                      share * (old[giver * n_components + c] - own[c]);
              }
          }
      }
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      std::copy_n(values.data() + sub * n_components,
                  n_components,
                  faces[sub / n_points].values.data() +
                    sub % n_points * n_components);

    double normal_motion = 0.;
    for (unsigned int sub = 0; sub < corners.size(); ++sub)
      {
        Tensor<1, 3> normal = area(sub, 0.);
        normal /= normal.norm();
        for (const unsigned int c : corners[sub])
          normal_motion =
            std::max(normal_motion, std::abs(normal * (after[c] - before[c])));
      }
    return normal_motion;
  }
} // namespace alveolus
