// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_layer_columns_h
#define alveolus_remeshing_layer_columns_h

#include <alveolus/remeshing/body_surface.h>

namespace alveolus
{
  /** A face of a mesh of hexahedra by its vertices, the smallest first. */
  using SortedFace = std::array<unsigned int, 4>;

  /** A cell and the number of one of its faces. */
  using CellSide = std::pair<unsigned int, unsigned int>;

  /** Vertices around the faces of a hexahedron, counterclockwise seen from
   * outside, in deal.II's numbers. */
  constexpr unsigned int vertices_around[6][4] = {{0, 4, 6, 2},
                                                  {1, 3, 7, 5},
                                                  {0, 1, 5, 4},
                                                  {2, 6, 7, 3},
                                                  {0, 2, 3, 1},
                                                  {4, 5, 7, 6}};

  /**
   * The cells of a body sorted into those of layers, which have to form columns
   * from one wall of the layer to the other, and connected components of one
   * material beside them; see BodySurface.
   */
  class LayerColumns
  {
  public:
    /** No cell, component or layer. */
    static constexpr unsigned int none = BodySurface::none;

    /** Cells in a row from one wall of a layer to the other. */
    struct Column
    {
      unsigned int layer;  ///< index among the layers
      CellSide     wall;   ///< where it begins: a cell of the first part
      unsigned int beyond; ///< component where it ends
      /** Vertices of its four edges from wall to wall. */
      std::array<std::vector<unsigned int>, 4> edges;
    };

    /**
     * @param mesh      see describe_mesh(); must outlive this object, like
     *        @p layer_ids, material ids of layers, and @p where, for messages
     * @throws RunError if cells of layers form no columns, or layers do not
     *         separate parts
     */
    LayerColumns(const MeshDescription<3>                   &mesh,
                 const std::set<dealii::types::material_id> &layer_ids,
                 const std::string                          &where);

    /** The vertices of a face. */
    SortedFace
    sorted_face(const CellSide &side) const;

    /** The cell beyond a face and its number of it; none at the boundary. */
    CellSide
    beyond(const CellSide &side) const;

    /** The one or two cells at each face. */
    std::map<SortedFace, std::vector<CellSide>> sides;
    std::vector<unsigned int> component; ///< of each cell, or none
    /** In the order of their first cells. */
    std::vector<BodySurface::Component> components;
    unsigned int                        n_parts = 0; ///< between the layers
    std::vector<BodySurface::Layer>     layers; ///< kinds, by their materials
    /** In the order of the cells they begin at. */
    std::vector<Column> columns;
    /** The edge of a column that a vertex of a layer is on. */
    std::map<unsigned int, std::vector<unsigned int>> column_edges;
    /** Where on this edge: 0 on the wall of the first part; by vertex. */
    std::vector<unsigned int> level;

  private:
    const MeshDescription<3>                   &mesh;
    const std::set<dealii::types::material_id> &layer_ids;
    const std::string                          &where;
    std::vector<unsigned int> layer_of; ///< of each cell, or none

    [[noreturn]] void
    fail(const std::string &found, const std::string &advice) const;
    bool
    in_layer(const unsigned int cell) const;
    void
    find_neighbours();
    void
    find_components();
    void
    find_columns();
  };
} // namespace alveolus

#endif
