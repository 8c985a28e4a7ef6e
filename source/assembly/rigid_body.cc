// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/rigid_body.h>
#include <alveolus/assembly/surface_load.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/physics/transformations.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  RigidBody<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      parameters.on,
                      "Boundaries that the body carries along.",
                      Patterns::Anything());
    prm.add_parameter(
      "Motion",
      parameters.motion,
      "Translation of the body [mm], an expression in t [T] for "
      "each component, separated by semicolons.",
      Patterns::Anything());
    prm.add_parameter(
      "Rotation",
      parameters.rotation,
      "Rotation about the centre [degrees], an expression in t.",
      Patterns::Anything());
    prm.add_parameter("Centre",
                      parameters.centre,
                      "Centre of the rotation and of the moment [mm].",
                      Patterns::Anything());
    prm.add_parameter("Axis",
                      parameters.axis,
                      "Axis of the rotation (3D).",
                      Patterns::Anything());
    prm.add_parameter("Attachment",
                      parameters.attachment,
                      "tied, or the name of an interface law from the section "
                      "Interfaces.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  RigidBody<dim>::choose_interface_law(const InterfaceLaws &laws,
                                       const std::string   &where)
  {
    law = nullptr;
    if (parameters.attachment == "tied")
      return;
    const auto found = laws.find(parameters.attachment);
    if (found == laws.end())
      throw InputError(where + " / Attachment",
                       "there is no interface law '" + parameters.attachment +
                         "'",
                       "write tied, or a name from Interfaces / Names");
    law = found->second.get();
  }



  template <int dim>
  void
  RigidBody<dim>::attach(const State<dim> &state, const std::string &path)
  {
    this->where               = path;
    const auto &configuration = state.configuration;
    ids = boundary_ids(configuration.mesh.names, parameters.on, path + " / On");
    motion = parse_function_of_time(parameters.motion, dim, path + " / Motion");
    angle =
      parse_function_of_time(parameters.rotation, 1, path + " / Rotation");
    centre = parse_vector(parameters.centre, path + " / Centre");
    axis   = parse_vector(parameters.axis, path + " / Axis");
    if (axis.norm() == 0.)
      throw InputError(path + " / Axis", "has no length", "write 0, 0, 1");
    axis /= axis.norm();

    nodes.clear();
    for (const auto &name : Utilities::split_string_list(parameters.on, ','))
      for (const NodeId node : state.nodes.boundary(name, path + " / On"))
        nodes.push_back(node);
    if (law != nullptr)
      jumps =
        std::make_unique<FaceHistory<dim>>(*configuration.mesh.triangulation,
                                           ids,
                                           Utilities::fixed_power<dim - 1>(
                                             configuration.degree + 1),
                                           dim);
  }



  template <int dim>
  Tensor<1, 3>
  RigidBody<dim>::displacement(const double t) const
  {
    Tensor<1, 3> d;
    for (unsigned int i = 0; i < dim; ++i)
      d[i] = motion->value(Point<1>(t), i);
    return d;
  }



  template <int dim>
  Tensor<2, 3>
  RigidBody<dim>::rotation(const double t) const
  {
    const double theta = angle->value(Point<1>(t)) * numbers::PI / 180.;
    if (theta == 0.)
      return Tensor<2, 3>(unit_symmetric_tensor<3>());
    return Physics::Transformations::Rotations::rotation_matrix_3d(
      dim == 2 ? Tensor<1, 3>(Point<3>(0, 0, 1)) : axis, theta);
  }



  template <int dim>
  Tensor<1, 3>
  RigidBody<dim>::carried(const Point<dim> &x, const Interval &interval) const
  {
    Tensor<1, 3> arm;
    for (unsigned int d = 0; d < dim; ++d)
      arm[d] = x[d];
    const Tensor<1, 3> before = displacement(interval.begin);
    const Tensor<1, 3> after  = displacement(interval.end);
    arm -= centre + before;
    const Tensor<2, 3> turn =
      rotation(interval.end) * transpose(rotation(interval.begin));
    return after - before + turn * arm - arm;
  }



  template <int dim>
  void
  RigidBody<dim>::begin_step(const State<dim> &state, const Interval &interval)
  {
    step = interval;
    if (law == nullptr)
      return;
    const auto       &configuration = state.configuration;
    FEFaceValues<dim> fe_values(configuration.mapping(),
                                configuration.fe,
                                QGauss<dim - 1>(configuration.degree + 1),
                                update_values | update_JxW_values |
                                  update_normal_vectors |
                                  update_quadrature_points);
    faces.clear();
    for (const auto &face : jumps->faces())
      {
        LoadedFace loaded;
        loaded.cell = typename DoFHandler<dim>::active_cell_iterator(
          configuration.mesh.triangulation.get(),
          face.cell->level(),
          face.cell->index(),
          &configuration.dof_handler);
        loaded.dofs.resize(configuration.fe.n_dofs_per_cell());
        loaded.cell->get_dof_indices(loaded.dofs);
        fe_values.reinit(loaded.cell, face.face_no);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            FacePoint point;
            for (unsigned int i = 0; i < loaded.dofs.size(); ++i)
              point.shapes.push_back(fe_values.shape_value(i, q));
            point.weight = fe_values.JxW(q);
            for (unsigned int d = 0; d < dim; ++d)
              point.normal[d] = fe_values.normal_vector(q)[d];
            point.x = fe_values.quadrature_point(q);
            loaded.points.push_back(point);
          }
        faces.push_back(loaded);
      }
  }



  template <int dim>
  void
  RigidBody<dim>::prescribe(const State<dim>     &state,
                            const Interval       &interval,
                            PrescribedIncrements &increments) const
  {
    if (law != nullptr)
      return;
    const NodalVector positions = state.configuration.positions();
    for (const NodeId node : nodes)
      {
        const Tensor<1, 3> du =
          carried(state.nodes.get(positions, node), interval);
        for (unsigned int d = 0; d < dim; ++d)
          increments.prescribe(state.nodes.dofs(node)[d], du[d], this->where);
      }
  }



  template <int dim>
  void
  RigidBody<dim>::add_forces(const State<dim>     &state,
                             const NodalVector    &increment,
                             const AssemblyTarget &target)
  {
    if (law == nullptr)
      return;
    const auto        &fe     = state.configuration.fe;
    const unsigned int n_dofs = fe.n_dofs_per_cell();
    Vector<double>     forces(n_dofs);
    FullMatrix<double> matrix(n_dofs, n_dofs);
    const Tensor<2, 3> turn =
      rotation(step.end) * transpose(rotation(step.begin));
    force           = 0.;
    moment          = 0.;
    smallest_strain = std::numeric_limits<double>::max();
    largest_strain  = std::numeric_limits<double>::lowest();
    largest_shear   = 0.;
    stored          = 0.;
    for (unsigned int f = 0; f < faces.size(); ++f)
      {
        forces = 0.;
        matrix = 0.;
        for (unsigned int q = 0; q < faces[f].points.size(); ++q)
          {
            FacePoint   &point = faces[f].points[q];
            Tensor<1, 3> old, du, normal = turn * point.normal;
            for (unsigned int d = 0; d < dim; ++d)
              old[d] = jumps->old_record(f, q)[d];
            for (unsigned int i = 0; i < n_dofs; ++i)
              du[fe.system_to_component_index(i).first] +=
                point.shapes[i] * increment(faces[f].dofs[i]);
            const Tensor<1, 3> jump = turn * old + carried(point.x, step) - du;
            for (unsigned int d = 0; d < dim; ++d)
              jumps->trial_record(f, q)[d] = jump[d];

            Tensor<1, 3> traction;
            Tensor<2, 3> tangent;
            double       energy = 0.;
            law->evaluate(jump, normal, traction, tangent, energy);
            point.traction = traction;
            stored += energy * point.weight;
            const double strain = law->normal_strain(jump, normal);
            smallest_strain     = std::min(smallest_strain, strain);
            largest_strain      = std::max(largest_strain, strain);
            largest_shear =
              std::max(largest_shear, law->shear_strain(jump, normal));

            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                const unsigned int c = fe.system_to_component_index(i).first;
                forces[i] -= point.shapes[i] * traction[c] * point.weight;
                if (target.system != nullptr && point.shapes[i] != 0.)
                  for (unsigned int j = 0; j < n_dofs; ++j)
                    matrix(i, j) +=
                      point.shapes[i] * point.shapes[j] * point.weight *
                      tangent[c][fe.system_to_component_index(j).first];
              }
            Tensor<1, 3> arm;
            for (unsigned int d = 0; d < dim; ++d)
              arm[d] = point.x[d] + du[d];
            arm -= centre + displacement(step.end);
            force += traction * point.weight;
            moment += cross_product_3d(arm, traction) * point.weight;
          }
        target.add(matrix, forces, faces[f].dofs);
      }
  }



  template <int dim>
  void
  RigidBody<dim>::commit()
  {
    if (jumps)
      jumps->commit();
  }



  template <int dim>
  void
  RigidBody<dim>::begin_work()
  {
    tractions_before.clear();
    for (const auto &face : faces)
      for (const auto &point : face.points)
        tractions_before.push_back(point.traction);
    stored_before = stored;
  }



  template <int dim>
  LayerWork
  RigidBody<dim>::layer_work(const State<dim>  &state,
                             const NodalVector &increment) const
  {
    // The body's forces act where the boundary is (see add_forces()): their
    // power is that of force and moment about the moved centre, at both ends.
    LayerWork          work;
    const auto        &fe     = state.configuration.fe;
    auto               before = tractions_before.begin();
    const Tensor<1, 3> start  = displacement(step.begin);
    const Tensor<1, 3> shift  = displacement(step.end) - start;
    const Tensor<1, 3> turn =
      (angle->value(Point<1>(step.end)) - angle->value(Point<1>(step.begin))) *
      numbers::PI / 180. *
      (dim == 2 ? Tensor<1, 3>(Point<3>(0., 0., 1.)) : axis);
    for (const auto &face : faces)
      for (const auto &point : face.points)
        {
          Tensor<1, 3> du, arm;
          for (unsigned int i = 0; i < face.dofs.size(); ++i)
            du[fe.system_to_component_index(i).first] +=
              point.shapes[i] * increment(face.dofs[i]);
          for (unsigned int d = 0; d < dim; ++d)
            arm[d] = point.x[d];
          arm -= centre + start;
          const Tensor<1, 3> t_0 = 0.5 * point.weight * *before++;
          const Tensor<1, 3> t_1 = 0.5 * point.weight * point.traction;
          work.by_body +=
            t_0 * (shift + cross_product_3d(turn, arm)) +
            t_1 * (shift + cross_product_3d(turn, arm + du - shift));
          work.on_boundary += (t_0 + t_1) * du;
        }
    work.stored_before = stored_before;
    work.stored_after  = stored;
    return work;
  }



  template <int dim>
  double
  RigidBody<dim>::stored_energy(const State<dim> &state) const
  {
    if (law == nullptr)
      return 0.;
    const auto       &configuration = state.configuration;
    FEFaceValues<dim> fe_values(configuration.mapping(),
                                configuration.fe,
                                QGauss<dim - 1>(configuration.degree + 1),
                                update_JxW_values | update_normal_vectors);
    double            sum = 0.;
    for (unsigned int f = 0; f < jumps->faces().size(); ++f)
      {
        const auto &face = jumps->faces()[f];
        fe_values.reinit(typename DoFHandler<dim>::active_cell_iterator(
                           configuration.mesh.triangulation.get(),
                           face.cell->level(),
                           face.cell->index(),
                           &configuration.dof_handler),
                         face.face_no);
        for (const unsigned int q : fe_values.quadrature_point_indices())
          {
            Tensor<1, 3> jump, normal, traction;
            Tensor<2, 3> tangent;
            double       energy = 0.;
            for (unsigned int d = 0; d < dim; ++d)
              {
                jump[d]   = jumps->old_record(f, q)[d];
                normal[d] = fe_values.normal_vector(q)[d];
              }
            law->evaluate(jump, normal, traction, tangent, energy);
            sum += energy * fe_values.JxW(q);
          }
      }
    return sum;
  }



  template <int dim>
  void
  RigidBody<dim>::save(const PortableFields<dim> &fields,
                       const std::string         &prefix,
                       BlockFile                 &blocks) const
  {
    if (law != nullptr)
      fields.save(*jumps, prefix + "jumps", blocks);
  }



  template <int dim>
  void
  RigidBody<dim>::load(const PortableFields<dim> &fields,
                       const std::string         &prefix,
                       const BlockFile           &blocks)
  {
    if (law != nullptr)
      fields.load(blocks, prefix + "jumps", *jumps);
  }



  template <int dim>
  std::vector<Recorded>
  RigidBody<dim>::record(const State<dim>  &state,
                         const NodalVector &reactions) const
  {
    Tensor<1, 3> f = force, m = moment;
    if (law == nullptr)
      {
        f                           = 0;
        m                           = 0;
        const NodalVector positions = state.configuration.positions();
        for (const NodeId node : nodes)
          if (state.nodes.is_owned(node))
            {
              Tensor<1, 3> arm, reaction;
              for (unsigned int d = 0; d < dim; ++d)
                {
                  reaction[d] = reactions(state.nodes.dofs(node)[d]);
                  arm[d]      = state.nodes.get(positions, node)[d];
                }
              arm -= centre + displacement(state.time);
              f += reaction;
              m += cross_product_3d(arm, reaction);
            }
      }
    const MPI_Comm communicator = state.configuration.communicator();
    f                           = Utilities::MPI::sum(f, communicator);
    m                           = Utilities::MPI::sum(m, communicator);

    static const char *const names[] = {"x", "y", "z"};
    std::vector<Recorded>    row;
    row.emplace_back("tooth displacement [mm]",
                     (displacement(state.time) - displacement(0.)).norm());
    for (unsigned int d = 0; d < dim; ++d)
      row.emplace_back(std::string("force ") + names[d] + " [N]", f[d]);
    if (dim == 2)
      row.emplace_back("moment [N mm]", m[2]);
    else
      for (unsigned int d = 0; d < dim; ++d)
        row.emplace_back(std::string("moment ") + names[d] + " [N mm]", m[d]);
    if (law != nullptr)
      {
        row.emplace_back("smallest interface strain",
                         Utilities::MPI::min(smallest_strain, communicator));
        row.emplace_back("largest interface strain",
                         Utilities::MPI::max(largest_strain, communicator));
        row.emplace_back("largest interface shear",
                         Utilities::MPI::max(largest_shear, communicator));
      }
    return row;
  }



  template <int dim>
  std::string
  RigidBody<dim>::describe() const
  {
    return parameters.on + ": rigid body moved by " + parameters.motion +
           " mm, " +
           (law == nullptr ? "tied" : "interface " + parameters.attachment);
  }

  template class RigidBody<2>;
  template class RigidBody<3>;

  ALVEOLUS_REGISTER_DIM(
    Condition,
    RigidBody,
    "rigid body",
    "A rigid body with prescribed `Motion` d(t) and `Rotation` theta(t) about "
    "`Centre` c, x = c + d + R (X - c), carries the boundaries `On`: tied, or "
    "through an interface law t(j) of the jump between them. Records "
    "displacement, force and moment exerted by the body.")
} // namespace alveolus
