// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_equilibrium_h
#define alveolus_solver_equilibrium_h

#include <alveolus/assembly/mechanics_assembler.h>
#include <alveolus/base/verdict.h>
#include <alveolus/mesh/hanging_nodes.h>

#include <deal.II/base/timer.h>

#include <memory>
#include <vector>

namespace alveolus
{
  /** What the solution of one increment took. */
  struct EquilibriumReport
  {
    unsigned int        n_iterations = 0; ///< linear systems solved
    std::vector<double> residuals; ///< L1 norm over the sum of internal forces
    unsigned int        n_line_search = 0; ///< halvings of the Newton step
    unsigned int        n_linear_iterations = 0;  ///< of all linear systems
    double              linear_residual     = 0.; ///< relative, the largest
    unsigned int        n_direct_instead    = 0;  ///< failed iterations
    unsigned int        n_augmentations     = 0;  ///< of multipliers
    /** Iterations after the one that was expected to be the last. */
    unsigned int n_late_matrices = 0;
    double       energy          = 0.; ///< stored [mJ (per mm)]
    double       energy_moved    = 0.; ///< on the moved mesh, see CellKernel
    double dissipation = 0.; ///< plastic work of the increment [mJ (per mm)]
    double force_scale = 0.; ///< see AssemblyResult
    /** If it ended there: what round-off makes of the residual, relative. */
    double round_off = 0.;
    /** L1 norm of the residual before the step over the internal forces. */
    double imbalance = 0.;
  };

  /**
   * Static equilibrium of one increment by Newton's method with backtracking.
   * The prescribed increments enter through the first linear system (which sees
   * the tangent of the last state) or an extrapolation of the last increment;
   * after that only unconstrained dofs change. Where a condition has
   * multipliers, Newton's method is repeated until they have settled. Where the
   * residual no longer falls and is what round-off makes (nearly incompressible
   * or very different materials), it ends above the tolerance, which the report
   * tells. Writes trial history only.
   */
  template <int dim>
  class Equilibrium
  {
  public:
    struct Parameters
    {
      /** Of the residual, over the sum of internal forces [-]. */
      double       tolerance          = 1e-9;
      double       absolute_tolerance = 1e-10; ///< or below this [N (per mm)]
      unsigned int max_iterations     = 15;    ///< Newton's steps, at most
      unsigned int max_line_search    = 6; ///< halvings of one of them, at most
      /** "extrapolated" or "linear": the first guess. */
      std::string predictor        = "extrapolated";
      bool        report_imbalance = false; ///< of the state before the step
      /** "automatic", "direct", "cg" or "gmres". */
      std::string linear_solver = "automatic";
      /** Of iterative solvers, relative [-]. */
      double linear_tolerance = 1e-10;

      /**
       * Add the parameters, bound to the members, to the current subsection.
       */
      void
      declare(dealii::ParameterHandler &prm);
    };

    /**
     * @param regions by index, as in the history
     * @param timer of the phases of a step; all must outlive this object
     */
    Equilibrium(State<dim>                                   &state,
                const std::vector<Region>                    &regions,
                typename MechanicsAssembler<dim>::Conditions &conditions,
                const Parameters                             &parameters,
                dealii::TimerOutput                          &timer);

    /** Nodal forces a remesh left unbalanced, and the part still held. */
    struct Imbalance
    {
      NodalVector forces;    ///< internal minus external [N (per mm)]
      double      part = 1.; ///< that is still held: from 1 to 0
    };

    /**
     * Solve for the increment of @p interval, from the committed state.
     * On success `increment` holds du and the trial history belongs to it.
     * @param held if not null: the residual has to equal held->part times
     *        held->forces instead of zero, and the first guess is no increment
     */
    Verdict
    solve(const Interval    &interval,
          EquilibriumReport &report,
          const Imbalance   *held = nullptr);

    /**
     * The residual of the committed state under the loads of time @p t: what a
     * transfer left unbalanced.
     * @param relative its L1 norm over the internal forces
     * @throws RunError if the state gives no valid stress
     */
    Imbalance
    imbalance(const double t, double &relative);

    /**
     * Assemble the forces of the committed state under the loads of its time:
     * where the work of a step begins. They are in assembly().internal_forces
     * and residual() until the next solve().
     */
    AssemblyResult
    assemble_committed();

    /** Whether a condition prescribes this dof, or it hangs. */
    bool
    is_held(const dealii::types::global_dof_index dof) const
    {
      return held.is_constrained(dof);
    }

    NodalVector increment; ///< du [mm], ghosted

    /** Internal minus external forces at the solution: reactions [N (per mm)].
     */
    const NodalVector &
    residual() const
    {
      return residual_vector;
    }

    /** Forces and tangent of the last iteration. */
    const MechanicsAssembler<dim> &
    assembly() const
    {
      return assembler;
    }

    /** See MechanicsAssembler. */
    void
    keep_moved_weights()
    {
      assembler.keep_moved_weights();
    }

    /** Whether the linear solver iterates. */
    bool
    solves_by_iteration() const
    {
      return system->is_iterative();
    }

    /** What solves the linear systems, for the log. */
    std::string
    linear_solver_name() const
    {
      return system->name();
    }

    /** The matrix and its solver, for what they tell. */
    LinearSystem &
    linear_system()
    {
      return *system;
    }

  private:
    void
    set_constraints(const Interval &interval);
    /** Tell all processes of the constraints of coupled dofs (collective). */
    void
    share_constraints();
    /** Set the constraints and make the matrix, anew if conditions couple other
     * dofs than before. */
    void
    update_system(const Interval &interval);
    /** Let the conditions improve their multipliers; whether any did. */
    bool
    augment();
    double
    free_norm(const NodalVector &v) const;
    /** Scalar product over the unconstrained dofs. */
    double
    free_work(const NodalVector &u, const NodalVector &v) const;
    AssemblyResult
    assemble(const NodalVector &du, const bool matrix, const bool lift);
    /** Whether one more iteration should do, from the residuals so far. */
    bool
    expect_convergence(const std::vector<double> &residuals,
                       const std::size_t          first);
    /**
     * L1 norm of what round-off of the displacements makes of the residual, at
     * the increment and its residual; leaves both as they are.
     */
    double
    round_off_residual();
    /** Residual without increment under the loads already begun. */
    AssemblyResult
    assemble_without_increment();

    State<dim>                                   &state;
    typename MechanicsAssembler<dim>::Conditions &conditions;
    const Parameters                             &parameters;
    dealii::TimerOutput                          &timer;
    MechanicsAssembler<dim>                       assembler;
    dealii::AffineConstraints<double> prescribed; ///< with inhomogeneities
    dealii::AffineConstraints<double> held;       ///< the same, homogeneous
    std::unique_ptr<LinearSystem>     system;
    std::vector<unsigned int> coupled; ///< revisions the system was made for
    /** On several processes: dofs of add_couplings(), ascending. */
    std::vector<dealii::types::global_dof_index> coupled_dofs;
    HangingNodes<dim>                            hanging;
    NodalVector                                  residual_vector;
    NodalVector                                  lifted;
    const Imbalance                             *held_imbalance = nullptr;
    /** c of r_{k+1} = c r_k^2 for relative residuals; 0 is unknown. */
    double contraction = 0.;
  };
} // namespace alveolus

#endif
