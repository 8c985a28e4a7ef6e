// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_outline_h
#define alveolus_geometry_outline_h

#include <alveolus/geometry/cubic_spline.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * A closed polygon with labelled pieces, in anticlockwise order, as read from
   * a file. The first point is not repeated.
   */
  struct Outline
  {
    std::string                   source; ///< file name, for messages
    std::vector<dealii::Point<2>> points; ///< [mm]
    /** Label of the line from point i to the next one; empty if it has none. */
    std::vector<std::string> labels;
    std::vector<std::size_t> lines; ///< of the file, for each point
    /** What had to be mended to make it so, for the log. */
    std::vector<std::string> remarks;

    /** The outline turned about the origin by @p angle [rad], then shifted. */
    Outline
    placed(const double angle, const dealii::Tensor<1, 2> &shift) const;
  };

  /**
   * Read a closed outline: one point a line, `x,y` or `x,y,label`, the
   * label being that of the line to the next point. Numbers are parted by
   * commas, blanks, tabs, or by semicolons; then commas are decimal ones. Lines
   * that begin with # are comments, a first line that does not begin with a
   * number is a heading. A third number that is the same in all lines (the
   * height of the plane) is left out.
   *
   * Accepted and told in `remarks`: the first point repeated at the end, a
   * point repeated at once (closer than 1e-7 of the outline's size), a
   * clockwise ring, which is turned round.
   * @param text   content of the file
   * @param source name of the file for the messages
   * @param unit   length of the file's unit [mm]
   * @throws InputError with file and line: no numbers, fewer than 8 points,
   * lines that cross or touch, no area, a third number that varies, an outline
   * smaller than 0.5 or larger than 1000 mm
   */
  Outline
  read_outline(const std::string &text,
               const std::string &source,
               const double       unit = 1.);

  /**
   * The same checks, mending and remarks for points from elsewhere.
   * @param outline points [mm], lines, and labels, all of the same number
   */
  Outline
  checked_outline(Outline outline);

  /** Area inside a closed polygon, positive if anticlockwise [mm^2]. */
  double
  signed_area(const std::vector<dealii::Point<2>> &polygon);

  /** Centroid of the area inside a closed polygon [mm]. */
  dealii::Point<2>
  centroid_of(const std::vector<dealii::Point<2>> &polygon);

  /**
   * Where an outline crosses itself: the first pair of lines (i from point i to
   * the next one, i < j) of the closed polygon that cross or touch without
   * being neighbours, or of neighbours that fold back onto each other.
   * @return false if there is none
   */
  bool
  find_crossing(const std::vector<dealii::Point<2>> &polygon,
                std::size_t                         &i,
                std::size_t                         &j);

  /** A stretch of an outline with one name, between two arc lengths [mm]. */
  struct Stretch
  {
    double      begin = 0.; ///< arc length [mm]
    double      end   = 0.; ///< arc length [mm]
    std::string name;       ///< label of its points, or empty
  };

  /**
   * A smooth curve through the points of an outline: interpolating cubic
   * splines from corner to corner, closed if there are no corners. A corner is
   * a point where the polygon turns by more than a given angle. Positions are
   * arc lengths s [mm] from the first corner (or the first point),
   * anticlockwise, modulo the whole length.
   */
  class SmoothOutline
  {
  public:
    /** @param corner_angle in radians */
    SmoothOutline(const Outline &outline, const double corner_angle);

    /** Length of the whole outline [mm]. */
    double
    length() const
    {
      return start.back();
    }

    /** Point at the arc length @p s from the begin [mm]. */
    dealii::Point<2>
    point(const double s) const;

    /** Unit tangent; at a corner that of the curve after it. */
    dealii::Tensor<1, 2>
    tangent(const double s) const;

    /** Unit normal to the right of the tangent: outwards. */
    dealii::Tensor<1, 2>
    normal(const double s) const;

    /** Positions of the corners in ascending order. */
    const std::vector<double> &
    corners() const
    {
      return corner_positions;
    }

    /** Positions where a label begins, ascending; none if all are the same. */
    const std::vector<double> &
    label_starts() const
    {
      return label_positions;
    }

    /** Label at position @p s; where two meet, that of the one beginning. */
    const std::string &
    label(const double s) const;

    /**
     * The outline from @p begin to @p end > begin as stretches with one name
     * @p name(s) each (their ends are found by bisection), divided at corners,
     * too.
     */
    std::vector<Stretch>
    stretches(const double                                      begin,
              const double                                      end,
              const std::function<std::string(const double s)> &name) const;

    /** @p s within [0, length). */
    double
    wrapped(const double s) const;

  private:
    std::pair<std::size_t, double>
    span_of(const double s) const;

    std::vector<CubicSpline<2>> spans;
    std::vector<double>      start; ///< of each span; whole length at the end
    std::vector<double>      corner_positions, label_positions;
    std::vector<std::string> labels;
  };
} // namespace alveolus

#endif
