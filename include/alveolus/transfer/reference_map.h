// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_reference_map_h
#define alveolus_transfer_reference_map_h

#include <alveolus/transfer/cell_nodes.h>
#include <alveolus/transfer/reference_outline.h>

#include <deal.II/base/quadrature_lib.h>

#include <map>
#include <string>
#include <vector>

namespace alveolus
{
  /** How a region takes its deformation from the reference map. */
  struct ReferenceMapRegion
  {
    /** False: the isochoric part only; the trace is the history's own. */
    bool with_volume = true;
    /** The volume ratio of FE_DGP(degree-1) on each cell instead of det F. */
    bool mean_dilatation = true;
  };

  /** What became of a reference map on a mesh (over all processes). */
  struct ReferenceMapReport
  {
    /** Smallest det(dX/dx) at points and corners, relative to cell means. */
    double smallest_jacobian = 1.;
    /** Boundary nodes put back onto the undeformed outline. */
    unsigned int n_projected = 0;
    /** The farthest of them [mm], also in edge lengths there [-]. */
    double largest_distance          = 0.;
    double largest_relative_distance = 0.; ///< the same in edge lengths

    /** Why the map cannot be taken; empty if it can. */
    std::string
    objection() const;
  };

  /**
   * The deformation of isotropic elastic bodies from the nodal field X(x) =
   * x - u(x), the place where the material at x was when the body was not
   * deformed (theory, section 6): F = (dX/dx)^{-1} and the Hencky strain h =
   * (1/2) ln(F F^T), instead of a strain transferred as history. The body
   * remembers its shape at rest: unloaded on any mesh, x = X at all nodes is a
   * solution without stress.
   *
   * With mean dilatation the volume ratio is J = P(det F) with the L2
   * projection P on FE_DGP(degree-1) of each undeformed cell: for degree 1 the
   * ratio of the volumes of the cell, as the increments of CellKernel add up
   * to.
   */
  template <int dim>
  class ReferenceMap
  {
  public:
    /**
     * @param configuration must outlive this object, as must @p store
     * @param regions by region index of @p store
     * @param field   name of the strain in their records
     */
    ReferenceMap(const Configuration<dim> &configuration,
                 const HistoryStore<dim>  &store,
                 const std::map<unsigned int, ReferenceMapRegion> &regions,
                 const std::string &field = "elastic strain");

    /**
     * Put X of the nodes on the outlines of the regions back onto the
     * undeformed outline by changing @p u, and judge the map on the mesh at
     * positions @p x (ghosted nodal vectors; collective).
     */
    ReferenceMapReport
    admit(const ReferenceOutline<dim> &outline,
          const NodalVector           &x,
          NodalVector                 &u) const;

    /**
     * Write the strains of the owned old records of the regions in @p target
     * (with the layout of the constructor's store).
     * @throws RunError where det(dX/dx) is not positive
     */
    void
    apply(const NodalVector &x,
          const NodalVector &u,
          HistoryStore<dim> &target) const;

    /**
     * The integral of det(dX/dx) over each region, its volume at rest
     * [mm^dim], in the order of region_indices() (collective).
     */
    std::vector<double>
    volumes_at_rest(const NodalVector &x, const NodalVector &u) const;

    /** Ascending. */
    std::vector<unsigned int>
    region_indices() const;

  private:
    /** A cell's maps at a point. */
    struct Maps
    {
      dealii::Tensor<2, dim> x, X; ///< dx/dxi, dX/dxi
    };

    void
    gather(const NodalVector                    &x,
           const NodalVector                    &u,
           const unsigned int                    cell,
           typename CellNodes<dim>::NodeTensors &position,
           typename CellNodes<dim>::NodeTensors &reference) const;

    Maps
    maps_at(const unsigned int                          point,
            const typename CellNodes<dim>::NodeTensors &position,
            const typename CellNodes<dim>::NodeTensors &reference) const;

    /** An owned node on the outlines. */
    struct OutlineNode
    {
      unsigned int cell, node; ///< one of its cells, and its number in it
      OutlineKeys  keys;
    };

    const Configuration<dim>                        &configuration;
    const std::map<unsigned int, ReferenceMapRegion> regions;
    const CellNodes<dim>                             cells;
    const dealii::QGauss<dim>                        quadrature;
    std::vector<unsigned int>                        owned;     ///< in regions
    std::vector<unsigned int>                        region_of; ///< of these
    std::map<unsigned int, unsigned int> offset; ///< of the strain, by region
    std::vector<OutlineNode>             outline_nodes;
    /** At the quadrature points, then at the corners. */
    std::vector<typename CellNodes<dim>::NodeTensors> shape_gradients;
    /** FE_DGP(degree-1) at the quadrature points, [function][point]. */
    std::vector<std::vector<double>> polynomials;
  };
} // namespace alveolus

#endif
