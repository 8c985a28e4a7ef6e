// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_driver_state_check_h
#define alveolus_driver_state_check_h

#include <alveolus/assembly/cell_kernel.h>
#include <alveolus/state/state.h>

#include <string>
#include <vector>

namespace alveolus
{
  /** What is wrong with the history of all points, over all processes. */
  struct StateFindings
  {
    /**
     * Why the state is no state of a body: a value that is not finite, or a
     * volume or stretch that is not positive in floating point, with the
     * place. Empty if there is nothing of the kind.
     */
    std::string garbage;
    /** Points with a value beyond the bounds of its field by more than 1e-9. */
    unsigned int n_beyond_bounds = 0;
    std::string  worst; ///< which field is farthest beyond its bound
  };

  /**
   * Look at every record (collective): values finite; volume ratio and the
   * eigenvalues of b_e = exp(2 h) and of T = exp(log T) finite and positive,
   * which a logarithmic tensor is unless it is absurdly large; scalars and
   * eigenvalues within the bounds that the material gave its fields, traces
   * zero where they have to be.
   * @param trial the records of the step that is judged, else the committed
   *        ones
   */
  template <int dim>
  StateFindings
  check_state(const State<dim>          &state,
              const std::vector<Region> &regions,
              const bool                 trial);
} // namespace alveolus

#endif
