// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_umfpack_h
#define alveolus_algebra_umfpack_h

#include <deal.II/lac/sparse_matrix.h>
#include <deal.II/lac/vector.h>

#include <vector>

namespace alveolus
{
  /**
   * UMFPACK through its C interface for a deal.II matrix whose sparsity pattern
   * stays: the symbolic analysis is made once and reused by every numerical
   * factorisation, which deal.II's own wrapper repeats each time.
   */
  class Umfpack
  {
  public:
    Umfpack() = default;
    ~Umfpack();
    Umfpack(const Umfpack &) = delete;
    Umfpack &
    operator=(const Umfpack &) = delete;

    /** Factorise @p matrix. @throws RunError if it is singular */
    void
    factorize(const dealii::SparseMatrix<double> &matrix);

    /** x = A^{-1} b with the last factorisation. */
    void
    solve(dealii::Vector<double> &x, const dealii::Vector<double> &b) const;

    /**
     * Smallest over largest pivot of the last factorisation, an estimate of the
     * reciprocal condition number. That of a body which nothing holds is at the
     * level of round-off, though seldom zero.
     */
    double
    pivot_ratio() const
    {
      return smallest_over_largest_pivot;
    }

  private:
    double smallest_over_largest_pivot = 1.;

    void
    analyse(const dealii::SparseMatrix<double> &matrix);

    const dealii::SparsityPattern *pattern  = nullptr;
    void                          *symbolic = nullptr;
    void                          *numeric  = nullptr;
    std::vector<long>              row_begin;
    std::vector<long>              columns;
    std::vector<std::size_t> source; ///< position of each entry in deal.II
    std::vector<double>      values;
  };
} // namespace alveolus

#endif
