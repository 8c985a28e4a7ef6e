// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/mesh/quality.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>

#include <array>
#include <cmath>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Gradients of the shape functions of FE_Q on the unit cell. */
    template <int dim>
    struct ShapeGradients
    {
      ShapeGradients(const FiniteElement<dim> &fe)
        : n_nodes(fe.n_dofs_per_cell())
        , n_points(QGauss<dim>(fe.degree + 1).size())
        , weights(QGauss<dim>(fe.degree + 1).get_weights())
        , gradients(n_points * n_nodes)
      {
        const QGauss<dim> quadrature(fe.degree + 1);
        for (unsigned int q = 0; q < n_points; ++q)
          for (unsigned int k = 0; k < n_nodes; ++k)
            gradients[q * n_nodes + k] = fe.shape_grad(k, quadrature.point(q));
      }

      const unsigned int          n_nodes, n_points;
      const std::vector<double>   weights;
      std::vector<Tensor<1, dim>> gradients; ///< [point][node]
    };

    /** Smallest value so far, and where; what is not finite is worst of all. */
    template <int dim>
    struct Extreme
    {
      double     value = std::numeric_limits<double>::max();
      Point<dim> where;

      void
      consider(double v, const Point<dim> &centre)
      {
        if (!std::isfinite(v))
          v = std::numeric_limits<double>::lowest();
        if (v < value)
          {
            value = v;
            where = centre;
          }
      }
    };
  } // namespace

  template <int dim>
  double
  scaled_jacobian(const std::vector<Point<dim>> &vertices,
                  const unsigned int             vertex)
  {
    Tensor<2, dim> edges;
    double         lengths = 1., sign = 1.;
    for (unsigned int a = 0; a < dim; ++a)
      {
        edges[a] = vertices[vertex ^ (1u << a)] - vertices[vertex];
        lengths *= edges[a].norm();
        if (vertex & (1u << a))
          sign = -sign;
      }
    const double scaled = sign * determinant(edges) / lengths;
    // A vanishing edge is as bad as an inverted corner.
    return std::isfinite(scaled) ? scaled : -1.;
  }



  template <int dim>
  QualitySummary<dim>
  mesh_quality(const Configuration<dim>           &configuration,
               const NodalVector                  &positions,
               const std::set<types::material_id> &regions,
               Vector<float>                      *per_cell)
  {
    constexpr unsigned int n_vertices  = GeometryInfo<dim>::vertices_per_cell;
    const auto            &fe          = configuration.fe;
    const auto            &dof_handler = configuration.dof_handler;

    static const std::array<ShapeGradients<dim>, 2> shapes{
      {ShapeGradients<dim>(FE_Q<dim>(1)), ShapeGradients<dim>(FE_Q<dim>(2))}};
    AssertIndexRange(configuration.degree - 1, shapes.size());
    const ShapeGradients<dim> &shape = shapes[configuration.degree - 1];

    std::vector<unsigned int> dof_of(shape.n_nodes * dim);
    for (unsigned int k = 0; k < shape.n_nodes; ++k)
      for (unsigned int c = 0; c < dim; ++c)
        dof_of[k * dim + c] = fe.component_to_system_index(c, k);

    if (per_cell != nullptr)
      per_cell->reinit(dof_handler.get_triangulation().n_active_cells());

    Extreme<dim>                         corners, points;
    unsigned int                         n_inverted = 0;
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    std::vector<Point<dim>>              x(shape.n_nodes);
    std::vector<double>                  determinants(shape.n_points);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const bool counts =
            regions.empty() || regions.count(cell->material_id()) > 0;
          if (!counts && per_cell == nullptr)
            continue;
          cell->get_dof_indices(dofs);
          for (unsigned int k = 0; k < shape.n_nodes; ++k)
            for (unsigned int c = 0; c < dim; ++c)
              x[k][c] = positions(dofs[dof_of[k * dim + c]]);
          Point<dim> centre;
          for (unsigned int v = 0; v < n_vertices; ++v)
            centre += x[v] / n_vertices;

          double smallest = std::numeric_limits<double>::max();
          for (unsigned int v = 0; v < n_vertices; ++v)
            {
              const double scaled = scaled_jacobian(x, v);
              smallest            = std::min(smallest, scaled);
              if (counts && scaled <= 0.)
                ++n_inverted;
            }
          if (per_cell != nullptr)
            (*per_cell)[cell->active_cell_index()] =
              static_cast<float>(smallest);
          if (!counts)
            continue;
          corners.consider(smallest, centre);

          // Scaled by the mean of the absolute values: equal to the cell mean
          // for a valid cell, and a cell turned inside out as a whole stays
          // negative.
          double scale = 0., least = std::numeric_limits<double>::max();
          for (unsigned int q = 0; q < shape.n_points; ++q)
            {
              Tensor<2, dim> jacobian;
              for (unsigned int k = 0; k < shape.n_nodes; ++k)
                for (unsigned int c = 0; c < dim; ++c)
                  jacobian[c] +=
                    x[k][c] * shape.gradients[q * shape.n_nodes + k];
              const double det = determinant(jacobian);
              scale += shape.weights[q] * std::abs(det);
              if (!(det >= least))
                least = det;
            }
          points.consider(scale == 0. ? 0. : least / scale, centre);
        }

    // One collective call; equal values are decided by the place, so that the
    // answer is the same for any number of processes.
    std::vector<double> mine = {corners.value,
                                points.value,
                                double(n_inverted)};
    for (unsigned int c = 0; c < dim; ++c)
      mine.push_back(corners.where[c]);
    for (unsigned int c = 0; c < dim; ++c)
      mine.push_back(points.where[c]);

    QualitySummary<dim> summary;
    summary.smallest_scaled_jacobian = std::numeric_limits<double>::max();
    summary.smallest_point_jacobian  = std::numeric_limits<double>::max();
    const auto worse                 = [](const double              a,
                          const dealii::Point<dim> &at_a,
                          const double              b,
                          const dealii::Point<dim> &at_b) {
      if (a != b)
        return a < b;
      for (unsigned int c = 0; c < dim; ++c)
        if (at_a[c] != at_b[c])
          return at_a[c] < at_b[c];
      return false;
    };
    for (const auto &part :
         Utilities::MPI::all_gather(configuration.communicator(), mine))
      {
        Point<dim> corner, point;
        for (unsigned int c = 0; c < dim; ++c)
          {
            corner[c] = part[3 + c];
            point[c]  = part[3 + dim + c];
          }
        if (worse(
              part[0], corner, summary.smallest_scaled_jacobian, summary.where))
          {
            summary.smallest_scaled_jacobian = part[0];
            summary.where                    = corner;
          }
        if (worse(part[1],
                  point,
                  summary.smallest_point_jacobian,
                  summary.where_point))
          {
            summary.smallest_point_jacobian = part[1];
            summary.where_point             = point;
          }
        summary.n_inverted_corners += static_cast<unsigned int>(part[2]);
      }
    return summary;
  }

  template double
  scaled_jacobian(const std::vector<Point<2>> &, const unsigned int);
  template double
  scaled_jacobian(const std::vector<Point<3>> &, const unsigned int);
  template QualitySummary<2>
  mesh_quality(const Configuration<2> &,
               const NodalVector &,
               const std::set<types::material_id> &,
               Vector<float> *);
  template QualitySummary<3>
  mesh_quality(const Configuration<3> &,
               const NodalVector &,
               const std::set<types::material_id> &,
               Vector<float> *);
} // namespace alveolus
