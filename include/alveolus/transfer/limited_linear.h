// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_limited_linear_h
#define alveolus_transfer_limited_linear_h

#include <alveolus/transfer/reconstruction.h>
#include <alveolus/transfer/sub_cell_neighbours.h>
#include <alveolus/transfer/transfer_scheme.h>

#include <memory>

namespace alveolus
{
  /**
   * Second order: what passes through a face is the mean over the swept volume
   * of the donor's linear reconstruction phi + grad phi . (x - x_centroid), the
   * gradient being the least-squares one of the sub-cells around (those of the
   * same region with a common corner). Beyond the donor's value times the swept
   * volume dV that is grad phi . (first moment of dV - dV x_centroid). These
   * corrections are multiplied by factors in [0,1] where the new mean would
   * leave the range of the old values around (flux-corrected remapping, R.
   * Liska, M. Shashkov, P. Vachal, B. Wendroff, J. Comput. Phys. 229 (2010)
   * 1467-1497; see CorrectionLimiter): no new extrema, content conserved, and
   * linear fields are moved exactly. At a domain or region boundary that gives
   * way the reconstruction goes on; where it moves out, new extrema are
   * limited.
   */
  template <int dim>
  class LimitedLinear : public TransferScheme<dim>
  {
  public:
    bool
    has_correction() const override
    {
      return true;
    }

    void
    attach(const SubCells<dim> &cells, const HistoryStore<dim> &store) override;

    void
    correct(const SweptStep<dim> &step,
            const unsigned int    stride,
            std::vector<double>  &correction) const override;

  private:
    /** The unlimited corrections. */
    void
    reconstruct(const SweptStep<dim> &step,
                const unsigned int    stride,
                std::vector<double>  &correction) const;

    /** Multiply the corrections by their factors. */
    void
    limit(const SweptStep<dim> &step,
          const unsigned int    stride,
          std::vector<double>  &correction) const;

    std::unique_ptr<SubCellNeighbours<dim>> neighbours;
  };
} // namespace alveolus

#endif
