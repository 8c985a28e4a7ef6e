// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/materials/tangent_table.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace alveolus
{
  namespace
  {
    using Points = std::vector<std::pair<double, double>>;

    /** Modulus at strain zero of a table that has no point there. */
    double
    modulus_at_zero(const Points &points)
    {
      for (unsigned int i = 0; i < points.size(); ++i)
        if (points[i].first > 0.)
          {
            if (i == 0)
              return points[0].second;
            const auto  &left = points[i - 1], &right = points[i];
            const double x = -left.first / (right.first - left.first);
            return left.second + x * (right.second - left.second);
          }
      return points.back().second;
    }
  } // namespace



  TangentTable::TangentTable(const Points &points, const std::string &where)
  {
    if (points.empty())
      throw InputError(where,
                       "the table of tangent moduli is empty",
                       "give points such as '0: 0.068, 0.14: 1.35' or a file");
    for (unsigned int i = 0; i < points.size(); ++i)
      {
        if (!std::isfinite(points[i].first) || !(points[i].second >= 0.) ||
            !std::isfinite(points[i].second))
          throw InputError(where,
                           "modulus " + std::to_string(points[i].second) +
                             " at strain " + std::to_string(points[i].first),
                           "moduli must not be negative [MPa]");
        if (i > 0 && points[i].first < points[i - 1].first)
          throw InputError(where,
                           "strain " + std::to_string(points[i].first) +
                             " follows " + std::to_string(points[i - 1].first),
                           "list the points by increasing strain");
        if (i > 1 && points[i].first == points[i - 2].first)
          throw InputError(where,
                           "three points at strain " +
                             std::to_string(points[i].first),
                           "a jump has two");
      }

    // Each branch as points (|strain|, modulus) going away from zero.
    const auto build = [&](const double sign, std::vector<Segment> &segments) {
      Points branch;
      for (const auto &point : points)
        if (sign * point.first >= 0.)
          branch.emplace_back(sign * point.first, point.second);
      if (sign < 0.)
        std::reverse(branch.begin(), branch.end());
      // Of a jump at zero the branch has only its own side.
      if (branch.size() > 1 && branch[1].first == 0.)
        branch.erase(branch.begin());
      if (branch.empty() || branch.front().first > 0.)
        branch.emplace(branch.begin(), 0., modulus_at_zero(points));

      double stress = 0., energy = 0., logarithmic = 0.;
      for (unsigned int i = 0; i < branch.size(); ++i)
        {
          const bool last = (i + 1 == branch.size());
          if (!last && branch[i + 1].first == branch[i].first)
            continue;
          Segment s;
          s.begin       = branch[i].first;
          s.modulus     = branch[i].second;
          s.stress      = stress;
          s.energy      = energy;
          s.logarithmic = logarithmic;
          s.end         = last ? std::numeric_limits<double>::infinity()
                               : branch[i + 1].first;
          s.slope =
            last ? 0. : (branch[i + 1].second - s.modulus) / (s.end - s.begin);
          segments.push_back(s);
          if (!last)
            {
              const double d = s.end - s.begin;
              energy +=
                d * (s.stress + d * (s.modulus / 2. + d * s.slope / 6.));
              stress += d * (s.modulus + d * s.slope / 2.);
              logarithmic += logarithmic_part(s, sign, d);
            }
        }
    };
    build(-1., compression);
    build(1., tension);
  }



  Points
  TangentTable::parse(const std::string &list, const std::string &where)
  {
    Points             points;
    std::istringstream items(list);
    std::string        item;
    while (std::getline(items, item, ','))
      {
        std::istringstream stream(item);
        double             strain, modulus;
        char               colon;
        std::string        rest;
        if (!(stream >> strain >> colon >> modulus) || colon != ':' ||
            (stream >> rest))
          throw InputError(where,
                           "cannot read '" + item + "'",
                           "write 'strain: modulus', separated by commas");
        points.emplace_back(strain, modulus);
      }
    return points;
  }



  Points
  TangentTable::read(const std::string &file, const std::string &where)
  {
    std::error_code ignored;
    std::ifstream   input(file);
    if (!input || !(std::filesystem::is_regular_file(file, ignored) ||
                    std::filesystem::is_fifo(file, ignored)))
      throw InputError(where,
                       "cannot open the table '" + file + "'",
                       "give the path of a file with two columns, strain and "
                       "modulus");
    Points       points;
    std::string  line;
    unsigned int number = 0;
    bool         first  = true;
    while (std::getline(input, line))
      {
        ++number;
        std::replace(line.begin(), line.end(), ',', ' ');
        std::istringstream stream(line);
        std::string        word;
        if (!(stream >> word) || word[0] == '#')
          continue;
        std::istringstream numbers(line);
        double             strain, modulus;
        if (!(numbers >> strain >> modulus) || (numbers >> word))
          {
            if (first && std::isalpha(static_cast<unsigned char>(word[0])))
              {
                first = false;
                continue;
              }
            throw InputError(file + ":" + std::to_string(number),
                             "cannot read '" + line + "'",
                             "two numbers are expected, strain and modulus");
          }
        first = false;
        points.emplace_back(strain, modulus);
      }
    return points;
  }



  Points
  TangentTable::without_jumps(const Points      &points,
                              const double       width,
                              const std::string &where)
  {
    // Value at x of the line through two points, constant beyond the table.
    const auto line =
      [&](const std::size_t i, const std::size_t j, const double x) {
        if (i >= points.size() || j >= points.size())
          return points[i < points.size() ? i : j].second;
        const auto &a = points[i], &b = points[j];
        return a.second +
               (b.second - a.second) * (x - a.first) / (b.first - a.first);
      };
    Points       result;
    const double half = width / 2.;
    for (std::size_t i = 0; i < points.size(); ++i)
      {
        const bool jump =
          i + 1 < points.size() && points[i].first == points[i + 1].first;
        if (!jump)
          {
            result.push_back(points[i]);
            continue;
          }
        const double strain = points[i].first;
        // The lines on either side must reach over the two halves.
        const bool before = i > 0, after = i + 2 < points.size();
        if ((before && points[i - 1].first > strain - half) ||
            (after && points[i + 2].first < strain + half) ||
            (!result.empty() && result.back().first > strain - half))
          throw InputError(where,
                           "the jump at strain " + std::to_string(strain) +
                             " has another point within the smoothing width",
                           "make the width smaller than " +
                             std::to_string(width));
        result.emplace_back(strain - half, line(i - 1, i, strain - half));
        result.emplace_back(strain + half, line(i + 1, i + 2, strain + half));
        ++i;
      }
    return result;
  }



  const TangentTable::Segment &
  TangentTable::find(const double strain) const
  {
    const auto  &segments = strain < 0. ? compression : tension;
    const double x        = std::abs(strain);
    unsigned int i        = 0;
    while (x > segments[i].end)
      ++i;
    return segments[i];
  }



  double
  TangentTable::modulus(const double strain) const
  {
    const Segment &s = find(strain);
    return s.modulus + s.slope * (std::abs(strain) - s.begin);
  }



  double
  TangentTable::stress(const double strain) const
  {
    const Segment &s      = find(strain);
    const double   d      = std::abs(strain) - s.begin;
    const double   stress = s.stress + d * (s.modulus + d * s.slope / 2.);
    return strain < 0. ? -stress : stress;
  }



  double
  TangentTable::logarithmic_part(const Segment &s,
                                 const double   sign,
                                 const double   d)
  {
    // With |e| = b + y: int_0^d (m + c y)/(1 + sign (b + y)) dy
    const double edge = 1. + sign * s.begin;
    const double ln   = std::log1p(sign * d / edge); // ln((1+e)/(1+e_begin))
    return sign * (s.slope * d + (s.modulus - sign * s.slope * edge) * ln);
  }



  double
  TangentTable::logarithmic_stress(const double strain) const
  {
    const Segment &s    = find(strain);
    const double   sign = strain < 0. ? -1. : 1.;
    return sign * (s.logarithmic +
                   logarithmic_part(s, sign, std::abs(strain) - s.begin));
  }



  double
  TangentTable::energy(const double strain) const
  {
    const Segment &s = find(strain);
    const double   d = std::abs(strain) - s.begin;
    return s.energy + d * (s.stress + d * (s.modulus / 2. + d * s.slope / 6.));
  }
} // namespace alveolus
