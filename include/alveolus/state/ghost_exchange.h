// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_ghost_exchange_h
#define alveolus_state_ghost_exchange_h

#include <deal.II/distributed/tria.h>

#include <vector>

namespace alveolus
{
  /**
   * Copies per-cell blocks of numbers from the owners of cells to the processes
   * that see them as ghosts, with one message per neighbouring process. The
   * pattern is built once per mesh.
   */
  template <int dim>
  class GhostExchange
  {
  public:
    /** Of the mesh whose cells exchange. */
    using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

    /** Build the pattern (collective). */
    explicit GhostExchange(const Triangulation &triangulation);

    /**
     * Fill the blocks of ghost cells (collective). The block of active cell c
     * is values[begin[c]], ..., values[begin[c+1]-1]; its size must be the same
     * on owner and receiver.
     * @param begin n_active_cells() + 1 offsets
     */
    void
    update(std::vector<double>            &values,
           const std::vector<std::size_t> &begin) const;

  private:
    /** What goes to and comes from one other process (active cell indices). */
    struct Link
    {
      unsigned int              rank;
      std::vector<unsigned int> send;
      std::vector<unsigned int> receive;
    };

    MPI_Comm          communicator;
    std::vector<Link> links;
  };
} // namespace alveolus

#endif
