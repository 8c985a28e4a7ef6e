// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_round_off_h
#define alveolus_solver_round_off_h

#include <alveolus/mesh/configuration.h>

#include <vector>

namespace alveolus
{
  /**
   * Nodal displacements of the size of round-off [mm]: each component is that
   * part of its shortest cell that the machine's precision is of one, of
   * alternating sign. The forces of a cell cannot be known better than to what
   * such displacements change in them, since its deformation gradient is of
   * order one.
   */
  template <int dim>
  NodalVector
  round_off_displacement(const Configuration<dim> &configuration);

  /**
   * Whether the last three of @p residuals, from @p first on, brought no less
   * than half of what had been reached before them.
   */
  bool
  stagnates(const std::vector<double> &residuals, const std::size_t first);
} // namespace alveolus

#endif
