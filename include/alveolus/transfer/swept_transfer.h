// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_swept_transfer_h
#define alveolus_transfer_swept_transfer_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/subcells.h>
#include <alveolus/transfer/transfer_scheme.h>

#include <memory>

namespace alveolus
{
  /** What a transfer did. */
  struct TransferReport
  {
    unsigned int n_subcycles = 0; ///< parts that the motion was divided into
    /**
     * Largest part of a sub-cell's volume that leaves it in the whole motion,
     * its CFL number.
     */
    double swept_fraction = 0.;
    /** Values brought back into field bounds from beyond round-off. */
    unsigned int n_limited = 0;
    /** Largest |V_new - V_old - sum of swept volumes| / V (asserted). */
    double geometric_conservation_error = 0.;
    /**
     * Contents (integrals, sums of V phi) of one chosen scalar field over all
     * processes, e.g. density: [unit mm^dim].
     */
    double content_before   = 0.;
    double content_after    = 0.; ///< the same afterwards
    double through_boundary = 0.; ///< booked at domain and region faces
    /** content_after - content_before - through_boundary */
    double
    error() const
    {
      return content_after - content_before - through_boundary;
    }
  };

  /**
   * History on the same connectivity moved from mesh x_old to mesh x_new
   * (theory, section 6): finite volumes on the sub-cells with exact swept
   * volumes, V_new phi_new = V phi - sum_f dV_f phi_upwind, sub-cycled so that
   * the donor fraction stays below its bound. At a domain or region face the
   * recipient's own value enters, booked as boundary content.
   */
  template <int dim>
  class SweptTransfer
  {
  public:
    /**
     * @param scheme       gives phi_upwind; shared by all fields
     * @param content_field name of the scalar field whose balance is reported
     * @param largest_donor_fraction of a sub-cell's volume per sub-cycle
     */
    SweptTransfer(const Configuration<dim>            &configuration,
                  const HistoryStore<dim>             &store,
                  std::unique_ptr<TransferScheme<dim>> scheme,
                  const std::string &content_field          = "density",
                  const double       largest_donor_fraction = 0.5);

    /**
     * Move the old records of @p store from positions @p x_old to @p x_new
     * (nodal vectors, ghosted) (collective).
     * @throws RunError if the geometric conservation law is violated by more
     *         than round-off
     */
    TransferReport
    transfer(HistoryStore<dim> &store,
             const NodalVector &x_old,
             const NodalVector &x_new);

    /** The geometry it works on. */
    const SubCells<dim> &
    subcells() const
    {
      return cells;
    }

  private:
    /** Arrays kept between transfers, to spare their allocation. */
    struct Work
    {
      std::vector<double> before, volume_before, volume_after, swept,
        correction, boundary;
    };

    /** Largest part of a sub-cell's volume given away (collective). */
    double
    donor_fraction() const;

    /** One sub-cycle between the volumes and with the swept volumes in work. */
    void
    sub_cycle(HistoryStore<dim> &store,
              const NodalVector &x_before,
              const NodalVector &x_after,
              TransferReport    &report);

    /** Contents of the chosen field by cell, summed up (collective). */
    double
    content(const HistoryStore<dim>   &store,
            const std::vector<double> &volume) const;

    Work                                 work;
    const Configuration<dim>            &configuration;
    SubCells<dim>                        cells;
    std::unique_ptr<TransferScheme<dim>> scheme;
    std::string                          content_field;
    double                               largest_donor_fraction;
  };
} // namespace alveolus

#endif
