// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_strip_mesh_h
#define alveolus_mesh_strip_mesh_h

#include <alveolus/mesh/quad_optimiser.h>

#include <array>
#include <vector>

namespace alveolus
{
  /**
   * Quads of a four-sided strip from the nodes of its sides, by transfinite
   * interpolation (W. J. Gordon, C. A. Hall, Int. J. Numer. Methods Eng. 7
   * (1973) 461-477) with weights of the ends that fall to zero within a few
   * widths of the strip, so that a bulging end moves nothing far away. Each end
   * may have a cap of k layers of quads parallel to it,
   *
   *     T_0 ---- T_1 ---- T_2          k = 1, four quads across,
   *      |        |     /  |           two at the end
   *      o ------ o -- o   |
   *      |        |    |\  |
   *      o ------ o -- o --R_1
   *      |        |    |/  |
   *      o ------ o -- o   |
   *      |        |     \  |
   *     B_0 ---- B_1 ---- B_2
   *
   * so that two quads share each corner and none has two sides on the border
   * there: the corner's angle may then grow beyond 180 degrees. An end with a
   * cap has n - 2k segments where n quads lie across the strip.
   */
  struct Strip
  {
    /** Nodes of the sides with their ends; bottom and top in one direction,
     * left and right from bottom to top. */
    std::vector<dealii::Point<2>> bottom;
    std::vector<dealii::Point<2>> right; ///< see bottom [mm]
    std::vector<dealii::Point<2>> top;   ///< see bottom [mm]
    std::vector<dealii::Point<2>> left;  ///< see bottom [mm]
    /** Quads between bottom and top. */
    unsigned int n_across = 1;
    /** Layers of the cap at the left and the right end; 0 is no cap. */
    std::array<unsigned int, 2> caps{{0, 0}};
  };

  /** Mesh of a strip. */
  struct StripMesh
  {
    /** First those of the border: bottom, top, then what is left of the left
     * and the right side; then the inner ones. */
    std::vector<dealii::Point<2>> vertices;
    std::vector<Quad>             quads; ///< vertices by number
    /** Vertices on the border: the first ones. */
    unsigned int n_border = 0;
    /** Indices of the vertices on the sides, as the sides were given. */
    std::vector<unsigned int> bottom;
    std::vector<unsigned int> right; ///< see bottom
    std::vector<unsigned int> top;   ///< see bottom
    std::vector<unsigned int> left;  ///< see bottom
  };

  /**
   * Mesh a strip. Inner vertices near caps are then moved to raise the smallest
   * scaled Jacobian.
   * @throws RunError naming @p name if the numbers of segments do not fit
   */
  StripMesh
  mesh_strip(const Strip &strip, const std::string &name);
} // namespace alveolus

#endif
