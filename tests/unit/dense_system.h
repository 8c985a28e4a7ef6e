// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_dense_system_h
#define alveolus_tests_unit_dense_system_h

// What conditions add to a matrix, for comparison with differences of forces.
#include <alveolus/algebra/linear_system.h>

#include <deal.II/lac/full_matrix.h>

namespace alveolus::bench
{
  using namespace dealii;

  /** A matrix of all entries, no constraints, no solver. */
  class DenseSystem : public LinearSystem
  {
  public:
    explicit DenseSystem(const unsigned int n)
      : matrix(n, n)
    {}
    void
    clear() override
    {
      matrix = 0.;
    }
    void
    add(const FullMatrix<double>                   &cell_matrix,
        const std::vector<types::global_dof_index> &dofs) override
    {
      for (unsigned int i = 0; i < dofs.size(); ++i)
        for (unsigned int j = 0; j < dofs.size(); ++j)
          matrix(dofs[i], dofs[j]) += cell_matrix(i, j);
    }
    void
    compress() override
    {}
    void
    solve(NodalVector &, const NodalVector &) override
    {}
    std::string
    name() const override
    {
      return "dense";
    }

    FullMatrix<double> matrix;
  };
} // namespace alveolus::bench

#endif
