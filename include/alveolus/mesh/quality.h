// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_quality_h
#define alveolus_mesh_quality_h

#include <alveolus/mesh/configuration.h>

#include <deal.II/lac/vector.h>

#include <set>
#include <string>

namespace alveolus
{
  /** Extremes of the mesh quality over all processes. */
  template <int dim>
  struct QualitySummary
  {
    double             smallest_scaled_jacobian = 0.; ///< of all corners
    dealii::Point<dim> where; ///< centre of that cell [mm]
    /** Corners with scaled Jacobian <= 0. */
    unsigned int n_inverted_corners = 0;
    /** Smallest det(dx/dxi) at the quadrature points, relative to cell means.
     */
    double             smallest_point_jacobian = 0.;
    dealii::Point<dim> where_point; ///< of that [mm]
  };

  /**
   * Scaled Jacobian at a vertex of a cell with straight edges: det(e_1..e_dim)/
   * prod|e_i| with the edge vectors e_i that leave it (Knupp 2000); -1 if an
   * edge has no length.
   * @param vertices positions of the vertices in deal.II's order; more may
   *        follow
   */
  template <int dim>
  double
  scaled_jacobian(const std::vector<dealii::Point<dim>> &vertices,
                  const unsigned int                     vertex);

  /**
   * Scaled Jacobian of the vertices of each active cell for the mesh at
   * @p positions: at a vertex det(e_1..e_dim)/prod|e_i| with the edge vectors
   * e_i that leave it, of a cell the smallest over its vertices (Knupp 2000); a
   * square has 1, an inverted corner is negative. Straight edges between the
   * vertices: for degree 2 the quadrature points judge the curved cell.
   * @param regions only cells with these material ids count in the summary
   *        (empty: all)
   * @param per_cell if not null: filled by active cell index (owned cells)
   * Collective. Uses Jacobians only, so inverted cells are allowed.
   */
  template <int dim>
  QualitySummary<dim>
  mesh_quality(const Configuration<dim>                   &configuration,
               const NodalVector                          &positions,
               const std::set<dealii::types::material_id> &regions  = {},
               dealii::Vector<float>                      *per_cell = nullptr);
} // namespace alveolus

#endif
