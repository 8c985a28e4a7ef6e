// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_gap_h
#define alveolus_assembly_contact_gap_h

#include <alveolus/assembly/contact_surface.h>

namespace alveolus
{
  /**
   * Numbers of the nodes of an edge and of the other nodes of its neighbours:
   * with the point x over the edge, those which the gap depends on. Coordinates
   * are (x_1, x_2, first node_1, first node_2, ...).
   */
  struct ContactPatch
  {
    /**
     * Coordinates at most: the point and the nodes of three edges of degree 2.
     */
    static constexpr unsigned int max_size = 16;

    using Row = std::array<double, max_size>; ///< derivatives by coordinates

    /** @p alone: without the neighbours. */
    ContactPatch(const ContactSurface &surface,
                 const unsigned int    edge,
                 const bool            alone = false);

    /** Number of coordinates. */
    unsigned int
    size() const
    {
      return 2 + 2 * nodes.size();
    }

    /** Of the outline; those of the edge are the first. */
    std::vector<unsigned int> nodes;
    /** Of the first ones, how many are of the edge. */
    unsigned int n_nodes_of_edge;
  };

  /**
   * Gap g = n . (x - y(xi)), its unit normal n and the foot xi of a point x
   * over an edge, all of which follow the motion of the coordinates of a
   * ContactPatch. With the interpolated normal m = |m| n between those of the
   * ends, s _|_ n and e = dx - N_b dy_b
   *
   *   dxi = (s . e - (g/|m|) s . dm|)/(s . y' + (g/|m|) s . m'),
   *   dg  = n . e - n . y' dxi,    dn = s (s . dm| + s . m' dxi)/|m|,
   *
   * dm| being the change at a fixed xi.
   */
  struct ContactGap
  {
    /** @p projection of @p x onto the surface */
    ContactGap(const dealii::Point<2>  &x,
               const ContactSurface    &surface,
               const ContactProjection &projection);

    /** Coordinates that all of this depends on. */
    ContactPatch         patch;
    double               gap = 0.; ///< [mm]
    dealii::Tensor<1, 2> normal;   ///< unit one, out of the surface
    /** Shape functions of the edge at the foot, and their derivatives by xi. */
    std::array<double, 3> shapes;
    std::array<double, 3> shape_derivatives; ///< see shapes
    ContactPatch::Row     d_gap{};           ///< derivatives of the gap [-]
    ContactPatch::Row     d_foot{};          ///< [1/mm]
    /** Of the normal's components [1/mm]. */
    std::array<ContactPatch::Row, 2> d_normal{};
  };

  /** A function of the coordinates of a ContactPatch without neighbours. */
  struct ContactMeasure
  {
    /** Derivatives by coordinate. */
    using Row = ContactPatch::Row;

    double value = 0.; ///< [mm]
    /** Of the value by coordinates [-]. */
    Row                                     gradient{};
    std::array<Row, ContactPatch::max_size> hessian{}; ///< [1/mm]
  };

  /**
   * The offset d = x - y(xi) of a point from the material point @p xi of an
   * edge, by components in the frame (n, t) of the edge there, which turns with
   * it: g = n . d, s = t . d. With the rotation dw = n . N_b' dy_b/|y'|
   *
   *   dg = n . e - s dw,   ds = t . e + g dw.
   */
  struct ContactOffset
  {
    /**
     * @param x a point [mm]
     * @param edge of the surface
     * @param xi of the material point on it, in [0, 1]
     */
    ContactOffset(const dealii::Point<2> &x,
                  const ContactSurface   &surface,
                  const unsigned int      edge,
                  const double            xi);

    ContactPatch   patch; ///< coordinates that both depend on
    ContactMeasure gap;   ///< along the outward normal
    ContactMeasure slip;  ///< along the tangent, from begin to end
  };
} // namespace alveolus

#endif
