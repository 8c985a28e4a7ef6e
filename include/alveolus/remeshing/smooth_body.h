// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_smooth_body_h
#define alveolus_remeshing_smooth_body_h

#include <alveolus/geometry/box_tree.h>
#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/remeshing/body_surface.h>

#include <memory>

namespace alveolus
{
  /**
   * Smooth curves and surfaces through the nodes of a BodySurface, on which new
   * nodes are put.
   *
   * Curves are cubic splines, with a parameter that is i at the i-th node. A
   * patch is divided into triangles; over a point y = sum_i l_i x_i of one with
   * the corners x_i the surface is
   *
   *   y + 1/2 sum_i l_i ((x_i - y) . n_i) n_i,
   *
   * n_i the unit normals at the corners (T. Boubekeur, M. Alexa: Phong
   * tessellation, ACM Trans. Graph. 27 (2008) 141, with their factor 1/2, for
   * which the chord's height comes out right). The normals are those of a
   * quadratic function over the tangent plane fitted to the nodes of the patch
   * around. Planes are exact; otherwise the error is of third order in the
   * length of edges, of second order without the correction.
   *
   * Where walls of a layer are glued together, the place on one wall is found
   * in the first part and taken over to the other by the weights l_i.
   */
  class SmoothBody
  {
  public:
    /** Where a point of a patch is. */
    struct Place
    {
      unsigned int triangle = 0; ///< index among the triangles
      /** Of its corners; their sum is 1. */
      std::array<double, 3> weights{{1., 0., 0.}};
    };

    /** Of a patch; its faces are divided into such. */
    struct Triangle
    {
      std::array<unsigned int, 3> nodes{};   ///< counterclockwise, as the face
      unsigned int                patch = 0; ///< that it is part of
    };

    /** @param body must outlive this object */
    explicit SmoothBody(const BodySurface &body);

    /** Whose nodes the curves and patches go through. */
    const BodySurface        &body;
    std::vector<Triangle>     triangles;  ///< of all patches
    std::vector<unsigned int> patch_face; ///< some face of each patch
    std::vector<double>       sizes;      ///< wanted edge length at nodes [mm]
    unsigned int              n_plain_normals = 0; ///< not fitted

    /** Parts of a patch; the first one is where it is measured. */
    const std::vector<unsigned int> &
    parts_of(const unsigned int patch) const
    {
      return patch_parts[patch];
    }

    /** Point of a curve at the parameter @p u. */
    dealii::Point<3>
    on_curve(const unsigned int curve,
             const double       u,
             const unsigned int part) const;

    /** Arc length from the start in the first part of the curve, and back. */
    double
    arc_length(const unsigned int curve, const double u) const;
    /** Parameter at an arc length [mm]. */
    double
    parameter(const unsigned int curve, const double arc_length) const;

    /** Wanted length of edges at a point of a curve [mm]. */
    double
    size_on_curve(const unsigned int curve, const double u) const;

    /** Nearest point of the triangles of a patch, in its first part. */
    Place
    nearest(const unsigned int patch, const dealii::Point<3> &x) const;

    /** Point of the smooth surface. */
    dealii::Point<3>
    on_patch(const Place &place, const unsigned int part) const;

    /** Wanted length of edges at a point of a patch [mm]. */
    double
    size_on_patch(const Place &place) const;

    /**
     * Wanted edge lengths: @p factor times the mean length of the edges of the
     * surface at each node, but not so long that the surface turns by more than
     * @p largest_turn [rad] along them, within the bounds, and no more than s_j
     * + growth |x_i - x_j| for all nodes j.
     */
    void
    set_sizes(const double factor,
              const double smallest,
              const double largest,
              const double growth,
              const double largest_turn);

  private:
    using Normals = std::map<unsigned int, dealii::Tensor<1, 3>>; ///< by node

    void
    divide_faces();
    void
    fit_normals();
    /** Largest normal curvature of the patches at each node [1/mm]. */
    std::vector<double>
    curvatures() const;
    /** Knot interval and place in it. */
    std::pair<unsigned int, double>
    interval(const unsigned int curve, double u) const;

    std::vector<std::vector<unsigned int>>              patch_parts;
    std::vector<std::map<unsigned int, CubicSpline<3>>> splines; ///< by part
    std::map<std::pair<unsigned int, unsigned int>, Normals>
                                             normals; ///< by patch and part
    std::vector<std::unique_ptr<BoxTree<3>>> trees;
    std::vector<std::vector<unsigned int>>   triangles_of; ///< patch
  };
} // namespace alveolus

#endif
