// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_quad_optimiser_h
#define alveolus_mesh_quad_optimiser_h

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace alveolus
{
  /** Vertices of a quad in deal.II's lexicographic order. */
  using Quad = std::array<unsigned int, 4>;

  /**
   * Smallest scaled Jacobian of the corners of a quad: the sine of the angle
   * between the edges that meet (Knupp 2000), -1 if an edge vanishes.
   */
  double
  scaled_jacobian(const std::vector<dealii::Point<2>> &vertices,
                  const Quad                          &quad);

  /**
   * Put a ring of cells around some of the cells, which shrink (pillowing,
   * Mitchell and Tautges 1995); the ring lies between their outer edges and
   * where these were. Here for one cell:
   *
   *     d-----------c          d-----------c
   *     |           |          | d'-----c' |
   *     |           |    ->    | |      |  |
   *     |           |          | a'-----b' |
   *     a-----------b          a-----------b
   *
   * @param cells which of them, connected by edges; new cells come at the end
   * @param fixed vertices that may not move; grows with @p vertices
   */
  void
  pillow(std::vector<dealii::Point<2>>   &vertices,
         std::vector<Quad>               &quads,
         std::vector<bool>               &fixed,
         const std::vector<unsigned int> &cells);

  /**
   * Give a second cell to boundary vertices that have one only although the
   * boundary is nearly straight there: such a cell owns two edges of the
   * boundary, and no movement of vertices could make the sine of its angle
   * larger. It is pillowed. A vertex counts if its angle is obtuse and its sine
   * below
   * @p least_sine.
   * @param fixed vertices at the boundary; grows with @p vertices
   * @return the number of cells divided
   */
  unsigned int
  divide_flat_corners(std::vector<dealii::Point<2>> &vertices,
                      std::vector<Quad>             &quads,
                      std::vector<bool>             &fixed,
                      const double                   least_sine);

  /**
   * Move vertices so that the smallest scaled Jacobian of the quads grows.
   * First @p n_smoothing sweeps of Laplacian smoothing, each vertex moving to
   * the mean of its neighbours only where the worst of its cells does not get
   * worse than it was or than @p good_quality. Then up to @p n_sweeps sweeps
   * over the vertices with a cell below @p good_quality, each looking in eight
   * directions with halved steps for the place where the worst of its cells is
   * best. Vertices are taken in ascending order: deterministic.
   * @param fixed vertices that stay where they are
   * @return the smallest scaled Jacobian reached
   */
  double
  optimise_quads(std::vector<dealii::Point<2>> &vertices,
                 const std::vector<Quad>       &quads,
                 const std::vector<bool>       &fixed,
                 const double                   good_quality,
                 const unsigned int             n_smoothing = 5,
                 const unsigned int             n_sweeps    = 50);
} // namespace alveolus

#endif
