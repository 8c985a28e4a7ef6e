// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/mesh/best_first.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/remeshing/outline_remesher.h>
#include <alveolus/remeshing/strip_ends.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    template <class Value>
    const Value *
    prescription(const std::map<std::string, Value> &values,
                 const LineIds                      &ids,
                 const NamedSets<2>                 &names)
    {
      for (const auto &entry : values)
        if (ids.are_on(entry.first, names))
          return &entry.second;
      return nullptr;
    }

    /** The number nearest to @p wanted that is as even or odd as @p old. */
    unsigned int
    alike(const double wanted, const unsigned int old)
    {
      const unsigned int odd = old % 2;
      const long         n   = 2 * std::lround(0.5 * (wanted - odd)) + odd;
      return std::max<long>(n, odd == 1 ? 1 : 2);
    }

    /** Area of the cells of some materials at their current positions. */
    double
    area_of(const GatheredMesh                 &mesh,
            const std::set<types::material_id> &materials)
    {
      double area = 0.;
      for (std::size_t c = 0; c < mesh.cells.size(); ++c)
        if (materials.count(mesh.materials[c]) != 0)
          {
            const auto at = [&](const unsigned int v) {
              return mesh.positions[mesh.cells[c][v]];
            };
            const Tensor<1, 2> a = at(3) - at(0), b = at(2) - at(1);
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
          }
      return area;
    }

    std::vector<Point<2>>
    loop_positions(const PlanarGeometry        &geometry,
                   const std::vector<LoopPart> &loop)
    {
      std::vector<Point<2>> result;
      for (const LoopPart &part : loop)
        {
          auto nodes = geometry.curves[part.curve].nodes;
          if (part.reversed)
            std::reverse(nodes.begin(), nodes.end());
          result.insert(result.end(), nodes.begin(), nodes.end() - 1);
        }
      return result;
    }
  } // namespace



  void
  OutlineRemesher::declare_parameters(ParameterHandler &prm)
  {
    const Patterns::Double length(1e-9, 1e6);
    const Patterns::List   names(Patterns::Anything(), 0);
    prm.add_parameter("Kept regions",
                      kept,
                      "Regions whose cells stay as they are.",
                      names);
    prm.add_parameter(
      "Smoothed regions",
      smoothed,
      "Regions that keep their cells, while inner vertices move "
      "where a scaled Jacobian is below Good quality.",
      names);
    prm.add_parameter("Strips",
                      strips,
                      "Regions of layered cells of which only the zones at the "
                      "Strip ends are meshed anew. Regions in none of these "
                      "three lists are meshed anew as a whole.",
                      names);
    prm.add_parameter("Strip ends",
                      strip_ends,
                      "Curves at which strips end freely.",
                      names);
    prm.add_parameter(
      "Zone lengths",
      zone_lengths,
      "Lengths of the zones from the ends of strips [mm], tried "
      "in turn until a mesh is good.",
      Patterns::List(length, 1));
    prm.add_parameter(
      "Strip end edges",
      zone_settings.rim_edges,
      "Numbers of edges at the ends of strips; each is tried. 0: "
      "nodes as they are; otherwise new ones on the cubic spline "
      "through them.",
      Patterns::List(Patterns::Integer(0, 1000), 1));
    prm.add_parameter("Strip end ratio",
                      zone_settings.rim_end_ratio,
                      "Length of the outermost of these new edges over that of "
                      "those in the middle [-].",
                      Patterns::Double(0.01, 100.));
    prm.add_parameter("Largest area change",
                      largest_area_change,
                      "New nodes at the end of a strip that change the area of "
                      "its region by a larger part are not taken [-].",
                      Patterns::Double(0., 1.));
    prm.add_parameter("Angle of two cells",
                      angle_of_two_cells,
                      "A corner at the end of a strip with a larger angle must "
                      "have two cells at least [degree].",
                      Patterns::Double(90., 360.));
    prm.add_parameter(
      "Edge lengths",
      edge_lengths,
      "Curves that get new nodes, with the length of their edges "
      "[mm]: `crown: 0.3, base: 1`. The number of edges stays even "
      "or odd, as quads demand. All other curves keep their "
      "nodes.",
      Patterns::Map(Patterns::Anything(), length, 0));
    prm.add_parameter("Edge numbers",
                      edge_numbers,
                      "The same with the number of edges of every piece of the "
                      "curve between corners and named points.",
                      Patterns::Map(Patterns::Anything(),
                                    Patterns::Integer(1, 1000000),
                                    0));
    prm.add_parameter("Largest edges",
                      largest_edges,
                      "Largest edges within regions that are meshed anew [mm]: "
                      "`tooth: 0.3`.",
                      Patterns::Map(Patterns::Anything(), length, 0));
    prm.add_parameter(
      "Growth",
      growth,
      "Growth of edges with the distance from the outline within "
      "regions that are meshed anew [-].",
      Patterns::Double(1e-3, 10.));
    prm.add_parameter("Corner angle",
                      corner_angle,
                      "Curves have a corner where they turn by more than this "
                      "angle from one edge to the next; splines end there "
                      "[degree].",
                      Patterns::Double(1., 180.));
    prm.add_parameter("Good quality",
                      mesher.good_quality,
                      "Smallest scaled Jacobian at which the search for better "
                      "cells ends [-].",
                      Patterns::Double(0., 1.));
    prm.add_parameter("Candidates",
                      n_candidates,
                      "Number of meshes to choose from at most.",
                      Patterns::Integer(1, 100));
    mesher.gmsh.declare_parameters(prm);
  }



  void
  OutlineRemesher::initialize(const NamedSets<2> &names,
                              const std::string  &subsection)
  {
    where = subsection;
    std::map<std::string, std::string> list_of;
    for (const auto &[list, title] :
         {std::make_pair(&kept, "Kept regions"),
          std::make_pair(&smoothed, "Smoothed regions"),
          std::make_pair(&strips, "Strips")})
      for (const std::string &region : *list)
        {
          const std::string parameter = where + " / " + title;
          names.region(region, parameter);
          const auto entry = list_of.emplace(region, title);
          if (!entry.second)
            throw InputError(parameter,
                             "the region '" + region + "' is already in '" +
                               entry.first->second + "'",
                             "name it once");
        }
    for (const std::string &curve : strip_ends)
      names.curve(curve, where + " / Strip ends");
    for (const auto &entry : edge_lengths)
      names.curve(entry.first, where + " / Edge lengths");
    for (const auto &entry : edge_numbers)
      names.curve(entry.first, where + " / Edge numbers");
    for (const auto &entry : largest_edges)
      names.region(entry.first, where + " / Largest edges");
    if (strips.empty() != strip_ends.empty())
      throw InputError(where + " / Strip ends",
                       strips.empty() ? "there are ends, but no strips"
                                      : "there are strips without ends",
                       "name the curves at which the regions in 'Strips' end");
  }



  OutlineRemesher::Treatment
  OutlineRemesher::treatment(const types::material_id material,
                             const NamedSets<2>      &names) const
  {
    const auto is_in = [&](const std::vector<std::string> &list) {
      for (const std::string &region : list)
        if (names.region(region, where).count(material) != 0)
          return true;
      return false;
    };
    return is_in(kept)       ? Treatment::keep
           : is_in(smoothed) ? Treatment::smooth
           : is_in(strips)   ? Treatment::strip
                             : Treatment::mesh;
  }



  std::vector<Point<2>>
  OutlineRemesher::nodes_of(const PlanarCurve  &curve,
                            const LineIds      &ids,
                            const NamedSets<2> &names) const
  {
    const unsigned int *number = prescription(edge_numbers, ids, names);
    const double       *length = prescription(edge_lengths, ids, names);
    if (number == nullptr && length == nullptr)
      return curve.nodes;
    const CubicSpline<2> spline(curve.nodes);
    const unsigned int   n =
      alike(number != nullptr ? *number : spline.length() / *length,
            curve.n_segments());
    std::vector<Point<2>> nodes;
    for (unsigned int i = 0; i <= n; ++i)
      nodes.push_back(spline.at_arc_length(spline.length() * i / n));
    nodes.front() = curve.nodes.front();
    nodes.back()  = curve.nodes.back();
    return nodes;
  }



  std::map<unsigned int, std::shared_ptr<const AreaMesh>>
  OutlineRemesher::common_areas(const GatheredMesh &mesh,
                                const NamedSets<2> &names,
                                const MeshingJob   &job) const
  {
    const BodyOutline outline =
      extract_outline(mesh, names, {}, corner_angle * numbers::PI / 180.);
    PlanarGeometry         geometry = kept_geometry(mesh, outline);
    std::set<unsigned int> changed;
    for (unsigned int i = 0; i < geometry.curves.size(); ++i)
      {
        auto nodes = nodes_of(geometry.curves[i], outline.pieces[i].ids, names);
        if (nodes != geometry.curves[i].nodes)
          changed.insert(i);
        geometry.curves[i].nodes = std::move(nodes);
      }

    std::map<unsigned int, std::shared_ptr<const AreaMesh>> result;
    for (unsigned int a = 0; a < geometry.areas.size(); ++a)
      {
        PlanarArea     &area = geometry.areas[a];
        const Treatment way  = treatment(outline.areas[a].material, names);
        if (way != Treatment::mesh)
          for (const auto &loop : area.loops)
            for (const LoopPart &part : loop)
              if (changed.count(part.curve) != 0)
                throw RunError(where,
                               "a curve that is to get new nodes borders cells "
                               "that are to stay",
                               "mesh the regions on both its sides anew");
        if (way == Treatment::smooth)
          {
            AreaMesh          smooth = *area.prepared;
            std::vector<bool> fixed(smooth.vertices.size(), false);
            std::set<std::pair<double, double>> on_loops;
            for (const auto &loop : area.loops)
              for (const Point<2> &p : loop_positions(geometry, loop))
                on_loops.emplace(p[0], p[1]);
            for (const auto &point : geometry.point_names)
              on_loops.emplace(point.second[0], point.second[1]);
            for (std::size_t v = 0; v < smooth.vertices.size(); ++v)
              fixed[v] =
                on_loops.count({smooth.vertices[v][0], smooth.vertices[v][1]});
            smooth.quality = optimise_quads(
              smooth.vertices, smooth.quads, fixed, mesher.good_quality, 0);
            smooth.remark = "smoothed";
            result[outline.areas[a].cells[0]] =
              std::make_shared<const AreaMesh>(std::move(smooth));
          }
        else if (way == Treatment::mesh)
          {
            area.growth = growth;
            for (const auto &entry : largest_edges)
              if (names.region(entry.first, where)
                    .count(outline.areas[a].material) != 0)
                area.largest_size = entry.second;
            std::vector<std::vector<Point<2>>> loops;
            for (const auto &loop : area.loops)
              loops.push_back(loop_positions(geometry, loop));
            result[outline.areas[a].cells[0]] =
              std::make_shared<const AreaMesh>(mesh_unstructured_area(
                area, loops, mesher, job.part(std::to_string(a + 1))));
          }
      }
    return result;
  }



  std::vector<RemeshCandidate<2>>
  OutlineRemesher::candidates(const Configuration<2> &old,
                              const std::string      &output_directory,
                              const std::string      &name) const
  {
    const NamedSets<2> &names = old.mesh.names;
    const MeshingJob    job{name, output_directory, where, old.communicator()};
    const GatheredMesh  mesh   = gather_mesh(old);
    const auto          common = common_areas(mesh, names, job);

    // All meshes of the zones at the ends of strips, best first
    std::set<types::material_id> strip_materials;
    for (const std::string &region : strips)
      for (const types::material_id id : names.region(region, where))
        strip_materials.insert(id);
    ZoneSettings settings       = zone_settings;
    settings.angle_of_two_cells = angle_of_two_cells * numbers::PI / 180.;
    settings.growth             = growth;
    settings.largest_area_change =
      largest_area_change * area_of(mesh, strip_materials);
    settings.mesher = mesher;
    settings.mesher.attempts.resize(4);
    const StripEnds ends = mesh_strip_ends(
      mesh, names, strip_materials, strip_ends, zone_lengths, settings, job);

    std::vector<RemeshCandidate<2>> result;
    for (const auto &combination : ends.combinations(n_candidates))
      {
        std::vector<const ZoneChoice *> chosen;
        std::set<MeshLine>              cuts;
        for (std::size_t e = 0; e < ends.choices.size(); ++e)
          {
            chosen.push_back(&ends.choices[e][combination[e]]);
            cuts.insert(chosen.back()->zone.cut_lines.begin(),
                        chosen.back()->zone.cut_lines.end());
          }
        const BodyOutline outline =
          extract_outline(mesh, names, cuts, corner_angle * numbers::PI / 180.);
        PlanarGeometry geometry = kept_geometry(mesh, outline);
        for (unsigned int i = 0; i < geometry.curves.size(); ++i)
          geometry.curves[i].nodes =
            nodes_of(geometry.curves[i], outline.pieces[i].ids, names);
        for (unsigned int a = 0; a < geometry.areas.size(); ++a)
          {
            const auto entry = common.find(outline.areas[a].cells[0]);
            if (entry != common.end())
              geometry.areas[a].prepared = entry->second;
          }
        for (const ZoneChoice *choice : chosen)
          put_zone(geometry, outline, *choice);

        PlanarMeshReport   report;
        MeshDescription<2> description =
          mesh_planar_geometry(geometry, mesher, job, report);
        RemeshCandidate<2> candidate;
        candidate.mesh    = build_named_mesh(description,
                                          line_ids(outline),
                                          names,
                                          job.communicator);
        candidate.quality = report.smallest_scaled_jacobian;
        std::ostringstream text;
        text << name << ": " << description.cells.size() << " cells, "
             << description.vertices.size()
             << " vertices, smallest scaled Jacobian " << std::setprecision(3)
             << candidate.quality;
        for (std::size_t e = 0; e < chosen.size(); ++e)
          text << "; " << strip_ends[e] << ": " << chosen[e]->mesh.description;
        text << ends.counts;
        candidate.describe(text.str());
        result.push_back(std::move(candidate));
      }
    sort_best_first(result, [](const auto &mesh) { return mesh.quality; });
    return result;
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Remesher<2>,
  alveolus::OutlineRemesher,
  "outline",
  "New meshes within the outlines and interfaces of the deformed body, in 2D. "
  "Outlines and interfaces are divided into pieces at junctions, named points, "
  "changes of name and corners (`Corner angle`). A piece keeps its nodes where "
  "they are, so that no region changes its area, unless `Edge lengths` or `Edge "
  "numbers` ask for new ones on the cubic spline through the old. `Kept "
  "regions` keep their cells; in `Smoothed regions` inner vertices move; of "
  "`Strips` (layers of cells with free ends, e.g. a ligament between tooth and "
  "bone) only the zones at the `Strip ends` are meshed anew, where corners "
  "open towards 180 degrees on one side of a bulge and close on the other: with "
  "lattices, with rings of cells around obtuse corners, so that a corner beyond "
  "`Angle of two cells` has two, and with gmsh, for each of the `Zone lengths` "
  "and `Strip end edges`. All other regions get unstructured quads by gmsh. The "
  "best meshes by the smallest scaled Jacobian are the candidates. Degree 1.")
