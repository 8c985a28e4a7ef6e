// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_trace_projection_h
#define alveolus_transfer_trace_projection_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/subcells.h>

#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Where mean dilatation is on, the trace of the elastic (Hencky) strain is
   * again a function of FE_DGP(degree-1) on each cell after a transfer: its
   * values at the points are replaced by their weighted least-squares fit in
   * the polynomials of total degree (degree-1) in the unit coordinates of the
   * quadrature points, the weights being the sub-cell volumes. The constant is
   * among them, so that the content sum V tr h of each cell stays. The
   * deviator is untouched. For degree 1 this is the volume-weighted mean.
   */
  template <int dim>
  class TraceProjection
  {
  public:
    /**
     * @param cells must outlive this object
     * @param field name of the symmetric tensor field
     */
    TraceProjection(const SubCells<dim> &cells,
                    const std::string   &field = "elastic strain");

    /**
     * Project the old records of owned cells of @p regions (region indices) at
     * positions @p x.
     * @throws RunError if one of the regions has no such tensor field
     */
    void
    apply(HistoryStore<dim>            &store,
          const NodalVector            &x,
          const std::set<unsigned int> &regions) const;

  private:
    const SubCells<dim>             &cells;
    std::string                      field;
    std::vector<std::vector<double>> polynomials; ///< values at the points
  };
} // namespace alveolus

#endif
