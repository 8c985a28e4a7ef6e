// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/remeshing/body_outline.h>
#include <alveolus/remeshing/remesher.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** A side of a block: pieces of the outline from corner to corner. */
    struct Side
    {
      std::vector<LoopPart> parts;
      unsigned int          n_edges = 0;
      double                length  = 0.; ///< [mm]
    };

    /** A four-sided area whose cells form a lattice. */
    struct Block
    {
      unsigned int        area = 0;
      std::array<Side, 4> sides;
    };

    /** Sides with the same number of edges: opposite ones and shared ones. */
    struct Group
    {
      std::vector<std::pair<unsigned int, unsigned int>> sides; ///< block, side
      bool                                               is_free = true;
    };
  } // namespace



  /** Divides blocks of cells anew, with other numbers of cells. */
  class StructuredRemesher : public Remesher<2>
  {
  public:
    void
    declare_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter(
        "Blocks",
        regions,
        "Regions of four sides whose cells form a lattice, to be "
        "divided anew. All other cells stay as they are.",
        Patterns::List(Patterns::Anything(), 0));
      prm.add_parameter("Edge length",
                        edge_length,
                        "Mean length of the new edges along sides that may be "
                        "divided anew [mm]; 0: by Aspect ratio.",
                        Patterns::Double(0., 1e6));
      prm.add_parameter("Aspect ratio",
                        aspect_ratio,
                        "Mean length of the new edges over that of the edges "
                        "across them [-].",
                        Patterns::Double(1e-3, 1e3));
      prm.add_parameter("Grading",
                        grading,
                        "Lengths of the new edges of a side: `as before`, "
                        "growing along it as the old ones do, or `equal`.",
                        Patterns::Selection("as before|equal"));
      prm.add_parameter("Corner angle",
                        corner_angle,
                        "Sides have a corner, which stays, where they turn by "
                        "more than this angle from one edge to the next "
                        "[degree].",
                        Patterns::Double(1., 180.));
    }

    void
    initialize(const NamedSets<2> &names,
               const std::string  &subsection) override
    {
      where = subsection;
      if (regions.empty())
        throw InputError(where + " / Blocks",
                         "no region is named",
                         "name those that are to be divided anew");
      for (const std::string &region : regions)
        names.region(region, where + " / Blocks");
    }

    std::vector<RemeshCandidate<2>>
    candidates(const Configuration<2> &old,
               const std::string      &output_directory,
               const std::string      &name) const override
    {
      const NamedSets<2> &names = old.mesh.names;
      const GatheredMesh  mesh  = gather_mesh(old);
      const BodyOutline   outline =
        extract_outline(mesh, names, {}, corner_angle * numbers::PI / 180.);
      PlanarGeometry     geometry = kept_geometry(mesh, outline);
      std::vector<Block> blocks   = find_blocks(mesh, names, outline, geometry);

      std::ostringstream changes;
      for (const Group &group : find_groups(outline, blocks))
        if (group.is_free)
          divide(group, geometry, blocks, changes);

      for (const Block &block : blocks)
        {
          PlanarArea &area = geometry.areas[block.area];
          area.prepared.reset();
          area.structured = true;
          area.loops[0].clear();
          for (unsigned int s = 0; s < 4; ++s)
            {
              area.corners[s] = area.loops[0].size();
              area.loops[0].insert(area.loops[0].end(),
                                   block.sides[s].parts.begin(),
                                   block.sides[s].parts.end());
            }
        }
      PlanarMeshReport         report;
      const MeshDescription<2> description = mesh_planar_geometry(
        geometry,
        PlanarMesher(),
        {name, output_directory, where, old.communicator()},
        report);
      if (!(report.smallest_scaled_jacobian > 0.))
        throw RunError(where,
                       "the blocks divided anew have inverted cells",
                       "remesh earlier");
      std::vector<RemeshCandidate<2>> result(1);
      result[0].mesh    = build_named_mesh(description,
                                        line_ids(outline),
                                        names,
                                        old.communicator());
      result[0].quality = report.smallest_scaled_jacobian;
      std::ostringstream text;
      text << name << ": " << description.cells.size() << " cells, "
           << description.vertices.size()
           << " vertices, smallest scaled Jacobian " << std::setprecision(3)
           << result[0].quality << changes.str();
      result[0].describe(text.str());
      return result;
    }

  private:
    std::vector<std::string> regions;
    double                   edge_length  = 0.;
    double                   aspect_ratio = 1.;
    std::string              grading      = "as before";
    double                   corner_angle = 40.; ///< [degree]
    std::string              where        = "Remeshing";

    std::vector<Block>
    find_blocks(const GatheredMesh   &mesh,
                const NamedSets<2>   &names,
                const BodyOutline    &outline,
                const PlanarGeometry &geometry) const
    {
      std::vector<Block> blocks;
      for (const std::string &region : regions)
        for (unsigned int a = 0; a < outline.areas.size(); ++a)
          if (names.region(region, where).count(outline.areas[a].material) != 0)
            blocks.push_back(
              make_block(a, region, mesh, outline.areas[a], outline, geometry));
      return blocks;
    }

    /** Corners of a lattice are the boundary nodes of one cell only. */
    Block
    make_block(const unsigned int    number,
               const std::string    &region,
               const GatheredMesh   &mesh,
               const OutlineArea    &area,
               const BodyOutline    &outline,
               const PlanarGeometry &geometry) const
    {
      std::map<unsigned int, unsigned int> n_cells;
      for (const unsigned int c : area.cells)
        for (const unsigned int v : mesh.cells[c])
          ++n_cells[v];
      const auto first_node = [&](const LoopPart &part) {
        const auto &nodes = outline.pieces[part.curve].nodes;
        return part.reversed ? nodes.back() : nodes.front();
      };
      // A loop that begins at a corner; corners are ends of pieces.
      std::vector<LoopPart> loop      = area.loops[0];
      unsigned int          n_corners = 0;
      for (const LoopPart &part : loop)
        n_corners += n_cells.at(first_node(part)) == 1;
      unsigned int n_single = 0;
      for (const auto &entry : n_cells)
        n_single += entry.second == 1;
      if (area.loops.size() != 1 || n_corners != 4 || n_single != 4)
        throw RunError(where,
                       "the region '" + region +
                         "' is no lattice with four corners",
                       "name regions of four sides only, their corners being "
                       "points, ends of curves, or sharper than 'Corner "
                       "angle'");
      while (n_cells.at(first_node(loop[0])) != 1)
        std::rotate(loop.begin(), loop.begin() + 1, loop.end());

      Block block;
      block.area        = number;
      unsigned int side = 0;
      for (std::size_t i = 0; i < loop.size(); ++i)
        {
          if (i > 0 && n_cells.at(first_node(loop[i])) == 1)
            ++side;
          const auto &nodes = geometry.curves[loop[i].curve].nodes;
          Side       &s     = block.sides[side];
          s.parts.push_back(loop[i]);
          s.n_edges += nodes.size() - 1;
          s.length += CubicSpline<2>(nodes).length();
        }
      if (block.sides[0].n_edges != block.sides[2].n_edges ||
          block.sides[1].n_edges != block.sides[3].n_edges ||
          block.sides[0].n_edges * block.sides[1].n_edges != area.cells.size())
        throw RunError(where,
                       "the cells of the region '" + region +
                         "' form no lattice",
                       "opposite sides need as many edges");
      return block;
    }

    /** Sides that must have the same number of edges. A group is free if none
     * of its sides belongs to cells that stay, or to a part of a side only. */
    std::vector<Group>
    find_groups(const BodyOutline        &outline,
                const std::vector<Block> &blocks) const
    {
      using Parts = std::set<unsigned int>; // curves of a side
      std::map<Parts, std::vector<unsigned int>> sides_of;
      std::map<unsigned int, unsigned int>       n_areas; // of a curve
      for (const OutlineArea &area : outline.areas)
        for (const auto &loop : area.loops)
          for (const LoopPart &part : loop)
            ++n_areas[part.curve];
      const auto parts_of = [&](const unsigned int side) {
        Parts parts;
        for (const LoopPart &part : blocks[side / 4].sides[side % 4].parts)
          parts.insert(part.curve);
        return parts;
      };
      std::vector<unsigned int> leader(4 * blocks.size());
      std::iota(leader.begin(), leader.end(), 0);
      const auto root = [&leader](unsigned int side) {
        while (leader[side] != side)
          side = leader[side];
        return side;
      };
      for (unsigned int side = 0; side < leader.size(); ++side)
        sides_of[parts_of(side)].push_back(side);
      for (const auto &entry : sides_of)
        for (const unsigned int side : entry.second)
          leader[root(side)] = root(entry.second[0]);
      for (unsigned int side = 0; side < leader.size(); ++side)
        if (side % 4 < 2)
          leader[root(side + 2)] = root(side);

      std::map<unsigned int, Group> groups;
      for (unsigned int side = 0; side < leader.size(); ++side)
        {
          Group &group = groups[root(side)];
          group.sides.emplace_back(side / 4, side % 4);
          const std::size_t n_blocks = sides_of.at(parts_of(side)).size();
          for (const unsigned int curve : parts_of(side))
            group.is_free = group.is_free && n_areas.at(curve) == n_blocks;
        }
      std::vector<Group> result;
      for (const auto &entry : groups)
        result.push_back(entry.second);
      return result;
    }

    /** Give the sides of a group new nodes. */
    void
    divide(const Group        &group,
           PlanarGeometry     &geometry,
           std::vector<Block> &blocks,
           std::ostream       &changes) const
    {
      double       length = 0., across = 0.;
      const double weight = 1. / group.sides.size();
      for (const auto &[b, s] : group.sides)
        {
          const Side &other = blocks[b].sides[(s + 1) % 4];
          const Side &last  = blocks[b].sides[(s + 3) % 4];
          length += weight * blocks[b].sides[s].length;
          across += weight * 0.5 * (other.length + last.length) / other.n_edges;
        }
      const double wanted =
        length / (edge_length > 0. ? edge_length : aspect_ratio * across);
      unsigned int n = std::max(1L, std::lround(wanted));
      for (const auto &[b, s] : group.sides)
        n = std::max<unsigned int>(n, blocks[b].sides[s].parts.size());
      changes
        << "; " << geometry.areas[blocks[group.sides[0].first].area].name
        << " from "
        << blocks[group.sides[0].first].sides[group.sides[0].second].n_edges
        << " to " << n << " edges";

      std::set<unsigned int> done; // a shared side comes twice
      for (const auto &[b, s] : group.sides)
        {
          Side &side = blocks[b].sides[s];
          // Edges of the pieces in proportion to the old ones, one at least
          unsigned int n_old = 0, n_new = 0;
          for (std::size_t i = 0; i < side.parts.size(); ++i)
            {
              PlanarCurve       &curve = geometry.curves[side.parts[i].curve];
              const unsigned int old =
                done.count(side.parts[i].curve) == 0 ? curve.n_segments() : 0;
              if (old == 0)
                continue;
              n_old += old;
              const unsigned int rest = side.parts.size() - 1 - i;
              const unsigned int until =
                rest == 0
                  ? n
                  : std::min<unsigned int>(
                      n - rest,
                      std::max<unsigned int>(n_new + 1,
                                             std::lround(double(n) * n_old /
                                                         side.n_edges)));
              renew(curve, until - n_new);
              n_new = until;
              done.insert(side.parts[i].curve);
            }
          side.n_edges = n;
        }
    }

    /** New nodes on the spline through the old ones. */
    void
    renew(PlanarCurve &curve, const unsigned int n) const
    {
      const CubicSpline<2>  spline(curve.nodes);
      const auto           &s     = spline.arc_lengths();
      const unsigned int    n_old = curve.n_segments();
      std::vector<Point<2>> nodes;
      for (unsigned int i = 0; i <= n; ++i)
        {
          double length = spline.length() * i / n;
          if (grading == "as before")
            {
              // The old arc lengths as a function of the part of the edges
              const double       t = double(i) / n * n_old;
              const unsigned int k =
                std::min<unsigned int>(n_old - 1, std::floor(t));
              length = s[k] + (t - k) * (s[k + 1] - s[k]);
            }
          nodes.push_back(spline.at_arc_length(length));
        }
      nodes.front() = curve.nodes.front();
      nodes.back()  = curve.nodes.back();
      curve.nodes   = nodes;
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Remesher<2>,
  alveolus::StructuredRemesher,
  "structured",
  "Divides the regions in `Blocks`, four-sided lattices of cells, anew, in 2D, "
  "while all other cells stay as they are. Opposite sides, and sides that two "
  "blocks share, have the same number of edges; where none of them belongs to "
  "other cells, the number becomes the mean length of the sides over `Edge "
  "length` or, if that is 0, over `Aspect ratio` times the mean length of the "
  "edges across. New nodes lie on the cubic splines through the old ones (named "
  "points and corners stay), graded as before or equally (`Grading`); the inside "
  "follows by transfinite interpolation. All names are kept. Degree 1.")
