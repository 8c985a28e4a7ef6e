// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/remeshing/layer_columns.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;



  LayerColumns::LayerColumns(const MeshDescription<3>           &mesh,
                             const std::set<types::material_id> &layer_ids,
                             const std::string                  &where)
    : level(mesh.vertices.size(), 0)
    , mesh(mesh)
    , layer_ids(layer_ids)
    , where(where)
  {
    find_neighbours();
    find_components();
    find_columns();
  }



  void
  LayerColumns::fail(const std::string &found, const std::string &advice) const
  {
    throw RunError(where, found, advice);
  }



  bool
  LayerColumns::in_layer(const unsigned int cell) const
  {
    return layer_ids.count(mesh.cells[cell].tag) != 0;
  }



  SortedFace
  LayerColumns::sorted_face(const CellSide &side) const
  {
    SortedFace result;
    for (unsigned int i = 0; i < 4; ++i)
      result[i] =
        mesh.cells[side.first].vertices[vertices_around[side.second][i]];
    std::sort(result.begin(), result.end());
    return result;
  }



  CellSide
  LayerColumns::beyond(const CellSide &side) const
  {
    for (const CellSide &other : sides.at(sorted_face(side)))
      if (other.first != side.first)
        return other;
    return {none, none};
  }



  void
  LayerColumns::find_neighbours()
  {
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      for (unsigned int f = 0; f < 6; ++f)
        sides[sorted_face({c, f})].emplace_back(c, f);
  }



  void
  LayerColumns::find_components()
  {
    component.assign(mesh.cells.size(), none);
    // Parts first: connected whatever the material
    std::vector<unsigned int> part(mesh.cells.size(), none);
    const auto                flood = [&](const unsigned int         start,
                           std::vector<unsigned int> &mark,
                           const unsigned int         value,
                           const bool                 same_material) {
      std::vector<unsigned int> front{start};
      mark[start] = value;
      while (!front.empty())
        {
          const unsigned int c = front.back();
          front.pop_back();
          for (unsigned int f = 0; f < 6; ++f)
            {
              const unsigned int n = beyond({c, f}).first;
              if (n == none || in_layer(n) || mark[n] != none ||
                  (same_material && mesh.cells[n].tag != mesh.cells[c].tag))
                continue;
              mark[n] = value;
              front.push_back(n);
            }
        }
    };
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      {
        if (in_layer(c))
          continue;
        if (part[c] == none)
          flood(c, part, n_parts++, false);
        if (component[c] == none)
          {
            flood(c, component, components.size(), true);
            components.push_back({mesh.cells[c].tag, part[c]});
          }
      }
    if (n_parts == 0)
      fail("there are layers only", "name thin regions as 'Layers'");
  }



  void
  LayerColumns::find_columns()
  {
    layer_of.assign(mesh.cells.size(), none);
    // By the component of the first part, the one beyond, and materials
    std::map<std::vector<types::material_id>, unsigned int> kinds;
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      for (unsigned int f = 0; f < 6; ++f)
        {
          if (in_layer(c))
            continue;
          CellSide inside = beyond({c, f});
          if (inside.first == none || !in_layer(inside.first))
            continue;
          Column                          column;
          std::vector<types::material_id> materials;
          std::vector<unsigned int>       passed;
          column.wall = {c, f};
          for (unsigned int i = 0; i < 4; ++i)
            column.edges[i].push_back(
              mesh.cells[c].vertices[vertices_around[f][i]]);
          while (inside.first != none && in_layer(inside.first))
            {
              const auto &cell = mesh.cells[inside.first];
              materials.push_back(cell.tag);
              passed.push_back(inside.first);
              // Each vertex of the face goes to its neighbour across
              const unsigned int bit = 1u << (inside.second / 2);
              for (auto &edge : column.edges)
                {
                  const unsigned int v = std::find(cell.vertices.begin(),
                                                   cell.vertices.end(),
                                                   edge.back()) -
                                         cell.vertices.begin();
                  edge.push_back(cell.vertices[v ^ bit]);
                }
              inside = beyond({inside.first, inside.second ^ 1u});
            }
          if (inside.first == none)
            fail("a column of cells of a layer ends at the boundary",
                 "name regions as 'Layers' that lie between others, of "
                 "cells in columns from one to the other");
          const unsigned int here  = components[component[c]].part;
          const unsigned int there = components[component[inside.first]].part;
          if (here == there)
            fail("the same part of the body is on both sides of a layer",
                 "name regions as 'Layers' that separate others");
          if (here > there)
            continue; // comes from the other side, too
          column.beyond    = component[inside.first];
          const auto entry = kinds.emplace(materials, layers.size());
          if (entry.second)
            layers.push_back({materials});
          column.layer = entry.first->second;
          for (const unsigned int cell : passed)
            {
              if (layer_of[cell] != none)
                fail("a cell of a layer belongs to two columns",
                     "name regions as 'Layers' whose cells form columns "
                     "from wall to wall");
              layer_of[cell] = column.layer;
            }
          for (const auto &edge : column.edges)
            for (unsigned int k = 0; k < edge.size(); ++k)
              {
                const auto known = column_edges.emplace(edge[k], edge);
                if (!known.second && known.first->second != edge)
                  fail("the columns of a layer do not fit together",
                       "name regions as 'Layers' whose cells form "
                       "columns from wall to wall");
                level[edge[k]] = k;
              }
          columns.push_back(column);
        }
    for (unsigned int c = 0; c < mesh.cells.size(); ++c)
      if (in_layer(c) && layer_of[c] == none)
        fail("a cell of a layer is in no column from wall to wall",
             "name regions as 'Layers' that lie between others");
  }
} // namespace alveolus
