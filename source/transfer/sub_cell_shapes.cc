// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/sub_cell_shapes.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/utilities.h>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Twice the area of a triangle. */
    double
    twice_area(const Point<2> &a, const Point<2> &b, const Point<2> &c)
    {
      const Tensor<1, 2> u = b - a, v = c - a;
      return u[0] * v[1] - u[1] * v[0];
    }

    /**
     * Add the body with the corners @p x in lexicographic order; returns
     * whether it is folded.
     */
    bool
    add_box(const std::array<Point<2>, 4> &x,
            std::vector<ConvexPiece<2>>   &result)
    {
      const std::array<Point<2>, 4> p{{x[0], x[1], x[3], x[2]}};
      bool                          convex = true;
      for (unsigned int i = 0; i < 4; ++i)
        convex =
          convex && twice_area(p[(i + 3) % 4], p[i], p[(i + 1) % 4]) >= 0.;
      // A positive sum of angles can also be a quadrilateral wound twice; the
      // area of both halves excludes that.
      const double half[2][2] = {
        {twice_area(p[0], p[1], p[2]), twice_area(p[0], p[2], p[3])},
        {twice_area(p[1], p[2], p[3]), twice_area(p[1], p[3], p[0])}};
      if (convex && half[0][0] + half[0][1] > 0.)
        {
          result.push_back({p, 4});
          return false;
        }
      // Two triangles, by the diagonal whose smaller triangle is larger.
      const unsigned int d =
        std::min(half[1][0], half[1][1]) > std::min(half[0][0], half[0][1]) ? 1
                                                                            : 0;
      if (half[d][0] > 0.)
        result.push_back({{{p[d], p[d + 1], p[d + 2], Point<2>()}}, 3});
      if (half[d][1] > 0.)
        result.push_back({{{p[d], p[d + 2], p[(d + 3) % 4], Point<2>()}}, 3});
      return !(half[d][0] >= 0. && half[d][1] >= 0.);
    }

    bool
    add_box(const std::array<Point<3>, 8> &x,
            std::vector<ConvexPiece<3>>   &result)
    {
      Point<3> centre;
      for (const auto &corner : x)
        centre += 0.125 * corner;
      bool folded = false;
      for (unsigned int f = 0; f < 6; ++f)
        {
          // Around the face, seen from outside counterclockwise.
          static constexpr unsigned int around[6][4] = {{0, 4, 6, 2},
                                                        {1, 3, 7, 5},
                                                        {0, 1, 5, 4},
                                                        {2, 6, 7, 3},
                                                        {0, 2, 3, 1},
                                                        {4, 5, 7, 6}};
          // Opposite corners first, so that both neighbours get the same bits.
          const Point<3> face(
            0.25 * ((Tensor<1, 3>(x[around[f][0]]) + x[around[f][2]]) +
                    (Tensor<1, 3>(x[around[f][1]]) + x[around[f][3]])));
          for (unsigned int i = 0; i < 4; ++i)
            {
              const Point<3> &a = x[around[f][i]];
              const Point<3> &b = x[around[f][(i + 1) % 4]];
              const double    volume =
                (a - centre) * cross_product_3d(b - centre, face - centre);
              if (volume > 0.)
                result.push_back({{{centre, a, b, face}}, 4});
              folded = folded || volume < 0.;
            }
        }
      return folded;
    }
  } // namespace

  template <int dim>
  SubCellShapes<dim>::SubCellShapes(const CellNodes<dim>      &nodes,
                                    const std::vector<double> &breaks)
    : n_nodes(nodes.n_nodes)
    , n_1d(breaks.size() - 1)
    , n_parts(nodes.degree == 1 ? 1 : (dim == 2 ? 4 : 2))
  {
    std::vector<double> lattice;
    for (unsigned int i = 0; i < n_1d; ++i)
      for (unsigned int k = 0; k < n_parts; ++k)
        lattice.push_back(breaks[i] +
                          (breaks[i + 1] - breaks[i]) * k / n_parts);
    lattice.push_back(breaks.back());

    typename CellNodes<dim>::NodeNumbers values;
    const unsigned int                   n = lattice.size();
    for (unsigned int i = 0; i < Utilities::pow(n, dim); ++i)
      {
        Point<dim> xi;
        for (unsigned int d = 0, rest = i; d < dim; ++d, rest /= n)
          xi[d] = lattice[rest % n];
        nodes.shape_values(xi, values);
        shape.insert(shape.end(), values.begin(), values.begin() + n_nodes);
      }
  }

  template <int dim>
  unsigned int
  SubCellShapes<dim>::pieces(
    const typename CellNodes<dim>::NodeTensors &positions,
    std::vector<ConvexPiece<dim>>              &result,
    std::vector<unsigned int>                  &sub_cell) const
  {
    result.clear();
    sub_cell.clear();
    const unsigned int      n = n_1d * n_parts + 1;
    std::vector<Point<dim>> x(Utilities::pow(n, dim));
    for (unsigned int i = 0; i < x.size(); ++i)
      for (unsigned int k = 0; k < n_nodes; ++k)
        x[i] += shape[i * n_nodes + k] * positions[k];

    // An edge of a sub-cell of degree 2 is a parabola, which the polyline of m
    // chords cuts off by 1/m^2 of the area over its own chord.
    if (dim == 2 && n_parts > 1)
      {
        const double factor = n_parts * n_parts / (n_parts * n_parts - 1.);
        for (unsigned int direction = 0; direction < 2; ++direction)
          {
            const unsigned int along  = direction == 0 ? 1 : n;
            const unsigned int across = direction == 0 ? n : 1;
            for (unsigned int line = 0; line < n; line += n_parts)
              for (unsigned int k = 0; k + 1 < n; k += n_parts)
                {
                  Point<dim>          *begin = &x[line * across + k * along];
                  const Tensor<1, dim> chord =
                    (begin[n_parts * along] - begin[0]) / n_parts;
                  for (unsigned int i = 1; i < n_parts; ++i)
                    {
                      const Point<dim> on_chord = begin[0] + i * chord;
                      begin[i * along] =
                        on_chord + factor * (begin[i * along] - on_chord);
                    }
                }
          }
      }

    unsigned int n_folded = 0;
    for (unsigned int box = 0; box < Utilities::pow(n - 1, dim); ++box)
      {
        unsigned int first = 0, point = 0, rest = box;
        for (unsigned int d = 0, stride = 1, points = 1; d < dim;
             ++d, stride *= n, points *= n_1d, rest /= n - 1)
          {
            first += (rest % (n - 1)) * stride;
            point += (rest % (n - 1)) / n_parts * points;
          }
        std::array<Point<dim>, GeometryInfo<dim>::vertices_per_cell> corners;
        for (unsigned int v = 0; v < corners.size(); ++v)
          corners[v] =
            x[first + (v & 1) + ((v >> 1) & 1) * n + ((v >> 2) & 1) * n * n];
        n_folded += add_box(corners, result) ? 1 : 0;
        sub_cell.resize(result.size(), point);
      }
    return n_folded;
  }

  template class SubCellShapes<2>;
  template class SubCellShapes<3>;
} // namespace alveolus
