// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_reconstruction_h
#define alveolus_transfer_reconstruction_h

#include <alveolus/base/history_field.h>

#include <deal.II/base/point.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <vector>

namespace alveolus
{
  /**
   * Gradient of means over sub-cells, each located at a centroid, as a weighted
   * sum of differences: grad phi = sum_j a_j (phi_j - phi). The a_j [1/mm] are
   * those of the least-squares fit of a plane through the value itself, with
   * weights 1/distance^2, hence exact for a linear field whatever the
   * arrangement, also at a boundary. Where the neighbours do not span the space
   * (all of them in a line), the gradient is zero: first order there.
   */
  template <int dim>
  void
  gradient_weights(const dealii::Point<dim>              &centroid,
                   const std::vector<dealii::Point<dim>> &neighbours,
                   std::vector<dealii::Tensor<1, dim>>   &weights);

  /**
   * Keeps corrections of a bounded first-order result within bounds: the new
   * mean of a sub-cell is (first-order value) + sum_f l_f (correction f), where
   * the factors l_f in [0,1] are shared with other sub-cells, so that contents
   * stay. One object is for one sub-cell and one field at a time.
   *
   * A scalar stays between the smallest and the largest of the old values
   * around. A tensor T (one factor for all of its components) is judged by
   * invariants, so that a turned scene has the turned result: T : N is at most
   * the largest of the values around for the direction N of its correction, and
   * its norm is at most the largest one; for tensors that are multiples of one
   * tensor that is the scalar criterion. Where the field has bounds, its
   * eigenvalues keep them.
   *
   * Where the corrected value keeps the bounds (e.g. any linear field, at any
   * place between the old centroids), nothing is limited (level 0). Otherwise
   * the factors are those of S. T. Zalesak, J. Comput. Phys. 31 (1979) 335-362
   * (level 1), which are right whatever the other sub-cells choose: for
   * scalars, and for tensors in the direction of each correction. If then a
   * tensor still exceeds the norm, the factors of level 2 are right in that
   * respect.
   */
  class CorrectionLimiter
  {
  public:
    /** @param offset of the field in its record */
    CorrectionLimiter(const HistoryField &field,
                      const unsigned int  offset,
                      const unsigned int  dim);

    /**
     * @param low    first-order record of the sub-cell: a mean of values around
     * @param around old records that bound the new value
     */
    void
    set(const double *low, const std::vector<const double *> &around);

    /**
     * Whether the record @p value, which comes from factors of level @p level,
     * keeps the bounds. Always true for the last level.
     */
    bool
    admits(const double *value, const unsigned int level) const;

    /** Factors of @p corrections (records) for a level of 1 or 2. */
    void
    factors(const std::vector<const double *> &corrections,
            const unsigned int                 level,
            std::vector<double>               &result) const;

  private:
    double
    product(const double *a, const double *b) const;

    /** Largest a : direction of the values a around. */
    double
    largest(const double *direction) const;

    /** Smallest and largest eigenvalue of low + (scale) correction. */
    std::array<double, 2>
    eigenvalues(const double *correction, const double scale) const;

    const bool                  scalar, bounded;
    const double                field_lower, field_upper;
    const unsigned int          offset, n, dim;
    const double               *low = nullptr;
    std::vector<const double *> around;
    double                      lower, upper; ///< of a scalar
    double                      largest_norm; ///< of a tensor
    double                      tolerance;    ///< round-off of the bounds
  };
} // namespace alveolus

#endif
