// SPDX-License-Identifier: LGPL-2.1-or-later
// Cook's membrane in plane strain, neo-Hookean and Lagrangian, written for this
// one problem in the manner of deal.II's tutorials: what a user would otherwise
// write, and what minimal_elastic.prm is measured against (doc/benchmarks.md).
//
//   minimal_elastic CELLS_PER_SIDE STEPS
//
// prints one line of JSON: tip displacement, iterations, seconds, memory.
#include <deal.II/base/multithread_info.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/base/timer.h>
#include <deal.II/base/utilities.h>
#include <deal.II/dofs/dof_handler.h>
#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/fe/fe_values.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/affine_constraints.h>
#include <deal.II/lac/dynamic_sparsity_pattern.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/numerics/vector_tools.h>
#include <deal.II/physics/elasticity/standard_tensors.h>

#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <iostream>

using namespace dealii;

namespace
{
  constexpr unsigned int dim = 2;

  class Membrane
  {
  public:
    explicit Membrane(const unsigned int n_cells_per_side);

    /** Solve all load steps and print the result. */
    void
    run(const unsigned int n_steps);

  private:
    void
    assemble(const Vector<double> &u, const double load);
    void
    assemble_load();

    // The material: (mu/2) (J^{-2/3} tr b - 3) + (kappa/4) (J^2 - 2 ln J - 1)
    const double mu    = 0.4225;
    const double kappa = 2. * mu * (1. + 0.3) / (3. * (1. - 2. * 0.3));

    Triangulation<dim>        triangulation;
    FESystem<dim>             fe;
    DoFHandler<dim>           dof_handler;
    AffineConstraints<double> constraints;
    SparsityPattern           pattern;
    SparseMatrix<double>      matrix;
    Vector<double>            residual;
    Vector<double>            unit_load;
    double                    force_scale = 0.; // sum of |cell forces|
    TimerOutput               timer;
  };



  Membrane::Membrane(const unsigned int n)
    : fe(FE_Q<dim>(1), dim)
    , dof_handler(triangulation)
    , timer(std::cout, TimerOutput::never, TimerOutput::cpu_times)
  {
    TimerOutput::Scope scope(timer, "setup");
    GridGenerator::subdivided_hyper_rectangle(
      triangulation, {n, n}, Point<dim>(0., 0.), Point<dim>(48., 44.), true);
    GridTools::transform(
      [](const Point<dim> &p) {
        return Point<dim>(p[0], p[1] + p[0] * (44. - 28. * p[1] / 44.) / 48.);
      },
      triangulation);

    dof_handler.distribute_dofs(fe);
    VectorTools::interpolate_boundary_values(dof_handler,
                                             0,
                                             Functions::ZeroFunction<dim>(dim),
                                             constraints);
    constraints.close();
    DynamicSparsityPattern entries(dof_handler.n_dofs());
    DoFTools::make_sparsity_pattern(dof_handler, entries, constraints, false);
    pattern.copy_from(entries);
    matrix.reinit(pattern);
    residual.reinit(dof_handler.n_dofs());
    unit_load.reinit(dof_handler.n_dofs());
    assemble_load();
  }



  void
  Membrane::assemble_load()
  {
    FEFaceValues<dim>                    fe_values(fe,
                                QGauss<dim - 1>(2),
                                update_values | update_JxW_values);
    std::vector<types::global_dof_index> dofs(fe.n_dofs_per_cell());
    for (const auto &cell : dof_handler.active_cell_iterators())
      for (const auto &face : cell->face_iterators())
        if (face->at_boundary() && face->boundary_id() == 1)
          {
            fe_values.reinit(cell, face);
            cell->get_dof_indices(dofs);
            for (unsigned int i = 0; i < dofs.size(); ++i)
              if (fe.system_to_component_index(i).first == 1)
                for (unsigned int q = 0; q < 2; ++q)
                  unit_load[dofs[i]] +=
                    fe_values.shape_value(i, q) * fe_values.JxW(q) / 16.;
          }
  }



  void
  Membrane::assemble(const Vector<double> &u, const double load)
  {
    TimerOutput::Scope               scope(timer, "assembly");
    const FEValuesExtractors::Vector displacement(0);
    FEValues<dim>                    fe_values(fe,
                            QGauss<dim>(2),
                            update_gradients | update_JxW_values);
    const unsigned int               n_dofs   = fe.n_dofs_per_cell();
    const unsigned int               n_points = fe_values.n_quadrature_points;

    FullMatrix<double>                   cell_matrix(n_dofs, n_dofs);
    Vector<double>                       cell_forces(n_dofs);
    std::vector<types::global_dof_index> dofs(n_dofs);
    std::vector<Tensor<2, dim>>          grad_u(n_points);
    std::vector<Tensor<2, dim>>          gradients(n_dofs);
    std::vector<SymmetricTensor<2, dim>> strains(n_dofs);
    using Standard = Physics::Elasticity::StandardTensors<dim>;

    matrix      = 0.;
    residual    = 0.;
    force_scale = 0.;
    for (const auto &cell : dof_handler.active_cell_iterators())
      {
        fe_values.reinit(cell);
        fe_values[displacement].get_function_gradients(u, grad_u);
        cell_matrix = 0.;
        cell_forces = 0.;
        for (unsigned int q = 0; q < n_points; ++q)
          {
            const Tensor<2, dim> F = grad_u[q] + Tensor<2, dim>(Standard::I);
            const Tensor<2, dim> F_inverse  = invert(F);
            const double         J          = determinant(F);
            const SymmetricTensor<2, dim> b = symmetrize(F * transpose(F));

            // The trace is that of three dimensions: b_33 = 1
            const double                  mu_bar = mu / std::cbrt(J * J);
            const double                  tr_b   = trace(b) + 1.;
            const SymmetricTensor<2, dim> tau_iso =
              mu_bar * (b - tr_b / 3. * Standard::I);
            const SymmetricTensor<2, dim> tau =
              tau_iso + kappa / 2. * (J * J - 1.) * Standard::I;
            const SymmetricTensor<4, dim> Jc =
              (kappa * J * J - 2. / 9. * mu_bar * tr_b) * Standard::IxI +
              (2. / 3. * mu_bar * tr_b - kappa * (J * J - 1.)) * Standard::S -
              2. / 3. *
                (outer_product(tau_iso, Standard::I) +
                 outer_product(Standard::I, tau_iso));

            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                gradients[i] =
                  fe_values[displacement].gradient(i, q) * F_inverse;
                strains[i] = symmetrize(gradients[i]);
              }
            const double JxW = fe_values.JxW(q);
            for (unsigned int i = 0; i < n_dofs; ++i)
              {
                const unsigned int component =
                  fe.system_to_component_index(i).first;
                const SymmetricTensor<2, dim> Jc_strain = Jc * strains[i];
                const Tensor<1, dim> tau_grad = tau * gradients[i][component];
                cell_forces[i] += tau * strains[i] * JxW;
                for (unsigned int j = 0; j <= i; ++j)
                  {
                    double entry = Jc_strain * strains[j];
                    if (fe.system_to_component_index(j).first == component)
                      entry += tau_grad * gradients[j][component];
                    cell_matrix(i, j) += entry * JxW;
                  }
              }
          }
        for (unsigned int i = 0; i < n_dofs; ++i)
          {
            force_scale += std::abs(cell_forces[i]);
            for (unsigned int j = i + 1; j < n_dofs; ++j)
              cell_matrix(i, j) = cell_matrix(j, i);
          }
        cell->get_dof_indices(dofs);
        constraints.distribute_local_to_global(
          cell_matrix, cell_forces, dofs, matrix, residual);
      }
    residual.add(-load, unit_load);
    constraints.set_zero(residual);
  }



  void
  Membrane::run(const unsigned int n_steps)
  {
    Vector<double> u(dof_handler.n_dofs()), increment(u), correction(u),
      trial(u);
    unsigned int n_iterations = 0;
    for (unsigned int step = 1; step <= n_steps; ++step)
      {
        // The first guess is the increment of the last step
        for (unsigned int iteration = 0;; ++iteration)
          {
            trial = u;
            trial += increment;
            assemble(trial, double(step) / n_steps);
            const double norm = residual.l1_norm();
            if ((step > 1 || iteration > 0) &&
                (norm <= 1e-9 * force_scale || norm <= 1e-10))
              break;
            AssertThrow(iteration < 15, ExcMessage("no convergence"));
            TimerOutput::Scope  scope(timer, "linear solver");
            SparseDirectUMFPACK direct;
            direct.factorize(matrix);
            direct.vmult(correction, residual);
            constraints.set_zero(correction);
            increment -= correction;
            ++n_iterations;
          }
        u += increment;
      }

    const Point<dim> corner(48., 60.);
    double           tip[dim] = {};
    for (const auto &cell : dof_handler.active_cell_iterators())
      for (const unsigned int v : cell->vertex_indices())
        if (cell->vertex(v).distance(corner) < 1e-9)
          for (unsigned int c = 0; c < dim; ++c)
            tip[c] = u[cell->vertex_dof_index(v, c)];

    Utilities::System::MemoryStats memory;
    Utilities::System::get_memory_stats(memory);
    auto seconds = timer.get_summary_data(TimerOutput::total_cpu_time);
    std::cout << std::setprecision(14)
              << "{\"cells\": " << triangulation.n_active_cells()
              << ", \"unknowns\": " << dof_handler.n_dofs()
              << ", \"tip x [mm]\": " << tip[0]
              << ", \"tip y [mm]\": " << tip[1]
              << ", \"Newton iterations\": " << n_iterations
              << ", \"setup\": " << seconds["setup"]
              << ", \"assembly\": " << seconds["assembly"]
              << ", \"linear solver\": " << seconds["linear solver"]
              << ", \"peak memory [kB]\": " << memory.VmHWM << "}\n";
  }
} // namespace



int
main(int argc, char **argv)
{
  if (argc != 3 || std::atoi(argv[1]) < 1 || std::atoi(argv[2]) < 1)
    {
      std::cerr << "usage: minimal_elastic CELLS_PER_SIDE STEPS\n";
      return 2;
    }
  MultithreadInfo::set_thread_limit(1);
  Membrane membrane(std::atoi(argv[1]));
  membrane.run(std::atoi(argv[2]));
}
