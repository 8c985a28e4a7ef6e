// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_reference_outline_h
#define alveolus_transfer_reference_outline_h

#include <alveolus/base/block_file.h>
#include <alveolus/geometry/box_tree.h>
#include <alveolus/geometry/cubic_spline.h>
#include <alveolus/mesh/configuration.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/cell_nodes.h>

#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

namespace alveolus
{
  /**
   * Faces of cells on the outlines of regions: at the domain boundary or
   * between two regions. Its key tells to which piece a face belongs: the
   * region and the boundary id, or the two regions. A node has the keys of all
   * its faces, ascending.
   */
  using OutlineKeys = std::vector<std::uint64_t>;

  template <int dim>
  struct OutlineFace
  {
    unsigned int  cell;    ///< active cell index, in one of the regions
    unsigned int  face_no; ///< of that cell
    std::uint64_t key;     ///< the same face has it on every process
  };

  /**
   * The outline faces of @p regions (indices of @p store) of owned and ghost
   * cells. A face between two of the regions comes from both sides.
   */
  template <int dim>
  std::vector<OutlineFace<dim>>
  outline_faces(const Configuration<dim>     &configuration,
                const HistoryStore<dim>      &store,
                const std::set<unsigned int> &regions);

  /** Lexicographic numbers of the nodes of face @p face_no of a cell. */
  template <int dim>
  std::vector<unsigned int>
  outline_nodes(const unsigned int face_no, const unsigned int degree);

  /**
   * The outlines of undeformed regions, kept by every process, whatever becomes
   * of the mesh. In 2D its pieces are cubic splines through the nodes, broken
   * at corners (more than 40 degrees) and where pieces meet; in 3D triangles
   * between the nodes, and segments and points where pieces meet.
   */
  template <int dim>
  class ReferenceOutline
  {
  public:
    /**
     * The outlines as they are now, which is when the body is not deformed
     * (collective).
     */
    ReferenceOutline(const Configuration<dim>     &configuration,
                     const HistoryStore<dim>      &store,
                     const std::set<unsigned int> &regions);

    /** From blocks "reference outline/...". @throws InputError */
    explicit ReferenceOutline(const BlockFile &blocks);

    /** Into blocks of a checkpoint. */
    void
    save(BlockFile &blocks) const;

    /**
     * The nearest point on the piece that a node with @p keys lies on: of
     * pieces that carry all of them, e.g. a corner for a node with two.
     * @param size set to the length of the mesh's edges there [mm]
     */
    dealii::Point<dim>
    nearest(const OutlineKeys        &keys,
            const dealii::Point<dim> &X,
            double                   &size) const;

  private:
    /** One point, a chain of points (2D), two (3D) or three points (3D). */
    struct Piece
    {
      OutlineKeys                     keys;
      std::vector<dealii::Point<dim>> points;
      bool                            closed = false;
    };

    /** Point, segment or triangle of a piece, by which it is found. */
    struct Element
    {
      unsigned int                    piece;
      std::vector<dealii::Point<dim>> points;
      double                          size;
      double begin = 0., end = 0.; ///< parameters of the piece's spline
    };

    /** Elements for one set of keys. */
    struct Index
    {
      std::vector<unsigned int> elements;
      BoxTree<dim>              tree;
    };

    /** Face nodes of all processes. */
    struct Gathered;

    Gathered
    gather(const Configuration<dim>     &configuration,
           const HistoryStore<dim>      &store,
           const std::set<unsigned int> &regions) const;
    void
    add_chains(const Gathered &all);
    void
    add_simplices(const Gathered &all);
    /** Elements and splines of the pieces. */
    void
    prepare();
    const Index &
    index_of(const OutlineKeys &keys) const;

    std::vector<Piece>                       pieces;
    std::vector<Element>                     elements;
    std::map<unsigned int, CubicSpline<dim>> splines; ///< by piece
    mutable std::map<OutlineKeys, Index>     indices; ///< made when asked for
  };
} // namespace alveolus

#endif
