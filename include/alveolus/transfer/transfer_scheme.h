// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_transfer_scheme_h
#define alveolus_transfer_transfer_scheme_h

#include <alveolus/base/registry.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/subcells.h>

#include <deal.II/base/parameter_handler.h>

namespace alveolus
{
  /** What a scheme sees of one sub-cycle of a swept transfer. */
  template <int dim>
  struct SweptStep
  {
    const SubCells<dim>     &cells; ///< geometry and neighbours
    const HistoryStore<dim> &store; ///< regions and layouts
    /** Old records, with valid ghosts, where HistoryStore keeps them. */
    const std::vector<double> &values;
    /** Where the record of each active cell begins in `values`. */
    const std::vector<std::size_t> &begin;
    /** Positions of the nodes at the begin [mm]. */
    const NodalVector &x_before;
    /** Positions of the nodes at the end [mm]. */
    const NodalVector &x_after;
    /** By sub-cell; owned ones [mm^dim]. */
    const std::vector<double> &volume_before;
    const std::vector<double> &volume_after; ///< the same at the end [mm^dim]
    /** By SubCells::faces(), positive where the first sub-cell grows. */
    const std::vector<double> &swept;

    /** Old record of sub-cell @p s. */
    const double *
    record(const unsigned int s) const
    {
      const unsigned int cell = s / cells.n_points;
      return values.data() + begin[cell] +
             (s % cells.n_points) * store.layout(store.region(cell)).size;
    }
  };

  /**
   * How much of the history passes through the faces of sub-cells when they
   * move. Through every face goes (swept volume) x (value of the donor), the
   * donor being the sub-cell that gives the volume away: the first-order flux,
   * monotone and conservative, common to all schemes. A scheme of higher order
   * adds to it. The same is done to all components of a record.
   */
  template <int dim>
  class TransferScheme
  {
  public:
    virtual ~TransferScheme() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &)
    {}

    /**
     * Called once before correct(), which gets the same @p cells and regions
     * (collective).
     */
    virtual void
    attach(const SubCells<dim> &, const HistoryStore<dim> &)
    {}

    /** False if correct() has nothing to add, so that it is not called. */
    virtual bool
    has_correction() const = 0;

    /**
     * Content [unit mm^dim] that passes from the second to the first sub-cell
     * of each face beyond the donor's value times the swept volume; at a
     * boundary face, what enters the first one. Both owners of a face between
     * two processes must find the same number.
     * @param correction component i of face f at [f * stride + i]; zero at
     *        entry
     * Collective, so ghost values may be exchanged inside.
     */
    virtual void
    correct(const SweptStep<dim> &step,
            const unsigned int    stride,
            std::vector<double>  &correction) const = 0;
  };
} // namespace alveolus

#endif
