// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_mesh_picture_h
#define alveolus_io_mesh_picture_h

#include <alveolus/mesh/mesh.h>

#include <string>
#include <vector>

namespace alveolus
{
  /**
   * A mesh as a picture (SVG): regions in colours, boundaries as strong lines,
   * curves inside dashed, points, all with their names; in 3D the boundary
   * seen from the direction (1, 0.9, -1.6), its cells without edges where there
   * are many (collective; the text is empty except on process 0).
   * @param title line above the picture
   */
  template <int dim>
  std::string
  mesh_picture(const Mesh<dim> &mesh, const std::string &title);
} // namespace alveolus

#endif
