// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/field_bounds.h>
#include <alveolus/transfer/swept_transfer.h>

#include <cmath>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * Violation of the geometric conservation law that means a wrong face, far
     * above the round-off of very flat cells and far below any real mistake.
     */
    constexpr double largest_conservation_error = 1e-9;

    /** More sub-cycles than this are a wandering mesh, not a rezoning. */
    constexpr unsigned int most_subcycles = 10000;
  } // namespace

  template <int dim>
  SweptTransfer<dim>::SweptTransfer(const Configuration<dim> &configuration,
                                    const HistoryStore<dim>  &store,
                                    std::unique_ptr<TransferScheme<dim>> scheme,
                                    const std::string &content_field,
                                    const double       largest_donor_fraction)
    : configuration(configuration)
    , cells(configuration,
            [&store](const unsigned int c) { return store.region(c); })
    , scheme(std::move(scheme))
    , content_field(content_field)
    , largest_donor_fraction(largest_donor_fraction)
  {
    if (store.n_points != cells.n_points)
      throw RunError("Transfer",
                     "the history has " + std::to_string(store.n_points) +
                       " points in each cell, sub-cells of degree " +
                       std::to_string(configuration.degree) + " are " +
                       std::to_string(cells.n_points),
                     "use the Gauss rule with degree + 1 points");
    if (!(largest_donor_fraction > 0. && largest_donor_fraction <= 1.))
      throw InputError("Transfer / Largest donor fraction",
                       "it is " + std::to_string(largest_donor_fraction),
                       "choose a number above 0 and at most 1");
    this->scheme->attach(cells, store);
  }

  template <int dim>
  double
  SweptTransfer<dim>::donor_fraction() const
  {
    double largest = 0.;
    for (const unsigned int c : cells.owned_cells())
      for (unsigned int s = c * cells.n_points; s < (c + 1) * cells.n_points;
           ++s)
        {
          double      given = 0.;
          const auto *faces = cells.incidences(s);
          for (unsigned int i = 0; i < cells.faces_per_sub_cell; ++i)
            {
              if (faces[i].face == SubCells<dim>::none)
                continue;
              const double gain = faces[i].side == 0
                                    ? work.swept[faces[i].face]
                                    : -work.swept[faces[i].face];
              if (gain < 0.)
                given -= gain;
            }
          largest = std::max(largest, given / work.volume_before[s]);
        }
    return Utilities::MPI::max(largest, configuration.communicator());
  }

  template <int dim>
  double
  SweptTransfer<dim>::content(const HistoryStore<dim>   &store,
                              const std::vector<double> &volume) const
  {
    std::vector<double> contents;
    contents.reserve(cells.owned_cells().size());
    for (const unsigned int c : cells.owned_cells())
      {
        const int offset = store.layout(store.region(c)).offset(content_field);
        if (offset < 0)
          continue;
        double sum = 0.;
        for (unsigned int q = 0; q < cells.n_points; ++q)
          sum +=
            volume[c * cells.n_points + q] * store.old_record(c, q)[offset];
        contents.push_back(sum);
      }
    return reproducible_sum(contents, configuration.communicator());
  }

  template <int dim>
  void
  SweptTransfer<dim>::sub_cycle(HistoryStore<dim> &store,
                                const NodalVector &x_before,
                                const NodalVector &x_after,
                                TransferReport    &report)
  {
    store.update_ghosts();
    work.before = store.old_values;

    unsigned int stride = 0;
    for (unsigned int r = 0; r < store.n_regions(); ++r)
      stride = std::max(stride, store.layout(r).size);

    const SweptStep<dim> step{cells,
                              store,
                              work.before,
                              store.offsets(),
                              x_before,
                              x_after,
                              work.volume_before,
                              work.volume_after,
                              work.swept};
    const bool           corrected = scheme->has_correction();
    if (corrected)
      {
        work.correction.assign(cells.faces().size() * stride, 0.);
        scheme->correct(step, stride, work.correction);
      }

    for (const unsigned int c : cells.owned_cells())
      {
        const HistoryLayout &layout = store.layout(store.region(c));
        const int            booked = layout.offset(content_field);
        for (unsigned int q = 0; q < cells.n_points; ++q)
          {
            const unsigned int s      = c * cells.n_points + q;
            const auto        *faces  = cells.incidences(s);
            const double       volume = work.volume_after[s];
            const double      *own    = step.record(s);
            double            *result = store.old_record(c, q);
            double             swept  = 0.;
            for (unsigned int i = 0; i < cells.faces_per_sub_cell; ++i)
              {
                if (faces[i].face == SubCells<dim>::none)
                  continue;
                const unsigned int f    = faces[i].face;
                const double       sign = faces[i].side == 0 ? 1. : -1.;
                const double       gain = sign * work.swept[f];
                const unsigned int other =
                  cells.faces()[f].sub_cell[1 - faces[i].side];
                swept += gain;

                // V_new phi_new = V phi + sum gain phi_donor, written as the
                // change of phi with V_new = V + sum gain: a uniform field is
                // then kept to the last bit. Where this sub-cell is the donor,
                // and at a boundary, where its own value enters, there is no
                // change.
                if (gain > 0. && other != SubCells<dim>::none)
                  {
                    const double *donor = step.record(other);
                    const double  part  = gain / volume;
                    for (unsigned int k = 0; k < layout.size; ++k)
                      result[k] += part * (donor[k] - own[k]);
                  }
                if (corrected)
                  for (unsigned int k = 0; k < layout.size; ++k)
                    result[k] +=
                      sign * work.correction[f * stride + k] / volume;
                if (other == SubCells<dim>::none && booked >= 0)
                  work.boundary[c] +=
                    gain * own[booked] +
                    (corrected ? work.correction[f * stride + booked] : 0.);
              }
            const double error =
              std::abs(volume - work.volume_before[s] - swept) / volume;
            // Not std::max, which would swallow a NaN.
            if (!(error <= report.geometric_conservation_error))
              report.geometric_conservation_error = error;
          }
      }
  }

  template <int dim>
  TransferReport
  SweptTransfer<dim>::transfer(HistoryStore<dim> &store,
                               const NodalVector &x_old,
                               const NodalVector &x_new)
  {
    const MPI_Comm communicator = configuration.communicator();
    TransferReport report;
    work.boundary.assign(cells.n_sub_cells() / cells.n_points, 0.);

    const auto require_volumes = [&](const std::vector<double> &volumes) {
      double smallest = std::numeric_limits<double>::max();
      for (const unsigned int c : cells.owned_cells())
        for (unsigned int q = 0; q < cells.n_points; ++q)
          // Not std::min, which would swallow a NaN.
          if (!(volumes[c * cells.n_points + q] >= smallest))
            smallest = volumes[c * cells.n_points + q];
      const unsigned int bad =
        Utilities::MPI::max(smallest > 0. ? 0u : 1u, communicator);
      if (bad > 0)
        throw RunError(
          "Transfer",
          "a sub-cell has no positive volume on the way of the "
          "mesh",
          "rezone more often, so that the mesh moves less at once");
    };

    cells.volumes(x_old, work.volume_before);
    require_volumes(work.volume_before);
    cells.swept_volumes(x_old, x_new, work.swept);
    report.content_before = content(store, work.volume_before);
    const double whole    = donor_fraction();
    report.swept_fraction = whole;

    // How much of the motion is done, as (part)/(parts): equal parts, halved
    // where one of them would still take too much from a sub-cell.
    unsigned int parts =
      std::max(1u,
               static_cast<unsigned int>(
                 std::ceil(std::min(whole / largest_donor_fraction - 1e-10,
                                    1. * most_subcycles + 1.))));
    NodalVector x_before, x_after;
    if (parts > 1)
      {
        x_before = x_old;
        x_before.update_ghost_values();
        x_after = x_before;
        x_after.update_ghost_values();
      }

    for (unsigned int part = 0; whole > 0. && part < parts;)
      {
        if (parts > most_subcycles)
          throw RunError("Transfer",
                         "more than " + std::to_string(most_subcycles) +
                           " sub-cycles would be needed",
                         "rezone more often or raise 'Largest donor fraction'");
        if (parts > 1)
          {
            const double       fraction = static_cast<double>(part + 1) / parts;
            const unsigned int n_local =
              x_new.get_partitioner()->locally_owned_size() +
              x_new.get_partitioner()->n_ghost_indices();
            for (unsigned int i = 0; i < n_local; ++i)
              {
                const double x0 = x_old.local_element(i);
                const double x1 = x_new.local_element(i);
                x_after.local_element(i) =
                  part + 1 == parts ? x1 : x0 + fraction * (x1 - x0);
              }
            cells.swept_volumes(x_before, x_after, work.swept);
            if (donor_fraction() > std::min(1., 1.2 * largest_donor_fraction))
              {
                part *= 2;
                parts *= 2;
                continue;
              }
          }
        const NodalVector &from = parts > 1 ? x_before : x_old;
        const NodalVector &to   = parts > 1 ? x_after : x_new;
        cells.volumes(to, work.volume_after);
        require_volumes(work.volume_after);
        sub_cycle(store, from, to, report);
        ++report.n_subcycles;
        ++part;
        std::swap(work.volume_before, work.volume_after);
        if (parts > 1)
          x_before.swap(x_after);
      }

    report.n_limited     = enforce_bounds(store);
    report.content_after = content(store, work.volume_before);
    report.through_boundary =
      reproducible_sum(work.boundary, configuration.communicator());

    // A NaN must not pass as zero.
    if (!std::isfinite(report.geometric_conservation_error))
      report.geometric_conservation_error = std::numeric_limits<double>::max();
    report.geometric_conservation_error =
      Utilities::MPI::max(report.geometric_conservation_error, communicator);
    if (report.geometric_conservation_error > largest_conservation_error)
      {
        std::ostringstream found;
        found << "volumes and swept volumes differ by "
              << report.geometric_conservation_error
              << " of a sub-cell's volume";
        throw RunError("Transfer",
                       found.str(),
                       "this is a mistake in the program: please report it "
                       "with the scene");
      }
    return report;
  }

  template class SweptTransfer<2>;
  template class SweptTransfer<3>;
} // namespace alveolus
