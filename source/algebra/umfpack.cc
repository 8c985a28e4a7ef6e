// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/umfpack.h>
#include <alveolus/base/errors.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <umfpack.h>

namespace alveolus
{
  using namespace dealii;

  static_assert(sizeof(SuiteSparse_long) == sizeof(long),
                "UMFPACK's long integers must be the compiler's");

  Umfpack::~Umfpack()
  {
    if (numeric != nullptr)
      umfpack_dl_free_numeric(&numeric);
    if (symbolic != nullptr)
      umfpack_dl_free_symbolic(&symbolic);
  }



  void
  Umfpack::analyse(const SparseMatrix<double> &matrix)
  {
    pattern              = &matrix.get_sparsity_pattern();
    const std::size_t n  = matrix.m();
    const std::size_t nz = matrix.n_nonzero_elements();
    row_begin.assign(1, 0);
    columns.clear();
    source.clear();
    columns.reserve(nz);
    source.reserve(nz);
    values.resize(nz);

    // deal.II stores the diagonal first in each row, UMFPACK wants ascending
    // columns; remember where each value comes from.
    std::size_t                               position = 0;
    std::vector<std::pair<long, std::size_t>> row;
    for (std::size_t i = 0; i < n; ++i)
      {
        row.clear();
        for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
          row.emplace_back(static_cast<long>(entry->column()), position++);
        std::sort(row.begin(), row.end());
        for (const auto &entry : row)
          {
            columns.push_back(entry.first);
            source.push_back(entry.second);
          }
        row_begin.push_back(static_cast<long>(columns.size()));
      }

    if (symbolic != nullptr)
      umfpack_dl_free_symbolic(&symbolic);
    const int status = umfpack_dl_symbolic(static_cast<long>(n),
                                           static_cast<long>(n),
                                           row_begin.data(),
                                           columns.data(),
                                           nullptr,
                                           &symbolic,
                                           nullptr,
                                           nullptr);
    if (status != UMFPACK_OK)
      throw RunError("UMFPACK",
                     "symbolic analysis failed with status " +
                       std::to_string(status),
                     "out of memory? try `Solver / Linear solver = MUMPS`");
  }



  void
  Umfpack::factorize(const SparseMatrix<double> &matrix)
  {
    if (pattern != &matrix.get_sparsity_pattern())
      analyse(matrix);
    std::vector<double> unsorted(values.size());
    std::size_t         position = 0;
    for (std::size_t i = 0; i < matrix.m(); ++i)
      for (auto entry = matrix.begin(i); entry != matrix.end(i); ++entry)
        unsorted[position++] = entry->value();
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = unsorted[source[k]];

    if (numeric != nullptr)
      umfpack_dl_free_numeric(&numeric);
    std::array<double, UMFPACK_INFO> info{};

    const int status            = umfpack_dl_numeric(row_begin.data(),
                                          columns.data(),
                                          values.data(),
                                          symbolic,
                                          &numeric,
                                          nullptr,
                                          info.data());
    smallest_over_largest_pivot = info[UMFPACK_RCOND];
    if (status != UMFPACK_OK)
      throw RunError("UMFPACK",
                     status == UMFPACK_WARNING_singular_matrix
                       ? "the matrix is singular"
                       : "factorisation failed with status " +
                           std::to_string(status),
                     "check that the boundary conditions hold every body");
  }



  void
  Umfpack::solve(Vector<double> &x, const Vector<double> &b) const
  {
    // Our rows are UMFPACK's columns, so the transposed system is ours.
    umfpack_dl_solve(UMFPACK_At,
                     row_begin.data(),
                     columns.data(),
                     values.data(),
                     x.begin(),
                     b.begin(),
                     numeric,
                     nullptr,
                     nullptr);
  }
} // namespace alveolus
