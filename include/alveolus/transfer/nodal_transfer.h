// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_nodal_transfer_h
#define alveolus_transfer_nodal_transfer_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/mesh/hanging_nodes.h>
#include <alveolus/transfer/cell_nodes.h>

#include <vector>

namespace alveolus
{
  /** What a nodal transfer did (over all processes). */
  struct NodalTransferReport
  {
    unsigned int n_subcycles = 0; ///< parts that the motion was divided into
    unsigned int n_moved     = 0; ///< nodes evaluated
    /** Nodes outside the old mesh, e.g. on a curved boundary. */
    unsigned int n_extrapolated   = 0;
    double       largest_distance = 0.; ///< of those from the old mesh [mm]
  };

  /**
   * A nodal field, e.g. the material displacement u, moved from mesh x_old to
   * mesh x_new on the same connectivity: the new nodal value is the old finite
   * element function at the new place of the node, searched in the cells around
   * that node. A field that is linear in x is kept exactly. Nodes that do not
   * move keep their value to the last bit. A boundary node that leaves the old
   * mesh takes the polynomial of the best cell beyond its face and is counted.
   * If a node leaves the cells around it, the motion is split in 2, 4, ...
   * equal parts (each is an interpolation of its own).
   */
  template <int dim>
  class NodalTransfer
  {
  public:
    /** Collects the cells around each node; once per mesh. */
    explicit NodalTransfer(const Configuration<dim> &configuration);

    /**
     * Replace @p u (nodal vector of the configuration) by its values at the
     * nodes of @p x_new; ghosts of @p u are updated (collective).
     * @throws RunError if a node is not found even in 64 parts
     */
    NodalTransferReport
    transfer(NodalVector       &u,
             const NodalVector &x_old,
             const NodalVector &x_new) const;

  private:
    /** A cell around a node. */
    struct Candidate
    {
      unsigned int cell;
      unsigned int node; ///< the node's number in the cell, if it has it
    };

    /** An owned node with its candidates, the same for any partition. */
    struct Node
    {
      std::vector<Candidate> candidates;
      bool                   at_boundary = false;
    };

    /** Returns the number of owned nodes that were not found. */
    unsigned int
    evaluate(const NodalVector   &u,
             const NodalVector   &x_old,
             const NodalVector   &x_new,
             NodalVector         &result,
             NodalTransferReport &report) const;

    const Configuration<dim> &configuration;
    const CellNodes<dim>      cells;
    const HangingNodes<dim>   hanging;
    std::vector<Node>         nodes;
    /** By active cell: which faces are at the domain boundary. */
    std::vector<std::array<bool, 2 * dim>> boundary_face;
  };
} // namespace alveolus

#endif
