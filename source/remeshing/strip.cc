// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/remeshing/strip.h>

#include <algorithm>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Indices  = std::vector<unsigned int>;
    using Directed = std::pair<unsigned int, unsigned int>;

    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();
    constexpr unsigned int ends[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};

    /** The cells of a strip and ways along their lines. */
    class Strip
    {
    public:
      Strip(const GatheredMesh                 &mesh,
            const std::set<types::material_id> &materials)
        : mesh(mesh)
      {
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          if (materials.count(mesh.materials[c]) != 0)
            for (const auto &end : ends)
              cell_left[{mesh.cells[c][end[0]], mesh.cells[c][end[1]]}] = c;
        for (const auto &entry : cell_left)
          {
            const auto [a, b] = entry.first;
            if (cell_left.count({b, a}) == 0)
              {
                next[a]     = b;
                previous[b] = a;
              }
          }
      }

      const GatheredMesh                  &mesh;
      std::map<unsigned int, unsigned int> next, previous; ///< at its outline

      /** The end of the line after (a, b) around the cell to its left. */
      unsigned int
      turn_left(const unsigned int a, const unsigned int b) const
      {
        for (const auto &end : ends)
          if (mesh.cells[cell_left.at({a, b})][end[0]] == b)
            return mesh.cells[cell_left.at({a, b})][end[1]];
        return none;
      }

      /** The way straight on at the inner node w, from u; none if its cells are
       * not four. */
      unsigned int
      straight_on(const unsigned int u, const unsigned int w) const
      {
        const unsigned int left = turn_left(u, w);
        if (cell_left.count({left, w}) == 0)
          return none;
        const unsigned int ahead = turn_left(left, w);
        if (cell_left.count({ahead, w}) == 0)
          return none;
        const unsigned int right = turn_left(ahead, w);
        if (cell_left.count({right, w}) == 0 || turn_left(right, w) != u)
          return none;
        return ahead;
      }

      /** The straight line of the mesh from node b of the outline to another
       * one; empty if there is none. */
      Indices
      line_from(const unsigned int b) const
      {
        Indices            line(1, b);
        const unsigned int inside = turn_left(previous.at(b), b);
        // Two cells at b: the next one goes on along the outline.
        if (cell_left.count({inside, b}) == 0 ||
            turn_left(inside, b) != next.at(b))
          return {};
        line.push_back(inside);
        while (next.count(line.back()) == 0)
          {
            const unsigned int ahead =
              straight_on(line[line.size() - 2], line.back());
            if (ahead == none || line.size() > mesh.cells.size())
              return {};
            line.push_back(ahead);
          }
        return line;
      }

    private:
      std::map<Directed, unsigned int> cell_left; ///< of a directed line
    };
  } // namespace



  StripZone
  find_strip_zone(const GatheredMesh                          &mesh,
                  const std::set<types::material_id>          &materials,
                  const std::function<bool(const MeshLine &)> &is_rim,
                  const double                                 length,
                  const std::string                           &name)
  {
    const Strip strip(mesh, materials);
    StripZone   zone;
    // The rim begins where the line before it is none of it.
    for (const auto &entry : strip.next)
      if (is_rim(GatheredMesh::line(entry.first, entry.second)) &&
          !is_rim(
            GatheredMesh::line(strip.previous.at(entry.first), entry.first)))
        {
          if (!zone.rim.empty())
            throw RunError("Remeshing",
                           "the end '" + name + "' of a strip is in parts",
                           "");
          zone.rim.push_back(entry.first);
          while (is_rim(GatheredMesh::line(zone.rim.back(),
                                           strip.next.at(zone.rim.back()))))
            zone.rim.push_back(strip.next.at(zone.rim.back()));
        }
    if (zone.rim.empty())
      throw RunError("Remeshing",
                     "the end '" + name + "' is not at the strip",
                     "name a curve at the boundary of the strip's region");

    zone.side_a.push_back(zone.rim.front());
    zone.side_b.push_back(zone.rim.back());
    double length_a = 0., length_b = 0.;
    while (std::min(length_a, length_b) < 10. * length)
      {
        const unsigned int a = strip.previous.at(zone.side_a.back());
        const unsigned int b = strip.next.at(zone.side_b.back());
        length_a +=
          mesh.positions[a].distance(mesh.positions[zone.side_a.back()]);
        length_b +=
          mesh.positions[b].distance(mesh.positions[zone.side_b.back()]);
        zone.side_a.push_back(a);
        zone.side_b.push_back(b);
        if (a == b || zone.side_a.size() > mesh.cells.size())
          break; // all the way round
        if (std::min(length_a, length_b) < length ||
            zone.side_a.size() % 2 == 0)
          continue;
        zone.cut = strip.line_from(b);
        if (zone.cut.empty() || zone.cut.back() != a)
          continue;
        std::reverse(zone.cut.begin(), zone.cut.end());
        for (std::size_t i = 0; i + 1 < zone.cut.size(); ++i)
          zone.cut_lines.insert(
            GatheredMesh::line(zone.cut[i], zone.cut[i + 1]));
        return zone;
      }
    throw RunError("Remeshing",
                   "no straight line of the mesh crosses the strip near its "
                   "end '" +
                     name + "'",
                   "strips need layers of cells, as many edges on both sides");
  }
} // namespace alveolus
