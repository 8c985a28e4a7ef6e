// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_anchored_curve_h
#define alveolus_rezoning_anchored_curve_h

#include <alveolus/mesh/nodes.h>

#include <set>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * A curve of nodes some of which a line rule must not move, its anchors: the
   * ends of an open curve, and nodes that rules of earlier stages set; on a
   * closed curve without any, the first node. The others keep their relative
   * places between the anchors on either side.
   */
  class AnchoredCurve
  {
  public:
    /** @param taken nodes that are anchors */
    AnchoredCurve(const NodeCurve &curve, const std::set<NodeId> &taken);

    /**
     * Keep @p stations, e.g. arc lengths from the first node, ascending; of a
     * closed curve one more, where its first node is reached again.
     */
    void
    keep(const std::vector<double> &stations);

    /** Whether node @p i of the curve is placed by another rule. */
    bool
    is_anchor(const unsigned int i) const
    {
      return before[i] == static_cast<int>(i);
    }

    /** Number of such nodes. */
    unsigned int
    n_anchors() const;

    /** Nodes that are no anchors. */
    std::vector<NodeId>
    free_nodes() const;

    /** Index (modulo the number of nodes) of the anchors on either side. */
    std::pair<unsigned int, unsigned int>
    anchors(const unsigned int i) const;

    /** Kept place of node i between its anchors, 0 to 1: (s_i-s_a)/(s_b-s_a).
     */
    double
    relative(const unsigned int i) const;

    /**
     * New station of node i between the anchors at their new stations @p now.
     * May lie outside of [0, length] on a closed curve: take it modulo.
     */
    double
    station(const unsigned int i, const std::vector<double> &now) const;

    const NodeCurve curve; ///< its nodes in order

  private:
    /** Station of index @p i, which may be one turn back or ahead. */
    double
    unrolled(const std::vector<double> &stations, const int i) const;

    /** Indices of the last anchor up to, and of the next one after, each node;
     * negative or beyond the nodes where a closed curve turns round. */
    std::vector<int>    before, after;
    std::vector<double> kept;
  };
} // namespace alveolus

#endif
