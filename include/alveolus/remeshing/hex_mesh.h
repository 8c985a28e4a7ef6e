// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_hex_mesh_h
#define alveolus_remeshing_hex_mesh_h

#include <alveolus/mesh/mesh_description.h>
#include <alveolus/remeshing/surface_mesh.h>
#include <alveolus/remeshing/tetrahedra.h>

namespace alveolus
{
  /** A mesh of hexahedra whose nodes know where they may move. */
  struct HexMesh
  {
    /** A point of a patch, or of glued patches with the nodes between them. */
    struct Slider
    {
      SurfaceMesh::Vertex vertex; ///< where the slider is now
      /** Nodes at (1 - s) x_first + s x_second. */
      struct Node
      {
        unsigned int node;   ///< number in the mesh
        unsigned int first;  ///< part
        unsigned int second; ///< part
        double       s;      ///< from 0 to 1
      };
      /** That move with it: one, or those through a layer. */
      std::vector<Node> nodes;

      /** Place of a node when the slider is @p at another vertex [mm]. */
      dealii::Point<3>
      place(const Node &node, const SurfaceMesh::Vertex &at) const
      {
        return Point(at.x[node.first] +
                     node.s * (at.x[node.second] - at.x[node.first]));
      }

    private:
      using Point = dealii::Point<3>;
    };

    MeshDescription<3>  description; ///< cells and names
    std::vector<bool>   is_inside;   ///< nodes that may move anywhere
    std::vector<Slider> sliders;     ///< nodes that stay on their patches
  };

  /** The tetrahedra of a component of the body. */
  struct FilledComponent
  {
    Tetrahedra mesh; ///< vertices, first those of the surface
    /** Vertices of the surface mesh that its first vertices are. */
    std::vector<unsigned int> surface_vertices;
  };

  /**
   * Divide each tetrahedron into four hexahedra by the middles of edges, faces
   * and cells, and each triangle between glued patches into three columns of
   * hexahedra. Middles on curves and patches are on these.
   * @param surface   triangles, remeshed
   * @param filled    tetrahedra of each component
   * @param old       the mesh whose names are taken over
   */
  HexMesh
  divide_into_hexahedra(const SurfaceMesh                  &surface,
                        const std::vector<FilledComponent> &filled,
                        const MeshDescription<3>           &old);
} // namespace alveolus

#endif
