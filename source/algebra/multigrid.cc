// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/multigrid.h>

#include <deal.II/lac/solver_cg.h>
#include <deal.II/lac/solver_control.h>
#include <deal.II/lac/trilinos_solver.h>

#include <Teuchos_ParameterList.hpp>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** What making a hierarchy costs, in iterations: when an old one has cost
     * as much more, a new one is made. */
    constexpr double setup_cost = 12.;

    /** Relative residual that Newton's method is content with. */
    constexpr double good_enough = 1e-6;
  } // namespace



  template <int dim>
  Multigrid<dim>::Multigrid(const DoFHandler<dim> &dof_handler,
                            const bool             symmetric)
    : symmetric(symmetric)
    , owned(dof_handler.locally_owned_dofs())
  {
    const auto                          &fe = dof_handler.get_fe();
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    std::vector<bool>                    found(owned.n_elements(), false);
    for (const auto &cell : dof_handler.active_cell_iterators())
      if (!cell->is_artificial())
        {
          cell->get_dof_indices(dofs);
          for (unsigned int k = 0; k < dofs.size() / dim; ++k)
            {
              std::array<types::global_dof_index, dim> node;
              for (unsigned int c = 0; c < dim; ++c)
                node[c] = dofs[fe.component_to_system_index(c, k)];
              if (!owned.is_element(node[0]) ||
                  found[owned.index_within_set(node[0])])
                continue;
              found[owned.index_within_set(node[0])] = true;
              nodes.push_back(node);
            }
        }
    places.resize(nodes.size());
  }



  template <int dim>
  void
  Multigrid<dim>::set_positions(const NodalVector &positions)
  {
    Tensor<1, dim> middle;
    for (unsigned int n = 0; n < nodes.size(); ++n)
      for (unsigned int c = 0; c < dim; ++c)
        {
          places[n][c] = positions(nodes[n][c]);
          middle[c] += places[n][c];
        }
    const MPI_Comm communicator = positions.get_mpi_communicator();
    middle                      = Utilities::MPI::sum(middle, communicator) /
             Utilities::MPI::sum(1. * nodes.size(), communicator);
    for (auto &x : places)
      x -= middle;
    renew = true;
  }



  template <int dim>
  void
  Multigrid<dim>::rigid_motions(Epetra_MultiVector &modes) const
  {
    modes.PutScalar(0.);
    for (unsigned int n = 0; n < nodes.size(); ++n)
      {
        const Tensor<1, dim> &x = places[n];
        for (unsigned int c = 0; c < dim; ++c)
          {
            const auto row      = owned.index_within_set(nodes[n][c]);
            modes[c][row]       = 1.;
            unsigned int column = dim;
            for (unsigned int a = 0; a < dim; ++a)
              for (unsigned int b = 0; b < a; ++b, ++column)
                if (c == a)
                  modes[column][row] = x[b];
                else if (c == b)
                  modes[column][row] = -x[a];
          }
      }
  }



  template <int dim>
  void
  Multigrid<dim>::make_hierarchy(const TrilinosWrappers::SparseMatrix &matrix)
  {
    TrilinosWrappers::PreconditionAMG::AdditionalData data;
    data.elliptic        = true;
    data.smoother_sweeps = 2;
    // Measured on a stiff block on a soft layer (doc/three-dimensions.md): with
    // these, iterations depend neither on the contrast nor much on the mesh.
    data.aggregation_threshold = 0.;
    data.smoother_type         = "symmetric Gauss-Seidel";
    Teuchos::ParameterList              parameters;
    std::unique_ptr<Epetra_MultiVector> unused;
    data.set_parameters(parameters, unused, matrix);
    constexpr int      n_modes = dim * (dim + 1) / 2;
    Epetra_MultiVector modes(matrix.trilinos_matrix().RowMap(), n_modes);
    rigid_motions(modes);
    parameters.set("PDE equations", dim);
    parameters.set("null space: type", "pre-computed");
    parameters.set("null space: dimension", n_modes);
    parameters.set("null space: vectors", modes.Values());
    hierarchy = std::make_unique<TrilinosWrappers::PreconditionAMG>();
    hierarchy->initialize(matrix, parameters);
    ++n_setups;
  }



  template <int dim>
  bool
  Multigrid<dim>::iterate(const TrilinosWrappers::SparseMatrix &matrix,
                          TrilinosWrappers::MPI::Vector        &x,
                          const TrilinosWrappers::MPI::Vector  &b,
                          const double                          tolerance)
  {
    const double  norm = b.l2_norm();
    SolverControl control(max_iterations, tolerance * norm);
    x = 0.;
    try
      {
        // deal.II's CG, since that of AztecOO gives up where rounding does not
        // let the residual fall any further.
        if (symmetric)
          SolverCG<TrilinosWrappers::MPI::Vector>(control).solve(matrix,
                                                                 x,
                                                                 b,
                                                                 *hierarchy);
        else
          TrilinosWrappers::SolverGMRES(
            control, TrilinosWrappers::SolverGMRES::AdditionalData(false, 100))
            .solve(matrix, x, b, *hierarchy);
      }
    catch (const ExceptionBase &)
      {
        // Among them: no convergence, an indefinite matrix
        return false;
      }
    iterations = control.last_step();
    // The residual that CG updates goes on falling below what rounding leaves.
    TrilinosWrappers::MPI::Vector left(b);
    residual = matrix.residual(left, x, b) / norm;
    return residual < std::max(10. * tolerance, good_enough);
  }



  template <int dim>
  bool
  Multigrid<dim>::solve(const TrilinosWrappers::SparseMatrix &matrix,
                        TrilinosWrappers::MPI::Vector        &x,
                        const TrilinosWrappers::MPI::Vector  &b,
                        const double                          tolerance)
  {
    bool fresh = renew || !hierarchy;
    try
      {
        if (fresh)
          make_hierarchy(matrix);
        if (!iterate(matrix, x, b, tolerance))
          {
            hierarchy.reset();
            if (fresh)
              return false;
            fresh = true;
            make_hierarchy(matrix);
            if (!iterate(matrix, x, b, tolerance))
              {
                hierarchy.reset();
                return false;
              }
          }
      }
    catch (const ExceptionBase &)
      {
        hierarchy.reset();
        return false;
      }
    renew = false;
    const double magnitudes =
      std::max(1., -std::log10(std::max(residual, 1e-16)));
    if (fresh)
      {
        per_magnitude = iterations / magnitudes;
        excess        = 0.;
      }
    else
      {
        excess += iterations - per_magnitude * magnitudes;
        renew = excess > setup_cost;
      }
    return true;
  }

  template class Multigrid<2>;
  template class Multigrid<3>;
} // namespace alveolus
