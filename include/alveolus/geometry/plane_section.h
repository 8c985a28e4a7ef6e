// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_plane_section_h
#define alveolus_geometry_plane_section_h

#include <alveolus/geometry/outline.h>

#include <string>

namespace alveolus
{
  /** A plane in space with axes of its own: y is `up`, x is up x normal. */
  struct SectionPlane
  {
    dealii::Point<3>     origin; ///< of the axes [mm]
    dealii::Tensor<1, 3> normal; ///< of length 1
    dealii::Tensor<1, 3> up;     ///< of length 1, orthogonal to the normal
  };

  /** Whether the program was built with CGAL, which cut_surface() needs. */
  bool
  can_cut_surfaces();

  /**
   * Outline of a closed surface in a plane: the surface is read from an STL
   * file (text or binary), its facets joined at equal corners and turned the
   * same way, and cut by CGAL's Polygon_mesh_slicer. The points of the outline
   * are where edges of facets cross the plane, in the plane's axes [mm].
   *
   * @param content of the file
   * @param source  its name, for messages
   * @param unit    length of the file's unit [mm]
   * @param loop    number of the loop to take, 1 for that of the largest area;
   *                0 where there must be one only
   * @param where   the parameter that gives @p loop, for messages
   * @throws InputError: no STL file, a surface that is not closed, a plane that
   * misses it, several loops (the message lists them), see checked_outline();
   * a program built without CGAL
   */
  Outline
  cut_surface(const std::string  &content,
              const std::string  &source,
              const double        unit,
              const SectionPlane &plane,
              const unsigned int  loop,
              const std::string  &where);
} // namespace alveolus

#endif
