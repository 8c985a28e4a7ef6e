// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/tensors.h>
#include <alveolus/io/rigid_motion.h>
#include <alveolus/state/reproducible_sum.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Angle times axis [rad] of a rotation, angle between 0 and pi. */
    Tensor<1, 3>
    rotation_vector(const Tensor<2, 3> &R)
    {
      const Tensor<1, 3> sines({0.5 * (R[2][1] - R[1][2]),
                                0.5 * (R[0][2] - R[2][0]),
                                0.5 * (R[1][0] - R[0][1])});
      const double       cosine = 0.5 * (trace(R) - 1.);
      const double       angle  = std::atan2(sines.norm(), cosine);
      if (sines.norm() == 0.)
        return cosine > 0. ? Tensor<1, 3>() : // a half turn has no sines
                 angle * spectral(symmetrize(R)).vectors[0];
      return angle / sines.norm() * sines;
    }

    const std::string axis_names[] = {"x", "y", "z"};
  } // namespace



  template <int dim>
  std::set<types::material_id>
  region_ids(const NamedSets<dim> &names,
             const std::string    &list,
             const std::string    &where)
  {
    std::set<types::material_id> ids;
    for (const auto &name : Utilities::split_string_list(list, ','))
      {
        const auto &more = names.region(name, where);
        ids.insert(more.begin(), more.end());
      }
    return ids;
  }



  template <int dim>
  void
  RigidMotion<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Named regions of the mesh, separated by commas.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  RigidMotion<dim>::attach(const State<dim> &state, const std::string &path)
  {
    where = path;
    ids   = region_ids(state.configuration.mesh.names, on, path + " / On");
    if (ids.empty())
      throw InputError(path + " / On", "names no region", "name at least one");
  }



  template <int dim>
  std::vector<Recorded>
  RigidMotion<dim>::record(const State<dim> &state, const NodalVector &) const
  {
    const auto   &configuration = state.configuration;
    FEValues<dim> fe_values(configuration.mapping(),
                            configuration.fe,
                            QGauss<dim>(configuration.degree + 1),
                            update_values | update_JxW_values |
                              update_quadrature_points);
    struct Place
    {
      double         weight;
      Tensor<1, dim> x, X;
    };
    std::vector<Place>                   places;
    std::vector<types::global_dof_index> dofs(
      configuration.fe.n_dofs_per_cell());
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        {
          fe_values.reinit(cell);
          cell->get_dof_indices(dofs);
          for (const unsigned int q : fe_values.quadrature_point_indices())
            {
              Place place;
              place.weight = fe_values.JxW(q);
              place.x      = fe_values.quadrature_point(q);
              place.X      = place.x;
              for (unsigned int i = 0; i < dofs.size(); ++i)
                place.X[configuration.fe.system_to_component_index(i).first] -=
                  state.displacement(dofs[i]) * fe_values.shape_value(i, q);
              places.push_back(place);
            }
        }
    const MPI_Comm communicator = configuration.communicator();
    const auto     integral     = [&](const auto &integrand) {
      std::vector<double> values;
      values.reserve(places.size());
      for (const Place &place : places)
        values.push_back(place.weight * integrand(place));
      return reproducible_sum(values, communicator);
    };
    const double   volume = integral([](const Place &) { return 1.; });
    Tensor<1, dim> x_c, X_c;
    for (unsigned int d = 0; d < dim; ++d)
      {
        x_c[d] = integral([&](const Place &p) { return p.x[d]; }) / volume;
        X_c[d] = integral([&](const Place &p) { return p.X[d]; }) / volume;
      }
    Tensor<2, 3> M;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        M[i][j] = integral([&](const Place &p) {
                    return (p.x[i] - x_c[i]) * (p.X[j] - X_c[j]);
                  }) /
                  volume;

    std::vector<Recorded> row;
    for (unsigned int d = 0; d < dim; ++d)
      row.emplace_back("translation " + axis_names[d] + " [mm]",
                       x_c[d] - X_c[d]);
    Tensor<2, dim> R;
    const double   to_degrees = 180. / numbers::PI;
    if constexpr (dim == 2)
      {
        const double angle = std::atan2(M[1][0] - M[0][1], M[0][0] + M[1][1]);
        R[0][0] = R[1][1] = std::cos(angle);
        R[1][0]           = std::sin(angle);
        R[0][1]           = -R[1][0];
        row.emplace_back("rotation [degrees]", angle * to_degrees);
        // (I - R) X = x_c - R X_c; det(I - R) = 2 (1 - cos)
        const Tensor<1, 2> rest   = x_c - R * X_c;
        const double       half   = std::tan(0.5 * angle);
        const double       beyond = std::numeric_limits<double>::quiet_NaN();
        const bool         turned = std::abs(angle) > 1e-12;
        row.emplace_back("centre of rotation x [mm]",
                         turned ? 0.5 * (rest[0] - rest[1] / half) : beyond);
        row.emplace_back("centre of rotation y [mm]",
                         turned ? 0.5 * (rest[1] + rest[0] / half) : beyond);
      }
    else
      {
        if (!(determinant(M) > 0.))
          throw RunError(where,
                         "region '" + on + "' has no rotation",
                         "its deformation is far from a rigid motion; leave "
                         "this record out");
        R                       = polar(M).R;
        const Tensor<1, 3> turn = rotation_vector(R);
        for (unsigned int d = 0; d < dim; ++d)
          row.emplace_back("rotation " + axis_names[d] + " [degrees]",
                           turn[d] * to_degrees);
        // Every rigid motion is a screw: the point of its axis nearest to the
        // centroid, X_c + (t + cot(angle/2) a x t)/2 with t normal to a
        const double       angle  = turn.norm();
        const bool         turned = angle > 1e-12;
        const Tensor<1, 3> axis   = turned ? turn / angle : Tensor<1, 3>();
        const Tensor<1, 3> moved  = x_c - X_c;
        const double       along  = moved * axis;
        const Tensor<1, 3> across = moved - along * axis;
        const Tensor<1, 3> on_axis =
          X_c + 0.5 * (across +
                       cross_product_3d(axis, across) / std::tan(0.5 * angle));
        const double beyond = std::numeric_limits<double>::quiet_NaN();
        for (unsigned int d = 0; d < dim; ++d)
          row.emplace_back("axis of rotation at " + axis_names[d] + " [mm]",
                           turned ? on_axis[d] : beyond);
        row.emplace_back("translation along axis [mm]",
                         turned ? along : beyond);
      }
    row.emplace_back("deviation [mm]",
                     std::sqrt(
                       integral([&](const Place &p) {
                         return (p.x - x_c - R * (p.X - X_c)).norm_square();
                       }) /
                       volume));
    return row;
  }

  template std::set<types::material_id>
  region_ids(const NamedSets<2> &, const std::string &, const std::string &);
  template std::set<types::material_id>
  region_ids(const NamedSets<3> &, const std::string &, const std::string &);
  template class RigidMotion<2>;
  template class RigidMotion<3>;

  ALVEOLUS_REGISTER_DIM(
    Recorder,
    RigidMotion,
    "rigid motion",
    "The rigid motion that fits the regions `On` best, x = x_c + R (X - X_c) "
    "with the least int |x - x_c - R (X - X_c)|^2 dv: displacement of the "
    "centroid [mm], rotation [degrees] (3D: rotation vector), in 2D the centre "
    "of rotation [mm], in 3D the point of the axis of rotation nearest to the "
    "centroid and the translation along it [mm] (nan without rotation), and the root mean square of the "
    "deviation from it [mm].")
} // namespace alveolus
