// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/distributed_force.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  DistributedForce<dim>::DistributedForce()
  {
    this->force_text = "0";
  }



  template <int dim>
  void
  DistributedForce<dim>::declare_parameters(ParameterHandler &prm)
  {
    this->declare_common(prm);
    prm.add_parameter("Force",
                      this->force_text,
                      "Total force F [N, per mm of thickness in 2D], an "
                      "expression in t [T].",
                      Patterns::Anything());
    prm.add_parameter("Direction",
                      this->direction,
                      "normal: a pressure whose resultant has the magnitude F, "
                      "positive if it presses; or a vector such as 1, 0: "
                      "uniform traction along it.",
                      Patterns::Anything());
    prm.add_parameter("Moment-to-force ratio",
                      this->ratio,
                      "Couple that goes with the force on the same piece, per "
                      "force [mm]; in 2D positive anticlockwise.",
                      Patterns::Double());
  }



  template <int dim>
  std::string
  DistributedForce<dim>::describe() const
  {
    return this->on + ": " + (this->follower ? "follower" : "dead") +
           " force of " + this->force_text + " N in all, direction " +
           this->direction;
  }



  template <int dim>
  Couple<dim>::Couple()
  {
    this->moment_text = "0";
  }



  template <int dim>
  void
  Couple<dim>::declare_parameters(ParameterHandler &prm)
  {
    this->declare_common(prm);
    prm.add_parameter("Moment",
                      this->moment_text,
                      "Moment M [N mm, per mm of thickness in 2D], an "
                      "expression in t [T]; in 2D positive anticlockwise.",
                      Patterns::Anything());
  }



  template <int dim>
  std::string
  Couple<dim>::describe() const
  {
    return this->on + ": " + (this->follower ? "follower" : "dead") +
           " couple of " + this->moment_text + " N mm";
  }



  template <int dim>
  void
  PointForce<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Named points, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter(
      "Force",
      text,
      "Force on each of them [N, per mm of thickness in 2D], an "
      "expression in t [T] for each component, separated by "
      "semicolons.",
      Patterns::Anything());
  }



  template <int dim>
  void
  PointForce<dim>::attach(const State<dim> &state, const std::string &path)
  {
    this->where = path;
    function    = parse_function_of_time(text, dim, path + " / Force");
    nodes.clear();
    for (const auto &name : Utilities::split_string_list(on, ','))
      nodes.push_back(state.nodes.point(name, path + " / On"));
  }



  template <int dim>
  Tensor<1, dim>
  PointForce<dim>::force(const double t) const
  {
    Tensor<1, dim> P;
    for (unsigned int d = 0; d < dim; ++d)
      P[d] = function->value(Point<1>(t), d);
    return P;
  }



  template <int dim>
  void
  PointForce<dim>::begin_step(const State<dim> &, const Interval &interval)
  {
    time = interval.end;
  }



  template <int dim>
  void
  PointForce<dim>::add_forces(const State<dim> &state,
                              const NodalVector &,
                              const AssemblyTarget &target)
  {
    const Tensor<1, dim> P = force(time);
    for (const NodeId node : nodes)
      if (state.nodes.is_owned(node))
        for (unsigned int d = 0; d < dim; ++d)
          target.residual(state.nodes.dofs(node)[d]) -= P[d];
  }



  template <int dim>
  std::vector<Recorded>
  PointForce<dim>::applied(const State<dim> &state) const
  {
    return {{"applied force [N]", nodes.size() * force(state.time).norm()}};
  }



  template <int dim>
  std::string
  PointForce<dim>::describe() const
  {
    return on + ": force " + text + " N";
  }

  template class DistributedForce<2>;
  template class DistributedForce<3>;
  template class Couple<2>;
  template class Couple<3>;
  template class PointForce<2>;
  template class PointForce<3>;

  ALVEOLUS_REGISTER_DIM(
    Condition,
    DistributedForce,
    "distributed force",
    "A force of given total F(t) = `Force` on the boundary piece `On`, spread "
    "over its reference shape X = x - u: with `Direction` normal as a pressure "
    "F/|int N dA|, else as a uniform traction F/A0 along the vector. A couple "
    "of `Moment-to-force ratio` times F is added as traction F ratio a x (X - "
    "X_c) about the centroid X_c of the piece. A dead load keeps its direction "
    "and does not depend on the mesh; with `Follower` the tractions turn with "
    "the surface, and the totals stay as given. Writes `applied force [N]` "
    "(and `applied moment [N mm]`) first in the history.")
  ALVEOLUS_REGISTER_DIM(
    Condition,
    Couple,
    "couple",
    "A couple of moment M(t) = `Moment` on the boundary piece `On`, spread over "
    "its reference shape X = x - u as traction M a x (X - X_c), X_c the centroid "
    "of the piece, a such that the moment is M: without resultant. Dead forces "
    "turn by phi with their body and then have the moment M cos(phi); with "
    "`Follower` they turn with the surface and the moment stays M. Writes "
    "`applied moment [N mm]` first in the history.")
  ALVEOLUS_REGISTER_DIM(
    Condition,
    PointForce,
    "point force",
    "A dead force P(t) = `Force` at the nodes of the named points `On`. Writes "
    "`applied force [N]` first in the history.")
} // namespace alveolus
