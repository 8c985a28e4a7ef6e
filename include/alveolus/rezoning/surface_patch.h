// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_rezoning_surface_patch_h
#define alveolus_rezoning_surface_patch_h

#include <alveolus/algebra/umfpack.h>
#include <alveolus/mesh/nodes.h>

#include <memory>
#include <set>

namespace alveolus
{
  /**
   * The nodes of a named surface of a body, with the quadrilaterals between
   * them, on every process: a piece of the boundary, or the interface of two
   * regions "a|b". Faces of degree 2 count as four quadrilaterals each.
   */
  class SurfacePatch
  {
  public:
    /** Position of a node [mm]. */
    using Place = dealii::Point<3>;

    /**
     * Find the nodes of the surface @p name and hold those on its rim and those
     * in @p taken; the others are free (collective).
     * @param positions of the nodes now [mm]: the mesh whose shapes are kept
     * @throws InputError if there is no such surface
     */
    SurfacePatch(const Nodes<3>         &nodes,
                 const NodalVector      &positions,
                 const std::set<NodeId> &taken,
                 const std::string      &name,
                 const std::string      &where);

    /** Once, before harmonic(), on the process that calls it. */
    void
    factorise();

    /**
     * Component @p c of the positions @p x of all nodes with the displacement
     * from the initial ones that is harmonic between the held ones: sum over
     * the neighbours j of w_ij (d_j
     * - d_i) = 0, w the stiffness of linear elements on the triangles of a node
     * with its neighbours in each quadrilateral, as in GiulianiRule. So
     * translations are followed exactly, on planes all affine maps.
     * @param held positions of which those of held nodes are used [mm]
     */
    void
    harmonic(const std::vector<Place> &held,
             const unsigned int        c,
             std::vector<Place>       &x) const;

    /**
     * Move the free ones among the nodes from @p begin to before @p end of
     * @p x onto the surface through @p surface: the place of each is written in
     * the frame of the nearest node of the surface, where the latter is h(t) =
     * g t + t K t / 2 over the tangent plane, fitted through the nodes of two
     * rings of quadrilaterals around. On planes exact, otherwise with an error
     * of third order in the distance of nodes, which vanishes with the way of a
     * node along the surface.
     */
    void
    project(const std::vector<Place> &surface,
            const unsigned int        begin,
            const unsigned int        end,
            std::vector<Place>       &x) const;

    std::vector<NodeId> nodes;   ///< ascending
    std::vector<bool>   is_free; ///< of each node

  private:
    /** Surface near a node: x = origin + t_1 e_1 + t_2 e_2 + h(t) n. */
    struct Frame
    {
      Place                               origin;
      std::array<dealii::Tensor<1, 3>, 2> tangents;
      dealii::Tensor<1, 3>                normal;
      std::array<double, 5>               h; ///< of t1, t2, t1^2/2, t1 t2, ..
    };

    void
    find_nodes(const Nodes<3>    &mesh_nodes,
               const std::string &name,
               const std::string &where);
    Frame
    fit(const std::vector<Place> &x, const unsigned int i) const;

    std::vector<std::array<unsigned int, 4>> quads; ///< lexicographic
    std::vector<std::vector<unsigned int>>   ring;  ///< nodes in common quads
    /** Quadrilaterals at each node, each with the place of the node in it. */
    std::vector<std::vector<std::pair<unsigned int, unsigned int>>> corners;
    std::vector<Place>                                              initial;
    /** Of its own, since the factors refer to it and patches are moved. */
    std::unique_ptr<CsrMatrix> matrix;
    std::unique_ptr<Umfpack>   factors;
  };
} // namespace alveolus

#endif
