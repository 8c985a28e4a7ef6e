// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/surface_load.h>

#include <deal.II/base/qprojector.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/fe/mapping_q_eulerian.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  std::set<types::boundary_id>
  boundary_ids(const NamedSets<dim> &names,
               const std::string    &list,
               const std::string    &where)
  {
    std::set<types::boundary_id> ids;
    for (const auto &name : Utilities::split_string_list(list, ','))
      {
        const auto &more = names.boundary(name, where);
        ids.insert(more.begin(), more.end());
      }
    return ids;
  }



  template <int dim>
  void
  TractionCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      parameters.on,
                      "Boundaries, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter(
      "Function",
      parameters.function,
      "Force per reference area [MPa], one expression in x, y(, z) "
      "[mm] (where the material came from) and t [T] for each "
      "component, separated by semicolons.",
      Patterns::Anything());
  }



  template <int dim>
  void
  TractionCondition<dim>::attach(const State<dim>  &state,
                                 const std::string &path)
  {
    this->where = path;
    ids         = boundary_ids(state.configuration.mesh.names,
                       parameters.on,
                       path + " / On");
    function =
      parse_function<dim>(parameters.function, dim, path + " / Function");
  }



  template <int dim>
  void
  TractionCondition<dim>::begin_step(const State<dim> &state,
                                     const Interval   &interval)
  {
    time      = interval.end;
    reference = state.configuration.mesh_displacement();
    reference.zero_out_ghost_values();
    reference -= state.displacement;
    reference.update_ghost_values();
  }



  template <int dim>
  void
  TractionCondition<dim>::add_forces(const State<dim> &state,
                                     const NodalVector &,
                                     const AssemblyTarget &target)
  {
    const auto &configuration = state.configuration;
    const MappingQEulerian<dim, NodalVector> mapping(configuration.degree,
                                                     configuration.dof_handler,
                                                     reference);
    FEFaceValues<dim>                        fe_values(mapping,
                                configuration.fe,
                                QGauss<dim - 1>(configuration.degree + 1),
                                update_values | update_JxW_values |
                                  update_quadrature_points);
    Vector<double> forces(configuration.fe.n_dofs_per_cell());
    Vector<double> traction(dim);
    std::vector<types::global_dof_index> dofs(forces.size());
    function->set_time(time);
    for (const auto &[cell, face] : boundary_faces(configuration, ids))
      {
        fe_values.reinit(cell, face);
        forces = 0.;
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            function->vector_value(fe_values.quadrature_point(q), traction);
            for (unsigned int i = 0; i < forces.size(); ++i)
              forces[i] -=
                fe_values.shape_value(i, q) *
                traction[configuration.fe.system_to_component_index(i).first] *
                fe_values.JxW(q);
          }
        cell->get_dof_indices(dofs);
        for (unsigned int i = 0; i < dofs.size(); ++i)
          target.residual(dofs[i]) += forces[i];
      }
  }



  template <int dim>
  std::string
  TractionCondition<dim>::describe() const
  {
    return parameters.on + ": dead traction " + parameters.function + " MPa";
  }



  template <int dim>
  void
  PressureCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      parameters.on,
                      "Boundaries, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter(
      "Function",
      parameters.function,
      "Pressure [MPa] against the boundary, an expression in x, "
      "y(, z) [mm] (current place) and t [T].",
      Patterns::Anything());
  }



  template <int dim>
  void
  PressureCondition<dim>::attach(const State<dim>  &state,
                                 const std::string &path)
  {
    this->where = path;
    ids         = boundary_ids(state.configuration.mesh.names,
                       parameters.on,
                       path + " / On");
    function =
      parse_function<dim>(parameters.function, 1, path + " / Function");
  }



  template <int dim>
  void
  PressureCondition<dim>::begin_step(const State<dim> &state,
                                     const Interval   &interval)
  {
    time      = interval.end;
    positions = state.configuration.positions();
  }



  template <int dim>
  void
  PressureCondition<dim>::add_forces(const State<dim>     &state,
                                     const NodalVector    &increment,
                                     const AssemblyTarget &target)
  {
    const auto                          &configuration = state.configuration;
    const auto                          &fe            = configuration.fe;
    const FE_Q<dim>                      scalar(configuration.degree);
    const QGauss<dim - 1>                quadrature(configuration.degree + 1);
    const unsigned int                   n_dofs = fe.n_dofs_per_cell();
    Vector<double>                       forces(n_dofs);
    FullMatrix<double>                   matrix(n_dofs, n_dofs);
    std::vector<types::global_dof_index> dofs(n_dofs);
    std::vector<double>                  value(scalar.n_dofs_per_cell());
    std::vector<Tensor<1, dim>>          gradient(scalar.n_dofs_per_cell());
    function->set_time(time);

    for (const auto &[cell, face] : boundary_faces(configuration, ids))
      {
        cell->get_dof_indices(dofs);
        forces = 0.;
        matrix = 0.;
        // Outward unit direction and tangents of the reference face, oriented
        // such that their cross product points outwards.
        const unsigned int direction = face / 2;
        const double       outward   = face % 2 == 1 ? 1. : -1.;
        const auto         points =
          QProjector<dim>::project_to_face(cell->reference_cell(),
                                           quadrature,
                                           face);
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          {
            Tensor<2, dim> F; // dx/dxi
            Point<dim>     x;
            for (unsigned int a = 0; a < value.size(); ++a)
              {
                value[a]    = scalar.shape_value(a, points.point(q));
                gradient[a] = scalar.shape_grad(a, points.point(q));
              }
            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                const auto [c, a] = fe.system_to_component_index(i);
                const double x_i  = positions(dofs[i]) + increment(dofs[i]);
                x[c] += x_i * value[a];
                F[c] += x_i * gradient[a];
              }
            const double p = function->value(x) * quadrature.weight(q);
            // n da = cof(F) N dA (Nanson's formula on the reference face).
            const auto cofactor = [&](const Tensor<2, dim> &A) {
              return determinant(A) * transpose(invert(A));
            };
            const Tensor<2, dim> cof = cofactor(F);
            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                const auto [c, a] = fe.system_to_component_index(i);
                forces[i] += p * value[a] * outward * cof[c][direction];
              }
            if (target.system == nullptr)
              continue;
            // d cof(F) = cof(F) tr(F^-1 dF) - cof(F) dF^T F^-T, F^-T = cof/det.
            const Tensor<2, dim> F_inverse = invert(F);
            for (unsigned int j = 0; j < n_dofs; ++j)
              {
                const auto [k, b] = fe.system_to_component_index(j);
                Tensor<1, dim> pulled; // F^-T-weighted gradient: dN_b/dx
                for (unsigned int m = 0; m < dim; ++m)
                  for (unsigned int l = 0; l < dim; ++l)
                    pulled[m] += gradient[b][l] * F_inverse[l][m];
                // dF = e_k (x) grad_xi N_b, so tr(F^-1 dF) = dN_b/dx_k and
                // (cof dF^T F^-T)_{c d} = cof[c].grad_xi N_b (F^-T)_{k d}
                for (unsigned int i = 0; i < n_dofs; ++i)
                  {
                    const auto [c, a] = fe.system_to_component_index(i);
                    const double d_cof =
                      cof[c][direction] * pulled[k] -
                      pulled[c] * determinant(F) * F_inverse[direction][k];
                    matrix(i, j) += p * value[a] * outward * d_cof;
                  }
              }
          }
        target.add(matrix, forces, dofs);
      }
  }



  template <int dim>
  std::string
  PressureCondition<dim>::describe() const
  {
    return parameters.on + ": follower pressure " + parameters.function +
           " MPa";
  }

  template std::set<types::boundary_id>
  boundary_ids(const NamedSets<2> &, const std::string &, const std::string &);
  template std::set<types::boundary_id>
  boundary_ids(const NamedSets<3> &, const std::string &, const std::string &);
  template class TractionCondition<2>;
  template class TractionCondition<3>;
  template class PressureCondition<2>;
  template class PressureCondition<3>;

  ALVEOLUS_REGISTER_DIM(
    Condition,
    TractionCondition,
    "traction",
    "Dead load: `Function` is the force per reference area [MPa] on the "
    "boundaries `On` in the shape X = x - u they had where the material came "
    "from.")
  ALVEOLUS_REGISTER_DIM(
    Condition,
    PressureCondition,
    "pressure",
    "Follower load: `Function` is the pressure p [MPa] against the deformed "
    "boundary, f = - int p N n da, with its load stiffness.")
} // namespace alveolus
