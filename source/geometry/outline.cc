// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/line_reader.h>
#include <alveolus/geometry/outline.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr std::size_t least_points = 8;

    double
    cross(const Tensor<1, 2> &a, const Tensor<1, 2> &b)
    {
      return a[0] * b[1] - a[1] * b[0];
    }

    double
    area_of(const std::vector<Point<2>> &polygon)
    {
      double area = 0.;
      for (std::size_t i = 0; i < polygon.size(); ++i)
        area += 0.5 * cross(polygon[i] - Point<2>(),
                            polygon[(i + 1) % polygon.size()] - Point<2>());
      return area;
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



  Outline
  read_outline(const std::string &text, const std::string &source)
  {
    Outline outline;
    outline.source = source;
    // Columns may be parted by commas, semicolons or blanks.
    std::string blanked = text;
    for (char &c : blanked)
      if (c == ',' || c == ';')
        c = ' ';
    LineReader reader(blanked, source);
    bool       heading_possible = true;
    while (reader.advance())
      {
        const char first = reader.all().front();
        if (first == '#')
          continue;
        const bool is_number = (first >= '0' && first <= '9') || first == '-' ||
                               first == '+' || first == '.';
        if (!is_number && heading_possible)
          {
            heading_possible = false;
            continue;
          }
        heading_possible = false;
        Point<2> p;
        p[0] = reader.take_coordinate();
        p[1] = reader.take_coordinate();
        outline.points.push_back(p);
        outline.labels.emplace_back(reader.remainder());
        outline.lines.push_back(reader.number);
      }

    const auto drop_last = [&outline]() {
      outline.points.pop_back();
      outline.labels.pop_back();
      outline.lines.pop_back();
    };
    if (outline.points.size() > 1 &&
        outline.points.front() == outline.points.back())
      drop_last();
    const std::size_t n = outline.points.size();
    if (n < least_points)
      throw InputError(source,
                       "an outline of " + std::to_string(n) + " points",
                       "give at least " + std::to_string(least_points) +
                         ", one a line as x, y [mm] and, if wanted, a label");
    const auto place = [&outline, &source](const std::size_t i) {
      return source + ", line " + std::to_string(outline.lines[i]);
    };
    for (std::size_t i = 0; i < n; ++i)
      if (outline.points[i] == outline.points[(i + 1) % n])
        throw InputError(place((i + 1) % n),
                         "the point is the same as the one before it",
                         "remove one of them");
    std::size_t i, j;
    if (find_crossing(outline.points, i, j))
      throw InputError(place(i),
                       "the outline crosses or touches itself: the line from "
                       "here to the next point meets the one that begins at "
                       "line " +
                         std::to_string(outline.lines[j]),
                       "list the points in the order in which they follow "
                       "each other, each once");
    const double area = area_of(outline.points);
    if (area < 0.)
      {
        std::reverse(outline.points.begin(), outline.points.end());
        std::reverse(outline.lines.begin(), outline.lines.end());
        std::reverse(outline.labels.begin(), outline.labels.end());
        // A label belongs to a line: the one that now begins a point earlier.
        std::rotate(outline.labels.begin(),
                    outline.labels.begin() + 1,
                    outline.labels.end());
      }
    return outline;
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
