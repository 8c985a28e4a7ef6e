// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_named_sizes_h
#define alveolus_io_named_sizes_h

#include <alveolus/mesh/mesh.h>

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /** What a name of a mesh stands for. */
  struct NamedSize
  {
    std::string name; ///< as it stands in the mesh
    std::string kind; ///< region, boundary, curve (2D: inside) or point
    /** Cells, faces or, of a curve, edges; 1 for a point. */
    unsigned int n_members = 0;
    /** Volume, area or length [mm^dim, mm^(dim-1), mm]; 0 for a point. */
    double size = 0.;
  };

  /**
   * All names with their sizes, each kind in alphabetical order (collective;
   * the list is empty except on process 0): regions, boundaries, in 2D the
   * curves that do not lie at the boundary entirely, points.
   */
  template <int dim>
  std::vector<NamedSize>
  named_sizes(const Mesh<dim> &mesh);

  /** A cell in 2D, a face of the boundary in 3D: the corners in order. */
  template <int dim>
  struct MeshPiece
  {
    std::array<dealii::Point<dim>, 4> corners;      ///< positions [mm]
    dealii::types::material_id        material = 0; ///< of the cell
    /** Of the face, in 3D. */
    dealii::types::boundary_id boundary =
      dealii::numbers::internal_face_boundary_id;

    /** For Boost.Serialization. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      for (dealii::Point<dim> &p : corners)
        archive &p;
      archive &material &boundary;
    }
  };

  /** A line with ids in 2D. */
  struct NamedLine
  {
    dealii::Point<2> a; ///< one end [mm]
    dealii::Point<2> b; ///< the other end [mm]
    /** By which curves know it. */
    dealii::types::manifold_id manifold = dealii::numbers::flat_manifold_id;
    /** By which boundaries know it. */
    dealii::types::boundary_id boundary =
      dealii::numbers::internal_face_boundary_id;
    double weight = 1.; ///< 1/2 if seen from both sides

    /** For Boost.Serialization. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &a &b &manifold &boundary &weight;
    }
  };

  /** What all processes together have; on process 0 only. */
  template <int dim>
  struct GatheredPieces
  {
    std::vector<MeshPiece<dim>> pieces; ///< cells (2D), boundary faces (3D)
    /** With ids of curves or boundaries; 2D only. */
    std::vector<NamedLine> lines;
    /** Number of cells and their volume [mm^dim] by material id. */
    std::map<dealii::types::material_id, std::pair<unsigned int, double>> cells;
  };

  /** Pieces, lines and cells of a mesh (collective). */
  template <int dim>
  GatheredPieces<dim>
  gather_pieces(const Mesh<dim> &mesh);

  /** The lines of a name, and whether all of them are at the boundary. */
  std::pair<std::vector<const NamedLine *>, bool>
  lines_of(const std::string       &name,
           const NamedSets<2>      &names,
           const GatheredPieces<2> &mesh);
} // namespace alveolus

#endif
