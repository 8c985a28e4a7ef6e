// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/grading.h>
#include <alveolus/mesh/socket_geometry.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Points = std::vector<Point<2>>;

    constexpr unsigned int n_samples = 4000; // of a whole outline

    std::string
    coordinates(const Point<2> &p)
    {
      std::ostringstream text;
      text.precision(4);
      text << "(" << p[0] << ", " << p[1] << ")";
      return text.str();
    }

    /** Whether @p p is inside the closed polygon (even-odd rule). */
    bool
    is_inside(const Points &polygon, const Point<2> &p)
    {
      bool inside = false;
      for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size();
           j = i++)
        {
          const Point<2> &a = polygon[i], &b = polygon[j];
          if ((a[1] > p[1]) != (b[1] > p[1]) &&
              p[0] < (b[0] - a[0]) * (p[1] - a[1]) / (b[1] - a[1]) + a[0])
            inside = !inside;
        }
      return inside;
    }

    double
    distance_to(const Points &points, const Point<2> &p)
    {
      double smallest = std::numeric_limits<double>::max();
      for (const Point<2> &q : points)
        smallest = std::min(smallest, q.distance_square(p));
      return std::sqrt(smallest);
    }

    /** Makes the geometry; members in the order in which they become known. */
    class Socket
    {
    public:
      Socket(const Outline        &tooth,
             const Outline        &bone,
             const SocketSettings &settings,
             const std::string    &where)
        : settings(settings)
        , where(where)
        , tooth(tooth, settings.corner_angle)
        , bone(bone, settings.corner_angle)
      {
        find_margins();
        find_upwards();
        make_root();
        check_socket();
        make_ligament();
        make_bone();
        make_tooth();
      }

      PlanarGeometry result;

    private:
      const SocketSettings settings;
      const std::string    where;
      const SmoothOutline  tooth, bone;

      // Arc lengths of the margins on both outlines; ends beyond the beginnings
      double root_begin = 0., root_end = 0., bone_begin = 0., bone_end = 0.;
      Points root, socket;
      double upwards = 1.; // +1: the crown is above the root, -1: below

      unsigned int labial_root, lingual_root, labial_socket, lingual_socket;
      unsigned int root_curve, socket_curve;
      std::map<std::string, unsigned int> tags;

      Point<2>
      offset(const double s) const
      {
        return tooth.point(s) + settings.thickness * tooth.normal(s);
      }

      /** Where offset(s) = bone(u), from nearby values (chord iteration). */
      void
      intersect(double &s, double &u) const
      {
        for (unsigned int iteration = 0; iteration < 100; ++iteration)
          {
            const Tensor<1, 2> gap = bone.point(u) - offset(s);
            const Tensor<1, 2> a = tooth.tangent(s), b = bone.tangent(u);
            const double       det = b[0] * a[1] - a[0] * b[1];
            // gap = a ds - b du
            const double ds = (b[0] * gap[1] - b[1] * gap[0]) / det;
            const double du = (a[0] * gap[1] - a[1] * gap[0]) / det;
            s += ds;
            u += du;
            if (std::abs(ds) + std::abs(du) < 1e-13 * bone.length())
              return;
          }
        throw InputError(where,
                         "the outline of the bone does not cross that of the "
                         "socket cleanly near " +
                           coordinates(offset(s)),
                         "let it cross the tooth at a clear angle");
      }

      void
      find_margins()
      {
        Points bone_polygon;
        for (unsigned int i = 0; i < n_samples; ++i)
          bone_polygon.push_back(bone.point(bone.length() * i / n_samples));
        std::vector<bool> inside;
        const double      step = tooth.length() / n_samples;
        for (unsigned int i = 0; i < n_samples; ++i)
          inside.push_back(is_inside(bone_polygon, offset(step * i)));
        std::vector<unsigned int> entries, exits; // last sample before
        for (unsigned int i = 0; i < n_samples; ++i)
          {
            const bool next = inside[(i + 1) % n_samples];
            if (!inside[i] && next)
              entries.push_back(i);
            if (inside[i] && !next)
              exits.push_back(i);
          }
        if (entries.empty())
          throw InputError(where,
                           "the outlines of tooth and bone do not cross: the "
                           "tooth is " +
                             std::string(inside[0] ? "inside" : "outside") +
                             " the bone",
                           "the bone's outline has to cross the tooth at the "
                           "margins of the socket; see 'Tooth shift'");
        if (entries.size() > 1)
          {
            std::string places;
            for (const unsigned int i : exits)
              places +=
                (places.empty() ? "" : ", ") + coordinates(offset(step * i));
            throw InputError(where,
                             "the socket leaves the bone at several places: " +
                               places,
                             "lower 'Ligament thickness', or draw the bone "
                             "thicker there");
          }
        const auto refined = [&](const unsigned int i, double &s, double &u) {
          s                = step * (i + 0.5);
          const Point<2> p = offset(s);
          std::size_t    nearest =
            std::min_element(bone_polygon.begin(),
                             bone_polygon.end(),
                             [&p](const Point<2> &a, const Point<2> &b) {
                               return a.distance_square(p) <
                                      b.distance_square(p);
                             }) -
            bone_polygon.begin();
          u = bone.length() * nearest / n_samples;
          intersect(s, u);
        };
        refined(entries[0], root_begin, bone_begin);
        refined(exits[0], root_end, bone_end);
        if (root_end < root_begin)
          root_end += tooth.length();
        if (bone_end < bone_begin)
          bone_end += bone.length();
      }

      /** Teeth of the upper jaw have their crown below. */
      void
      find_upwards()
      {
        const auto mean = [this](const double begin, const double end) {
          double sum = 0.;
          for (unsigned int i = 0; i < n_samples; ++i)
            sum +=
              tooth.point(begin + (end - begin) * (i + 0.5) / n_samples)[1];
          return sum / n_samples;
        };
        if (mean(root_end, root_begin + tooth.length()) <
            mean(root_begin, root_end))
          upwards = -1.;
      }

      double
      height(const Point<2> &p) const // towards the incisal edge
      {
        return upwards * p[1];
      }

      void
      make_root()
      {
        const unsigned int n = settings.n_along;
        for (unsigned int i = 0; i <= n; ++i)
          {
            const double s = root_begin + (root_end - root_begin) * i / n;
            root.push_back(tooth.point(s));
            socket.push_back(offset(s));
          }
      }

      void
      check_socket() const
      {
        Points strip = socket;
        strip.insert(strip.end(), root.rbegin(), root.rend());
        std::size_t i, j;
        if (find_crossing(strip, i, j))
          throw InputError(where,
                           "the ligament of " +
                             std::to_string(settings.thickness) +
                             " mm overlaps itself near " +
                             coordinates(strip[i]) + " and " +
                             coordinates(strip[j]),
                           "lower 'Ligament thickness' or smooth the outline "
                           "of the root: a hollow must be wider than the "
                           "ligament is thick");

        Points surface;
        for (unsigned int k = 0; k <= n_samples; ++k)
          surface.push_back(
            bone.point(bone_begin + (bone_end - bone_begin) * k / n_samples));
        const double h = (root_end - root_begin) / settings.n_along;
        for (unsigned int k = 0; k <= settings.n_along; ++k)
          {
            const double depth = h * std::min(k, settings.n_along - k);
            const double plate = distance_to(surface, socket[k]);
            if (depth > 2. * settings.least_bone && plate < settings.least_bone)
              throw InputError(
                where,
                "the bone is only " + std::to_string(plate) +
                  " mm thick beside the socket at " + coordinates(socket[k]),
                "lower 'Ligament thickness' or 'Least bone thickness', or draw "
                "the bone thicker there");
          }
      }

      unsigned int
      add_point(const Point<2> &p)
      {
        result.points.push_back(p);
        return result.points.size() - 1;
      }

      unsigned int
      add_curve(const std::string &name,
                const unsigned int begin,
                const unsigned int end,
                Points             nodes)
      {
        const auto entry = tags.emplace(name, tags.size() + 1);
        result.curve_names[name].insert(entry.first->second);
        PlanarCurve curve;
        curve.begin   = begin;
        curve.end     = end;
        nodes.front() = result.points[begin];
        nodes.back()  = result.points[end];
        curve.nodes   = std::move(nodes);
        curve.tag     = entry.first->second;
        result.curves.push_back(std::move(curve));
        return result.curves.size() - 1;
      }

      Points
      rim(const Point<2> &a, const Point<2> &b, const unsigned int cap) const
      {
        Points             nodes;
        const unsigned int n = settings.n_across - 2 * cap;
        for (unsigned int i = 0; i <= n; ++i)
          nodes.push_back(a + (b - a) * (double(i) / n));
        return nodes;
      }

      void
      add_area(const std::string           &name,
               const std::vector<LoopPart> &loop,
               const double                 size,
               const double                 growth,
               const bool                   structured)
      {
        PlanarArea area;
        area.name         = name;
        area.tag          = result.areas.size() + 1;
        area.loops        = {loop};
        area.largest_size = size;
        area.growth       = growth;
        area.structured   = structured;
        result.region_names[name].insert(area.tag);
        result.areas.push_back(area);
      }

      void
      make_ligament()
      {
        labial_root                                 = add_point(root.front());
        lingual_root                                = add_point(root.back());
        labial_socket                               = add_point(socket.front());
        lingual_socket                              = add_point(socket.back());
        result.point_names["margin root labial"]    = root.front();
        result.point_names["margin root lingual"]   = root.back();
        result.point_names["margin socket labial"]  = socket.front();
        result.point_names["margin socket lingual"] = socket.back();
        result.point_names["apex"] =
          *std::min_element(root.begin(),
                            root.end(),
                            [this](const Point<2> &a, const Point<2> &b) {
                              return height(a) < height(b);
                            });
        root_curve = add_curve("root", labial_root, lingual_root, root);
        socket_curve =
          add_curve("socket", labial_socket, lingual_socket, socket);
        const unsigned int labial =
          add_curve("rim labial",
                    labial_root,
                    labial_socket,
                    rim(root.front(), socket.front(), settings.caps[0]));
        const unsigned int lingual =
          add_curve("rim lingual",
                    lingual_root,
                    lingual_socket,
                    rim(root.back(), socket.back(), settings.caps[1]));
        add_area("ligament",
                 {{socket_curve, false},
                  {lingual, true},
                  {root_curve, true},
                  {labial, false}},
                 0.,
                 0.,
                 true);
        result.areas.back().caps = settings.caps;
      }

      /** Curves along the stretches, from one point to another. */
      std::vector<LoopPart>
      add_stretches(const SmoothOutline        &outline,
                    const std::vector<Stretch> &list,
                    const unsigned int          begin,
                    const unsigned int          end,
                    const std::function<double(const Point<2> &position)> &size)
      {
        std::vector<LoopPart> parts;
        unsigned int          from = begin;
        for (std::size_t i = 0; i < list.size(); ++i)
          {
            const Stretch     &stretch = list[i];
            const unsigned int to      = i + 1 == list.size()
                                           ? end
                                           : add_point(outline.point(stretch.end));
            Points             nodes;
            for (const double s : graded_division(
                   stretch.end - stretch.begin, [&](const double s) {
                     return size(outline.point(stretch.begin + s));
                   }))
              nodes.push_back(outline.point(stretch.begin + s));
            parts.push_back({add_curve(stretch.name, from, to, nodes), false});
            from = to;
          }
        return parts;
      }

      /** Edge length at the distance @p d from the ligament. */
      double
      edge_length(const double d,
                  const double growth,
                  const double largest) const
      {
        const double h = (root_end - root_begin) / settings.n_along;
        return std::min(std::max(h, largest), h + growth * d);
      }

      void
      make_bone()
      {
        const bool labelled = !bone.label_starts().empty();
        double     lowest   = std::numeric_limits<double>::max();
        for (unsigned int i = 0; i < n_samples; ++i)
          lowest =
            std::min(lowest, height(bone.point(bone.length() * i / n_samples)));
        const auto name = [&](const double s) -> std::string {
          const double to_labial = s - bone_begin, to_lingual = bone_end - s;
          const std::string side =
            to_labial < to_lingual ? "labial" : "lingual";
          if (labelled)
            return bone.label(s) == "crest" ? "crest " + side : bone.label(s);
          if (std::min(to_labial, to_lingual) < settings.crest_length)
            return "crest " + side;
          return height(bone.point(s)) < lowest + settings.base_height
                   ? "bone base"
                   : "bone surface";
        };
        auto loop = add_stretches(bone,
                                  bone.stretches(bone_begin, bone_end, name),
                                  labial_socket,
                                  lingual_socket,
                                  [&](const Point<2> &p) {
                                    return edge_length(distance_to(socket, p),
                                                       settings.bone_growth,
                                                       settings.bone_size);
                                  });
        loop.push_back({socket_curve, true});
        add_area("bone", loop, settings.bone_size, settings.bone_growth, false);
      }

      void
      make_tooth()
      {
        const bool   labelled = !tooth.label_starts().empty();
        const double begin = root_end, end = root_begin + tooth.length();
        double top = begin, highest = std::numeric_limits<double>::lowest();
        for (unsigned int i = 0; i <= n_samples; ++i)
          {
            const double s = begin + (end - begin) * i / n_samples;
            const double y = height(tooth.point(s));
            if (y > highest)
              {
                highest = y;
                top     = s;
              }
          }
        const double margin =
          std::max(height(root.front()), height(root.back()));
        const auto name = [&](const double s) -> std::string {
          const std::string side = s < top ? "lingual" : "labial";
          if (labelled)
            return tooth.label(s) == "root" ? "neck " + side : tooth.label(s);
          const double y = height(tooth.point(s));
          if (y > highest - settings.incisal_height)
            return "incisal edge";
          return (y > margin + settings.crown_height ? "crown " : "neck ") +
                 side;
        };
        std::vector<Stretch> list = tooth.stretches(begin, end, name);

        // The tip has to be a node.
        double edge_begin = top, edge_end = top;
        for (const Stretch &stretch : list)
          if (stretch.name == "incisal edge")
            {
              if (edge_begin == top && edge_end == top)
                edge_begin = stretch.begin;
              edge_end = stretch.end;
            }
        const double tip = 0.5 * (edge_begin + edge_end);
        for (std::size_t i = 0; i < list.size(); ++i)
          if (tip > list[i].begin + 1e-9 && tip < list[i].end - 1e-9)
            {
              Stretch rest = list[i];
              rest.begin   = tip;
              list[i].end  = tip;
              list.insert(list.begin() + i + 1, rest);
              break;
            }

        const Points margins = {root.front(), root.back()};
        auto         loop    = add_stretches(
          tooth, list, lingual_root, labial_root, [&](const Point<2> &p) {
            return edge_length(distance_to(margins, p),
                               settings.tooth_growth,
                               settings.tooth_size);
          });
        for (const LoopPart &part : loop)
          if (result.points[result.curves[part.curve].end].distance(
                tooth.point(tip)) < 1e-8)
            result.point_names["tip"] =
              result.points[result.curves[part.curve].end];
        loop.push_back({root_curve, false});
        add_area(
          "tooth", loop, settings.tooth_size, settings.tooth_growth, false);
      }
    };
  } // namespace



  PlanarGeometry
  socket_geometry(const Outline        &tooth,
                  const Outline        &bone,
                  const SocketSettings &settings,
                  const std::string    &where)
  {
    return Socket(tooth, bone, settings, where).result;
  }
} // namespace alveolus
