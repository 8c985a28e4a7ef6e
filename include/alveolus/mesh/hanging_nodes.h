// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_hanging_nodes_h
#define alveolus_mesh_hanging_nodes_h

#include <alveolus/mesh/configuration.h>

#include <deal.II/lac/affine_constraints.h>

namespace alveolus
{
  /**
   * The nodes in the middle of edges and faces of coarser neighbours on a
   * locally refined mesh, which have to stay there: x_hanging = sum w_j x_j
   * over the vertices of that edge or face. Positions, displacements and forces
   * all obey them. A mesh without hanging nodes costs nothing here.
   */
  template <int dim>
  class HangingNodes
  {
  public:
    /**
     * Find them (collective).
     * @throws InputError for hanging nodes on a mesh of degree 2
     */
    explicit HangingNodes(const Configuration<dim> &configuration);

    /** On all processes: there are none. */
    bool
    empty() const
    {
      return none;
    }

    /** One line for each component of each relevant hanging node; closed. */
    const dealii::AffineConstraints<double> &
    constraints() const
    {
      return lines;
    }

    /** Put hanging values of the ghosted nodal vector @p v where they belong
     * (collective). */
    void
    distribute(NodalVector &v) const;

    /**
     * Give the forces @p f on hanging nodes to the nodes they hang on
     * (collective; no ghost state). Sums and moments about straight edges stay.
     */
    void
    condense(NodalVector &f) const;

  private:
    bool                              none;
    dealii::IndexSet                  owned;
    dealii::AffineConstraints<double> lines;
  };
} // namespace alveolus

#endif
