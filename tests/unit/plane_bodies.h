// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_plane_bodies_h
#define alveolus_tests_unit_plane_bodies_h

// Outlines of plane bodies, and their meshes.
#include "files_and_messages.h"

#include <alveolus/mesh/planar_mesher.h>

#include <deal.II/base/numbers.h>

#include <sstream>

namespace alveolus::bench
{
  using namespace dealii;

  using Points = std::vector<Point<2>>;

  /** Area of a polygon, positive anticlockwise. */
  inline double
  polygon_area(const Points &p)
  {
    double area = 0.;
    for (std::size_t i = 0; i < p.size(); ++i)
      {
        const Point<2> &a = p[i], &b = p[(i + 1) % p.size()];
        area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
      }
    return area;
  }

  /** Number of the region's cells. */
  inline std::size_t
  n_cells(const MeshDescription<2> &mesh, const std::string &region)
  {
    std::size_t n = 0;
    for (const auto &cell : mesh.cells)
      n += mesh.regions.at(region).count(cell.tag);
    return n;
  }

  /** The mesher's mesh of the geometry. */
  inline MeshDescription<2>
  mesh_of(const PlanarGeometry &geometry, PlanarMeshReport &report)
  {
    return mesh_planar_geometry(geometry,
                                PlanarMesher(),
                                {"planar", folder(), "test", MPI_COMM_WORLD},
                                report);
  }

  /** A closed ring of points on an ellipse, as text. */
  inline std::string
  ring(const double       x,
       const double       y,
       const double       a,
       const double       b,
       const unsigned int n,
       const int          direction = 1)
  {
    std::ostringstream text;
    text.precision(17);
    for (unsigned int i = 0; i < n; ++i)
      {
        const double angle = direction * 2. * numbers::PI * i / n;
        text << x + a * std::cos(angle) << ", " << y + b * std::sin(angle)
             << "\n";
      }
    return text.str();
  }
} // namespace alveolus::bench

#endif
