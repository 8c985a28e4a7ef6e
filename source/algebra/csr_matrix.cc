// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/csr_matrix.h>
#include <alveolus/base/errors.h>

#include <limits>

namespace alveolus
{
  void
  CsrMatrix::reinit(const dealii::DynamicSparsityPattern &pattern)
  {
    const std::size_t n = pattern.n_rows();
    if (pattern.n_nonzero_elements() + n >
        static_cast<std::size_t>(std::numeric_limits<int>::max()))
      throw RunError("UMFPACK",
                     "the matrix has " +
                       std::to_string(pattern.n_nonzero_elements()) +
                       " entries, more than it can count",
                     "set `Solver / Linear solver = MUMPS`");
    row_begin.assign(1, 0);
    row_begin.reserve(n + 1);
    columns.clear();
    columns.reserve(pattern.n_nonzero_elements() + n);
    for (std::size_t i = 0; i < n; ++i)
      {
        bool diagonal = false;
        for (auto entry = pattern.begin(i); entry != pattern.end(i); ++entry)
          {
            const auto j = entry->column();
            if (j >= i && !diagonal)
              {
                diagonal = true;
                if (j > i)
                  columns.push_back(static_cast<int>(i));
              }
            columns.push_back(static_cast<int>(j));
          }
        if (!diagonal)
          columns.push_back(static_cast<int>(i));
        row_begin.push_back(static_cast<int>(columns.size()));
      }
    columns.shrink_to_fit();
    values.assign(columns.size(), 0.);
  }
} // namespace alveolus
