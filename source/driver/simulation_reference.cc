// SPDX-License-Identifier: LGPL-2.1-or-later
// The reference map of elastic bodies: what is known of the undeformed body,
// and how the material displacement comes to a rezoned mesh.
#include <alveolus/driver/messages.h>
#include <alveolus/driver/simulation.h>

#include <set>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Relative error of a region's volume at rest that is worth a line. */
    constexpr double noteworthy_volume_error = 1e-3;

    constexpr unsigned int most_halvings = 8;
  } // namespace



  template <int dim>
  void
  Simulation<dim>::begin_reference()
  {
    if (!model->reference_map)
      return;
    const State<dim> &state = *model->state;
    const auto        list  = model->reference_map->region_indices();
    if (resumed && resumed->has("reference outline/pieces"))
      {
        reference_outline = std::make_unique<ReferenceOutline<dim>>(*resumed);
        reference_volumes = resumed->numbers("reference outline/volumes");
        if (reference_volumes.size() != list.size())
          resumed->refuse("reference outline/volumes",
                          "does not hold " + std::to_string(list.size()) +
                            " numbers");
        return;
      }
    if (resumed)
      throw InputError("Regions / Transfer of deformation",
                       "the checkpoint knows nothing of the undeformed body",
                       "run the scene anew");
    reference_outline = std::make_unique<ReferenceOutline<dim>>(
      state.configuration,
      state.history,
      std::set<unsigned int>(list.begin(), list.end()));
    reference_volumes =
      model->reference_map->volumes_at_rest(state.configuration.positions(),
                                            state.displacement);
  }



  template <int dim>
  std::vector<double>
  Simulation<dim>::reference_volume_errors() const
  {
    const State<dim>   &state = *model->state;
    std::vector<double> errors =
      model->reference_map->volumes_at_rest(state.configuration.positions(),
                                            state.displacement);
    for (unsigned int i = 0; i < errors.size(); ++i)
      errors[i] = errors[i] / reference_volumes[i] - 1.;
    return errors;
  }



  template <int dim>
  void
  Simulation<dim>::note_reference_volumes()
  {
    const std::vector<double> errors = reference_volume_errors();
    const auto                list   = model->reference_map->region_indices();
    noted_volume_errors.resize(list.size(), noteworthy_volume_error / 2.);
    for (unsigned int i = 0; i < list.size(); ++i)
      if (!(std::abs(errors[i]) < 2. * noted_volume_errors[i]))
        {
          noted_volume_errors[i] = std::abs(errors[i]);
          log.note("the reference map gives region '" +
                   model->regions[list[i]].name +
                   "' a volume at rest that is "
                   "off by " +
                   number(errors[i], 3) + " of it");
        }
  }



  template <int dim>
  NodalVector
  Simulation<dim>::carry_displacement(Model<dim>        &carried,
                                      const NodalVector &lagrangian,
                                      NodalVector       &rezoned)
  {
    const State<dim> &state    = *carried.state;
    const NodalVector proposed = rezoned;
    double            fraction = 1.;
    std::string       reason;
    for (unsigned int halvings = 0;; ++halvings)
      {
        NodalVector u = state.displacement;
        u.update_ghost_values();
        if (fraction > 0.)
          carried.nodal_transfer->transfer(u, lagrangian, rezoned);
        if (!carried.reference_map || fraction == 0.)
          return u;
        const std::string objection =
          carried.reference_map->admit(*reference_outline, rezoned, u)
            .objection();
        const bool valid =
          halvings == 0 ||
          mesh_quality(state.configuration, rezoned).smallest_scaled_jacobian >
            0.;
        if (objection.empty() && valid)
          {
            if (halvings > 0)
              log.note("rezoning cut back to " + number(fraction) +
                       " of its motion: " + reason);
            return u;
          }
        if (!objection.empty())
          reason = objection;
        if (halvings == 0)
          ++totals.cut_back;
        fraction = halvings < most_halvings ? 0.5 * fraction : 0.;
        for (unsigned int i = 0; i < rezoned.locally_owned_size(); ++i)
          {
            const double x = lagrangian.local_element(i);
            rezoned.local_element(i) =
              fraction == 0. ? x
                             : x + fraction * (proposed.local_element(i) - x);
          }
        rezoned.update_ghost_values();
        if (fraction == 0.)
          log.note("rezoning not done: " + reason);
      }
  }

#define INSTANTIATE(dim)                                                  \
  template void                Simulation<dim>::begin_reference();        \
  template std::vector<double> Simulation<dim>::reference_volume_errors() \
    const;                                                                \
  template void        Simulation<dim>::note_reference_volumes();         \
  template NodalVector Simulation<dim>::carry_displacement(               \
    Model<dim> &, const NodalVector &, NodalVector &);
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
