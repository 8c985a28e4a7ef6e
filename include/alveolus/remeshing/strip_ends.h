// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_strip_ends_h
#define alveolus_remeshing_strip_ends_h

#include <alveolus/remeshing/body_outline.h>
#include <alveolus/remeshing/zone_mesher.h>

namespace alveolus
{
  /** A zone at the end of a strip and a mesh of it. */
  struct ZoneChoice
  {
    StripZone zone; ///< which cells are replaced
    ZoneMesh  mesh; ///< what replaces them
  };

  /** What there is to choose from at the ends of strips. */
  struct StripEnds
  {
    std::vector<std::vector<ZoneChoice>> choices; ///< of each end, best first
    std::string counts; ///< what was tried and dropped, for the log

    /**
     * Up to @p n combinations of one choice for each end, so that each end
     * varies: the best of all, then the second of one end with the best of the
     * others, the ends in turn, the one with the lowest quality first, and so
     * on.
     */
    std::vector<std::vector<std::size_t>>
    combinations(const std::size_t n) const;
  };

  /**
   * Mesh the zones at the ends of strips (collective): for each of @p ends the
   * zones of @p lengths [mm] in turn, until one is good.
   * @param materials of the strips
   * @throws RunError if an end has no valid mesh
   */
  StripEnds
  mesh_strip_ends(const GatheredMesh                         &mesh,
                  const NamedSets<2>                         &names,
                  const std::set<dealii::types::material_id> &materials,
                  const std::vector<std::string>             &ends,
                  const std::vector<double>                  &lengths,
                  const ZoneSettings                         &settings,
                  const MeshingJob                           &job);

  /**
   * Fill the zone of a choice in the geometry of a body whose outline was
   * extracted with the cut of the zone; new nodes of the rim make it one curve.
   */
  void
  put_zone(PlanarGeometry    &geometry,
           const BodyOutline &outline,
           const ZoneChoice  &choice);
} // namespace alveolus

#endif
