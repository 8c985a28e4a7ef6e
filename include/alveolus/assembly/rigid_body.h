// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_rigid_body_h
#define alveolus_assembly_rigid_body_h

#include <alveolus/assembly/condition.h>
#include <alveolus/base/expressions.h>

#include <memory>

namespace alveolus
{
  /**
   * A rigid body (a tooth) with prescribed motion that carries a boundary
   * along: x(t) = c + d(t) + R(theta(t)) (X - c). Either tied (the boundary
   * nodes move with it) or through an interface law of zero thickness (theory,
   * section 4): the traction t(j) acts on the boundary, with the jump
   *
   *   j_{n+1} = dR j_n + (x_body(x, t_{n+1}) - x) - du(x)
   *
   * of body minus boundary, kept as history at the face quadrature points. The
   * traction is integrated over the boundary of x_n with the normal of x_n
   * turned with the body, so that it derives from a potential in du. Not
   * modelled: change of the boundary's area within the step.
   *
   * Reports displacement, force and moment (about the moved centre) that the
   * body exerts, per mm of thickness in 2D.
   */
  template <int dim>
  class RigidBody : public Condition<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    choose_interface_law(const InterfaceLaws &laws,
                         const std::string   &where) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    void
    begin_step(const State<dim> &state, const Interval &interval) override;
    void
    prescribe(const State<dim>     &state,
              const Interval       &interval,
              PrescribedIncrements &increments) const override;
    void
    add_forces(const State<dim>     &state,
               const NodalVector    &increment,
               const AssemblyTarget &target) override;
    void
    commit() override;
    bool
    is_layer() const override
    {
      return law != nullptr;
    }
    void
    begin_work() override;
    LayerWork
    layer_work(const State<dim>  &state,
               const NodalVector &increment) const override;
    double
    stored_energy(const State<dim> &state) const override;
    FaceHistory<dim> *
    face_history() override
    {
      return jumps.get();
    }
    void
    save(const PortableFields<dim> &fields,
         const std::string         &prefix,
         BlockFile                 &blocks) const override;
    void
    load(const PortableFields<dim> &fields,
         const std::string         &prefix,
         const BlockFile           &blocks) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;
    std::string
    describe() const override;

  private:
    struct Parameters
    {
      std::string on;
      std::string motion;
      std::string rotation   = "0";
      std::string centre     = "0, 0, 0";
      std::string axis       = "0, 0, 1";
      std::string attachment = "tied";
    } parameters;

    /** Geometry of a face point of x_n. */
    struct FacePoint
    {
      std::vector<double>  shapes; ///< of all dofs of the cell
      double               weight = 0.;
      dealii::Tensor<1, 3> normal;
      dealii::Point<dim>   x;
      dealii::Tensor<1, 3> traction; ///< on the boundary, last add_forces()
    };
    struct LoadedFace
    {
      typename dealii::DoFHandler<dim>::active_cell_iterator cell;
      std::vector<dealii::types::global_dof_index>           dofs;
      std::vector<FacePoint>                                 points;
    };

    dealii::Tensor<1, 3>
    displacement(const double t) const;
    dealii::Tensor<2, 3>
    rotation(const double t) const;
    /** Displacement of the body's point @p x (at t_n) during the step. */
    dealii::Tensor<1, 3>
    carried(const dealii::Point<dim> &x, const Interval &interval) const;

    std::set<dealii::types::boundary_id>       ids;
    std::vector<NodeId>                        nodes; ///< tied ones
    std::unique_ptr<dealii::FunctionParser<1>> motion, angle;
    dealii::Tensor<1, 3>                       centre, axis;
    const InterfaceLaw                        *law = nullptr;
    std::unique_ptr<FaceHistory<dim>>          jumps;
    std::vector<LoadedFace>                    faces;
    Interval                                   step;
    dealii::Tensor<1, 3>                       force, moment; ///< last assembly
    double smallest_strain = 0., largest_strain = 0., largest_shear = 0.;

    /** Stored in the layer by the last add_forces(), owned [mJ (per mm)]. */
    double stored = 0.;
    /** Of begin_work(), in the order of faces and points. */
    std::vector<dealii::Tensor<1, 3>> tractions_before;
    double                            stored_before = 0.;
  };
} // namespace alveolus

#endif
