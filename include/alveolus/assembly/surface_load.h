// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_surface_load_h
#define alveolus_assembly_surface_load_h

#include <alveolus/assembly/condition.h>
#include <alveolus/base/expressions.h>

namespace alveolus
{
  /**
   * Dead load on boundaries: a force per area [MPa], as a function of place and
   * time, on the reference shape X = x - u of the boundary. As it knows the
   * material, not the mesh, rezoning and remeshing change it by no more than
   * the transfer of u does.
   */
  template <int dim>
  class TractionCondition : public Condition<dim>
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
    std::string
    describe() const override;

  private:
    struct Parameters
    {
      std::string on;
      std::string function;
    } parameters;

    std::set<dealii::types::boundary_id>         ids;
    std::unique_ptr<dealii::FunctionParser<dim>> function;
    double                                       time = 0.;
    NodalVector reference; ///< X_n = x_n - u_n relative to the mesh's vertices
  };

  /**
   * Follower pressure [MPa] on boundaries: f = - int p N n da on the deformed
   * surface x_n + du, with its exact (unsymmetric) load stiffness. By the
   * parametrised surface x(s): n da = x_,1 x x_,2 ds (3D), the rotated tangent
   * in 2D; Wriggers, Nonlinear Finite Element Methods (2008), section 4.2.5.
   */
  template <int dim>
  class PressureCondition : public Condition<dim>
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
    std::string
    describe() const override;

  private:
    struct Parameters
    {
      std::string on;
      std::string function;
    } parameters;

    std::set<dealii::types::boundary_id>         ids;
    std::unique_ptr<dealii::FunctionParser<dim>> function;
    double                                       time = 0.;
    NodalVector                                  positions; ///< x_n
  };

  /** Union of the boundary ids of a comma separated list. @throws InputError */
  template <int dim>
  std::set<dealii::types::boundary_id>
  boundary_ids(const NamedSets<dim> &names,
               const std::string    &list,
               const std::string    &where);
} // namespace alveolus

#endif
