// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_godunov_h
#define alveolus_transfer_godunov_h

#include <alveolus/transfer/transfer_scheme.h>

namespace alveolus
{
  /**
   * First-order upwind scheme after Godunov, as in Mengoni, Ponthot, Boman
   * (Med. Eng. Phys. 38 (2016) 140-147): what passes through a face has the
   * donor's value. No new extrema; per sub-cycle with Courant number c on
   * sub-cells of width h it adds the variance c(1-c) h^2 to a profile
   * (numerical diffusion).
   */
  template <int dim>
  class Godunov : public TransferScheme<dim>
  {
  public:
    bool
    has_correction() const override
    {
      return false;
    }

    void
    correct(const SweptStep<dim> &,
            const unsigned int,
            std::vector<double> &) const override
    {}
  };
} // namespace alveolus

#endif
