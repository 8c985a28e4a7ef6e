// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_condition_h
#define alveolus_assembly_condition_h

#include <alveolus/algebra/linear_system.h>
#include <alveolus/base/registry.h>
#include <alveolus/materials/interface_law.h>
#include <alveolus/mesh/nodes.h>
#include <alveolus/state/face_history.h>
#include <alveolus/state/portable_fields.h>
#include <alveolus/state/state.h>

#include <deal.II/base/parameter_handler.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /** The time interval of a step. */
  struct Interval
  {
    double begin = 0.; ///< t_n [T]
    double end   = 0.; ///< t_{n+1} [T]
  };

  /**
   * Prescribed increments of single degrees of freedom, each with the condition
   * it comes from; the same value may be prescribed twice, a different one is
   * an InputError that names both.
   */
  class PrescribedIncrements
  {
  public:
    /**
     * Prescribe the increment of a dof [mm].
     * @param where the condition, in the message
     * @throws InputError if another value has been prescribed
     */
    void
    prescribe(const dealii::types::global_dof_index dof,
              const double                          value,
              const std::string                    &where);

    /** By dof: the increment [mm] and the condition it comes from. */
    const std::map<dealii::types::global_dof_index,
                   std::pair<double, std::string>> &
    all() const
    {
      return values;
    }

  private:
    std::map<dealii::types::global_dof_index, std::pair<double, std::string>>
      values;
  };

  /**
   * Where cell contributions go: the residual (internal minus external forces),
   * the matrix if there is one, and, in the first iteration of a step, minus
   * the matrix times the prescribed increments.
   */
  struct AssemblyTarget
  {
    /** Internal minus external forces [N (per mm)]. */
    NodalVector &residual;
    /** Gets the matrix; null: forces only. */
    LinearSystem *system = nullptr;
    /** With the prescribed increments [mm]; null: none. */
    const dealii::AffineConstraints<double> *lift = nullptr;
    /** Gets minus matrix times these [N (per mm)]. */
    NodalVector *lifted = nullptr;

    /** Add forces and (if there is a system) the matrix of some dofs. */
    void
    add(const dealii::FullMatrix<double>                   &matrix,
        const dealii::Vector<double>                       &forces,
        const std::vector<dealii::types::global_dof_index> &dofs) const;

    /**
     * The same where every process has the same forces and the same matrix, of
     * any dofs: each takes the rows it owns. The dofs that are coupled this way
     * must be among those of Condition::add_couplings().
     */
    void
    add_replicated(
      const dealii::FullMatrix<double>                   &matrix,
      const dealii::Vector<double>                       &forces,
      const std::vector<dealii::types::global_dof_index> &dofs) const;

    /** Minus the matrix times prescribed increments, if that is asked for. */
    void
    add_lifted(const dealii::FullMatrix<double>                   &matrix,
               const std::vector<dealii::types::global_dof_index> &dofs) const;
  };

  /** The scene's interface laws by name. */
  using InterfaceLaws = std::map<std::string, std::unique_ptr<InterfaceLaw>>;

  /**
   * Where the work goes that a body does on the mesh through a layer that is
   * not meshed, in a step, by the trapezoidal rule; of the owned faces [mJ (per
   * mm)].
   */
  struct LayerWork
  {
    double by_body       = 0.; ///< of the body's forces along its motion
    double on_boundary   = 0.; ///< of the layer's forces along the boundary's
    double stored_before = 0.; ///< in the layer, on the area of x_n
    double stored_after  = 0.; ///< the same at the end of the step
  };

  /** A named number for the history file. */
  using Recorded = std::pair<std::string, double>;

  /**
   * A condition on a named boundary, curve or point: prescribes increments of
   * degrees of freedom, adds forces, or both. Conditions are registered; the
   * scene lists them under Conditions / Names.
   */
  template <int dim>
  class Condition
  {
  public:
    virtual ~Condition() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Offer the scene's interface laws by their names. */
    virtual void
    choose_interface_law(const InterfaceLaws & /*laws*/,
                         const std::string & /*where*/)
    {}

    /**
     * Resolve names on the mesh; called at the start and after each remesh.
     * @param where path of the subsection, for messages. @throws InputError
     */
    virtual void
    attach(const State<dim> &state, const std::string &where) = 0;

    /**
     * After a remesh, once attached: go on from the same condition on the old
     * mesh, e.g. with its multipliers. A face_history() is moved by the caller.
     */
    virtual void
    take_over(const Condition<dim> & /*old*/)
    {}

    /** Called before the iterations of each attempt at a step. */
    virtual void
    begin_step(const State<dim> & /*state*/, const Interval & /*interval*/)
    {}

    /** Prescribe increments of relevant degrees of freedom. */
    virtual void
    prescribe(const State<dim> & /*state*/,
              const Interval & /*interval*/,
              PrescribedIncrements & /*increments*/) const
    {}

    /** Subtract external forces (and add minus their derivative). */
    virtual void
    add_forces(const State<dim> & /*state*/,
               const NodalVector & /*increment*/,
               const AssemblyTarget & /*target*/)
    {}

    /**
     * Groups of degrees of freedom, beyond those of one cell, that add_forces()
     * couples with each other, the same on every process; valid from
     * begin_step() on, until couplings_revision() changes.
     */
    virtual void
    add_couplings(DofGroups & /*couplings*/) const
    {}

    /** Changes whenever begin_step() has found other couplings; 0: never any.
     */
    virtual unsigned int
    couplings_revision() const
    {
      return 0;
    }

    /**
     * Newton has converged at @p increment: improve multipliers, if there are
     * any and they are not good enough yet.
     * @return whether they changed, so that the forces are out of balance again
     * @throws RunError if they do not settle; the step is then repeated with a
     *         smaller increment
     */
    virtual bool
    augment(const State<dim> & /*state*/, const NodalVector & /*increment*/)
    {
      return false;
    }

    /** The step is accepted. */
    virtual void
    commit()
    {}

    // For the books of energy:
    /** True if bodies of the mesh exert its forces on each other. */
    virtual bool
    is_contact() const
    {
      return false;
    }
    /** True if the forces are those of a layer that stores energy. */
    virtual bool
    is_layer() const
    {
      return false;
    }
    /** Keep the forces of the last add_forces() as those at t_n. */
    virtual void
    begin_work()
    {}
    /** Of a layer: the work since begin_work(), up to the last add_forces(). */
    virtual LayerWork
    layer_work(const State<dim> & /*state*/,
               const NodalVector & /*increment*/) const
    {
      return {};
    }
    /** Of a layer: what its committed jumps store on the mesh now; owned faces.
     */
    virtual double
    stored_energy(const State<dim> & /*state*/) const
    {
      return 0.;
    }

    /** History on the condition's boundary, to be moved by rezoning; or null.
     */
    virtual FaceHistory<dim> *
    face_history()
    {
      return nullptr;
    }

    /**
     * Put what the next step depends on into blocks whose names begin with
     * @p prefix, for a checkpoint; called between steps (collective). Nothing
     * where parameters and mesh tell everything.
     */
    virtual void
    save(const PortableFields<dim> & /*fields*/,
         const std::string & /*prefix*/,
         BlockFile & /*blocks*/) const
    {}

    /**
     * Get it back, once attached (collective).
     * @throws InputError through BlockFile if something is missing or does not
     * fit
     */
    virtual void
    load(const PortableFields<dim> & /*fields*/,
         const std::string & /*prefix*/,
         const BlockFile & /*blocks*/)
    {}

    /**
     * Quantities of this condition for the history file, with units in their
     * names (collective).
     * @param reactions internal minus external forces at the solution
     */
    virtual std::vector<Recorded>
    record(const State<dim> & /*state*/,
           const NodalVector & /*reactions*/) const
    {
      return {};
    }

    /**
     * What a load applies at the state's time, e.g. "applied force [N]"
     * (collective): these columns of the history file come right after the
     * time, before those of any other force.
     */
    virtual std::vector<Recorded>
    applied(const State<dim> & /*state*/) const
    {
      return {};
    }

    /** One line that says what is modelled, for `--validate`. */
    virtual std::string
    describe() const = 0;

    std::string where; ///< path of the subsection
  };

  /** Owned cells and their faces on a set of boundary ids. */
  template <int dim>
  std::vector<std::pair<typename dealii::DoFHandler<dim>::active_cell_iterator,
                        unsigned int>>
  boundary_faces(const Configuration<dim>                   &configuration,
                 const std::set<dealii::types::boundary_id> &ids);

  /** x,y,z list -> component numbers. @throws InputError */
  std::vector<unsigned int>
  parse_components(const std::string &list,
                   const unsigned int dim,
                   const std::string &where);
} // namespace alveolus

#endif
