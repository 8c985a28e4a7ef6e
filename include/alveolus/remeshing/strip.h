// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_strip_h
#define alveolus_remeshing_strip_h

#include <alveolus/remeshing/gathered_mesh.h>

#include <functional>
#include <set>

namespace alveolus
{
  /**
   * The end of a strip of cells, from its free edge (rim) down to a straight
   * line of the mesh across the strip (cut):
   *
   *     a_0 ---- rim ---- b_0
   *      |                 |
   *    side a            side b
   *      |                 |
   *     a_k ---- cut ---- b_k
   *
   * The outline runs anticlockwise: along the rim from side a to side b.
   */
  struct StripZone
  {
    std::vector<unsigned int> rim;       ///< nodes from a_0 to b_0
    std::vector<unsigned int> side_a;    ///< nodes from rim to cut
    std::vector<unsigned int> side_b;    ///< nodes from rim to cut
    std::vector<unsigned int> cut;       ///< nodes from a_k to b_k
    std::set<MeshLine>        cut_lines; ///< lines of the cut
  };

  /**
   * Find the zone at the end of a strip.
   * @param materials of the strip's cells
   * @param is_rim whether a line is part of the rim
   * @param length least length of both sides [mm]; the cut is the first
   * straight line of the mesh beyond it that joins sides of the same, even
   * number of edges
   * @throws RunError if there is no rim, or no such line within ten times the
   *         length
   */
  StripZone
  find_strip_zone(const GatheredMesh                          &mesh,
                  const std::set<dealii::types::material_id>  &materials,
                  const std::function<bool(const MeshLine &)> &is_rim,
                  const double                                 length,
                  const std::string                           &name);
} // namespace alveolus

#endif
