// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/driver/bone_mass.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  BoneMass<dim>::BoneMass(const State<dim> &state)
    : cells(state.configuration,
            [&](const unsigned int cell) { return state.history.region(cell); })
  {
    cells.volumes(state.configuration.positions(), volumes);
    mass = initial = content(state, volumes, false);
  }



  template <int dim>
  bool
  BoneMass<dim>::present(const State<dim> &state)
  {
    for (unsigned int r = 0; r < state.history.n_regions(); ++r)
      if (state.history.layout(r).offset("density") >= 0)
        return true;
    return false;
  }



  template <int dim>
  double
  BoneMass<dim>::content(const State<dim>          &state,
                         const std::vector<double> &volume,
                         const bool                 trial) const
  {
    const auto &history = state.history;
    double      sum     = 0.;
    for (const unsigned int cell : cells.owned_cells())
      {
        const int offset =
          history.layout(history.region(cell)).offset("density");
        if (offset >= 0)
          for (unsigned int q = 0; q < history.n_points; ++q)
            sum += (trial ? history.trial_record(cell, q)
                          : history.old_record(cell, q))[offset] *
                   volume[cell * history.n_points + q];
      }
    return Utilities::MPI::sum(sum, state.configuration.communicator());
  }



  template <int dim>
  void
  BoneMass<dim>::book_step(const State<dim>  &state,
                           const NodalVector &new_positions)
  {
    std::vector<double> new_volumes;
    cells.volumes(new_positions, new_volumes);
    const double before   = content(state, volumes, false);
    const double deformed = content(state, new_volumes, false);
    const double after    = content(state, new_volumes, true);
    by_volume_change += deformed - before;
    by_remodelling += after - deformed;
    mass    = after;
    volumes = std::move(new_volumes);
  }



  template <int dim>
  void
  BoneMass<dim>::book_transfer(const State<dim>     &state,
                               const TransferReport &report)
  {
    through_boundary += report.through_boundary;
    cells.volumes(state.configuration.positions(), volumes);
    mass = content(state, volumes, false);
  }



  template <int dim>
  std::pair<double, double>
  BoneMass<dim>::extremes(const State<dim> &state) const
  {
    const auto &history = state.history;
    double      least = std::numeric_limits<double>::max(), greatest = -least;
    for (const unsigned int cell : cells.owned_cells())
      {
        const int offset =
          history.layout(history.region(cell)).offset("density");
        if (offset >= 0)
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              const double density = history.old_record(cell, q)[offset];
              least                = std::min(least, density);
              greatest             = std::max(greatest, density);
            }
      }
    const MPI_Comm communicator = state.configuration.communicator();
    return {Utilities::MPI::min(least, communicator),
            Utilities::MPI::max(greatest, communicator)};
  }

  template <int dim>
  std::vector<std::size_t>
  BoneMass<dim>::begin_of_cells() const
  {
    std::vector<std::size_t> begin(volumes.size() / cells.n_points + 1);
    for (std::size_t c = 0; c < begin.size(); ++c)
      begin[c] = c * cells.n_points;
    return begin;
  }



  template <int dim>
  void
  BoneMass<dim>::save(const PortableFields<dim> &fields,
                      BlockFile                 &blocks) const
  {
    blocks.put("bone mass/books",
               BlockFile::Numbers{mass,
                                  initial,
                                  by_remodelling,
                                  by_volume_change,
                                  through_boundary,
                                  by_remeshing});
    // Volumes could be computed from the positions, but not to the last bit:
    // those of a Lagrangian step come from the sum of positions and increment.
    fields.save(volumes, begin_of_cells(), "bone mass/volumes", blocks);
  }



  template <int dim>
  void
  BoneMass<dim>::load(const PortableFields<dim> &fields,
                      const BlockFile           &blocks)
  {
    const auto &books = blocks.numbers("bone mass/books");
    if (books.size() != 6)
      blocks.refuse("bone mass/books", "does not hold 6 numbers");
    mass             = books[0];
    initial          = books[1];
    by_remodelling   = books[2];
    by_volume_change = books[3];
    through_boundary = books[4];
    by_remeshing     = books[5];
    fields.load(blocks, "bone mass/volumes", begin_of_cells(), volumes);
  }

  template class BoneMass<2>;
  template class BoneMass<3>;
} // namespace alveolus
