// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_bone_mass_h
#define alveolus_driver_bone_mass_h

#include <alveolus/state/portable_fields.h>
#include <alveolus/state/state.h>
#include <alveolus/transfer/subcells.h>
#include <alveolus/transfer/swept_transfer.h>

#include <utility>

namespace alveolus
{
  /**
   * Books of the bone mass M = sum rho V over the sub-cells of all regions with
   * a density [mg, per mm of thickness in 2D]: what remodelling added, what the
   * volume change of the Lagrangian phase did, what crossed boundaries and what
   * the transfers lost (theory, section 8).
   */
  template <int dim>
  class BoneMass
  {
  public:
    /** Begin with the mass of a state. */
    explicit BoneMass(const State<dim> &state);

    /** True if some region of the state has a density. */
    static bool
    present(const State<dim> &state);

    /**
     * Book a Lagrangian step before its commit: volume change at the old
     * density, then the change of density at the new volume.
     */
    void
    book_step(const State<dim> &state, const NodalVector &new_positions);

    /** Book a transfer to the mesh that the configuration has now. */
    void
    book_transfer(const State<dim> &state, const TransferReport &report);

    /**
     * Go on with the books of the old mesh after a remesh, in equilibrium on
     * the new mesh. What the transfer does beyond the change of outlines is not
     * explained: it stays in the balance.
     * @param gained      by the change of outlines, OverlapReport
     * @param transferred mass after the transfer, before the equilibrium was
     *        sought; the density does not change then, so that the rest is the
     *        change of volume
     */
    void
    take_over(const BoneMass &old,
              const double    gained,
              const double    transferred)
    {
      initial          = old.initial;
      by_remodelling   = old.by_remodelling;
      by_volume_change = old.by_volume_change + (mass - transferred);
      through_boundary = old.through_boundary;
      by_remeshing     = old.by_remeshing + gained;
    }

    /** Into and from blocks "bone mass/..." of a checkpoint (collective). */
    void
    save(const PortableFields<dim> &fields, BlockFile &blocks) const;
    /** The same back. @throws InputError if a block does not fit */
    void
    load(const PortableFields<dim> &fields, const BlockFile &blocks);

    double mass             = 0.; ///< now
    double initial          = 0.; ///< at the beginning of the run
    double by_remodelling   = 0.; ///< all cumulative
    double by_volume_change = 0.; ///< of pores closed or opened by strain
    double through_boundary = 0.; ///< by rezoning along boundaries
    double by_remeshing     = 0.; ///< at outlines of new meshes

    /** What is not explained, relative to the initial mass. */
    double
    balance() const
    {
      return (mass - initial - by_remodelling - by_volume_change -
              through_boundary - by_remeshing) /
             initial;
    }

    /** Least and greatest density of the old records (collective). */
    std::pair<double, double>
    extremes(const State<dim> &state) const;

  private:
    double
    content(const State<dim>          &state,
            const std::vector<double> &volumes,
            const bool                 trial) const;

    /** Where the volumes of each active cell begin, and where the last end. */
    std::vector<std::size_t>
    begin_of_cells() const;

    SubCells<dim>       cells;
    std::vector<double> volumes; ///< of the current mesh
  };
} // namespace alveolus

#endif
