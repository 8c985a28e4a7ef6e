// SPDX-License-Identifier: LGPL-2.1-or-later
// The linear system of one process against deal.II's condensation of the same
// cell matrices, with held and hanging nodes, through either way of adding.
#include <alveolus/algebra/serial_system.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/fe_q.h>
#include <deal.II/fe/fe_system.h>
#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/tria.h>
#include <deal.II/lac/sparse_matrix.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;

TEST(SerialSystem, CondensesAsDealII)
{
  Triangulation<2> triangulation;
  GridGenerator::subdivided_hyper_cube(triangulation, 3);
  triangulation.begin_active()->set_refine_flag();
  triangulation.execute_coarsening_and_refinement();
  const FESystem<2> fe(FE_Q<2>(1), 2);
  DoFHandler<2>     dof_handler(triangulation);
  dof_handler.distribute_dofs(fe);
  AffineConstraints<double> constraints;
  DoFTools::make_hanging_node_constraints(dof_handler, constraints);
  unsigned int n_held = 0;
  for (unsigned int i = 3; i < dof_handler.n_dofs(); i += 7)
    if (!constraints.is_constrained(i))
      {
        constraints.add_line(i);
        ++n_held;
      }
  constraints.close();
  ASSERT_GT(n_held, 2u);
  ASSERT_GT(constraints.n_constraints(), n_held);

  DynamicSparsityPattern entries(dof_handler.n_dofs());
  DoFTools::make_sparsity_pattern(dof_handler, entries, constraints, false);
  SparsityPattern pattern;
  pattern.copy_from(entries);
  SparseMatrix<double> expected(pattern);
  SerialSystem by_slot(entries, constraints, triangulation.n_active_cells());
  SerialSystem plainly(entries, constraints, 0);

  std::mt19937                           generator(3);
  std::uniform_real_distribution<double> random(-1., 1.);
  std::vector<types::global_dof_index>   dofs(fe.n_dofs_per_cell());
  // Twice: the first assembly finds the positions, the second uses them
  for (unsigned int assembly = 0; assembly < 2; ++assembly)
    {
      expected = 0.;
      by_slot.clear();
      plainly.clear();
      unsigned int slot = 0;
      for (const auto &cell : dof_handler.active_cell_iterators())
        {
          FullMatrix<double> matrix(dofs.size(), dofs.size());
          for (unsigned int i = 0; i < dofs.size(); ++i)
            for (unsigned int j = 0; j < dofs.size(); ++j)
              matrix(i, j) = random(generator);
          cell->get_dof_indices(dofs);
          constraints.distribute_local_to_global(matrix, dofs, expected);
          by_slot.add_cell(slot++, matrix, dofs);
          plainly.add(matrix, dofs);
        }
      std::size_t n_entries = 0;
      for (unsigned int i = 0; i < expected.m(); ++i)
        for (auto entry = expected.begin(i); entry != expected.end(i); ++entry)
          {
            ++n_entries;
            for (const auto *system : {&by_slot, &plainly})
              {
                const CsrMatrix  &csr = system->csr();
                const std::size_t at  = csr.position(i, entry->column());
                ASSERT_LT(at, csr.values.size());
                EXPECT_NEAR(csr.values[at], entry->value(), 1e-14);
              }
          }
      EXPECT_EQ(n_entries, by_slot.n_nonzeros());
    }
}

TEST(SerialSystem, ExpectedFactorsAreThoseOfADenseBlock)
{
  // n^2 entries in L and U together; the diagonal of L are ones
  const unsigned int     n = 30;
  DynamicSparsityPattern entries(n, n);
  for (unsigned int i = 0; i < n; ++i)
    for (unsigned int j = 0; j < n; ++j)
      entries.add(i, j);
  AffineConstraints<double> none;
  none.close();
  SerialSystem system(entries, none, 0);
  EXPECT_EQ(system.expected_factor_bytes(), n * n * sizeof(double));
}
