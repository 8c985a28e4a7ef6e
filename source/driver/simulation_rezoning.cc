// SPDX-License-Identifier: LGPL-2.1-or-later
// Rezoning: when, and how the state is carried to the moved mesh.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  Simulation<dim>::rezone_if_due(const NodalVector &start)
  {
    swept_fraction                = 0.;
    const RezoningPlan &plan      = scene.rezoning_plan;
    double              remaining = 1.;
    if (plan.asks_for_quality())
      remaining = model->quality().smallest_scaled_jacobian;
    if (!plan.due(totals.steps, remaining))
      {
        ++totals.skipped_rezonings;
        if (!rezoning_start)
          {
            rezoning_start = std::make_unique<NodalVector>(start);
            rezoning_start->update_ghost_values();
          }
        return;
      }
    rezone(*model, rezoning_start ? *rezoning_start : start, true);
    rezoning_start.reset();
  }



  template <int dim>
  void
  Simulation<dim>::rezone(Model<dim>        &rezoned_model,
                          const NodalVector &start,
                          const bool         booked)
  {
    State<dim>       &state      = *rezoned_model.state;
    const NodalVector lagrangian = state.configuration.positions();
    rezoning_report              = RezoningReport();
    NodalVector rezoned;
    {
      TimerOutput::Scope scope(timer, "rezoning");
      rezoned = rezoned_model.rezoner->propose(state.nodes,
                                               start,
                                               lagrangian,
                                               rezoning_report);
    }
    if (rezoning_report.cut_back)
      {
        ++totals.cut_back;
        log.note("rezoning cut back to " + number(rezoning_report.fraction) +
                 " of its motion, it would have inverted elements");
      }
    if (rezoning_report.unconverged_rules > 0)
      {
        ++totals.unconverged_rezonings;
        log.note("rezoning did not converge in " +
                 std::to_string(rezoning_report.sweeps) + " sweeps");
      }
    if (rezoning_report.largest_motion == 0.)
      return;

    TimerOutput::Scope        scope(timer, "transfer");
    const std::vector<double> history      = state.history.old_values;
    const NodalVector         displacement = state.displacement;
    const NodalVector         mesh_displacement =
      state.configuration.mesh_displacement();
    std::vector<std::vector<double>> faces;
    for (auto &condition : rezoned_model.conditions)
      faces.push_back(condition->face_history() == nullptr
                        ? std::vector<double>()
                        : condition->face_history()->old_values);
    try
      {
        // First, since it may cut the rezoning back
        state.displacement =
          carry_displacement(rezoned_model, lagrangian, rezoned);
        state.displacement.update_ghost_values();
        const TransferReport report =
          rezoned_model.swept_transfer->transfer(state.history,
                                                 lagrangian,
                                                 rezoned);
        for (auto &condition : rezoned_model.conditions)
          if (condition->face_history() != nullptr)
            rezoned_model.face_transfer->transfer(*condition->face_history(),
                                                  lagrangian,
                                                  rezoned);
        state.configuration.set_positions(rezoned);

        totals.limited +=
          report.n_limited + rezoned_model.make_history_admissible();
        totals.subcycles += report.n_subcycles;
        scope.stop();
        if (booked)
          {
            swept_fraction = report.swept_fraction;
            check_committed(rezoned_model);
            TimerOutput::Scope books(timer, "monitor");
            if (bone_mass)
              bone_mass->book_transfer(state, report);
            if (energy_books)
              energy_books->book_transfer(rezoned_model);
            if (reference_outline)
              note_reference_volumes();
          }
      }
    catch (const RunError &)
      {
        // As if the step had not been rezoned
        state.history.old_values = history;
        state.displacement       = displacement;
        state.displacement.update_ghost_values();
        state.configuration.set_mesh_displacement(mesh_displacement);
        for (unsigned int i = 0; i < faces.size(); ++i)
          if (rezoned_model.conditions[i]->face_history() != nullptr)
            rezoned_model.conditions[i]->face_history()->old_values = faces[i];
        throw;
      }
  }

#define INSTANTIATE(dim)                                             \
  template void Simulation<dim>::rezone_if_due(const NodalVector &); \
  template void Simulation<dim>::rezone(Model<dim> &,                \
                                        const NodalVector &,         \
                                        const bool);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
