// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/transfer_scheme.h>

namespace alveolus
{
  /**
   * What passes through a face has the mean of the values on both sides: less
   * diffusive than the donor's value, but not bounded. Conservative like every
   * scheme, since what one sub-cell gets the other one loses.
   */
  template <int dim>
  class CentredScheme : public TransferScheme<dim>
  {
  public:
    bool
    has_correction() const override
    {
      return true;
    }

    void
    correct(const SweptStep<dim> &step,
            const unsigned int    stride,
            std::vector<double>  &correction) const override
    {
      const auto &faces = step.cells.faces();
      for (unsigned int f = 0; f < faces.size(); ++f)
        {
          const unsigned int first  = faces[f].sub_cell[0];
          const unsigned int second = faces[f].sub_cell[1];
          if (second == SubCells<dim>::none)
            continue; // at a boundary the donor's value is all there is
          const unsigned int region =
            step.store.region(first / step.cells.n_points);
          const double *a = step.record(first), *b = step.record(second);
          // The mean less the donor's value, which is counted already
          const double half = 0.5 * std::abs(step.swept[f]);
          for (unsigned int i = 0; i < step.store.layout(region).size; ++i)
            correction[f * stride + i] = half * (a[i] - b[i]);
        }
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::TransferScheme,
  alveolus::CentredScheme,
  "centred",
  "What passes through a sub-cell face has the mean of the values on both "
  "sides. Conservative, of second order on uniform meshes, not bounded.")
