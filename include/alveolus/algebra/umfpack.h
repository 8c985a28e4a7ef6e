// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_umfpack_h
#define alveolus_algebra_umfpack_h

#include <alveolus/algebra/csr_matrix.h>

#include <deal.II/lac/vector.h>

#include <vector>

namespace alveolus
{
  /**
   * UMFPACK through its C interface for a matrix whose sparsity pattern is
   * symmetric, but for rows of held unknowns, and stays:
   * the symbolic analysis is made once and reused by every numerical
   * factorisation, which deal.II's own wrapper repeats each time.
   */
  class Umfpack
  {
  public:
    /**
     * @param refine improve each solution by up to two steps of iterative
     *        refinement, each of which costs another solution. Newton's method
     *        is such an iteration itself and does without.
     */
    explicit Umfpack(const bool refine = true);
    ~Umfpack();
    Umfpack(const Umfpack &) = delete;
    Umfpack &
    operator=(const Umfpack &) = delete;

    /**
     * Factorise @p matrix, which must outlive the solutions with it and, as
     * long as it is the same object, keep its pattern.
     * @throws RunError if it is singular
     */
    void
    factorize(const CsrMatrix &matrix);

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

    /**
     * Bytes the factors of @p matrix are expected to take, without pivoting.
     * Analyses the pattern if that was not done yet.
     */
    std::size_t
    expected_bytes(const CsrMatrix &matrix);

  private:
    double smallest_over_largest_pivot = 1.;

    void
    analyse(const CsrMatrix &matrix);

    std::vector<double> control; ///< in the order of UMFPACK

    const CsrMatrix *factorised = nullptr;
    double           expected   = 0.; ///< entries of both factors
    void            *symbolic   = nullptr;
    void            *numeric    = nullptr;
  };
} // namespace alveolus

#endif
