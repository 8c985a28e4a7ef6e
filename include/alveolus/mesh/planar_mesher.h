// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_planar_mesher_h
#define alveolus_mesh_planar_mesher_h

#include <alveolus/mesh/area_mesher.h>
#include <alveolus/mesh/mesh_description.h>

namespace alveolus
{
  /** What a mesh of quads became. */
  struct PlanarMeshReport
  {
    /** One line for each area: cells, quality, options taken. */
    std::vector<std::string> areas;
    double                   smallest_scaled_jacobian = 0.; ///< of all corners
    /** Attempts of gmsh, all together. */
    unsigned int n_mesher_runs = 0;

    /** All areas in one line. */
    std::string
    summary() const;
  };

  /**
   * Fill a plane geometry with quads (collective). The nodes on curves are
   * those of @p geometry exactly, so that areas fit together. Areas
   * with a finished mesh keep it, structured areas are filled by
   * mesh_structured_area(), others by mesh_unstructured_area(), each with the
   * options of the mesher's list in turn until its smallest scaled Jacobian is
   * good (or the best of them): the result is deterministic.
   * @return a description that has passed check_description()
   * @throws InputError if gmsh cannot be started, RunError if no attempt gives
   * a valid mesh of an area, or a loop of an unstructured area has an odd
   * number of segments, or a structured one unequal sides
   */
  MeshDescription<2>
  mesh_planar_geometry(const PlanarGeometry &geometry,
                       const PlanarMesher   &mesher,
                       const MeshingJob     &job,
                       PlanarMeshReport     &report);
} // namespace alveolus

#endif
