// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/godunov.h>

namespace alveolus
{
  template class Godunov<2>;
  template class Godunov<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::TransferScheme,
  alveolus::Godunov,
  "Godunov",
  "First order: what passes through a sub-cell face has the donor's value, "
  "V_new phi_new = V phi - sum_f dV_f phi_donor. Bounded, conservative, "
  "diffusive: with Courant number c on sub-cells of width h each sub-cycle adds "
  "c(1-c) h^2 to the variance of a profile.")
