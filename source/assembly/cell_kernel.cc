// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/cell_kernel.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  CellKernel<dim>::CellKernel(const Configuration<dim> &configuration,
                              const StepGeometry<dim>  &geometry)
    : configuration(configuration)
    , geometry(geometry)
    , points(geometry.n_points)
  {
    for (unsigned int i = 0; i < configuration.fe.n_dofs_per_cell(); ++i)
      {
        component.push_back(
          configuration.fe.system_to_component_index(i).first);
        node.push_back(configuration.fe.system_to_component_index(i).second);
      }
    for (auto &point : points)
      point.gradients.resize(geometry.n_nodes);

    const FE_DGP<dim>  pressure_fe(configuration.degree - 1);
    const unsigned int n = pressure_fe.n_dofs_per_cell();
    pressure_shapes.assign(n, std::vector<double>(points.size()));
    for (unsigned int m = 0; m < n; ++m)
      for (unsigned int q = 0; q < points.size(); ++q)
        pressure_shapes[m][q] =
          pressure_fe.shape_value(m, geometry.quadrature.point(q));
    mass_inverse.reinit(n, n);
    coefficients.resize(n);
    coefficients_pressure.resize(n);
    stress_variation.resize(component.size() * points.size());
    theta_variation.resize(component.size() * points.size());
  }



  template <int dim>
  void
  CellKernel<dim>::invert_mass(const double *weights)
  {
    const unsigned int n = coefficients.size();
    for (unsigned int m = 0; m < n; ++m)
      for (unsigned int k = 0; k <= m; ++k)
        {
          double sum = 0.;
          for (unsigned int q = 0; q < points.size(); ++q)
            sum += pressure_shapes[m][q] * pressure_shapes[k][q] * weights[q];
          mass_inverse(m, k) = mass_inverse(k, m) = sum;
        }
    if (n == 1)
      mass_inverse(0, 0) = 1. / mass_inverse(0, 0);
    else
      mass_inverse.gauss_jordan();
  }



  template <int dim>
  template <typename Get>
  void
  CellKernel<dim>::project(const Get &integrand, std::vector<double> &out) const
  {
    const unsigned int n = out.size();
    double             moments[1 + dim];
    for (unsigned int m = 0; m < n; ++m)
      {
        moments[m] = 0.;
        for (unsigned int q = 0; q < points.size(); ++q)
          moments[m] += pressure_shapes[m][q] * integrand(q);
      }
    for (unsigned int m = 0; m < n; ++m)
      {
        out[m] = 0.;
        for (unsigned int k = 0; k < n; ++k)
          out[m] += mass_inverse(m, k) * moments[k];
      }
  }



  template <int dim>
  double
  CellKernel<dim>::projected(const std::vector<double> &c,
                             const unsigned int         point) const
  {
    double value = 0.;
    for (unsigned int m = 0; m < c.size(); ++m)
      value += c[m] * pressure_shapes[m][point];
    return value;
  }



  template <int dim>
  typename CellKernel<dim>::Status
  CellKernel<dim>::evaluate_points(const unsigned int    cell,
                                   const Region         &region,
                                   HistoryStore<dim>    &history,
                                   const Vector<double> &increment,
                                   const bool            need_tangent)
  {
    const double *weights = geometry.weights(cell);
    mean_dilatation       = region.mean_dilatation;
    geometry_weight       = weights;

    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Point                &point = points[q];
        const Tensor<1, dim> *G     = geometry.gradients(cell, q);
        point.f                     = 0;
        for (unsigned int d = 0; d < 3; ++d)
          point.f[d][d] = 1.;
        for (unsigned int i = 0; i < component.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            point.f[component[i]][d] += increment[i] * G[node[i]][d];
        point.det = determinant(point.f);
        if (!(point.det > 0.))
          return Status::inverted;

        const Tensor<2, 3> f_inverse = invert(point.f);
        for (unsigned int a = 0; a < geometry.n_nodes; ++a)
          for (unsigned int d = 0; d < dim; ++d)
            {
              point.gradients[a][d] = 0.;
              for (unsigned int e = 0; e < dim; ++e)
                point.gradients[a][d] += G[a][e] * f_inverse[e][d];
            }
      }

    if (mean_dilatation)
      {
        invert_mass(weights);
        project([&](
                  const unsigned int q) { return points[q].det * weights[q]; },
                coefficients);
      }

    energy = energy_moved = dissipation = 0.;
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Point        &point = points[q];
        const double *old   = history.old_record(cell, q);
        const double  J_n   = region.material->volume_ratio(old);
        Tensor<2, 3>  f_bar = point.f;
        point.weight        = weights[q] / J_n;
        point.theta         = point.det;
        if (mean_dilatation)
          {
            point.theta = projected(coefficients, q);
            if (!(point.theta > 0.))
              return Status::inverted;
            f_bar *= std::cbrt(point.theta / point.det);
          }
        point.response.dissipation = 0.;
        region.material->evaluate(f_bar,
                                  old,
                                  history.trial_record(cell, q),
                                  need_tangent,
                                  point.response);
        if (!std::isfinite(point.response.stress.norm()))
          return Status::not_finite;
        energy += point.response.energy * point.weight;
        energy_moved += point.response.energy * moved_weight(q);
        dissipation += point.response.dissipation * point.weight;
        point.pressure_integrand =
          trace(point.response.stress) / (3. * point.theta);
      }
    if (mean_dilatation)
      {
        project(
          [&](const unsigned int q) {
            return points[q].pressure_integrand * points[q].weight;
          },
          coefficients_pressure);
        for (unsigned int q = 0; q < points.size(); ++q)
          points[q].pressure = projected(coefficients_pressure, q);
      }
    return Status::good;
  }



  template <int dim>
  typename CellKernel<dim>::Status
  CellKernel<dim>::evaluate(const unsigned int    cell,
                            const Region         &region,
                            HistoryStore<dim>    &history,
                            const Vector<double> &increment,
                            FullMatrix<double>   *matrix,
                            Vector<double>       &forces)
  {
    const Status status =
      evaluate_points(cell, region, history, increment, matrix != nullptr);
    if (status != Status::good)
      return status;

    // From here on "stress" is what the forces see: tau_hat times dv_n / J_n.
    forces = 0.;
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Point                &point  = points[q];
        SymmetricTensor<2, 3> stress = point.response.stress * point.weight;
        if (mean_dilatation)
          stress = deviator(stress) + point.pressure * point.det *
                                        geometry_weight[q] *
                                        unit_symmetric_tensor<3>();
        for (unsigned int i = 0; i < component.size(); ++i)
          for (unsigned int d = 0; d < dim; ++d)
            forces[i] += stress[component[i]][d] * point.gradients[node[i]][d];
      }
    if (matrix != nullptr)
      {
        *matrix = 0.;
        add_tangent(*matrix);
      }
    return Status::good;
  }



  template <int dim>
  void
  CellKernel<dim>::add_tangent(FullMatrix<double> &matrix)
  {
    const unsigned int n_dofs   = component.size();
    const unsigned int n_points = points.size();

    // Variation of theta for every dof: P(det f div v).
    if (mean_dilatation)
      for (unsigned int b = 0; b < n_dofs; ++b)
        {
          project(
            [&](const unsigned int q) {
              const Point &point = points[q];
              return point.det * point.gradients[node[b]][component[b]] *
                     geometry_weight[q];
            },
            coefficients);
          for (unsigned int q = 0; q < n_points; ++q)
            theta_variation[b * n_points + q] = projected(coefficients, q);
        }

    // Variation of tau_bar for every dof.
    for (unsigned int q = 0; q < n_points; ++q)
      {
        const Point          &point = points[q];
        const auto           &T     = point.response.tangent;
        SymmetricTensor<2, 3> volumetric;
        if (mean_dilatation)
          volumetric = T[0][0] + T[1][1] + T[2][2];
        for (unsigned int b = 0; b < n_dofs; ++b)
          {
            const unsigned int     k     = component[b];
            const Tensor<1, dim>  &g     = point.gradients[node[b]];
            SymmetricTensor<2, 3> &d_tau = stress_variation[b * n_points + q];
            d_tau                        = g[0] * T[k][0];
            for (unsigned int l = 1; l < dim; ++l)
              d_tau += g[l] * T[k][l];
            if (mean_dilatation)
              d_tau +=
                (theta_variation[b * n_points + q] / point.theta - g[k]) / 3. *
                volumetric;
          }
      }

    for (unsigned int b = 0; b < n_dofs; ++b)
      {
        const unsigned int k = component[b];
        if (mean_dilatation)
          project(
            [&](const unsigned int q) {
              const Point &point = points[q];
              return point.weight / (3. * point.theta) *
                     (trace(stress_variation[b * n_points + q]) -
                      trace(point.response.stress) *
                        theta_variation[b * n_points + q] / point.theta);
            },
            coefficients);
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const Point          &point = points[q];
            const Tensor<1, dim> &g     = point.gradients[node[b]];
            SymmetricTensor<2, 3> d_stress =
              stress_variation[b * n_points + q] * point.weight;
            SymmetricTensor<2, 3> stress = point.response.stress * point.weight;
            if (mean_dilatation)
              {
                const double dp = projected(coefficients, q);
                const double w  = geometry_weight[q] * point.det;
                d_stress = deviator(d_stress) + (dp + point.pressure * g[k]) *
                                                  w *
                                                  unit_symmetric_tensor<3>();
                stress = deviator(stress) +
                         point.pressure * w * unit_symmetric_tensor<3>();
              }
            double stress_g[dim];
            for (unsigned int i = 0; i < dim; ++i)
              {
                stress_g[i] = 0.;
                for (unsigned int l = 0; l < dim; ++l)
                  stress_g[i] += stress[i][l] * g[l];
              }
            for (unsigned int a = 0; a < n_dofs; ++a)
              {
                const unsigned int    i   = component[a];
                const Tensor<1, dim> &g_a = point.gradients[node[a]];
                double                sum = -stress_g[i] * g_a[k];
                for (unsigned int j = 0; j < dim; ++j)
                  sum += d_stress[i][j] * g_a[j];
                matrix(a, b) += sum;
              }
          }
      }
  }

  template class CellKernel<2>;
  template class CellKernel<3>;
} // namespace alveolus
