// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/subcells.h>

#include <deal.II/base/quadrature_lib.h>

#include <algorithm>
#include <array>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** The unit directions of a face normal to @p direction, ascending. */
    template <int dim>
    std::array<unsigned int, dim - 1>
    tangential_directions(const unsigned int direction)
    {
      std::array<unsigned int, dim - 1> result;
      for (unsigned int d = 0, t = 0; d < dim; ++d)
        if (d != direction)
          result[t++] = d;
      return result;
    }

    /**
     * Directions of the tangents a, b with a x b (3D), or the one tangent a
     * with (a_y, -a_x) times +-1 (2D), pointing to the upper side.
     */
    template <int dim>
    std::array<unsigned int, dim - 1>
    oriented_tangents(const unsigned int direction)
    {
      if constexpr (dim == 2)
        return {{1 - direction}};
      else
        return {{(direction + 1) % 3, (direction + 2) % 3}};
    }
  } // namespace

  template <int dim>
  SubCells<dim>::SubCells(
    const Configuration<dim>                        &configuration,
    const std::function<unsigned int(unsigned int)> &region)
    : nodes(configuration)
    , n_points(Utilities::pow(configuration.degree + 1, dim))
    , faces_per_sub_cell(configuration.mesh.triangulation->has_hanging_nodes()
                           ? 2 * dim * Utilities::pow(2, dim - 1)
                           : 2 * dim)
    , n_cells(configuration.mesh.triangulation->n_active_cells())
    , n_1d(configuration.degree + 1)
    , n_tangential(Utilities::pow(configuration.degree + 1, dim - 1))
  {
    if (configuration.degree > 1 &&
        configuration.mesh.triangulation->has_hanging_nodes())
      throw InputError("Mesh / Degree",
                       "it is " + std::to_string(configuration.degree) +
                         " and the mesh has hanging nodes",
                       "set it to 1, or refine the mesh as a whole");

    const QGauss<1> gauss(n_1d);
    breaks_1d.push_back(0.);
    for (unsigned int i = 0; i + 1 < n_1d; ++i)
      breaks_1d.push_back(breaks_1d.back() + gauss.weight(i));
    breaks_1d.push_back(1.);

    // Degrees of the integrands in each unit direction: see the class
    // comment; n Gauss points are exact for degree 2n-1.
    const unsigned int p = configuration.degree;
    build_volume_rule(dim == 2 ? p : (3 * p + 1) / 2, volume_rule);
    build_volume_rule(dim == 2 ? (3 * p + 1) / 2 : 2 * p, centroid_rule);
    build_face_rule(dim == 2 ? p : (3 * p + 1) / 2, swept_rule);
    build_face_rule(dim == 2 ? (3 * p + 1) / 2 : 2 * p, moment_rule);
    build_faces(configuration, region);
  }

  template <int dim>
  unsigned int
  SubCells<dim>::form_index(const unsigned int direction,
                            const unsigned int plane,
                            const unsigned int tangential) const
  {
    return (direction * (n_1d + 1) + plane) * n_tangential + tangential;
  }

  template <int dim>
  unsigned int
  SubCells<dim>::point_index(const unsigned int direction,
                             const unsigned int layer,
                             const unsigned int tangential) const
  {
    // Position of the sub-cell in each unit direction, x fastest.
    unsigned int result = 0, stride = 1, rest = tangential;
    for (unsigned int d = 0; d < dim; ++d, stride *= n_1d)
      if (d == direction)
        result += layer * stride;
      else
        {
          result += (rest % n_1d) * stride;
          rest /= n_1d;
        }
    return result;
  }

  template <int dim>
  void
  SubCells<dim>::build_volume_rule(const unsigned int n_gauss, Rule &rule) const
  {
    const QGauss<dim> gauss(n_gauss);
    rule.n_quadrature = gauss.size();
    typename CellNodes<dim>::NodeNumbers values;
    typename CellNodes<dim>::NodeTensors gradients;
    for (unsigned int q = 0; q < n_points; ++q)
      {
        Point<dim>     corner;
        Tensor<1, dim> width;
        double         size = 1.;
        for (unsigned int d = 0, rest = q; d < dim; ++d, rest /= n_1d)
          {
            corner[d] = breaks_1d[rest % n_1d];
            width[d]  = breaks_1d[rest % n_1d + 1] - corner[d];
            size *= width[d];
          }
        rule.shape_begin.push_back(rule.shape.size());
        for (unsigned int g = 0; g < gauss.size(); ++g)
          {
            Point<dim> xi = corner;
            for (unsigned int d = 0; d < dim; ++d)
              xi[d] += width[d] * gauss.point(g)[d];
            rule.weights.push_back(size * gauss.weight(g));
            nodes.shape_gradients(xi, values, gradients);
            for (unsigned int i = 0; i < nodes.n_nodes; ++i)
              {
                rule.shape.push_back(values[i]);
                for (unsigned int d = 0; d < dim; ++d)
                  rule.shape.push_back(gradients[i][d]);
              }
          }
      }
  }

  template <int dim>
  void
  SubCells<dim>::build_face_rule(const unsigned int n_gauss, Rule &rule) const
  {
    const QGauss<dim - 1> gauss(n_gauss);
    rule.n_quadrature = gauss.size();
    typename CellNodes<dim>::NodeNumbers values;
    typename CellNodes<dim>::NodeTensors gradients;
    for (unsigned int direction = 0; direction < dim; ++direction)
      for (unsigned int plane = 0; plane <= n_1d; ++plane)
        for (unsigned int t = 0; t < n_tangential; ++t)
          {
            const auto directions = tangential_directions<dim>(direction);
            const auto tangents   = oriented_tangents<dim>(direction);

            // On a face of the cell only the nodes of that face count.
            rule.support.emplace_back();
            for (unsigned int i = 0; i < nodes.n_nodes; ++i)
              if ((plane > 0 && plane < n_1d) ||
                  std::abs(nodes.unit_position(i)[direction] -
                           breaks_1d[plane]) < 1e-10)
                rule.support.back().push_back(i);

            rule.shape_begin.push_back(rule.shape.size());
            for (unsigned int g = 0; g < gauss.size(); ++g)
              {
                Point<dim> xi;
                double     size = 1.;
                xi[direction]   = breaks_1d[plane];
                for (unsigned int k = 0, rest = t; k < dim - 1;
                     ++k, rest /= n_1d)
                  {
                    const double lower = breaks_1d[rest % n_1d];
                    const double width = breaks_1d[rest % n_1d + 1] - lower;
                    xi[directions[k]]  = lower + width * gauss.point(g)[k];
                    size *= width;
                  }
                rule.weights.push_back(size * gauss.weight(g));
                nodes.shape_gradients(xi, values, gradients);
                for (const unsigned int i : rule.support.back())
                  {
                    rule.shape.push_back(values[i]);
                    for (const unsigned int d : tangents)
                      rule.shape.push_back(gradients[i][d]);
                  }
              }
          }
  }

  template <int dim>
  void
  SubCells<dim>::build_faces(
    const Configuration<dim>                        &configuration,
    const std::function<unsigned int(unsigned int)> &region)
  {
    // A face waiting for its place in the list, with its slot in each of its
    // two sub-cells.
    struct Draft
    {
      Face                        face;
      std::array<unsigned int, 2> slot;
    };
    std::vector<Draft> drafts;

    using Cell = typename Triangulation<dim>::active_cell_iterator;
    // Centre of a face of sub-cells at a face of the undeformed cell with
    // straight edges: the same from both sides, whatever their orientation.
    const auto centre =
      [&](const Cell &cell, const unsigned int face_no, const unsigned int t) {
        const unsigned int direction = face_no / 2;
        Point<dim>         xi, result;
        xi[direction]     = face_no % 2;
        unsigned int rest = t;
        for (const unsigned int d : tangential_directions<dim>(direction))
          {
            xi[d] = 0.5 * (breaks_1d[rest % n_1d] + breaks_1d[rest % n_1d + 1]);
            rest /= n_1d;
          }
        for (const unsigned int v : cell->vertex_indices())
          result +=
            GeometryInfo<dim>::d_linear_shape_function(xi, v) * cell->vertex(v);
        return result;
      };

    const unsigned int width = faces_per_sub_cell / (2 * dim);
    // All faces of sub-cells of face f of a cell that is finer than its
    // neighbour: they belong to one sub-cell of that.
    const auto hang = [&](const Cell        &fine,
                          const unsigned int f,
                          const Cell        &coarse,
                          const unsigned int g) {
      Point<dim>         middle;
      const unsigned int n_vertices = fine->face(f)->n_vertices();
      for (unsigned int v = 0; v < n_vertices; ++v)
        middle += fine->face(f)->vertex(v) / n_vertices;
      unsigned int best     = 0;
      double       distance = std::numeric_limits<double>::max();
      for (unsigned int s = 0; s < n_tangential; ++s)
        if (centre(coarse, g, s).distance(middle) < distance)
          {
            best     = s;
            distance = centre(coarse, g, s).distance(middle);
          }
      const bool         upper = f % 2 == 1;
      const unsigned int there =
        coarse->active_cell_index() * n_points +
        point_index(g / 2, g % 2 == 1 ? n_1d - 1 : 0, best);
      const unsigned int c = fine->active_cell_index();
      for (unsigned int t = 0; t < n_tangential; ++t)
        drafts.push_back(
          {{{{c * n_points + point_index(f / 2, upper ? n_1d - 1 : 0, t),
              there}},
            c,
            form_index(f / 2, upper ? n_1d : 0, t),
            upper ? 1. : -1.},
           {{f * width, g * width + t}}});
    };

    for (const auto &cell :
         configuration.mesh.triangulation->active_cell_iterators())
      {
        const unsigned int c = cell->active_cell_index();
        if (!cell->is_artificial())
          relevant.push_back(c);
        if (!cell->is_locally_owned())
          continue;
        owned.push_back(c);

        for (unsigned int d = 0; d < dim; ++d)
          for (unsigned int plane = 1; plane < n_1d; ++plane)
            for (unsigned int t = 0; t < n_tangential; ++t)
              drafts.push_back({{{{c * n_points + point_index(d, plane - 1, t),
                                   c * n_points + point_index(d, plane, t)}},
                                 c,
                                 form_index(d, plane, t),
                                 1.},
                                {{(2 * d + 1) * width, 2 * d * width}}});

        for (const unsigned int f : cell->face_indices())
          {
            const unsigned int d     = f / 2;
            const bool         upper = f % 2 == 1;
            const unsigned int layer = upper ? n_1d - 1 : 0;
            const unsigned int plane = upper ? n_1d : 0;
            const double       sign  = upper ? 1. : -1.;
            const bool         finer =
              !cell->at_boundary(f) && cell->face(f)->has_children();
            const bool open =
              !cell->at_boundary(f) &&
              region((finer ? cell->neighbor_child_on_subface(f, 0)
                            : cell->neighbor(f))
                       ->active_cell_index()) == region(c);
            if (!open)
              {
                for (unsigned int t = 0; t < n_tangential; ++t)
                  drafts.push_back(
                    {{{{c * n_points + point_index(d, layer, t), none}},
                      c,
                      form_index(d, plane, t),
                      sign},
                     {{f * width, none}}});
                continue;
              }

            // Between cells of different size the finer one gives faces and
            // geometry.
            if (finer)
              {
                for (unsigned int k = 0; k < cell->face(f)->n_children(); ++k)
                  {
                    const Cell child = cell->neighbor_child_on_subface(f, k);
                    if (!child->is_locally_owned())
                      hang(child, cell->neighbor_of_neighbor(f), cell, f);
                  }
                continue;
              }
            if (cell->neighbor_is_coarser(f))
              {
                hang(cell,
                     f,
                     cell->neighbor(f),
                     cell->neighbor_of_coarser_neighbor(f).first);
                continue;
              }

            // The cell that comes first in the global order gives the
            // geometry, so that every process computes the same bits.
            const Cell neighbor = cell->neighbor(f);
            const bool first    = cell->global_active_cell_index() <
                               neighbor->global_active_cell_index();
            if (!first && neighbor->is_locally_owned())
              continue;

            const unsigned int g        = cell->neighbor_of_neighbor(f);
            const unsigned int c_other  = neighbor->active_cell_index();
            const bool         other_up = g % 2 == 1;
            std::vector<bool>  taken(n_tangential, false);
            const double       diameter = cell->face(f)->diameter();
            for (unsigned int t = 0; t < n_tangential; ++t)
              {
                const Point<dim> x    = centre(cell, f, t);
                unsigned int     best = none;
                for (unsigned int s = 0; s < n_tangential; ++s)
                  if (!taken[s] &&
                      centre(neighbor, g, s).distance(x) < 1e-6 * diameter)
                    best = s;
                // A periodic or degenerate mesh: no input can lead here.
                AssertThrow(best != none, ExcInternalError());
                taken[best] = true;

                const unsigned int here =
                  c * n_points + point_index(d, layer, t);
                const unsigned int there =
                  c_other * n_points +
                  point_index(g / 2, other_up ? n_1d - 1 : 0, best);
                if (first)
                  drafts.push_back(
                    {{{{here, there}}, c, form_index(d, plane, t), sign},
                     {{f * width, g * width}}});
                else
                  drafts.push_back(
                    {{{{there, here}},
                      c_other,
                      form_index(g / 2, other_up ? n_1d : 0, best),
                      other_up ? 1. : -1.},
                     {{g * width, f * width}}});
              }
          }
      }

    // Faces of one cell follow each other, so that its nodes are gathered once.
    std::stable_sort(drafts.begin(),
                     drafts.end(),
                     [](const Draft &a, const Draft &b) {
                       return a.face.cell < b.face.cell;
                     });
    all_incidences.assign(n_sub_cells() * faces_per_sub_cell, {none, 0});
    all_faces.reserve(drafts.size());
    for (const Draft &draft : drafts)
      {
        for (unsigned int side = 0; side < 2; ++side)
          if (draft.slot[side] != none)
            all_incidences[draft.face.sub_cell[side] * faces_per_sub_cell +
                           draft.slot[side]] = {
              static_cast<unsigned int>(all_faces.size()), side};
        all_faces.push_back(draft.face);
      }

    for (const unsigned int c : owned)
      for (unsigned int s = c * n_points; s < (c + 1) * n_points; ++s)
        for (unsigned int f = 0; f < 2 * dim; ++f)
          AssertThrow(incidences(s)[f * width].face != none,
                      ExcInternalError());
  }

  template <int dim>
  void
  SubCells<dim>::volumes(const NodalVector   &x,
                         std::vector<double> &result,
                         const bool           with_ghosts) const
  {
    nodes.check(x);
    result.resize(n_sub_cells());
    typename CellNodes<dim>::NodeTensors position;
    for (const unsigned int c : with_ghosts ? relevant : owned)
      {
        nodes.gather(x, c, position);
        // Relative to one node: round-off is then relative to the cell's size.
        for (unsigned int i = nodes.n_nodes; i-- > 0;)
          position[i] -= position[0];
        const double *shape  = volume_rule.shape.data();
        const double *weight = volume_rule.weights.data();
        for (unsigned int q = 0; q < n_points; ++q)
          {
            double volume = 0.;
            for (unsigned int g = 0; g < volume_rule.n_quadrature; ++g)
              {
                Tensor<2, dim> jacobian;
                for (unsigned int i = 0; i < nodes.n_nodes;
                     ++i, shape += dim + 1)
                  for (unsigned int a = 0; a < dim; ++a)
                    for (unsigned int b = 0; b < dim; ++b)
                      jacobian[a][b] += position[i][a] * shape[1 + b];
                volume += *(weight++) * determinant(jacobian);
              }
            result[c * n_points + q] = volume;
          }
      }
  }

  template <int dim>
  void
  SubCells<dim>::centroids(const NodalVector       &x,
                           std::vector<Point<dim>> &result,
                           std::vector<double>     &volume) const
  {
    nodes.check(x);
    result.resize(n_sub_cells());
    volume.resize(n_sub_cells());
    typename CellNodes<dim>::NodeTensors position;
    for (const unsigned int c : relevant)
      {
        nodes.gather(x, c, position);
        const Tensor<1, dim> base = position[0];
        for (unsigned int i = 0; i < nodes.n_nodes; ++i)
          position[i] -= base;
        const double *shape  = centroid_rule.shape.data();
        const double *weight = centroid_rule.weights.data();
        for (unsigned int q = 0; q < n_points; ++q)
          {
            double         v = 0.;
            Tensor<1, dim> moment;
            for (unsigned int g = 0; g < centroid_rule.n_quadrature; ++g)
              {
                Tensor<2, dim> jacobian;
                Tensor<1, dim> point;
                for (unsigned int i = 0; i < nodes.n_nodes;
                     ++i, shape += dim + 1)
                  for (unsigned int a = 0; a < dim; ++a)
                    {
                      point[a] += position[i][a] * shape[0];
                      for (unsigned int b = 0; b < dim; ++b)
                        jacobian[a][b] += position[i][a] * shape[1 + b];
                    }
                const double JxW = *(weight++) * determinant(jacobian);
                v += JxW;
                moment += JxW * point;
              }
            volume[c * n_points + q] = v;
            result[c * n_points + q] = Point<dim>(base + moment / v);
          }
      }
  }

  template <int dim>
  template <typename Integrand>
  void
  SubCells<dim>::integrate_faces(const Rule        &rule,
                                 const unsigned int n_time,
                                 const NodalVector &x_0,
                                 const NodalVector &x_1,
                                 Integrand        &&add) const
  {
    nodes.check(x_0);
    nodes.check(x_1);
    const QGauss<1>     time(n_time);
    std::vector<double> times, time_weights;
    for (unsigned int k = 0; k < n_time; ++k)
      {
        times.push_back(time.point(k)[0]);
        time_weights.push_back(time.weight(k));
      }

    std::vector<typename CellNodes<dim>::NodeTensors> position(n_time);
    typename CellNodes<dim>::NodeTensors              motion, start;
    Tensor<1, dim>                                    base;
    bool                                              moved = false;
    unsigned int                                      cell  = none;
    for (unsigned int f = 0; f < all_faces.size(); ++f)
      {
        const Face &face = all_faces[f];
        if (face.cell != cell)
          {
            cell = face.cell;
            nodes.gather(x_0, cell, start);
            nodes.gather(x_1, cell, motion);
            base  = start[0];
            moved = false;
            for (unsigned int i = 0; i < nodes.n_nodes; ++i)
              {
                motion[i] -= start[i];
                moved = moved || motion[i] != Tensor<1, dim>();
                start[i] -= base;
                for (unsigned int k = 0; k < n_time; ++k)
                  position[k][i] = start[i] + times[k] * motion[i];
              }
          }
        if (!moved)
          continue;

        const std::vector<unsigned int> &support = rule.support[face.form];
        const double *shape = rule.shape.data() + rule.shape_begin[face.form];
        const double *weight =
          rule.weights.data() + face.form * rule.n_quadrature;
        const bool flip = dim == 2 && face.form >= (n_1d + 1) * n_tangential;
        for (unsigned int g = 0; g < rule.n_quadrature;
             ++g, shape += support.size() * dim)
          {
            Tensor<1, dim> velocity;
            const double  *s = shape;
            for (const unsigned int i : support)
              {
                velocity += s[0] * motion[i];
                s += dim;
              }
            for (unsigned int k = 0; k < n_time; ++k)
              {
                Tensor<1, dim> point, a, b;
                s = shape;
                for (const unsigned int i : support)
                  {
                    const Tensor<1, dim> &x = position[k][i];
                    point += s[0] * x;
                    a += s[1] * x;
                    if constexpr (dim == 3)
                      b += s[2] * x;
                    s += dim;
                  }
                double rate;
                if constexpr (dim == 2)
                  rate = (velocity[0] * a[1] - velocity[1] * a[0]) *
                         (flip ? -1. : 1.);
                else
                  rate = velocity * cross_product_3d(a, b);
                add(f,
                    face.sign * weight[g] * time_weights[k] * rate,
                    base,
                    point);
              }
          }
      }
  }

  template <int dim>
  void
  SubCells<dim>::swept_volumes(const NodalVector   &x_0,
                               const NodalVector   &x_1,
                               std::vector<double> &result) const
  {
    result.assign(all_faces.size(), 0.);
    integrate_faces(swept_rule,
                    dim - 1,
                    x_0,
                    x_1,
                    [&](const unsigned int f,
                        const double       volume,
                        const Tensor<1, dim> &,
                        const Tensor<1, dim> &) { result[f] += volume; });
  }

  template <int dim>
  void
  SubCells<dim>::swept_moments(const NodalVector           &x_0,
                               const NodalVector           &x_1,
                               std::vector<Tensor<1, dim>> &result) const
  {
    result.assign(all_faces.size(), Tensor<1, dim>());
    integrate_faces(moment_rule,
                    2,
                    x_0,
                    x_1,
                    [&](const unsigned int    f,
                        const double          volume,
                        const Tensor<1, dim> &base,
                        const Tensor<1, dim> &point) {
                      result[f] += volume * (base + point);
                    });
  }

  template class SubCells<2>;
  template class SubCells<3>;
} // namespace alveolus
