// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_csr_matrix_h
#define alveolus_algebra_csr_matrix_h

#include <deal.II/lac/dynamic_sparsity_pattern.h>

#include <algorithm>
#include <vector>

namespace alveolus
{
  /**
   * A square sparse matrix in compressed rows with ascending columns: the form
   * that UMFPACK factorises in place, without a second copy of pattern and
   * values, and whose entries can be added by their position.
   */
  class CsrMatrix
  {
  public:
    /**
     * Take a pattern, add what is missing of the diagonal, set zero values.
     * Indices are short ones: a quarter of the memory of a matrix is saved and
     * some of the factors'. @throws RunError beyond 2^31 entries
     */
    void
    reinit(const dealii::DynamicSparsityPattern &pattern);

    /** Number of rows. */
    std::size_t
    size() const
    {
      return row_begin.empty() ? 0 : row_begin.size() - 1;
    }

    /** Index in values of an entry, or values.size() if there is none. */
    std::size_t
    position(const std::size_t row, const std::size_t column) const
    {
      const auto begin = columns.begin() + row_begin[row];
      const auto end   = columns.begin() + row_begin[row + 1];
      const auto found = std::lower_bound(begin, end, static_cast<int>(column));
      return found != end && *found == static_cast<int>(column)
               ? found - columns.begin()
               : values.size();
    }

    /** Bytes in use. */
    std::size_t
    memory_consumption() const
    {
      return (row_begin.capacity() + columns.capacity()) * sizeof(int) +
             values.capacity() * sizeof(double);
    }

    std::vector<int>    row_begin; ///< of each row, and the end
    std::vector<int>    columns;   ///< column of each entry, ascending in a row
    std::vector<double> values;    ///< value of each entry
  };
} // namespace alveolus

#endif
