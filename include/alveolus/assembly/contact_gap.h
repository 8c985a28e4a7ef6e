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
    static constexpr unsigned int max_size = 16;

    using Row = std::array<double, max_size>; ///< derivatives by coordinates

    /** @p alone: without the neighbours. */
    ContactPatch(const ContactSurface &surface,
                 const unsigned int    edge,
                 const bool            alone = false);

    unsigned int
    size() const
    {
      return 2 + 2 * nodes.size();
    }

    /** Of the outline; those of the edge are the first. */
    std::vector<unsigned int> nodes;
    unsigned int              n_nodes_of_edge;
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

    ContactPatch                     patch;
    double                           gap = 0.; ///< [mm]
    dealii::Tensor<1, 2>             normal;
    std::array<double, 3>            shapes, shape_derivatives; ///< of the edge
    ContactPatch::Row                d_gap{};
    ContactPatch::Row                d_foot{}; ///< [1/mm]
    std::array<ContactPatch::Row, 2> d_normal{};
  };

  /** A function of the coordinates of a ContactPatch without neighbours. */
  struct ContactMeasure
  {
    using Row = ContactPatch::Row;

    double                                  value = 0.; ///< [mm]
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
    ContactOffset(const dealii::Point<2> &x,
                  const ContactSurface   &surface,
                  const unsigned int      edge,
                  const double            xi);

    ContactPatch   patch;
    ContactMeasure gap;  ///< along the outward normal
    ContactMeasure slip; ///< along the tangent, from begin to end
  };
} // namespace alveolus

#endif
