// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/area_mesher.h>
#include <alveolus/remeshing/body_outline.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = std::numeric_limits<unsigned int>::max();
    constexpr unsigned int ends[4][2] = {{0, 1}, {1, 3}, {3, 2}, {2, 0}};

    using Directed = std::pair<unsigned int, unsigned int>;

    /** Finds pieces and areas, step by step. */
    class Extraction
    {
    public:
      Extraction(const GatheredMesh       &mesh,
                 const NamedSets<2>       &names,
                 const std::set<MeshLine> &cuts,
                 const double              corner_angle)
        : mesh(mesh)
        , cuts(cuts)
      {
        find_separators(names);
        find_areas();
        check_separators(names);
        find_ends(corner_angle);
        find_pieces();
        find_loops();
      }

      BodyOutline result;

    private:
      const GatheredMesh       &mesh;
      const std::set<MeshLine> &cuts;

      /** The cell to the left of a line from one node to another. */
      std::map<Directed, unsigned int> left_cell;
      std::set<MeshLine>               separators;
      std::vector<unsigned int>        area_of; ///< by cell

      std::map<unsigned int, std::vector<unsigned int>> neighbours;
      std::set<unsigned int>                            piece_ends;
      std::set<MeshLine>           used;    ///< lines in pieces
      std::map<Directed, LoopPart> part_at; ///< by the first line of a piece

      unsigned int
      cell_left_of(const unsigned int a, const unsigned int b) const
      {
        const auto entry = left_cell.find({a, b});
        return entry == left_cell.end() ? none : entry->second;
      }

      void
      find_separators(const NamedSets<2> &names)
      {
        std::set<types::manifold_id> named;
        for (const auto &curve : names.curves)
          named.insert(curve.second.begin(), curve.second.end());
        for (unsigned int c = 0; c < mesh.cells.size(); ++c)
          for (const auto &end : ends)
            left_cell[{mesh.cells[c][end[0]], mesh.cells[c][end[1]]}] = c;
        for (const auto &line : mesh.lines)
          {
            const auto [a, b]        = line.first;
            const unsigned int left  = cell_left_of(a, b);
            const unsigned int right = cell_left_of(b, a);
            if (left == none || right == none ||
                mesh.materials[left] != mesh.materials[right] ||
                named.count(line.second.manifold) != 0 ||
                cuts.count(line.first) != 0)
              {
                separators.insert(line.first);
                neighbours[a].push_back(b);
                neighbours[b].push_back(a);
              }
          }
        for (auto &entry : neighbours)
          std::sort(entry.second.begin(), entry.second.end());
      }

      void
      find_areas()
      {
        area_of.assign(mesh.cells.size(), none);
        for (unsigned int first = 0; first < mesh.cells.size(); ++first)
          {
            if (area_of[first] != none)
              continue;
            OutlineArea area;
            area.material  = mesh.materials[first];
            area_of[first] = result.areas.size();
            area.cells.push_back(first);
            for (std::size_t i = 0; i < area.cells.size(); ++i)
              for (const auto &end : ends)
                {
                  const Quad        &cell = mesh.cells[area.cells[i]];
                  const unsigned int a = cell[end[0]], b = cell[end[1]];
                  const unsigned int other = cell_left_of(b, a);
                  if (other != none && area_of[other] == none &&
                      separators.count(GatheredMesh::line(a, b)) == 0)
                    {
                      area_of[other] = area_of[first];
                      area.cells.push_back(other);
                    }
                }
            std::sort(area.cells.begin(), area.cells.end());
            result.areas.push_back(std::move(area));
          }
      }

      void
      check_separators(const NamedSets<2> &names) const
      {
        for (const MeshLine &line : separators)
          {
            const unsigned int left  = cell_left_of(line.first, line.second);
            const unsigned int right = cell_left_of(line.second, line.first);
            if (left == none || right == none ||
                area_of[left] != area_of[right])
              continue;
            std::string name = "a cut";
            for (const auto &curve : names.curves)
              if (curve.second.count(mesh.lines.at(line).manifold) != 0)
                name = "the curve '" + curve.first + "'";
            throw RunError("Remeshing",
                           name + " ends inside a region",
                           "a curve has to part regions, or a region in two, "
                           "from end to end");
          }
      }

      /** Areas left and right, the smaller first. */
      std::pair<unsigned int, unsigned int>
      sides(const unsigned int a, const unsigned int b) const
      {
        const unsigned int left  = cell_left_of(a, b),
                           right = cell_left_of(b, a);
        return std::minmax(left == none ? none : area_of[left],
                           right == none ? none : area_of[right]);
      }

      void
      find_ends(const double corner_angle)
      {
        for (const auto &point : mesh.points)
          if (neighbours.count(point.second) != 0)
            piece_ends.insert(point.second);
        for (const auto &entry : neighbours)
          {
            const unsigned int v = entry.first;
            if (entry.second.size() != 2)
              {
                piece_ends.insert(v);
                continue;
              }
            const unsigned int a = entry.second[0], b = entry.second[1];
            const MeshLine     line_a = GatheredMesh::line(a, v),
                           line_b     = GatheredMesh::line(v, b);
            const Tensor<1, 2> in     = mesh.positions[v] - mesh.positions[a];
            const Tensor<1, 2> out    = mesh.positions[b] - mesh.positions[v];
            const double       turn =
              std::atan2(in[0] * out[1] - in[1] * out[0], in * out);
            if (!(mesh.lines.at(line_a) == mesh.lines.at(line_b)) ||
                sides(a, v) != sides(v, b) ||
                cuts.count(line_a) != cuts.count(line_b) ||
                std::abs(turn) > corner_angle)
              piece_ends.insert(v);
          }
      }

      void
      add_piece(const unsigned int first, const unsigned int second)
      {
        OutlinePiece piece;
        piece.nodes         = {first, second};
        const MeshLine line = GatheredMesh::line(first, second);
        piece.ids           = mesh.lines.at(line);
        piece.is_cut        = cuts.count(line) != 0;
        while (piece_ends.count(piece.nodes.back()) == 0)
          {
            const auto &around = neighbours.at(piece.nodes.back());
            const bool  back = around[0] == piece.nodes[piece.nodes.size() - 2];
            piece.nodes.push_back(around[back ? 1 : 0]);
          }
        const unsigned int number = result.pieces.size();
        const std::size_t  n      = piece.nodes.size();
        part_at[{first, second}]  = {number, false};
        part_at[{piece.nodes[n - 1], piece.nodes[n - 2]}] = {number, true};
        for (std::size_t i = 0; i + 1 < n; ++i)
          used.insert(GatheredMesh::line(piece.nodes[i], piece.nodes[i + 1]));
        result.pieces.push_back(std::move(piece));
      }

      void
      find_pieces()
      {
        for (const unsigned int v : piece_ends)
          for (const unsigned int next : neighbours.at(v))
            if (used.count(GatheredMesh::line(v, next)) == 0)
              add_piece(v, next);
        // What is left are closed loops without an end: begun at the first
        // node.
        for (const MeshLine &line : separators)
          if (used.count(line) == 0)
            {
              piece_ends.insert(line.first);
              add_piece(line.first, line.second);
            }
      }

      /** The line after (a, b) around the area to the left of it. */
      Directed
      following(const unsigned int a, const unsigned int b) const
      {
        unsigned int from = a;
        while (true)
          {
            const Quad  &cell = mesh.cells[left_cell.at({from, b})];
            unsigned int next = none;
            for (const auto &end : ends)
              if (cell[end[0]] == b)
                next = cell[end[1]];
            if (separators.count(GatheredMesh::line(b, next)) != 0)
              return {b, next};
            from = next; // on to the cell on the other side of (b, next)
          }
      }

      double
      signed_area(const std::vector<LoopPart> &loop) const
      {
        double     area  = 0.;
        const auto nodes = result.loop_nodes(loop);
        for (std::size_t i = 0; i < nodes.size(); ++i)
          {
            const Point<2> &a = mesh.positions[nodes[i]];
            const Point<2> &b = mesh.positions[nodes[(i + 1) % nodes.size()]];
            area += 0.5 * (a[0] * b[1] - a[1] * b[0]);
          }
        return area;
      }

      void
      find_loops()
      {
        std::set<Directed> done;
        for (const auto &entry : part_at)
          {
            const unsigned int cell =
              cell_left_of(entry.first.first, entry.first.second);
            if (cell == none || done.count(entry.first) != 0)
              continue;
            std::vector<LoopPart> loop;
            Directed              line = entry.first;
            do
              {
                const auto part = part_at.find(line);
                if (part != part_at.end())
                  {
                    loop.push_back(part->second);
                    done.insert(line);
                  }
                line = following(line.first, line.second);
            } while (line != entry.first);
            result.areas[area_of[cell]].loops.push_back(std::move(loop));
          }
        for (OutlineArea &area : result.areas)
          std::stable_sort(area.loops.begin(),
                           area.loops.end(),
                           [this](const auto &a, const auto &b) {
                             return signed_area(a) > signed_area(b);
                           });
      }
    };
  } // namespace



  std::vector<unsigned int>
  BodyOutline::loop_nodes(const std::vector<LoopPart> &loop) const
  {
    std::vector<unsigned int> result;
    for (const LoopPart &part : loop)
      {
        auto nodes = pieces[part.curve].nodes;
        if (part.reversed)
          std::reverse(nodes.begin(), nodes.end());
        result.insert(result.end(), nodes.begin(), nodes.end() - 1);
      }
    return result;
  }



  BodyOutline
  extract_outline(const GatheredMesh       &mesh,
                  const NamedSets<2>       &names,
                  const std::set<MeshLine> &cuts,
                  const double              corner_angle)
  {
    return Extraction(mesh, names, cuts, corner_angle).result;
  }



  PlanarGeometry
  kept_geometry(const GatheredMesh &mesh, const BodyOutline &outline)
  {
    PlanarGeometry                       geometry;
    std::map<unsigned int, unsigned int> point_of; // node to point
    const auto                           point = [&](const unsigned int node) {
      const auto entry = point_of.emplace(node, geometry.points.size());
      if (entry.second)
        geometry.points.push_back(mesh.positions[node]);
      return entry.first->second;
    };
    for (const OutlinePiece &piece : outline.pieces)
      {
        PlanarCurve curve;
        curve.begin = point(piece.nodes.front());
        curve.end   = point(piece.nodes.back());
        curve.tag   = geometry.curves.size() + 1;
        for (const unsigned int node : piece.nodes)
          curve.nodes.push_back(mesh.positions[node]);
        geometry.curves.push_back(std::move(curve));
      }
    for (const OutlineArea &area : outline.areas)
      {
        PlanarArea result;
        result.name  = "area " + std::to_string(geometry.areas.size() + 1);
        result.tag   = area.material;
        result.loops = area.loops;
        AreaMesh                             cells;
        std::map<unsigned int, unsigned int> index;
        cells.quality = 1.;
        cells.remark  = "kept";
        for (const unsigned int c : area.cells)
          {
            Quad quad;
            for (unsigned int v = 0; v < 4; ++v)
              {
                const auto entry =
                  index.emplace(mesh.cells[c][v], cells.vertices.size());
                if (entry.second)
                  cells.vertices.push_back(mesh.positions[mesh.cells[c][v]]);
                quad[v] = entry.first->second;
              }
            cells.quads.push_back(quad);
            cells.quality =
              std::min(cells.quality, scaled_jacobian(cells.vertices, quad));
          }
        result.prepared = std::make_shared<const AreaMesh>(std::move(cells));
        geometry.areas.push_back(std::move(result));
      }
    for (const auto &point : mesh.points)
      geometry.point_names[point.first] = mesh.positions[point.second];
    return geometry;
  }



  std::map<unsigned int, LineIds>
  line_ids(const BodyOutline &outline)
  {
    std::map<unsigned int, LineIds> result;
    for (unsigned int i = 0; i < outline.pieces.size(); ++i)
      result[i + 1] = outline.pieces[i].ids;
    return result;
  }
} // namespace alveolus
