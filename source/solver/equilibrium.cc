// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/adaptive_tolerance.h>
#include <alveolus/solver/equilibrium.h>
#include <alveolus/solver/round_off.h>

#include <deal.II/dofs/dof_tools.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * Ratio of the pivots below which a failure may have its cause in the
     * matrix: a few times round-off. Regular matrices of very different
     * stiffnesses may reach it, too, so that it only explains failures.
     */
    constexpr double nearly_singular = 1e-14;

    /**
     * Residual asked of an iterative linear solver, relative to the right hand
     * side: small enough not to be felt by Newton's method (choice 2 of
     * Eisenstat & Walker, SIAM J. Sci. Comput. 17 (1996) 16-32), and far below
     * the residual at which Newton's method ends.
     * @param norm, last_norm nonlinear residual now and before the last
     *        correction; 0 if there was none
     * @param enough residual at which Newton's method ends
     */
    double
    linear_tolerance(const double norm,
                     const double last_norm,
                     const double enough)
    {
      constexpr double largest = 1e-2;
      const double     ratio   = last_norm > 0. ? norm / last_norm : 1.;
      return std::max(std::min(largest, 0.5 * ratio * ratio),
                      1e-2 * enough / norm);
    }
  } // namespace

  template <int dim>
  void
  Equilibrium<dim>::Parameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Newton stops when the sum of |residual forces| is below "
                      "this part of the sum of |internal nodal forces|.",
                      Patterns::Double(1e-15, 1e-2));
    prm.add_parameter("Absolute tolerance",
                      absolute_tolerance,
                      "... or below this force [N per mm of thickness].",
                      Patterns::Double(0.));
    prm.add_parameter("Maximum iterations",
                      max_iterations,
                      "Newton iterations after which a step is repeated with a "
                      "smaller increment.",
                      Patterns::Integer(1, 1000));
    prm.add_parameter("Maximum line search steps",
                      max_line_search,
                      "Halvings of a Newton step that does not reduce the "
                      "residual.",
                      Patterns::Integer(0, 50));
    prm.add_parameter(
      "Predictor",
      predictor,
      "First guess of an increment: the last one, scaled by the "
      "step (extrapolated), or the solution of the linearised "
      "problem (linear).",
      Patterns::Selection("extrapolated|linear"));
    prm.add_parameter("Report imbalance",
                      report_imbalance,
                      "Record how far the state before a step is from "
                      "equilibrium, e.g. after a transfer (costs one assembly "
                      "of forces).",
                      Patterns::Bool());
    prm.add_parameter(
      "Linear solver",
      linear_solver,
      "automatic is UMFPACK on one process, MUMPS on several; "
      "multigrid is CG with algebraic multigrid (Trilinos ML, rigid "
      "motions as near null space), for large meshes in 3D; "
      "multigrid GMRES for matrices that are not symmetric. "
      "Where the iteration fails, MUMPS takes over, which the "
      "log tells.",
      Patterns::Selection("automatic|UMFPACK|MUMPS|multigrid|"
                          "multigrid GMRES"));
    prm.add_parameter(
      "Linear tolerance",
      linear_tolerance,
      "Relative residual at which iterative linear solvers stop; earlier in "
      "Newton iterations that are still far from the solution.",
      Patterns::Double(1e-15, 0.1));
  }



  template <int dim>
  Equilibrium<dim>::Equilibrium(
    State<dim>                                   &state,
    const std::vector<Region>                    &regions,
    typename MechanicsAssembler<dim>::Conditions &conditions,
    const Parameters                             &parameters,
    TimerOutput                                  &timer)
    : increment(state.configuration.make_vector())
    , state(state)
    , conditions(conditions)
    , parameters(parameters)
    , timer(timer)
    , assembler(state, regions, conditions)
    , hanging(state.configuration)
    , residual_vector(state.configuration.make_vector())
    , lifted(state.configuration.make_vector())
  {
    // Which dofs are constrained does not change in time, only their values.
    const Interval now{state.time, state.time};
    for (auto &condition : conditions)
      condition->begin_step(state, now);
    update_system(now);
  }



  template <int dim>
  bool
  Equilibrium<dim>::augment()
  {
    bool changed = false;
    for (auto &condition : conditions)
      changed = condition->augment(state, increment) || changed;
    return changed;
  }



  template <int dim>
  bool
  Equilibrium<dim>::expect_convergence(const std::vector<double> &residuals,
                                       const std::size_t          first)
  {
    // Near the solution r_{k+1} = c r_k^2; c of the last two, or of the step
    // before. A wrong guess costs an evaluation of the forces, no accuracy.
    const std::size_t n = residuals.size();
    if (n > first + 1 && residuals[n - 2] > 0.)
      contraction = residuals[n - 1] / std::pow(residuals[n - 2], 2);
    return contraction > 0. && contraction * std::pow(residuals.back(), 2) <
                                 0.1 * parameters.tolerance;
  }



  template <int dim>
  AssemblyResult
  Equilibrium<dim>::assemble(const NodalVector &du,
                             const bool         matrix,
                             const bool         lift)
  {
    TimerOutput::Scope   scope(timer, "assembly");
    const AssemblyResult result =
      assembler.assemble(du,
                         AssemblyTarget{residual_vector,
                                        matrix ? system.get() : nullptr,
                                        lift ? &prescribed : nullptr,
                                        lift ? &lifted : nullptr});
    hanging.condense(residual_vector);
    if (lift)
      hanging.condense(lifted);
    if (held_imbalance != nullptr)
      residual_vector.add(-held_imbalance->part, held_imbalance->forces);
    return result;
  }



  template <int dim>
  double
  Equilibrium<dim>::round_off_residual()
  {
    NodalVector here(residual_vector);
    here.zero_out_ghost_values();
    NodalVector moved = round_off_displacement(state.configuration);
    hanging.distribute(moved);
    moved.zero_out_ghost_values();
    increment.zero_out_ghost_values();
    moved += increment;
    moved.update_ghost_values();
    increment.update_ghost_values();
    const bool good = assemble(moved, false, false).good;
    residual_vector.zero_out_ghost_values();
    residual_vector -= here;
    const double norm = good ? free_norm(residual_vector) : 0.;
    assemble(increment, false, false); // its history again
    return norm;
  }



  template <int dim>
  AssemblyResult
  Equilibrium<dim>::assemble_without_increment()
  {
    NodalVector none(state.configuration.make_vector());
    none.update_ghost_values();
    return assemble(none, false, false);
  }



  template <int dim>
  AssemblyResult
  Equilibrium<dim>::assemble_committed()
  {
    const Interval now{state.time, state.time};
    held_imbalance = nullptr;
    assembler.begin_step(now);
    set_constraints(now);
    return assemble_without_increment();
  }



  template <int dim>
  typename Equilibrium<dim>::Imbalance
  Equilibrium<dim>::imbalance(const double t, double &relative)
  {
    const Interval now{t, t};
    held_imbalance = nullptr;
    assembler.begin_step(now);
    set_constraints(now);
    const AssemblyResult result = assemble_without_increment();
    if (!result.good)
      throw RunError("Remeshing", result.reason, "try other densities");
    Imbalance found{state.configuration.make_vector(), 1.};
    found.forces.zero_out_ghost_values();
    found.forces = residual_vector;
    relative =
      free_norm(residual_vector) / std::max(result.force_scale, 1e-300);
    return found;
  }



  template <int dim>
  Verdict
  Equilibrium<dim>::solve(const Interval    &interval,
                          EquilibriumReport &report,
                          const Imbalance   *held)
  {
    held_imbalance    = held;
    bool       solved = false;
    const auto repeat = [&](const std::string &reason,
                            const std::string &cause) {
      // A body that nothing holds goes anywhere: what comes of it is no cause.
      const bool singular = solved && system->pivot_ratio() < nearly_singular;
      return Verdict{Verdict::Kind::repeat,
                     reason + (singular ? " (the matrix is singular but for "
                                          "round-off: check that the "
                                          "conditions hold every body)"
                                        : ""),
                     cause};
    };
    assembler.begin_step(interval);
    update_system(interval);
    if (system->is_iterative())
      system->set_positions(state.configuration.positions());
    const unsigned int n_replaced = system->n_replaced();
    const auto        &owned      = state.configuration.locally_owned;
    NodalVector        correction(state.configuration.make_vector());
    NodalVector        trial(state.configuration.make_vector());

    if (parameters.report_imbalance)
      {
        // Without increment the residual is what the last step left, what
        // transfers did to it, and the change of the loads.
        const AssemblyResult before = assemble_without_increment();
        if (before.good && before.force_scale > 0.)
          report.imbalance = free_norm(residual_vector) / before.force_scale;
      }

    // The first guess. An extrapolation that folds the mesh is given up for
    // the linearised problem, which only needs the last state.
    bool           lift = true;
    AssemblyResult result;
    increment.zero_out_ghost_values();
    if (held != nullptr)
      {
        increment = 0.;
        increment.update_ghost_values();
        result = assemble(increment, true, false);
        lift   = false;
        if (!result.good)
          return repeat(result.reason, "material or mesh");
      }
    else if (parameters.predictor == "extrapolated" && state.last_step > 0.)
      {
        increment = state.increment;
        increment.zero_out_ghost_values();
        increment *= (interval.end - interval.begin) / state.last_step;
        for (const auto i : owned)
          if (prescribed.is_constrained(i))
            increment(i) = prescribed.get_inhomogeneity(i);
        increment.update_ghost_values();
        hanging.distribute(increment);
        result = assemble(increment, true, false);
        lift   = !result.good;
      }
    if (lift)
      {
        increment.zero_out_ghost_values();
        increment = 0.;
        increment.update_ghost_values();
        result = assemble(increment, true, true);
        if (!result.good)
          return repeat(result.reason, "material or mesh");
      }

    // No residual is better than what round-off makes; where it stagnates
    // within ten times that, it has converged. Measured once, where needed.
    double     round_off    = -1.;
    const auto is_round_off = [&](const double norm, const std::size_t first) {
      if (!stagnates(report.residuals, first))
        return false;
      if (round_off < 0.)
        round_off = round_off_residual();
      return norm <= 10. * round_off;
    };

    unsigned int n_before_augmentation = 0;
    double       last_norm             = 0.;
    bool         have_matrix           = true;
    std::size_t  first                 = lift ? 1 : 0; // of Newton's residuals
    for (;;)
      {
        const double norm  = free_norm(residual_vector);
        const double scale = std::max(result.force_scale, 1e-300);
        report.residuals.push_back(norm / scale);
        report.energy       = result.energy;
        report.energy_moved = result.energy_moved;
        report.dissipation  = result.dissipation;
        report.force_scale  = result.force_scale;
        if (!std::isfinite(norm))
          return repeat("the residual is not a finite number", "Newton");
        const bool small = norm <= parameters.tolerance * result.force_scale ||
                           norm <= parameters.absolute_tolerance;
        const bool at_round_off = !lift && !small && is_round_off(norm, first);
        if (at_round_off)
          report.round_off = round_off / scale;
        if (!lift && (small || at_round_off))
          {
            expect_convergence(report.residuals, first); // learns from it
            try
              {
                if (!augment())
                  return Verdict{};
              }
            catch (const RunError &error)
              {
                return repeat(error.what(), "contact");
              }
            ++report.n_augmentations;
            n_before_augmentation = report.n_iterations;
            first                 = report.residuals.size();
            have_matrix           = true;
            result                = assemble(increment, true, false);
            if (!result.good)
              return repeat(result.reason, "material or mesh");
            continue;
          }
        const unsigned int n = report.n_iterations - n_before_augmentation;
        if (n >= parameters.max_iterations)
          return repeat("Newton did not converge in " + std::to_string(n) +
                          " iterations (residual " +
                          Utilities::to_string(norm / scale) + ")" +
                          (round_off > 0.
                             ? "; round-off alone makes " +
                                 Utilities::to_string(round_off / scale)
                             : ""),
                        "Newton");

        if (!have_matrix)
          {
            ++report.n_late_matrices;
            have_matrix = true;
            result      = assemble(increment, true, false);
          }
        const bool last = !lift && expect_convergence(report.residuals, first);
        residual_vector *= -1.;
        if (lift)
          residual_vector += lifted;
        else if (auto *adaptive =
                   dynamic_cast<AdaptiveTolerance *>(system.get()))
          adaptive->ask(
            linear_tolerance(norm,
                             last_norm,
                             std::max(parameters.tolerance * result.force_scale,
                                      parameters.absolute_tolerance)));
        last_norm = lift ? 0. : norm;
        {
          TimerOutput::Scope scope(timer, "linear solver");
          try
            {
              system->solve(correction, residual_vector);
              solved = true;
            }
          catch (const RunError &error)
            {
              return repeat(error.what(), "linear solver");
            }
        }
        ++report.n_iterations;
        report.n_linear_iterations += system->n_iterations();
        report.linear_residual =
          std::max(report.linear_residual, system->residual());
        report.n_direct_instead = system->n_replaced() - n_replaced;
        if (lift)
          {
            correction.zero_out_ghost_values();
            for (const auto i : owned)
              if (prescribed.is_constrained(i))
                correction(i) = prescribed.get_inhomogeneity(i);
            correction.update_ghost_values();
            hanging.distribute(correction);
          }

        // Backtracking: the full step is assembled with its matrix at once,
        // because it is nearly always taken, unless it is expected to be the
        // last: then the forces alone tell. The first, inhomogeneous step
        // cannot be shortened (it would miss the prescribed values), only
        // judged. A step is good if the residual falls or its work along the
        // step does: with a stiff bulk a good step raises the norm for an
        // iteration, through volume changes of second order.
        const double work     = free_work(correction, residual_vector);
        double       fraction = 1.;
        unsigned int halvings = 0;
        for (;; ++halvings)
          {
            trial.zero_out_ghost_values();
            trial = increment;
            trial.zero_out_ghost_values();
            trial.add(fraction, correction);
            trial.update_ghost_values();
            have_matrix = !(last && halvings == 0);
            result      = assemble(trial, have_matrix, false);
            if (result.good &&
                (lift ||
                 free_norm(residual_vector) < (1. - 1e-4 * fraction) * norm ||
                 free_norm(residual_vector) <=
                   parameters.tolerance * result.force_scale ||
                 std::abs(free_work(correction, residual_vector)) <
                   0.5 * std::abs(work) ||
                 halvings == parameters.max_line_search))
              break;
            if (lift || halvings == parameters.max_line_search)
              return repeat(result.reason, "material or mesh");
            fraction /= 2.;
          }
        report.n_line_search += halvings;
        increment.zero_out_ghost_values();
        increment = trial;
        increment.update_ghost_values();
        lift = false;
      }
  }

  template class Equilibrium<2>;
  template class Equilibrium<3>;
} // namespace alveolus
