// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_convex_overlap_h
#define alveolus_geometry_convex_overlap_h

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>

namespace alveolus
{
  /**
   * A small convex body: in 2D a polygon of three or four corners,
   * counterclockwise; in 3D a tetrahedron with det[c_1-c_0, c_2-c_0, c_3-c_0]
   * > 0. Corners in mm.
   */
  template <int dim>
  struct ConvexPiece
  {
    /** In order around (2D), or of a tetrahedron [mm]. */
    std::array<dealii::Point<dim>, 4> corners;
    /** Of these, how many count. */
    unsigned int n_corners = 4;
  };

  /** Volume (2D: area) and first moment of a body. */
  template <int dim>
  struct Moments
  {
    double volume = 0.; ///< [mm^dim]
    /** The integral of x - x_0 [mm^(dim+1)]; what x_0 is says the function. */
    dealii::Tensor<1, dim> first;
  };

  /** Volume of @p piece and its first moment about its first corner. */
  template <int dim>
  Moments<dim>
  moments(const ConvexPiece<dim> &piece);

  /**
   * Volume of the intersection of two convex bodies and its first moment about
   * the first corner of @p a. In 2D by clipping polygon @p a with the edges of
   * @p b (Sutherland, Hodgman, Comm. ACM 17 (1974) 32-42), in 3D by cutting the
   * tetrahedron @p a into tetrahedra along the faces of @p b. Exact but for
   * round-off; both are zero if the bodies only touch or are apart.
   */
  template <int dim>
  Moments<dim>
  overlap(const ConvexPiece<dim> &a, const ConvexPiece<dim> &b);
} // namespace alveolus

#endif
