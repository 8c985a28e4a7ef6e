// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/line_reader.h>
#include <alveolus/geometry/outline.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr std::size_t least_points = 8;

    constexpr double smallest_size = 0.5, largest_size = 1000.; // [mm]

    double
    cross(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    /** Whether c lies in the box of the line from a to b. */
    bool
    within_box(const Point<2> &a, const Point<2> &b, const Point<2> &c)
    {
      return std::min(a[0], b[0]) <= c[0] && c[0] <= std::max(a[0], b[0]) &&
             std::min(a[1], b[1]) <= c[1] && c[1] <= std::max(a[1], b[1]);
    }

    /** Whether the lines ab and cd have a point in common. */
    bool
    lines_meet(const Point<2> &a,
               const Point<2> &b,
               const Point<2> &c,
               const Point<2> &d)
    {
      const double c_side = cross(b - a, c - a), d_side = cross(b - a, d - a);
      const double a_side = cross(d - c, a - c), b_side = cross(d - c, b - c);
      if (((c_side > 0. && d_side < 0.) || (c_side < 0. && d_side > 0.)) &&
          ((a_side > 0. && b_side < 0.) || (a_side < 0. && b_side > 0.)))
        return true;
      return (c_side == 0. && within_box(a, b, c)) ||
             (d_side == 0. && within_box(a, b, d)) ||
             (a_side == 0. && within_box(c, d, a)) ||
             (b_side == 0. && within_box(c, d, b));
    }
  } // namespace



  Outline
  Outline::placed(const double angle, const Tensor<1, 2> &shift) const
  {
    Outline      result = *this;
    const double c = std::cos(angle), s = std::sin(angle);
    for (Point<2> &p : result.points)
      p = Point<2>(c * p[0] - s * p[1] + shift[0],
                   s * p[0] + c * p[1] + shift[1]);
    return result;
  }



  bool
  find_crossing(const std::vector<Point<2>> &polygon,
                std::size_t                 &i,
                std::size_t                 &j)
  {
    const std::size_t n = polygon.size();
    for (i = 0; i < n; ++i)
      for (j = i + 1; j < n; ++j)
        {
          const Point<2> &a = polygon[i], &b = polygon[i + 1 < n ? i + 1 : 0];
          const Point<2> &c = polygon[j], &d = polygon[j + 1 < n ? j + 1 : 0];
          // Neighbours share a point; they must not fold back.
          const bool after = j == i + 1, before = i == 0 && j + 1 == n;
          if (after || before)
            {
              const Tensor<1, 2> first  = after ? b - a : d - c;
              const Tensor<1, 2> second = after ? d - c : b - a;
              if (cross(first, second) == 0. && first * second < 0.)
                return true;
            }
          else if (std::max(a[0], b[0]) >= std::min(c[0], d[0]) &&
                   std::max(c[0], d[0]) >= std::min(a[0], b[0]) &&
                   lines_meet(a, b, c, d))
            return true;
        }
    return false;
  }



  double
  signed_area(const std::vector<Point<2>> &polygon)
  {
    double area = 0.;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      area += 0.5 * cross(polygon[i] - polygon[0],
                          polygon[(i + 1) % polygon.size()] - polygon[0]);
    return area;
  }



  Point<2>
  centroid_of(const std::vector<Point<2>> &polygon)
  {
    Tensor<1, 2> moment;
    for (std::size_t i = 0; i < polygon.size(); ++i)
      {
        const Tensor<1, 2> a = polygon[i] - polygon[0];
        const Tensor<1, 2> b = polygon[(i + 1) % polygon.size()] - polygon[0];
        moment += cross(a, b) / 6. * (a + b);
      }
    return polygon[0] + moment / signed_area(polygon);
  }



  Outline
  checked_outline(Outline outline)
  {
    const std::string &source = outline.source;
    const auto         erase  = [&outline](const std::size_t i) {
      outline.points.erase(outline.points.begin() + i);
      outline.labels.erase(outline.labels.begin() + i);
      outline.lines.erase(outline.lines.begin() + i);
    };
    const auto place = [&outline, &source](const std::size_t i) {
      return source + ", line " + std::to_string(outline.lines[i]);
    };
    Tensor<1, 2> extent;
    for (unsigned int d = 0; d < 2 && !outline.points.empty(); ++d)
      {
        const auto range =
          std::minmax_element(outline.points.begin(),
                              outline.points.end(),
                              [d](const Point<2> &a, const Point<2> &b) {
                                return a[d] < b[d];
                              });
        extent[d] = (*range.second)[d] - (*range.first)[d];
      }
    const double same = 1e-7 * extent.norm();
    const auto   meet = [&outline, same](const std::size_t i) {
      return outline.points[i].distance(
               outline.points[(i + 1) % outline.points.size()]) <= same;
    };
    if (outline.points.size() > 1 && meet(outline.points.size() - 1))
      {
        erase(outline.points.size() - 1);
        outline.remarks.emplace_back("the first point is repeated at the end");
      }
    // Of repeated points the last one stays: its label is that of the line.
    unsigned int n_repeated = 0;
    for (std::size_t i = 0; i + 1 < outline.points.size();)
      if (meet(i))
        {
          erase(i);
          ++n_repeated;
        }
      else
        ++i;
    if (n_repeated > 0)
      outline.remarks.push_back(std::to_string(n_repeated) +
                                " repeated points left out");
    const std::size_t n = outline.points.size();
    if (n < least_points)
      throw InputError(source,
                       "an outline of " + std::to_string(n) + " points",
                       "give at least " + std::to_string(least_points) +
                         ", one a line as x, y [mm] and, if wanted, a label");
    const double size = std::max(extent[0], extent[1]);
    if (size < smallest_size || size > largest_size)
      {
        std::ostringstream text;
        text.precision(3);
        text << "the outline is " << extent[0] << " x " << extent[1]
             << " mm in size";
        throw InputError(source,
                         text.str(),
                         "lengths are in mm: set `Outline unit` to that of the "
                         "file");
      }
    std::size_t i, j;
    if (find_crossing(outline.points, i, j))
      throw InputError(place(i),
                       "the outline crosses or touches itself: the line from "
                       "here to the next point meets the one that begins at "
                       "line " +
                         std::to_string(outline.lines[j]),
                       "list the points in the order in which they follow "
                       "each other, each once");
    if (signed_area(outline.points) < 0.)
      {
        std::reverse(outline.points.begin(), outline.points.end());
        std::reverse(outline.lines.begin(), outline.lines.end());
        std::reverse(outline.labels.begin(), outline.labels.end());
        // A label belongs to a line: the one that now begins a point earlier.
        std::rotate(outline.labels.begin(),
                    outline.labels.begin() + 1,
                    outline.labels.end());
        outline.remarks.emplace_back("clockwise, turned round");
      }
    return outline;
  }



  Outline
  read_outline(const std::string &text,
               const std::string &source,
               const double       unit)
  {
    Outline outline;
    outline.source = source;
    // Columns may be parted by commas, semicolons or blanks; where there are
    // semicolons, commas are those of decimal numbers.
    std::string blanked = text;
    if (blanked.compare(0, 3, "\xef\xbb\xbf") == 0) // mark of UTF-8
      blanked.erase(0, 3);
    bool comment = false, semicolons = false;
    for (std::size_t i = 0; i < blanked.size(); ++i)
      {
        if (i == 0 || blanked[i - 1] == '\n')
          comment = blanked[i] == '#';
        semicolons = semicolons || (!comment && blanked[i] == ';');
      }
    for (char &c : blanked)
      if (c == ',')
        c = semicolons ? '.' : ' ';
      else if (c == ';')
        c = ' ';
    LineReader reader(blanked, source);
    bool       heading_possible = true;
    const auto begins_number    = [](const std::string_view word) {
      const char first = word.front();
      return (first >= '0' && first <= '9') || first == '-' || first == '+' ||
             first == '.';
    };
    while (reader.advance())
      {
        if (reader.all().front() == '#')
          continue;
        if (!begins_number(reader.all()) && heading_possible)
          {
            heading_possible = false;
            continue;
          }
        heading_possible = false;
        Point<2> p;
        p[0] = unit * reader.take_coordinate();
        p[1] = unit * reader.take_coordinate();
        outline.points.push_back(p);
        outline.labels.emplace_back(reader.remainder());
        outline.lines.push_back(reader.number);
        const std::string &label = outline.labels.back();
        if (!label.empty() && begins_number(label) &&
            label != outline.labels.front())
          reader.fail("a third number, '" + label +
                        "', that is not the same in "
                        "all lines",
                      "an outline lies in a plane: give x, y and, if wanted, a "
                      "label that does not begin with a digit; closed surfaces "
                      "come as STL files");
      }
    if (!outline.labels.empty() && !outline.labels.front().empty() &&
        begins_number(outline.labels.front()))
      {
        outline.remarks.emplace_back("the third numbers left out");
        for (std::string &label : outline.labels)
          label.clear();
      }
    return checked_outline(std::move(outline));
  }



  SmoothOutline::SmoothOutline(const Outline &outline,
                               const double   corner_angle)
  {
    const std::vector<Point<2>> &p = outline.points;
    const std::size_t            n = p.size();
    std::vector<std::size_t>     corner;
    for (std::size_t i = 0; i < n; ++i)
      {
        const Tensor<1, 2> before = p[i] - p[(i + n - 1) % n];
        const Tensor<1, 2> after  = p[(i + 1) % n] - p[i];
        if (std::atan2(std::abs(cross(before, after)), before * after) >
            corner_angle)
          corner.push_back(i);
      }

    using Spline              = CubicSpline<2>;
    const std::size_t   first = corner.empty() ? 0 : corner[0];
    std::vector<double> position; // of the points, counted from the first one
    start.assign(1, 0.);
    if (corner.empty())
      {
        spans.emplace_back(p, Spline::Ends::closed, Spline::Knots::centripetal);
        position = spans[0].arc_lengths();
        start.push_back(spans[0].length());
      }
    else
      for (std::size_t k = 0; k < corner.size(); ++k)
        {
          const std::size_t begin = corner[k];
          const std::size_t end =
            k + 1 < corner.size() ? corner[k + 1] : corner[0] + n;
          std::vector<Point<2>> points;
          for (std::size_t i = begin; i <= end; ++i)
            points.push_back(p[i % n]);
          spans.emplace_back(points,
                             Spline::Ends::not_a_knot,
                             Spline::Knots::centripetal);
          corner_positions.push_back(start.back());
          for (std::size_t i = 0; i + 1 < points.size(); ++i)
            position.push_back(start.back() + spans.back().arc_lengths()[i]);
          start.push_back(start.back() + spans.back().length());
        }

    for (std::size_t i = 0; i < n; ++i)
      {
        const std::string &here = outline.labels[(first + i) % n];
        if (here != outline.labels[(first + i + n - 1) % n])
          {
            label_positions.push_back(position[i]);
            labels.push_back(here);
          }
      }
    if (labels.empty())
      labels.push_back(outline.labels[0]);
  }



  double
  SmoothOutline::wrapped(const double s) const
  {
    const double w = s - std::floor(s / length()) * length();
    return w < length() ? w : 0.;
  }



  std::pair<std::size_t, double>
  SmoothOutline::span_of(const double s) const
  {
    const double w   = wrapped(s);
    const auto after = std::upper_bound(start.begin() + 1, start.end() - 1, w);
    const std::size_t k = after - start.begin() - 1;
    return {k, spans[k].parameter_at(w - start[k])};
  }



  Point<2>
  SmoothOutline::point(const double s) const
  {
    const auto [k, t] = span_of(s);
    return spans[k].value(t);
  }



  Tensor<1, 2>
  SmoothOutline::tangent(const double s) const
  {
    const auto [k, t]             = span_of(s);
    const Tensor<1, 2> derivative = spans[k].derivative(t);
    return derivative / derivative.norm();
  }



  Tensor<1, 2>
  SmoothOutline::normal(const double s) const
  {
    const Tensor<1, 2> t = tangent(s);
    Tensor<1, 2>       n;
    n[0] = t[1];
    n[1] = -t[0];
    return n;
  }



  const std::string &
  SmoothOutline::label(const double s) const
  {
    if (labels.size() == 1)
      return labels[0];
    const auto after = std::upper_bound(label_positions.begin(),
                                        label_positions.end(),
                                        wrapped(s));
    return after == label_positions.begin()
             ? labels.back()
             : labels[after - label_positions.begin() - 1];
  }



  std::vector<Stretch>
  SmoothOutline::stretches(
    const double                                      begin,
    const double                                      end,
    const std::function<std::string(const double s)> &name) const
  {
    constexpr unsigned int n_samples = 4000;
    std::vector<Stretch>   list;
    double                 start = begin, last = begin;
    std::string            current = name(begin);
    for (unsigned int i = 1; i <= n_samples; ++i)
      {
        const double s = begin + (end - begin) * i / n_samples;
        // The last sample belongs to what precedes it.
        const std::string here = i < n_samples ? name(s) : current;
        if (here != current)
          {
            double low = last, high = s;
            while (true)
              {
                const double middle = 0.5 * (low + high);
                if (middle <= low || middle >= high)
                  break;
                (name(middle) == current ? low : high) = middle;
              }
            list.push_back({start, high, current});
            start   = high;
            current = here;
          }
        last = s;
      }
    list.push_back({start, end, current});

    const double shortest = 1e-9 * length();
    for (const double corner : corner_positions)
      for (const double s : {corner, corner + length()})
        for (std::size_t i = 0; i < list.size(); ++i)
          if (s > list[i].begin + shortest && s < list[i].end - shortest)
            {
              Stretch rest = list[i];
              rest.begin   = s;
              list[i].end  = s;
              list.insert(list.begin() + i + 1, rest);
            }
    return list;
  }
} // namespace alveolus
