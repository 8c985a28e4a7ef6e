// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/piece_load.h>
#include <alveolus/assembly/surface_load.h>
#include <alveolus/state/reproducible_sum.h>

#include <deal.II/base/qprojector.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_q.h>

#include <array>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** In three dimensions, for the formulas that both dimensions share. */
    template <int dim>
    Tensor<1, 3>
    in_space(const Tensor<1, dim> &v)
    {
      Tensor<1, 3> w;
      for (unsigned int d = 0; d < dim; ++d)
        w[d] = v[d];
      return w;
    }

    template <int dim>
    Tensor<1, dim>
    from_space(const Tensor<1, 3> &v)
    {
      Tensor<1, dim> w;
      for (unsigned int d = 0; d < dim; ++d)
        w[d] = v[d];
      return w;
    }

    /** Sums of vectors over all points of all processes, to the last bit. */
    template <int n>
    class VectorSum
    {
    public:
      void
      add(const Tensor<1, n> &v)
      {
        for (unsigned int d = 0; d < n; ++d)
          values[d].push_back(v[d]);
      }

      Tensor<1, n>
      total(const MPI_Comm &communicator) const
      {
        Tensor<1, n> sum;
        for (unsigned int d = 0; d < n; ++d)
          sum[d] = reproducible_sum(values[d], communicator);
        return sum;
      }

    private:
      std::array<std::vector<double>, n> values;
    };



    /**
     * The normal (times area) of a face that is the unit cell's with the
     * normal along @p direction: its tangents are t[0] and (3D) t[1], those
     * of the following directions in cyclic order.
     */
    Tensor<1, 2>
    normal_of(const std::array<Tensor<1, 2>, 1> &t,
              const unsigned int                 direction,
              const double                       outward)
    {
      const double sign = direction == 0 ? outward : -outward;
      return Point<2>(sign * t[0][1], -sign * t[0][0]);
    }

    Tensor<1, 3>
    normal_of(const std::array<Tensor<1, 3>, 2> &t,
              const unsigned int,
              const double outward)
    {
      return outward * cross_product_3d(t[0], t[1]);
    }

    /** Its change for the change @p dt of the tangents. */
    Tensor<1, 2>
    normal_change(const std::array<Tensor<1, 2>, 2> &,
                  const std::array<Tensor<1, 2>, 1> &dt,
                  const unsigned int                 direction,
                  const double                       outward)
    {
      return normal_of(dt, direction, outward);
    }

    Tensor<1, 3>
    normal_change(const std::array<Tensor<1, 3>, 3> &basis,
                  const std::array<Tensor<1, 3>, 2> &dt,
                  const unsigned int,
                  const double outward)
    {
      return outward * (cross_product_3d(dt[0], basis[1]) +
                        cross_product_3d(basis[0], dt[1]));
    }
  } // namespace



  template <int dim>
  void
  PieceLoad<dim>::declare_common(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Boundaries, separated by commas: one piece.",
                      Patterns::Anything());
    if (dim == 3)
      prm.add_parameter("Axis",
                        axis_text,
                        "Axis of the couple.",
                        Patterns::Anything());
    prm.add_parameter("Follower",
                      follower,
                      "false: dead load, fixed in direction, on the shape the "
                      "piece had where the material came from; true: turns "
                      "with the surface.",
                      Patterns::Bool());
  }



  template <int dim>
  double
  PieceLoad<dim>::force(const double t) const
  {
    return force_function ? force_function->value(Point<1>(t)) : 0.;
  }



  template <int dim>
  double
  PieceLoad<dim>::moment(const double t) const
  {
    return ratio * force(t) +
           (moment_function ? moment_function->value(Point<1>(t)) : 0.);
  }



  template <int dim>
  void
  PieceLoad<dim>::attach(const State<dim> &state, const std::string &path)
  {
    this->where               = path;
    const auto &configuration = state.configuration;
    ids = boundary_ids(configuration.mesh.names, on, path + " / On");
    if (!force_text.empty())
      force_function = parse_function_of_time(force_text, 1, path + " / Force");
    if (!moment_text.empty())
      moment_function =
        parse_function_of_time(moment_text, 1, path + " / Moment");
    normal = (direction == "normal");
    if (!normal)
      {
        vector = parse_vector(direction, path + " / Direction");
        if (dim == 2)
          vector[2] = 0.;
        if (vector.norm() == 0.)
          throw InputError(path + " / Direction",
                           "'" + direction + "' has no length",
                           "write normal, or a vector such as 1, 0");
        vector /= vector.norm();
      }
    axis = dim == 2 ? Tensor<1, 3>(Point<3>(0., 0., 1.))
                    : parse_vector(axis_text, path + " / Axis");
    if (axis.norm() == 0.)
      throw InputError(path + " / Axis", "has no length", "write 0, 0, 1");
    axis /= axis.norm();

    component.clear();
    node.clear();
    for (unsigned int i = 0; i < configuration.fe.n_dofs_per_cell(); ++i)
      {
        component.push_back(
          configuration.fe.system_to_component_index(i).first);
        node.push_back(configuration.fe.system_to_component_index(i).second);
      }
    find_faces(state);
    distribute(state);
  }



  template <int dim>
  void
  PieceLoad<dim>::find_faces(const State<dim> &state)
  {
    const auto           &configuration = state.configuration;
    const FE_Q<dim>       scalar(configuration.degree);
    const QGauss<dim - 1> quadrature(configuration.degree + 1);
    faces.clear();
    for (const auto &[cell, face] : boundary_faces(configuration, ids))
      {
        LoadedFace loaded;
        loaded.direction = face / 2;
        loaded.outward   = face % 2 == 1 ? 1. : -1.;
        loaded.dofs.resize(configuration.fe.n_dofs_per_cell());
        cell->get_dof_indices(loaded.dofs);
        const auto on_face =
          QProjector<dim>::project_to_face(cell->reference_cell(),
                                           quadrature,
                                           face);
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          {
            FacePoint point;
            point.weight = quadrature.weight(q);
            for (unsigned int a = 0; a < scalar.n_dofs_per_cell(); ++a)
              {
                point.shapes.push_back(scalar.shape_value(a, on_face.point(q)));
                point.gradients.push_back(
                  scalar.shape_grad(a, on_face.point(q)));
              }
            loaded.points.push_back(std::move(point));
          }
        faces.push_back(std::move(loaded));
      }
  }



  template <int dim>
  template <class Position>
  typename PieceLoad<dim>::Surface
  PieceLoad<dim>::surface(const LoadedFace &face,
                          const FacePoint  &point,
                          const Position   &position) const
  {
    Surface                             s;
    std::array<Tensor<1, dim>, dim - 1> tangents;
    for (unsigned int i = 0; i < face.dofs.size(); ++i)
      {
        const double x_i = position(face.dofs[i]);
        s.x[component[i]] += x_i * point.shapes[node[i]];
        for (unsigned int k = 0; k + 1 < dim; ++k)
          tangents[k][component[i]] +=
            x_i * point.gradients[node[i]][(face.direction + 1 + k) % dim];
      }
    for (unsigned int k = 0; k + 1 < dim; ++k)
      s.basis[k] = tangents[k];
    s.basis[dim - 1] = normal_of(tangents, face.direction, face.outward);
    return s;
  }



  template <int dim>
  Tensor<1, dim>
  PieceLoad<dim>::combine(const Tensor<1, dim> &components,
                          const Surface        &surface)
  {
    Tensor<1, dim> sum;
    for (unsigned int k = 0; k < dim; ++k)
      sum += components[k] * surface.basis[k];
    return sum;
  }



  // The densities q_f and q_m on the reference shape of the piece.
  template <int dim>
  void
  PieceLoad<dim>::distribute(const State<dim> &state)
  {
    const MPI_Comm communicator = state.configuration.communicator();
    const auto     x_n          = state.configuration.positions();
    const auto     reference    = [&](const types::global_dof_index i) {
      return x_n(i) - state.displacement(i);
    };
    VectorSum<dim> normals, moments;
    VectorSum<1>   areas;
    for (auto &face : faces)
      for (auto &point : face.points)
        {
          const Surface s   = surface(face, point, reference);
          point.X           = s.x;
          point.N           = s.basis[dim - 1];
          const double area = point.N.norm() * point.weight;
          areas.add(Point<1>(area));
          normals.add(point.N * point.weight);
          moments.add(area * point.X);
        }
    const double         area     = areas.total(communicator)[0];
    const Tensor<1, dim> sum_N    = normals.total(communicator);
    const Tensor<1, dim> centroid = moments.total(communicator) / area;
    if (normal && force_function && !(sum_N.norm() > 1e-6 * area))
      throw InputError(this->where + " / Direction",
                       "the normals of '" + on + "' have no resultant",
                       "give a vector as direction, or a piece that is not "
                       "closed");

    // Tensor of the second moments of the area about its centroid
    VectorSum<6> second;
    for (const auto &face : faces)
      for (const auto &point : face.points)
        {
          const Tensor<1, 3> r         = in_space<dim>(point.X - centroid);
          const double       a         = point.N.norm() * point.weight;
          const double       values[6] = {a * (r * r - r[0] * r[0]),
                                          a * (r * r - r[1] * r[1]),
                                          a * (r * r - r[2] * r[2]),
                                          -a * r[0] * r[1],
                                          -a * r[0] * r[2],
                                          -a * r[1] * r[2]};
          Tensor<1, 6>       v;
          for (unsigned int i = 0; i < 6; ++i)
            v[i] = values[i];
          second.add(v);
        }
    const Tensor<1, 6>    J = second.total(communicator);
    Tensor<1, 3>          turn; // a = J^{-1} axis
    SymmetricTensor<2, 3> inertia;
    for (unsigned int i = 0; i < 3; ++i)
      inertia[i][i] = J[i];
    inertia[0][1] = J[3];
    inertia[0][2] = J[4];
    inertia[1][2] = J[5];
    if (dim == 2)
      turn[2] = 1. / inertia[2][2];
    else
      turn = invert(inertia) * axis;

    for (auto &face : faces)
      for (auto &point : face.points)
        {
          const double dA = point.N.norm();
          point.q_force   = normal ? Tensor<1, dim>(-point.N / sum_N.norm())
                                   : from_space<dim>(vector) * (dA / area);
          point.q_moment  = from_space<dim>(
            dA * cross_product_3d(turn, in_space<dim>(point.X - centroid)));
          if (!follower)
            continue;
          // Components in the basis of tangents and normal
          const Surface  s = surface(face, point, reference);
          Tensor<2, dim> basis;
          for (unsigned int k = 0; k < dim; ++k)
            for (unsigned int d = 0; d < dim; ++d)
              basis[d][k] = s.basis[k][d];
          const Tensor<2, dim> inverse = invert(basis);
          point.c_force                = inverse * point.q_force;
          point.c_moment               = inverse * point.q_moment;
        }
  }



  template <int dim>
  void
  PieceLoad<dim>::begin_step(const State<dim> &state, const Interval &interval)
  {
    time      = interval.end;
    positions = state.configuration.positions();
    distribute(state);
  }



  template <int dim>
  void
  PieceLoad<dim>::scale_to_total(const State<dim>  &state,
                                 const NodalVector &increment)
  {
    const MPI_Comm communicator = state.configuration.communicator();
    const auto     current      = [&](const types::global_dof_index i) {
      return positions(i) + increment(i);
    };
    VectorSum<dim> forces, places;
    VectorSum<1>   areas;
    for (const auto &face : faces)
      for (const auto &point : face.points)
        {
          const Surface s    = surface(face, point, current);
          const double  area = s.basis[dim - 1].norm() * point.weight;
          areas.add(Point<1>(area));
          places.add(area * s.x);
          forces.add(combine(point.c_force, s) * point.weight);
        }
    force_scale = force_function ? 1. / forces.total(communicator).norm() : 0.;
    const Tensor<1, dim> centroid =
      places.total(communicator) / areas.total(communicator)[0];
    VectorSum<3> moments;
    for (const auto &face : faces)
      for (const auto &point : face.points)
        {
          const Surface s = surface(face, point, current);
          moments.add(
            cross_product_3d(in_space<dim>(s.x - centroid),
                             in_space<dim>(combine(point.c_moment, s))) *
            point.weight);
        }
    moment_scale = 1. / moments.total(communicator).norm();
  }



  template <int dim>
  void
  PieceLoad<dim>::add_forces(const State<dim>     &state,
                             const NodalVector    &increment,
                             const AssemblyTarget &target)
  {
    const double F = force(time), M = moment(time);
    if (follower)
      scale_to_total(state, increment);
    const auto current = [&](const types::global_dof_index i) {
      return positions(i) + increment(i);
    };
    const unsigned int n_dofs = state.configuration.fe.n_dofs_per_cell();
    Vector<double>     forces(n_dofs);
    FullMatrix<double> matrix(n_dofs, n_dofs);
    for (const auto &face : faces)
      {
        forces = 0.;
        matrix = 0.;
        for (const auto &point : face.points)
          {
            if (!follower)
              {
                const Tensor<1, dim> t =
                  (F * point.q_force + M * point.q_moment) * point.weight;
                for (unsigned int i = 0; i < n_dofs; ++i)
                  forces[i] -= point.shapes[node[i]] * t[component[i]];
                continue;
              }
            const Tensor<1, dim> c = (F * force_scale * point.c_force +
                                      M * moment_scale * point.c_moment) *
                                     point.weight;
            const Surface        s = surface(face, point, current);
            const Tensor<1, dim> t = combine(c, s);
            for (unsigned int i = 0; i < n_dofs; ++i)
              forces[i] -= point.shapes[node[i]] * t[component[i]];
            if (target.system == nullptr)
              continue;
            for (unsigned int j = 0; j < n_dofs; ++j)
              {
                // change of the basis with dof j
                std::array<Tensor<1, dim>, dim - 1> dt;
                Tensor<1, dim>                      change;
                for (unsigned int k = 0; k + 1 < dim; ++k)
                  {
                    dt[k][component[j]] =
                      point.gradients[node[j]][(face.direction + 1 + k) % dim];
                    change += c[k] * dt[k];
                  }
                change +=
                  c[dim - 1] *
                  normal_change(s.basis, dt, face.direction, face.outward);
                for (unsigned int i = 0; i < n_dofs; ++i)
                  matrix(i, j) -= point.shapes[node[i]] * change[component[i]];
              }
          }
        if (follower)
          target.add(matrix, forces, face.dofs);
        else // no matrix to add
          for (unsigned int i = 0; i < n_dofs; ++i)
            target.residual(face.dofs[i]) += forces[i];
      }
  }



  template <int dim>
  std::vector<Recorded>
  PieceLoad<dim>::applied(const State<dim> &state) const
  {
    std::vector<Recorded> row;
    if (force_function)
      row.emplace_back("applied force [N]", force(state.time));
    if (moment_function || ratio != 0.)
      row.emplace_back("applied moment [N mm]", moment(state.time));
    return row;
  }



  template class PieceLoad<2>;
  template class PieceLoad<3>;
} // namespace alveolus
