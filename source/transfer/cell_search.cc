// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/cell_search.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** In unit coordinates: this far outside a cell is still inside. */
    constexpr double inside_tolerance = 1e-8;

    /** In unit coordinates: this near to a node is at the node. */
    constexpr double node_tolerance = 1e-10;

    constexpr unsigned int n_near = 24;

    /**
     * Unit coordinates of the point of a cell nearest to @p x, from the start
     * value @p xi, by Gauss-Newton steps along the faces it has come to.
     */
    template <int dim>
    void
    move_to_nearest(const CellNodes<dim>                       &nodes,
                    const typename CellNodes<dim>::NodeTensors &positions,
                    const Point<dim>                           &x,
                    Point<dim>                                 &xi)
    {
      typename CellNodes<dim>::NodeNumbers values;
      typename CellNodes<dim>::NodeTensors gradients;
      const auto                           clamp = [&] {
        for (unsigned int d = 0; d < dim; ++d)
          xi[d] = std::min(1., std::max(0., xi[d]));
      };
      clamp();
      for (unsigned int iteration = 0; iteration < 20; ++iteration)
        {
          nodes.shape_gradients(xi, values, gradients);
          Tensor<1, dim> residual = x;
          Tensor<2, dim> jacobian;
          for (unsigned int i = 0; i < nodes.n_nodes; ++i)
            {
              residual -= values[i] * positions[i];
              jacobian += outer_product(positions[i], gradients[i]);
            }
          Tensor<1, dim> descent = transpose(jacobian) * residual;
          Tensor<2, dim> matrix  = transpose(jacobian) * jacobian;
          for (unsigned int d = 0; d < dim; ++d)
            if ((xi[d] == 0. && descent[d] < 0.) ||
                (xi[d] == 1. && descent[d] > 0.))
              {
                descent[d] = 0.;
                for (unsigned int e = 0; e < dim; ++e)
                  matrix[d][e] = matrix[e][d] = 0.;
                matrix[d][d] = 1.;
              }
          if (!(determinant(matrix) > 0.))
            return;
          const Point<dim> before = xi;
          xi += invert(matrix) * descent;
          clamp();
          if (xi.distance(before) < 1e-12)
            return;
        }
    }
  } // namespace

  template <int dim>
  CellSearch<dim>::CellSearch(const CellNodes<dim>            &nodes,
                              const std::vector<NodeTensors>  &positions,
                              const std::vector<unsigned int> &regions)
    : nodes(nodes)
    , positions(positions)
  {
    unsigned int n_regions = 0;
    for (const unsigned int r : regions)
      n_regions = std::max(n_regions, r + 1);
    for (unsigned int r = 0; r < n_regions; ++r)
      {
        std::vector<unsigned int>     cells;
        std::vector<BoundingBox<dim>> boxes;
        for (unsigned int c = 0; c < positions.size(); ++c)
          if (regions[c] == r)
            {
              cells.push_back(c);
              BoundingBox<dim> box =
                BoxTree<dim>::around(positions[c], nodes.n_nodes);
              // Curved edges bulge beyond their nodes, by less than 1/4 of the
              // box for degrees 2 and 3.
              double size = 0.;
              for (unsigned int d = 0; d < dim; ++d)
                size = std::max(size, box.side_length(d));
              box.extend(size * (nodes.degree == 1 ? 1e-7 : 0.25));
              boxes.push_back(box);
            }
        by_region.push_back({std::move(cells), BoxTree<dim>(boxes)});
      }
  }

  template <int dim>
  typename CellSearch<dim>::Place
  CellSearch<dim>::find(const Point<dim>             &x,
                        const std::set<unsigned int> &regions) const
  {
    const auto try_cell = [&](const unsigned int cell, Place &place) {
      place.cell = cell;
      for (unsigned int d = 0; d < dim; ++d)
        place.xi[d] = 0.5;
      if (!nodes.invert(positions[cell], x, place.xi))
        return false;
      place.excess = 0.;
      for (unsigned int d = 0; d < dim; ++d)
        place.excess = std::max({place.excess, -place.xi[d], place.xi[d] - 1.});
      return true;
    };

    std::vector<unsigned int> found;
    Place                     place, best;
    for (const unsigned int r : regions)
      {
        if (r >= by_region.size())
          continue;
        by_region[r].tree.meeting(BoundingBox<dim>({x, x}), found);
        for (const unsigned int i : found)
          if (try_cell(by_region[r].cells[i], place) &&
              place.excess <= inside_tolerance)
            {
              place.excess = 0.;
              for (unsigned int n = 0; n < nodes.n_nodes; ++n)
                if (place.xi.distance(nodes.unit_position(n)) < node_tolerance)
                  place.node = n;
              return place;
            }
      }

    double least = std::numeric_limits<double>::max();
    for (const unsigned int r : regions)
      {
        if (r >= by_region.size())
          continue;
        by_region[r].tree.nearest(x, n_near, found);
        for (const unsigned int i : found)
          {
            if (!try_cell(by_region[r].cells[i], place))
              continue;
            Place nearest = place;
            move_to_nearest(nodes, positions[place.cell], x, nearest.xi);
            place.distance =
              (evaluate(nearest, positions[place.cell]) - x).norm();
            if (place.distance < least)
              {
                least = place.distance;
                best  = place;
              }
          }
      }
    return best;
  }

  template <int dim>
  Tensor<1, dim>
  CellSearch<dim>::evaluate(const Place &place, const NodeTensors &f) const
  {
    if (place.node != numbers::invalid_unsigned_int)
      return f[place.node];
    typename CellNodes<dim>::NodeNumbers shape;
    nodes.shape_values(place.xi, shape);
    // One value plus differences, so that a constant is kept exactly.
    Tensor<1, dim> result = f[0];
    for (unsigned int i = 1; i < nodes.n_nodes; ++i)
      result += shape[i] * (f[i] - f[0]);
    return result;
  }

  template class CellSearch<2>;
  template class CellSearch<3>;
} // namespace alveolus
