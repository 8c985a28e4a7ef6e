// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_distributed_force_h
#define alveolus_assembly_distributed_force_h

#include <alveolus/assembly/piece_load.h>

namespace alveolus
{
  /**
   * A force of given total on a boundary piece, with the couple of a
   * moment-to-force ratio if wanted; see PieceLoad.
   */
  template <int dim>
  class DistributedForce : public PieceLoad<dim>
  {
  public:
    DistributedForce();
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    std::string
    describe() const override;
  };

  /** A couple of given moment on a boundary piece; see PieceLoad. */
  template <int dim>
  class Couple : public PieceLoad<dim>
  {
  public:
    Couple();
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    std::string
    describe() const override;
  };

  /**
   * A dead force at a node: components P(t) [N, per mm of thickness in 2D] on
   * the nodes of named points. In the continuum the displacement under a point
   * force is infinite: use it where only what it does farther away matters.
   * The points are nodes of the mesh that stay with the material.
   */
  template <int dim>
  class PointForce : public Condition<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    void
    begin_step(const State<dim> &state, const Interval &interval) override;
    void
    add_forces(const State<dim>     &state,
               const NodalVector    &increment,
               const AssemblyTarget &target) override;
    /** "applied force [N]": magnitude of the sum over the points. */
    std::vector<Recorded>
    applied(const State<dim> &state) const override;
    std::string
    describe() const override;

  private:
    /** P at the time @p t. */
    dealii::Tensor<1, dim>
    force(const double t) const;

    std::string                                on, text;
    std::unique_ptr<dealii::FunctionParser<1>> function;
    std::vector<NodeId>                        nodes;
    double                                     time = 0.;
  };
} // namespace alveolus

#endif
