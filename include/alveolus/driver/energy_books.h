// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_energy_books_h
#define alveolus_driver_energy_books_h

#include <alveolus/driver/model.h>

#include <map>
#include <string>

namespace alveolus
{
  /**
   * Books of the energy [mJ, per mm of thickness in 2D] (doc/invariants.md):
   *
   *   external + unbalanced = stored - initial + dissipated + contact
   *                           - remodelling - update - transfer - remeshing.
   *
   * Work of a step is 1/2 (f_n + f_{n+1}) . du of nodal forces (trapezoidal
   * rule), f_n at the beginning of the step on the committed mesh and history
   * under the loads of t_n. With this rule the work of internal forces is that
   * of all others up to round-off. The elastic energy comes from the materials,
   * and their dissipation from the plastic return, neither from the forces: so
   * the balance closes up to the error of the rule, O(dt^3) a step.
   *
   * An object that is not there costs nothing. The order of calls is begin()
   * before the attempts at a step, book_step() before its commit and
   * book_commit() after it, book_transfer() after a rezoning, book_remesh()
   * after a remesh; nothing is booked for rejected attempts.
   */
  template <int dim>
  class EnergyBooks
  {
  public:
    /** Begin with what is stored in the committed state. */
    explicit EnergyBooks(Model<dim> &model);

    /**
     * Keep the forces at the beginning of a step, once for all its attempts.
     * @throws RunError if the committed state gives no valid stress
     */
    void
    begin(Model<dim> &model);

    /** Book a step that is about to be committed. */
    void
    book_step(Model<dim>               &model,
              const EquilibriumReport  &mechanics,
              const RemodellingSummary &remodelling);

    /** The moved mesh has become the one that the next step begins with. */
    void
    book_commit(const Model<dim> &model);

    /** History and mesh were changed by rezoning. */
    void
    book_transfer(const Model<dim> &model);

    /** The model was replaced, and settled at constant load. */
    void
    book_remesh(Model<dim> &model);

    /** Columns of the history file; which ones depends on the scene only. */
    std::vector<Recorded>
    record(const Model<dim> &model) const;

    /** The same for the summary: everything there is. */
    std::vector<Recorded>
    totals() const;

    /** Into blocks "energy/..." of a checkpoint. */
    void
    save(BlockFile &blocks) const;
    /** The same back. @throws InputError */
    void
    load(const BlockFile &blocks);

    /** What is not explained, over the sum of the absolute changes. */
    double
    balance() const;

    /** Cumulative terms, all [mJ (per mm)]. */
    struct Terms
    {
      double external   = 0.;  ///< work of loads, supports and rigid bodies
      double unbalanced = 0.;  ///< work of forces that transfer, remodelling or
                               ///< the new reference left out of balance
      double dissipated  = 0.; ///< plastic work
      double contact     = 0.; ///< work lost between bodies in contact
      double remodelling = 0.; ///< Y : dH at fixed strain
      double update      = 0.; ///< when the moved mesh becomes the reference
      double transfer    = 0.; ///< rezoning and admissibility
      double remeshing   = 0.; ///< transfer to a new mesh, and settling
      double stored      = 0.; ///< now: elastic, layers included
      double layers      = 0.; ///< now: the layers' part
      double initial     = 0.; ///< stored at the beginning
      double changes     = 0.; ///< sum of absolute changes of all terms
      double worst       = 0.; ///< greatest |balance| of any step so far
    };

    /** The sums up to now. */
    const Terms &
    terms() const
    {
      return sum;
    }

    /**
     * Sum of all external forces and reactions of the step that is judged, and
     * of their moments over the length of the mesh, over @p force_scale; kept
     * for record(). The internal forces that they balance have no resultant,
     * and no moment where the stress is symmetric.
     */
    double
    check_resultants(const Model<dim> &model, const double force_scale);

  private:
    /** Add a change to a term. */
    void
    book(double &term, const double change)
    {
      term += change;
      sum.changes += std::abs(change);
    }
    /** Stored in the cells by the committed history on the mesh as it is. */
    double
    stored_in_cells(const Model<dim> &model) const;
    double
    stored_in_layers(const Model<dim> &model) const;
    /** Of conditions in contact, as they stand in the residual. */
    NodalVector
    contact_forces(Model<dim> &model, const NodalVector &increment) const;

    /** Take anew what is stored, since mesh and history are others.
     * @return by how much it has changed [mJ (per mm)] */
    double
    take_stock(const Model<dim> &model);

    Terms  sum;
    double resultants = 0.;
    double in_cells   = 0.; ///< stored there at the end of the last step
    bool   begun      = false;
    /** Of begin(): internal forces, residual, contact. */
    NodalVector internal, residual, contact;
  };
} // namespace alveolus

#endif
