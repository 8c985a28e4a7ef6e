// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_mesh_newton_h
#define alveolus_rezoning_mesh_newton_h

#include <alveolus/rezoning/mesh_energy.h>

namespace alveolus
{
  /** What came of a minimisation. */
  struct MinimiseReport
  {
    unsigned int iterations = 0;     ///< Newton's steps
    unsigned int modified   = 0;     ///< of these with the positive Hessian
    unsigned int values     = 0;     ///< evaluations of the energy
    bool         converged  = false; ///< whether the tolerance was reached
    double       energy     = 0.;    ///< at the end
  };

  /**
   * Minimise the energy of a mesh by Newton's method, from a valid mesh over
   * valid meshes: H d = -dE/dx, x <- x + a d with a = 1, 1/2, 1/4, ... until
   * all Jacobians are positive and E has fallen by 1e-4 of what its slope
   * promises (Armijo). H is the Hessian where its direction leads downhill and
   * is accepted with a >= 1/8, otherwise the one made of the absolute values
   * of the eigenvalues of the cell matrices, which is positive definite. A
   * decrease below the round-off of E cannot be judged; then the step only has
   * to be valid.
   *
   * Converged when a whole step strains no cell by more than @p tolerance;
   * this step is taken, too, so that the error is about its square.
   *
   * @param energy after fit_sizes()
   * @param system with constraints on what does not move
   * @param x in: start, of finite energy; out: the last mesh, ghosted
   * Collective.
   */
  template <int dim>
  MinimiseReport
  minimise(const MeshEnergy<dim> &energy,
           LinearSystem          &system,
           const double           tolerance,
           const unsigned int     largest_iterations,
           NodalVector           &x);
} // namespace alveolus

#endif
