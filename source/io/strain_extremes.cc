// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/tensors.h>
#include <alveolus/io/rigid_motion.h>
#include <alveolus/io/strain_extremes.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  StrainExtremes<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Named regions of the mesh, separated by commas.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  StrainExtremes<dim>::attach(const State<dim> &state, const std::string &where)
  {
    ids = region_ids(state.configuration.mesh.names, on, where + " / On");
    if (ids.empty())
      throw InputError(where + " / On", "names no region", "name at least one");
    bool missing = false;
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        missing =
          missing ||
          state.history.layout(state.history.region(cell->active_cell_index()))
              .offset("elastic strain") < 0;
    // Every process must hear of it.
    if (Utilities::MPI::max(missing ? 1 : 0,
                            state.configuration.communicator()) > 0)
      throw InputError(where + " / On",
                       "a material of '" + on + "' keeps no elastic strain",
                       "name regions whose materials do");
  }



  template <int dim>
  std::vector<Recorded>
  StrainExtremes<dim>::record(const State<dim> &state,
                              const NodalVector &) const
  {
    const double huge  = std::numeric_limits<double>::max();
    double       least = huge, greatest = -huge;   // of h
    double       smallest = huge, largest = -huge; // of tr h
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        {
          const unsigned int c = cell->active_cell_index();
          const int offset     = state.history.layout(state.history.region(c))
                               .offset("elastic strain");
          for (unsigned int q = 0; q < state.history.n_points; ++q)
            {
              const auto h =
                unpack(state.history.old_record(c, q) + offset, dim);
              const Spectral s = spectral(h);
              least            = std::min(least, s.values[2]);
              greatest         = std::max(greatest, s.values[0]);
              smallest         = std::min(smallest, trace(h));
              largest          = std::max(largest, trace(h));
            }
        }
    const MPI_Comm communicator = state.configuration.communicator();
    least                       = Utilities::MPI::min(least, communicator);
    greatest                    = Utilities::MPI::max(greatest, communicator);
    smallest                    = Utilities::MPI::min(smallest, communicator);
    largest                     = Utilities::MPI::max(largest, communicator);
    return {{"least Hencky strain", least},
            {"greatest Hencky strain", greatest},
            {"least engineering strain", std::expm1(least)},
            {"greatest engineering strain", std::expm1(greatest)},
            {"least volume ratio", std::exp(smallest)},
            {"greatest volume ratio", std::exp(largest)}};
  }

  template class StrainExtremes<2>;
  template class StrainExtremes<3>;

  ALVEOLUS_REGISTER_DIM(
    Recorder,
    StrainExtremes,
    "strain extremes",
    "Extremes at the quadrature points of the regions `On` of the principal "
    "elastic Hencky strains h, of the engineering strains exp(h) - 1, and of "
    "the volume ratio exp(tr h).")
} // namespace alveolus
