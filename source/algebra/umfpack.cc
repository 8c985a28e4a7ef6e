// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/umfpack.h>
#include <alveolus/base/errors.h>

#include <array>
#include <umfpack.h>

namespace alveolus
{
  using namespace dealii;

  Umfpack::Umfpack(const bool refine)
    : control(UMFPACK_CONTROL)
  {
    umfpack_di_defaults(control.data());
    // The pattern is that of a finite element matrix, symmetric with its
    // diagonal. Left to itself, UMFPACK sometimes decides for columns and
    // partial pivoting, which then loses all digits (Cook's membrane of 72 x 72
    // cells: entries of the factors 4e13 times those of the matrix).
    control[UMFPACK_STRATEGY] = UMFPACK_STRATEGY_SYMMETRIC;
    if (!refine)
      control[UMFPACK_IRSTEP] = 0.;
  }



  Umfpack::~Umfpack()
  {
    if (numeric != nullptr)
      umfpack_di_free_numeric(&numeric);
    if (symbolic != nullptr)
      umfpack_di_free_symbolic(&symbolic);
  }



  void
  Umfpack::analyse(const CsrMatrix &matrix)
  {
    factorised = &matrix;
    if (symbolic != nullptr)
      umfpack_di_free_symbolic(&symbolic);
    std::array<double, UMFPACK_INFO> info{};

    const int n      = static_cast<int>(matrix.size());
    const int status = umfpack_di_symbolic(n,
                                           n,
                                           matrix.row_begin.data(),
                                           matrix.columns.data(),
                                           nullptr,
                                           &symbolic,
                                           control.data(),
                                           info.data());
    expected         = info[UMFPACK_SYMMETRIC_LUNZ];
    if (status != UMFPACK_OK)
      throw RunError("UMFPACK",
                     "symbolic analysis failed with status " +
                       std::to_string(status),
                     "out of memory? try `Solver / Linear solver = MUMPS`");
  }



  std::size_t
  Umfpack::expected_bytes(const CsrMatrix &matrix)
  {
    if (factorised != &matrix)
      analyse(matrix);
    // A value each; the row and column numbers are compressed
    return static_cast<std::size_t>(expected * sizeof(double));
  }



  void
  Umfpack::factorize(const CsrMatrix &matrix)
  {
    if (factorised != &matrix)
      analyse(matrix);
    if (numeric != nullptr)
      umfpack_di_free_numeric(&numeric);
    std::array<double, UMFPACK_INFO> info{};

    const int status            = umfpack_di_numeric(matrix.row_begin.data(),
                                          matrix.columns.data(),
                                          matrix.values.data(),
                                          symbolic,
                                          &numeric,
                                          control.data(),
                                          info.data());
    smallest_over_largest_pivot = info[UMFPACK_RCOND];
    if (status != UMFPACK_OK)
      throw RunError("UMFPACK",
                     status == UMFPACK_WARNING_singular_matrix
                       ? "the matrix is singular"
                       : "factorisation failed with status " +
                           std::to_string(status),
                     status == UMFPACK_ERROR_out_of_memory
                       ? "out of memory, or factors beyond the 16 GB that it "
                         "can count: try `Solver / Linear solver = MUMPS`"
                       : "check that the boundary conditions hold every body");
  }



  void
  Umfpack::solve(Vector<double> &x, const Vector<double> &b) const
  {
    // Our rows are UMFPACK's columns, so the transposed system is ours.
    umfpack_di_solve(UMFPACK_At,
                     factorised->row_begin.data(),
                     factorised->columns.data(),
                     factorised->values.data(),
                     x.begin(),
                     b.begin(),
                     numeric,
                     control.data(),
                     nullptr);
  }
} // namespace alveolus
