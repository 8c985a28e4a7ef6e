// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_surface_h
#define alveolus_assembly_contact_surface_h

#include <alveolus/assembly/contact_outline.h>

namespace alveolus
{
  /** Where a point faces an outline. */
  struct ContactProjection
  {
    unsigned int edge = no_edge; ///< no_edge: it faces none
    double       xi   = 0.;      ///< foot, outside [0, 1] at sharp kinks only
    double       gap  = 0.;      ///< along the outward normal; < 0: inside [mm]

    /** Whether the point faces an edge. */
    bool
    found() const
    {
      return edge != no_edge;
    }
  };

  /**
   * A deformed outline with normals that turn continuously. At a joint of two
   * edges that is not sharp both have the mean of their normals; along an edge
   * the normal is interpolated between its ends. So a point that slides over a
   * joint feels no jump in the direction of the force, as it would on the
   * polygon itself, where Newton's method would go back and forth between two
   * edges. The gap is measured to the polygon (parabolas) itself.
   */
  class ContactSurface
  {
  public:
    /**
     * @param smooth for each edge whether its joint with the previous edge is
     *        to be smoothed
     */
    ContactSurface(const ContactOutline                &outline,
                   const std::vector<dealii::Point<2>> &positions,
                   const std::vector<bool>             &smooth);

    /**
     * The joints where the outline turns by less than @p angle [rad], for the
     * constructor.
     */
    static std::vector<bool>
    smooth_joints(const ContactOutline                &outline,
                  const std::vector<dealii::Point<2>> &positions,
                  const double                         angle);

    /** An edge as a curve at the positions of this surface. */
    EdgeCurve
    curve(const unsigned int edge) const
    {
      return outline.curve(edge, positions);
    }

    /** Unit normal at the begin (0) or end (1) of an edge, the mean one. */
    const dealii::Tensor<1, 2> &
    end_normal(const unsigned int edge, const unsigned int end) const
    {
      return end_normals[edge][end];
    }

    /** The edge whose normal enters end_normal(), too; or no_edge. */
    unsigned int
    smooth_neighbour(const unsigned int edge, const unsigned int end) const;

    /**
     * Interpolated normal, not of unit length; beyond an end that of the edge
     * alone at this end.
     */
    dealii::Tensor<1, 2>
    normal(const unsigned int edge, const double xi) const
    {
      if (xi < 0. || xi > 1.)
        return curve(edge).normal(xi < 0. ? 0. : 1.);
      return (1. - xi) * end_normals[edge][0] + xi * end_normals[edge][1];
    }

    /**
     * The nearest of some edges that @p x lies over in the direction of the
     * normal.
     *
     * At a sharp kink there is a fan of points that lie over none of both
     * edges. There the edge is taken beyond whose end the foot lies less far,
     * continued along itself: so the gap is a continuous function of x and of
     * the nodes. Beyond the end of the outline, or of the given edges, there is
     * no projection: a body that turns about a vertex which it shares with the
     * outline touches nothing as long as the angle is more than 90 degrees.
     *
     * An edge that has @p x behind it counts only if @p normal, the outward one
     * of the boundary that @p x is on, points against its own within 45
     * degrees. Otherwise x is not inside, but on the other side of a wedge:
     * e.g. the edge of a ligament that sinks into its socket has the outer
     * slope of the bone's crest in front of it, seen from inside.
     */
    ContactProjection
    project(const dealii::Point<2>          &x,
            const dealii::Tensor<1, 2>      &normal,
            const std::vector<unsigned int> &candidates) const;

    /** Of whose lines the surface consists; must outlive this object. */
    const ContactOutline &outline;
    /** Of the outline's nodes [mm]. */
    const std::vector<dealii::Point<2>> positions;

  private:
    /**
     * Solve (x - y(xi)) x n(xi) = 0 with n between @p begin and @p end; whether
     * there is a foot near the edge.
     */
    bool
    foot(const dealii::Point<2>     &x,
         const unsigned int          edge,
         const dealii::Tensor<1, 2> &begin,
         const dealii::Tensor<1, 2> &end,
         double                     &xi) const;

    const std::vector<bool>                          smooth;
    std::vector<std::array<dealii::Tensor<1, 2>, 2>> end_normals;
  };
} // namespace alveolus

#endif
