// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_nodes_h
#define alveolus_mesh_nodes_h

#include <alveolus/mesh/configuration.h>

#include <array>
#include <unordered_map>
#include <vector>

namespace alveolus
{
  /** A node is known everywhere by the global index of its first component. */
  using NodeId = dealii::types::global_dof_index;

  /**
   * An ordered curve of mesh nodes, replicated on every process. The order is
   * the same for any number of processes: an open curve begins at the end with
   * the smaller initial position (x first, then y, z), a closed one at its
   * smallest node, towards the smaller one of its two neighbours; the first
   * node is not repeated at the end.
   */
  struct NodeCurve
  {
    std::vector<NodeId> nodes;          ///< along the curve
    bool                closed = false; ///< the last one is next to the first
  };

  /**
   * The node view of a Configuration: support points of FE_Q(degree) with their
   * dim degrees of freedom, and the nodes of named points, curves, boundaries
   * and regions. Built once per mesh. In 2D a name of a boundary is also the
   * name of a curve.
   */
  template <int dim>
  class Nodes
  {
  public:
    /** @param configuration must outlive this object (collective) */
    explicit Nodes(const Configuration<dim> &configuration);

    /** True where the node is owned by this process. */
    bool
    is_owned(const NodeId node) const;

    /** True where this process sees the node (owned or ghost). */
    bool
    is_relevant(const NodeId node) const;

    /** Global indices of the dim components of a relevant node. */
    const std::array<dealii::types::global_dof_index, dim> &
    dofs(const NodeId node) const;

    /** All relevant nodes in ascending order. */
    const std::vector<NodeId> &
    relevant() const;

    /** Value of the nodal vector @p field at a relevant node. */
    dealii::Point<dim>
    get(const NodalVector &field, const NodeId node) const;

    /** Set an owned node; ghost values are updated by the caller. */
    void
    set(NodalVector              &field,
        const NodeId              node,
        const dealii::Point<dim> &value) const;

    /**
     * Values of @p field at @p nodes on every process, in the order of
     * @p nodes (collective; each node must be owned by some process).
     */
    std::vector<dealii::Point<dim>>
    gather(const NodalVector &field, const std::vector<NodeId> &nodes) const;

    /**
     * Nodes of a relevant cell in the numbering of FE_Q(degree): vertices,
     * lines, faces (3D), interior.
     */
    void
    cell_nodes(const typename dealii::DoFHandler<dim>::active_cell_iterator &c,
               std::vector<NodeId> &nodes) const;

    /** Node at a named point (collective). @throws InputError */
    NodeId
    point(const std::string &name, const std::string &where) const;

    /**
     * Ordered nodes of a named curve, vertices and (degree 2) line midpoints
     * (collective). @throws InputError if unknown, branched or in several parts
     */
    NodeCurve
    curve(const std::string &name, const std::string &where) const;

    /**
     * Relevant nodes on a named curve, ascending, whatever its shape, branched
     * or in parts (collective). @throws InputError
     */
    std::vector<NodeId>
    on_curve(const std::string &name, const std::string &where) const;

    /**
     * Relevant nodes on a named boundary piece, ascending (collective).
     * @throws InputError
     */
    std::vector<NodeId>
    boundary(const std::string &name, const std::string &where) const;

    /**
     * Relevant nodes of the cells of a named region, ascending (collective).
     * @throws InputError
     */
    std::vector<NodeId>
    region(const std::string &name, const std::string &where) const;

    const Configuration<dim> &configuration; ///< whose nodes these are

  private:
    /** Relevant nodes among those marked by their owners, ascending. */
    std::vector<NodeId>
    collect(NodalVector &marks) const;

    std::vector<NodeId> relevant_nodes;
    std::unordered_map<NodeId, std::array<dealii::types::global_dof_index, dim>>
      components;
  };
} // namespace alveolus

#endif
