// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_body_surface_h
#define alveolus_remeshing_body_surface_h

#include <alveolus/mesh/mesh_description.h>

#include <deal.II/base/types.h>

#include <array>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /** An edge of a surface: its nodes, the smaller number first. */
  using SurfaceEdge = std::pair<unsigned int, unsigned int>;

  /** Edge between two nodes. */
  inline SurfaceEdge
  surface_edge(const unsigned int a, const unsigned int b)
  {
    return a < b ? SurfaceEdge(a, b) : SurfaceEdge(b, a);
  }

  /**
   * The boundary and the interfaces of materials of a body of hexahedra, taken
   * apart into smooth patches and the curves and corners between them.
   *
   * Layers (e.g. a ligament) are left out: where a layer was, both its walls
   * are glued together. Its cells have to form columns from wall to wall, all
   * of the same materials; a node of one wall is glued to the node at the other
   * end of its column. What is left falls into *parts*, between which the
   * layers lie; a node of the surface has a place for each part it belongs to.
   * Each part is divided into *components*: connected cells of the same
   * material.
   */
  struct BodySurface
  {
    /** No component, layer or patch. */
    static constexpr unsigned int none =
      std::numeric_limits<unsigned int>::max();

    /** A quadrilateral of the surface. */
    struct Face
    {
      /** Around the face, counterclockwise seen from outside of the first
       * component. */
      std::array<unsigned int, 4> nodes{};
      /** Component it is the boundary of, and the one beyond or none. */
      std::array<unsigned int, 2> components{{none, none}};
      unsigned int boundary = 0;    ///< boundary id, where there is none beyond
      unsigned int layer    = none; ///< between the components, if any
      unsigned int patch    = none; ///< index; none until it is found
    };

    /** Materials of a layer from wall to wall. */
    struct Layer
    {
      /** Of its cells, along a column. */
      std::vector<dealii::types::material_id> materials;
    };

    /** Connected cells of one material. */
    struct Component
    {
      dealii::types::material_id material = 0; ///< of all its cells
      unsigned int               part     = 0; ///< index of the part it is in
    };

    /** What an edge with other than two faces, or with a name, has. */
    struct Edge
    {
      std::vector<unsigned int>            faces; ///< indices of faces
      std::map<unsigned int, unsigned int> lines; ///< tag by part
      /** Boundary ids of the faces of the layer that end here, by level. */
      std::vector<unsigned int> strip;

      /** Whether both carry the same names, whatever their faces. */
      bool
      operator==(const Edge &other) const
      {
        return lines == other.lines && strip == other.strip;
      }
    };

    /** Edges between patches in a row. */
    struct Curve
    {
      /** Closed: the first node is repeated at the end. */
      std::vector<unsigned int> nodes;
      bool                      closed = false; ///< without ends
      std::set<unsigned int>    parts;          ///< in which it has places
      Edge                      ids; ///< lines and strip, the same everywhere
    };

    /** A named point. */
    struct NamedPlace
    {
      unsigned int node; ///< of the surface
      unsigned int part; ///< where the name is
    };

    /** Nodes by part; of other parts the place has no meaning [mm]. */
    std::vector<std::vector<dealii::Point<3>>> places;
    std::vector<std::vector<bool>>             is_in; ///< part, node
    /** All of them, part after part. */
    std::vector<Component> components;
    std::vector<Layer>     layers; ///< each kind once
    /** Of the surface, in the order of cells. */
    std::vector<Face>  faces;
    unsigned int       n_patches = 0; ///< their number
    std::vector<Curve> curves;        ///< between patches
    /** Nodes where curves end. */
    std::set<unsigned int> corners;
    /** Tags of named lines through a layer at a corner, by level. */
    std::map<unsigned int, std::vector<unsigned int>> through;
    std::map<std::string, NamedPlace>                 points; ///< by name

    /** Nodes of the surface: those of walls glued together count once. */
    unsigned int
    n_nodes() const
    {
      return is_in[0].size();
    }

    /** The part in which a face is measured: that of its first component. */
    unsigned int
    part(const Face &face) const
    {
      return components[face.components[0]].part;
    }
  };

  /**
   * Take a mesh apart.
   * @param mesh         see describe_mesh()
   * @param layers       material ids of layers
   * @param corner_angle edges where the surface turns by more than this, and
   *        corners of curves that do, are kept [rad]
   * @param where        for messages
   * @throws RunError if layers are no columns or do not separate parts; for
   *         named points or lines inside a material or a layer
   */
  BodySurface
  extract_surface(const MeshDescription<3>                   &mesh,
                  const std::set<dealii::types::material_id> &layers,
                  const double                                corner_angle,
                  const std::string                          &where);
} // namespace alveolus

#endif
