// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/best_first.h>
#include <alveolus/remeshing/strip_ends.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  std::vector<std::vector<std::size_t>>
  StripEnds::combinations(const std::size_t n) const
  {
    std::vector<std::size_t> order(choices.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(),
                     order.end(),
                     [this](const std::size_t a, const std::size_t b) {
                       return choices[a][0].mesh.mesh.quality <
                              choices[b][0].mesh.mesh.quality;
                     });
    std::size_t longest = 1;
    for (const auto &list : choices)
      longest = std::max(longest, list.size());
    std::vector<std::vector<std::size_t>> result(
      1, std::vector<std::size_t>(choices.size(), 0));
    for (std::size_t i = 1; i < longest; ++i)
      for (const std::size_t end : order)
        if (i < choices[end].size() && result.size() < n)
          {
            result.emplace_back(choices.size(), 0);
            result.back()[end] = i;
          }
    return result;
  }



  StripEnds
  mesh_strip_ends(const GatheredMesh                 &mesh,
                  const NamedSets<2>                 &names,
                  const std::set<types::material_id> &materials,
                  const std::vector<std::string>     &ends,
                  const std::vector<double>          &lengths,
                  const ZoneSettings                 &settings,
                  const MeshingJob                   &job)
  {
    StripEnds          result;
    std::ostringstream counts;
    for (const std::string &end : ends)
      {
        std::vector<ZoneChoice> choices;
        unsigned int            n_tried = 0, n_invalid = 0, n_flat = 0;
        std::set<unsigned int>  too_coarse;
        double                  best = 0.;
        for (std::size_t l = 0;
             l < lengths.size() && best < settings.mesher.good_quality;
             ++l)
          {
            const StripZone zone = find_strip_zone(
              mesh,
              materials,
              [&](const MeshLine &line) {
                return mesh.lines.at(line).are_on(end, names);
              },
              lengths[l],
              end);
            ZoneMeshes zones =
              mesh_zone(mesh,
                        zone,
                        settings,
                        job.part(end + "-" + std::to_string(l + 1)));
            n_tried += zones.n_tried;
            n_invalid += zones.n_invalid;
            n_flat += zones.n_flat;
            too_coarse.insert(zones.too_coarse.begin(), zones.too_coarse.end());
            for (ZoneMesh &entry : zones.meshes)
              {
                best = std::max(best, entry.mesh.quality);
                choices.push_back({zone, std::move(entry)});
              }
          }
        counts << "; " << end << ": " << n_tried << " zones tried, "
               << n_invalid << " invalid, " << n_flat
               << " with one cell at a flat corner";
        for (const unsigned int n : too_coarse)
          counts << ", " << n << " edges would change the area too much";
        if (choices.empty())
          throw RunError(job.where,
                         "no valid mesh of the zone at '" + end + "'" +
                           counts.str(),
                         "remesh earlier, or try other 'Zone lengths' and "
                         "'Strip end edges'");
        sort_best_first(choices, [](const ZoneChoice &choice) {
          return choice.mesh.mesh.quality;
        });
        result.choices.push_back(std::move(choices));
      }
    result.counts = counts.str();
    return result;
  }



  void
  put_zone(PlanarGeometry    &geometry,
           const BodyOutline &outline,
           const ZoneChoice  &choice)
  {
    const StripZone   &zone      = choice.zone;
    const ZoneMesh    &zone_mesh = choice.mesh;
    std::set<MeshLine> rim_lines;
    for (std::size_t i = 0; i + 1 < zone.rim.size(); ++i)
      rim_lines.insert(GatheredMesh::line(zone.rim[i], zone.rim[i + 1]));
    const auto is_rim = [&](const LoopPart &part) {
      if (part.curve >= outline.pieces.size())
        return false; // a new rim of another zone
      const auto &nodes = outline.pieces[part.curve].nodes;
      return rim_lines.count(GatheredMesh::line(nodes[0], nodes[1])) != 0;
    };
    for (PlanarArea &area : geometry.areas)
      {
        auto      &loop  = area.loops[0];
        const auto first = std::find_if(loop.begin(), loop.end(), is_rim);
        if (first == loop.end())
          continue;
        area.prepared = std::make_shared<const AreaMesh>(zone_mesh.mesh);
        if (zone_mesh.nodes_kept)
          return;
        // One curve for all pieces of the rim, at the begin of the loop
        while (is_rim(loop.back()))
          std::rotate(loop.begin(), loop.end() - 1, loop.end());
        while (!is_rim(loop.front()))
          std::rotate(loop.begin(), loop.begin() + 1, loop.end());
        std::size_t n = 0;
        while (n < loop.size() && is_rim(loop[n]))
          ++n;
        const auto end_of = [&](const LoopPart &part, const bool begin) {
          const PlanarCurve &curve = geometry.curves[part.curve];
          return begin != part.reversed ? curve.begin : curve.end;
        };
        PlanarCurve rim;
        rim.begin = end_of(loop[0], true);
        rim.end   = end_of(loop[n - 1], false);
        rim.nodes = zone_mesh.rim;
        rim.tag   = geometry.curves[loop[0].curve].tag;
        // Their lines are none of the mesh any more.
        for (std::size_t i = 0; i < n; ++i)
          geometry.curves[loop[i].curve].tag = 0;
        loop.erase(loop.begin() + 1, loop.begin() + n);
        loop[0] = {static_cast<unsigned int>(geometry.curves.size()), false};
        geometry.curves.push_back(std::move(rim));
        return;
      }
  }
} // namespace alveolus
