// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_chebyshev_sweeps_h
#define alveolus_rezoning_chebyshev_sweeps_h

#include <alveolus/algebra/types.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * Solves x_i = sum_j w_ij x_j for moving nodes i by Chebyshev's
   * semi-iteration of the Jacobi sweeps (e.g. Saad, Iterative Methods for
   * Sparse Linear Systems (2003), 12.3.2): no scalar products, so that any
   * number of processes gives the same.
   *
   * The nodes that move may lie on few of the processes. For the sweeps they
   * are therefore distributed anew, in equal numbers; values go there before
   * the first sweep and come back after the last one.
   */
  template <int dim>
  class ChebyshevSweeps
  {
  public:
    /** A node by the local indices of its components in a nodal vector. */
    using LocalNode = std::array<unsigned int, dim>;
    /** Weight of a neighbour, and the neighbour. */
    using Link = std::pair<double, LocalNode>;

    /**
     * Distribute the nodes and find the eigenvalues of I - W, the smallest by
     * power iteration, the largest by Gershgorin's circles (collective).
     * @param positions any nodal vector of the mesh
     * @param vertices  owned nodes that move, ascending
     * @param links     neighbours of each, also those that do not move; the
     *        weights of a node have the sum 1
     */
    void
    reinit(const NodalVector                    &positions,
           const std::vector<LocalNode>         &vertices,
           const std::vector<std::vector<Link>> &links);

    /** How the iteration ended. */
    struct Report
    {
      bool         converged = false; ///< within the tolerance
      unsigned int n_sweeps  = 0;     ///< that were made
    };

    /**
     * Move the nodes (collective).
     * @param positions the start, in the end the solution [mm]
     * @param sizes     of the mesh at each own vertex [mm]
     * @param tolerance distance of each x_i from its sum at which the iteration
     *        ends, relative to the size
     */
    Report
    solve(NodalVector               &positions,
          const std::vector<double> &sizes,
          const double               tolerance,
          const unsigned int         largest_number_of_sweeps) const;

  private:
    using Partitioner = dealii::Utilities::MPI::Partitioner;

    /** Numbers of a node that are sent: x, what held neighbours add, size. */
    static constexpr unsigned int n_sent = 2 * dim + 1;

    void
    find_eigenvalues(const double largest_row);

    // On the mesh:
    std::vector<LocalNode>         vertices;
    std::vector<std::vector<Link>> held; ///< neighbours that do not move
    /** Owned: by vertices of this process; ghosts: those it sweeps. */
    std::shared_ptr<const Partitioner> to_sweeps;
    // Where they are swept, by equal numbers of nodes:
    std::vector<unsigned int> first_link; ///< of each node, and the end
    std::vector<std::pair<double, unsigned int>> links; ///< local, of x
    std::vector<unsigned int>          inner; ///< nodes without links to ghosts
    std::vector<unsigned int>          at_ghosts; ///< the other ones
    std::shared_ptr<const Partitioner> swept;     ///< ghosts: neighbours
    /** The same nodes; ghosts: those on this process in the mesh. */
    std::shared_ptr<const Partitioner> to_mesh;
    double smallest_eigenvalue = 0., largest_eigenvalue = 2.;
  };
} // namespace alveolus

#endif
