// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/tensors.h>
#include <alveolus/driver/messages.h>
#include <alveolus/driver/state_check.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Beyond this a logarithmic strain is no strain: a stretch of 5e8. */
    constexpr double largest_strain = 20.;
    /** By which a bound may be missed by round-off, relative and absolute. */
    constexpr double tolerance = 1e-9;

    /** By how much the field at @p values is beyond its bounds; 0: within. */
    double
    excess(const HistoryField &field,
           const double       *values,
           const unsigned int  dim)
    {
      const auto beyond = [&](const double least, const double greatest) {
        return std::max(std::isfinite(field.lower) ? field.lower - least : 0.,
                        std::isfinite(field.upper) ? greatest - field.upper
                                                   : 0.);
      };
      if (field.shape == HistoryField::Shape::scalar)
        return beyond(values[0], values[0]);
      const SymmetricTensor<2, 3> tensor = unpack(values, dim);
      double worst = field.traceless ? std::abs(trace(tensor)) : 0.;
      // The norm bounds the eigenvalues: only where it does not help are they
      // needed.
      const double norm = tensor.norm();
      if (norm > std::min(-field.lower, field.upper))
        {
          const auto eigenvalues = spectral(tensor).values;
          worst                  = std::max(
            worst,
            beyond(std::min({eigenvalues[0], eigenvalues[1], eigenvalues[2]}),
                   std::max({eigenvalues[0], eigenvalues[1], eigenvalues[2]})));
        }
      return worst;
    }
  } // namespace



  template <int dim>
  StateFindings
  check_state(const State<dim>          &state,
              const std::vector<Region> &regions,
              const bool                 trial)
  {
    const auto   &history = state.history;
    StateFindings found;
    double        worst = tolerance;
    for (const auto &cell :
         state.configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int   c      = cell->active_cell_index();
          const Region        &region = regions[history.region(c)];
          const HistoryLayout &layout = history.layout(history.region(c));
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              const double *record =
                trial ? history.trial_record(c, q) : history.old_record(c, q);
              std::string problem;
              for (unsigned int i = 0; i < layout.size; ++i)
                if (!std::isfinite(record[i]))
                  problem = "history that is not a finite number";
              const double J = region.material->volume_ratio(record);
              if (problem.empty() &&
                  !(std::abs(std::log(J)) < 3. * largest_strain))
                problem = "a volume ratio of " + number(J);
              bool beyond = false;
              for (unsigned int f = 0;
                   f < layout.fields.size() && problem.empty();
                   ++f)
                {
                  const HistoryField &field  = layout.fields[f];
                  const double       *values = record + layout.offsets[f];
                  if (field.shape == HistoryField::Shape::symmetric_tensor &&
                      field.unit.empty() &&
                      !(unpack(values, dim).norm() < 2. * largest_strain))
                    {
                      problem = "a logarithmic strain or fabric of " +
                                number(unpack(values, dim).norm());
                      break;
                    }
                  const double by = excess(field, values, dim);
                  beyond          = beyond || by > tolerance;
                  if (by > worst)
                    {
                      worst       = by;
                      found.worst = "'" + field.name + "' in region '" +
                                    region.name + "' by " + number(by);
                    }
                }
              found.n_beyond_bounds += beyond;
              if (!problem.empty() && found.garbage.empty())
                {
                  std::ostringstream text;
                  text << "region '" << region.name << "' has " << problem
                       << " in the element whose undeformed centre is ("
                       << cell->center() << ") mm";
                  found.garbage = text.str();
                }
            }
        }
    const MPI_Comm     communicator = state.configuration.communicator();
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n  = Utilities::MPI::n_mpi_processes(communicator);
    found.n_beyond_bounds =
      Utilities::MPI::sum(found.n_beyond_bounds, communicator);
    // The messages of the lowest process that has one are everybody's.
    for (std::string *text : {&found.garbage, &found.worst})
      {
        const unsigned int first =
          Utilities::MPI::min(text->empty() ? n : me, communicator);
        if (first < n)
          *text = Utilities::MPI::broadcast(communicator, *text, first);
      }
    return found;
  }

  template StateFindings
  check_state(const State<2> &, const std::vector<Region> &, const bool);
  template StateFindings
  check_state(const State<3> &, const std::vector<Region> &, const bool);
} // namespace alveolus
