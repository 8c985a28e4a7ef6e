// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_subcells_h
#define alveolus_transfer_subcells_h

#include <alveolus/transfer/cell_nodes.h>

#include <functional>

namespace alveolus
{
  /**
   * Tensor-product sub-cells: each cell is cut, on the unit cell, into
   * (degree+1)^dim boxes whose widths are the weights of the Gauss rule (1/2,
   * 1/2; 5/18, 4/9, 5/18), so that each quadrature point owns one. Sub-cell q
   * belongs to quadrature point q of the tensor product Gauss rule, x fastest;
   * its number is active cell index * n_points + q. On a moved mesh sub-cells
   * are the images of the boxes under the polynomial map of the cell, hence
   * curved for degree 2.
   *
   * Topology (sub-cell faces and their two sides) is found once; geometry comes
   * for any nodal positions. A volume is the integral of the Jacobian
   * determinant and a swept volume that of det[dx/dt, dx/ds] over face and
   * pseudo-time, x(s,t) = (1-t) x_0(s) + t x_1(s): polynomials, hence exact by
   * Gauss quadrature, so that volumes and swept volumes of the same positions
   * agree to round-off (geometric conservation law). Nothing here depends on
   * the number of processes, to the last bit.
   *
   * Where a cell of degree 1 has finer neighbours, each of its sub-cells there
   * has the whole face of one of them: the faces of its 2^(dim-1) sub-cells.
   * Their geometry is that of the finer cell, the same as long as hanging nodes
   * are in the middle of what they hang on.
   */
  template <int dim>
  class SubCells
  {
  public:
    /** No sub-cell. */
    static constexpr unsigned int none = dealii::numbers::invalid_unsigned_int;

    /**
     * A face between two sub-cells of one region, or (second one `none`) at a
     * domain or region boundary.
     */
    struct Face
    {
      /** First and second sub-cell. */
      std::array<unsigned int, 2> sub_cell;
      unsigned int                cell; ///< whose map gives the geometry
      unsigned int                form; ///< which face of the unit sub-cells
      double                      sign; ///< -1: first is on the upper side
    };

    /** A face as seen from one of its sub-cells. */
    struct Incidence
    {
      unsigned int face; ///< index of the face
      unsigned int side; ///< which one of Face::sub_cell is the viewer
    };

    /**
     * @param region region index by active cell index (owned and ghost cells)
     * @throws InputError on a mesh with hanging nodes and degree above 1 (on
     *         all processes)
     * Collective.
     */
    SubCells(const Configuration<dim>                        &configuration,
             const std::function<unsigned int(unsigned int)> &region);

    /** Sub-cells are numbered from 0 to one less than this. */
    unsigned int
    n_sub_cells() const
    {
      return n_cells * n_points;
    }

    /** Active cell indices of the locally owned cells, ascending. */
    const std::vector<unsigned int> &
    owned_cells() const
    {
      return owned;
    }

    /** Active cell indices of owned and ghost cells, ascending. */
    const std::vector<unsigned int> &
    relevant_cells() const
    {
      return relevant;
    }

    /** All faces with at least one owned sub-cell. */
    const std::vector<Face> &
    faces() const
    {
      return all_faces;
    }

    /**
     * The faces_per_sub_cell faces of an owned sub-cell: lower and upper one in
     * each unit direction. On a mesh with hanging nodes 2^(dim-1) places for
     * each of them, of which all are taken where the neighbour is finer and
     * else the first one; the others have Incidence::face `none`.
     */
    const Incidence *
    incidences(const unsigned int sub_cell) const
    {
      return all_incidences.data() + sub_cell * faces_per_sub_cell;
    }

    /**
     * Volumes at positions @p x [mm^dim], by sub-cell number, of owned and (if
     * @p with_ghosts) ghost cells.
     */
    void
    volumes(const NodalVector   &x,
            std::vector<double> &result,
            const bool           with_ghosts = false) const;

    /**
     * Centroids at positions @p x [mm] of owned and ghost sub-cells, and their
     * volumes.
     */
    void
    centroids(const NodalVector               &x,
              std::vector<dealii::Point<dim>> &result,
              std::vector<double>             &volume) const;

    /**
     * Volumes swept by all faces() when the nodes move straight from @p x_0 to
     * @p x_1 [mm^dim]; positive where the first sub-cell grows.
     */
    void
    swept_volumes(const NodalVector   &x_0,
                  const NodalVector   &x_1,
                  std::vector<double> &result) const;

    /**
     * First moments, the integral of x over the (signed) swept volumes
     * [mm^(dim+1)], with the same sign as the swept volumes.
     */
    void
    swept_moments(const NodalVector                   &x_0,
                  const NodalVector                   &x_1,
                  std::vector<dealii::Tensor<1, dim>> &result) const;

    /** Ends of the sub-cells in one unit direction: 0, ..., 1. */
    const std::vector<double> &
    breaks() const
    {
      return breaks_1d;
    }

    const CellNodes<dim> nodes;    ///< shape functions of the cells
    const unsigned int   n_points; ///< sub-cells per cell
    /** Places for faces: 2 dim, with hanging nodes times 2^(dim-1). */
    const unsigned int faces_per_sub_cell;

  private:
    /**
     * Shape functions at quadrature points, one after the other: for each point
     * and each node (volume rules) or each supporting node (face rules) the
     * value and derivatives.
     */
    struct Rule
    {
      unsigned int        n_quadrature = 0; ///< points per sub-cell or face
      std::vector<double> weights;
      std::vector<double> shape;
      std::vector<std::size_t>               shape_begin; ///< by form
      std::vector<std::vector<unsigned int>> support;     ///< by form
    };

    void
    build_volume_rule(const unsigned int n_gauss, Rule &rule) const;
    void
    build_face_rule(const unsigned int n_gauss, Rule &rule) const;
    void
    build_faces(const Configuration<dim>                        &configuration,
                const std::function<unsigned int(unsigned int)> &region);

    unsigned int
    form_index(const unsigned int direction,
               const unsigned int plane,
               const unsigned int tangential) const;
    unsigned int
    point_index(const unsigned int direction,
                const unsigned int layer,
                const unsigned int tangential) const;

    template <typename Integrand>
    void
    integrate_faces(const Rule        &rule,
                    const unsigned int n_time,
                    const NodalVector &x_0,
                    const NodalVector &x_1,
                    Integrand        &&add) const;

    unsigned int              n_cells; ///< active ones
    unsigned int              n_1d;    ///< sub-cells in one direction
    unsigned int              n_tangential;
    std::vector<double>       breaks_1d;
    std::vector<unsigned int> owned;
    std::vector<unsigned int> relevant;
    std::vector<Face>         all_faces;
    std::vector<Incidence>    all_incidences;
    Rule volume_rule, centroid_rule, swept_rule, moment_rule;
  };
} // namespace alveolus

#endif
