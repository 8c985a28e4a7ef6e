// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/cell_kernel.h>

#include <deal.II/base/geometry_info.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    bool
    is_finite(const SymmetricTensor<2, 3> &stress)
    {
      // The sum of squares is not finite if one of them is not
      double sum = 0.;
      for (unsigned int i = 0; i < 6; ++i)
        sum += stress.access_raw_entry(i) * stress.access_raw_entry(i);
      return std::isfinite(sum);
    }
  } // namespace



  template <int dim>
  CellKernel<dim>::CellKernel(const Configuration<dim> &configuration,
                              const StepGeometry<dim>  &geometry)
    : configuration(configuration)
    , geometry(geometry)
    , points(geometry.n_points)
    , pressure_shapes(geometry.pressure_shapes)
  {
    for (unsigned int a = 0; a < geometry.n_nodes; ++a)
      for (unsigned int i = 0; i < dim; ++i)
        dof.push_back(configuration.fe.component_to_system_index(i, a));
    for (auto &point : points)
      {
        point.gradients.resize(geometry.n_nodes);
        for (unsigned int d = 0; d < 3; ++d)
          point.f[d][d] = 1.;
        point.response.plane_strain = (dim == 2);
      }

    const unsigned int n = pressure_shapes.size();
    mass_inverse.reinit(n, n);
    coefficients.resize(n);
    coefficients_pressure.resize(n);
    tangent.resize(dof.size() * dof.size());
    gradients_by_component.resize(dof.size());
    for (auto *rows :
         {&volume_rows, &pressure_rows, &deviator_rows, &theta_rows, &dp_rows})
      rows->resize(n * dof.size());
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
        Tensor<2, dim>        f;
        for (unsigned int d = 0; d < dim; ++d)
          f[d][d] = 1.;
        for (unsigned int a = 0; a < geometry.n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            f[i] += increment[dof[a * dim + i]] * G[a];
        point.det = determinant(f);
        if (!(point.det > 0.))
          return Status::inverted;

        const Tensor<2, dim> f_inverse = invert(f);
        for (unsigned int a = 0; a < geometry.n_nodes; ++a)
          point.gradients[a] = G[a] * f_inverse;
        for (unsigned int i = 0; i < dim; ++i)
          for (unsigned int j = 0; j < dim; ++j)
            point.f[i][j] = f[i][j];
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
        if (!is_finite(point.response.stress))
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
        const Point   &point = points[q];
        Tensor<2, dim> stress;
        const double   pressure =
          mean_dilatation ? point.pressure * point.det * geometry_weight[q] -
                              point.weight * trace(point.response.stress) / 3.
                            : 0.;
        for (unsigned int i = 0; i < dim; ++i)
          {
            for (unsigned int j = 0; j < dim; ++j)
              stress[i][j] = point.weight * point.response.stress[i][j];
            stress[i][i] += pressure;
          }
        for (unsigned int a = 0; a < geometry.n_nodes; ++a)
          for (unsigned int i = 0; i < dim; ++i)
            forces[dof[a * dim + i]] += stress[i] * point.gradients[a];
      }
    if (matrix != nullptr)
      fill_tangent(*matrix);
    return Status::good;
  }



  template <int dim>
  void
  CellKernel<dim>::fill_tangent(FullMatrix<double> &matrix)
  {
    // With the number of nodes known, the compiler unrolls the loops over them.
    constexpr unsigned int linear    = GeometryInfo<dim>::vertices_per_cell;
    constexpr unsigned int quadratic = Utilities::pow(3, dim);
    if (geometry.n_nodes == linear)
      add_point_tangents<linear>();
    else if (geometry.n_nodes == quadratic)
      add_point_tangents<quadratic>();
    else
      add_point_tangents<0>();
    if (mean_dilatation)
      add_dilatation_tangent();

    const unsigned int n_nodes = geometry.n_nodes;
    for (unsigned int b = 0; b < n_nodes; ++b)
      for (unsigned int k = 0; k < dim; ++k)
        for (unsigned int i = 0; i < dim; ++i)
          {
            const double *entries =
              tangent.data() + ((b * dim + k) * dim + i) * n_nodes;
            const unsigned int column = dof[b * dim + k];
            for (unsigned int a = 0; a < n_nodes; ++a)
              matrix(dof[a * dim + i], column) = entries[a];
          }
  }



  /**
   * For the velocity gradient e_k (x) grad N_b the change of the force on node
   * a is a_ijkl (grad N_a)_j (grad N_b)_l with a_ijkl = (change of the
   * stress)_ijkl - sigma_il delta_jk. With mean dilatation only the part at
   * constant theta and p is meant here.
   */
  template <int dim>
  template <unsigned int n_static>
  void
  CellKernel<dim>::add_point_tangents()
  {
    const unsigned int n_nodes = n_static > 0 ? n_static : geometry.n_nodes;
    std::fill(tangent.begin(), tangent.end(), 0.);
    for (unsigned int q = 0; q < points.size(); ++q)
      {
        Point       &point = points[q];
        const auto  &T     = point.response.tangent;
        const double w     = point.weight;

        Tensor<2, dim> stress;
        const double   mean =
          mean_dilatation ? trace(point.response.stress) / 3. : 0.;
        const double pressure =
          mean_dilatation
            ? point.pressure * geometry_weight[q] * point.det - w * mean
            : 0.;
        for (unsigned int i = 0; i < dim; ++i)
          {
            for (unsigned int j = 0; j < dim; ++j)
              stress[i][j] = w * point.response.stress[i][j];
            stress[i][i] += pressure;
          }

        SymmetricTensor<2, 3> volumetric; // of a change of theta
        if (mean_dilatation)
          {
            volumetric           = (T[0][0] + T[1][1] + T[2][2]) / 3.;
            const double trace_v = trace(volumetric);
            const double factor  = w / point.theta;
            for (unsigned int i = 0; i < dim; ++i)
              {
                for (unsigned int j = 0; j < dim; ++j)
                  point.stress_by_theta[i][j] = factor * volumetric[i][j];
                point.stress_by_theta[i][i] -= factor * trace_v / 3.;
              }
            point.pressure_by_theta = factor / (3. * point.theta) *
                                      (trace_v - trace(point.response.stress));
          }

        const double p_volume =
          mean_dilatation ? point.pressure * geometry_weight[q] * point.det
                          : 0.;
        for (unsigned int k = 0; k < dim; ++k)
          for (unsigned int l = 0; l < dim; ++l)
            {
              SymmetricTensor<2, 3> change = T[k][l];
              double                sphere = 0.;
              if (mean_dilatation)
                {
                  if (k == l)
                    change -= volumetric;
                  const double t                   = trace(change);
                  point.pressure_by_gradient[k][l] = w * t / (3. * point.theta);
                  sphere = -w * t / 3. + (k == l ? p_volume : 0.);
                }
              for (unsigned int i = 0; i < dim; ++i)
                {
                  for (unsigned int j = 0; j < dim; ++j)
                    moduli[k][i][j][l] = w * change[i][j];
                  moduli[k][i][i][l] += sphere;
                  moduli[k][i][k][l] -= stress[i][l];
                }
            }

        for (unsigned int a = 0; a < n_nodes; ++a)
          for (unsigned int d = 0; d < dim; ++d)
            gradients_by_component[d * n_nodes + a] = point.gradients[a][d];

        const double *G   = gradients_by_component.data();
        double       *out = tangent.data();
        for (unsigned int b = 0; b < n_nodes; ++b)
          {
            const Tensor<1, dim> &g = point.gradients[b];
            for (unsigned int k = 0; k < dim; ++k)
              for (unsigned int i = 0; i < dim; ++i)
                {
                  double row[dim];
                  for (unsigned int j = 0; j < dim; ++j)
                    {
                      row[j] = moduli[k][i][j][0] * g[0];
                      for (unsigned int l = 1; l < dim; ++l)
                        row[j] += moduli[k][i][j][l] * g[l];
                    }
                  for (unsigned int a = 0; a < n_nodes; ++a)
                    {
                      double sum = row[0] * G[a];
                      for (unsigned int j = 1; j < dim; ++j)
                        sum += row[j] * G[j * n_nodes + a];
                      out[a] += sum;
                    }
                  out += n_nodes;
                }
          }
      }
  }



  /**
   * theta and p of a cell depend on all its dofs, through one number for each
   * function psi_m of FE_DGP: with C_mb = int psi_m det f div v_b, that is,
   * d theta_b = psi_m (M^-1 C)_mb, the tangent gets C^T M^-1 R for dp and
   * E^T M^-1 C for the change of the deviator by theta.
   */
  template <int dim>
  void
  CellKernel<dim>::add_dilatation_tangent()
  {
    const unsigned int n       = coefficients.size();
    const unsigned int n_nodes = geometry.n_nodes;
    const unsigned int n_dofs  = n_nodes * dim;
    for (unsigned int m = 0; m < n; ++m)
      {
        double *C = volume_rows.data() + m * n_dofs;
        double *R = pressure_rows.data() + m * n_dofs;
        double *E = deviator_rows.data() + m * n_dofs;
        std::fill(C, C + n_dofs, 0.);
        std::fill(R, R + n_dofs, 0.);
        std::fill(E, E + n_dofs, 0.);
        for (unsigned int q = 0; q < points.size(); ++q)
          {
            const Point         &point  = points[q];
            const double         psi    = pressure_shapes[m][q];
            const double         volume = psi * geometry_weight[q] * point.det;
            const Tensor<2, dim> by_gradient = psi * point.pressure_by_gradient;
            const Tensor<2, dim> by_theta    = psi * point.stress_by_theta;
            for (unsigned int a = 0; a < n_nodes; ++a)
              for (unsigned int i = 0; i < dim; ++i)
                {
                  const Tensor<1, dim> &g = point.gradients[a];
                  C[a * dim + i] += volume * g[i];
                  R[a * dim + i] += by_gradient[i] * g;
                  E[a * dim + i] += by_theta[i] * g;
                }
          }
      }

    const auto solve_mass = [&](const std::vector<double> &rows,
                                std::vector<double>       &result) {
      for (unsigned int m = 0; m < n; ++m)
        for (unsigned int b = 0; b < n_dofs; ++b)
          {
            double sum = 0.;
            for (unsigned int k = 0; k < n; ++k)
              sum += mass_inverse(m, k) * rows[k * n_dofs + b];
            result[m * n_dofs + b] = sum;
          }
    };
    solve_mass(volume_rows, theta_rows);
    for (unsigned int m = 0; m < n; ++m)
      for (unsigned int k = 0; k < n; ++k)
        {
          double coupling = 0.;
          for (unsigned int q = 0; q < points.size(); ++q)
            coupling += pressure_shapes[m][q] * pressure_shapes[k][q] *
                        points[q].pressure_by_theta;
          for (unsigned int b = 0; b < n_dofs; ++b)
            pressure_rows[m * n_dofs + b] +=
              coupling * theta_rows[k * n_dofs + b];
        }
    solve_mass(pressure_rows, dp_rows);

    for (unsigned int m = 0; m < n; ++m)
      {
        const double *C     = volume_rows.data() + m * n_dofs;
        const double *E     = deviator_rows.data() + m * n_dofs;
        const double *dp    = dp_rows.data() + m * n_dofs;
        const double *theta = theta_rows.data() + m * n_dofs;
        double       *out   = tangent.data();
        for (unsigned int b = 0; b < n_dofs; ++b)
          for (unsigned int i = 0; i < dim; ++i, out += n_nodes)
            for (unsigned int a = 0; a < n_nodes; ++a)
              out[a] += C[a * dim + i] * dp[b] + E[a * dim + i] * theta[b];
      }
  }

  template class CellKernel<2>;
  template class CellKernel<3>;
} // namespace alveolus
