// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/tensors.h>
#include <alveolus/transfer/reconstruction.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Part of the size of values that is round-off. */
    constexpr double round_off = 2e-15;

    /** Determinant of the normalised least-squares matrix of a line. */
    constexpr double least_determinant = 1e-10;

    constexpr unsigned int most_values = 6;
  } // namespace

  template <int dim>
  void
  gradient_weights(const Point<dim>              &centroid,
                   const std::vector<Point<dim>> &neighbours,
                   std::vector<Tensor<1, dim>>   &weights)
  {
    weights.assign(neighbours.size(), Tensor<1, dim>());
    Tensor<2, dim> matrix;
    for (const auto &x : neighbours)
      {
        const Tensor<1, dim> d = x - centroid;
        matrix += outer_product(d, d) / d.norm_square();
      }
    const double size = trace(matrix) / dim;
    if (!(determinant(matrix) > least_determinant * std::pow(size, dim)))
      return;
    const Tensor<2, dim> inverse = invert(matrix);
    for (unsigned int j = 0; j < neighbours.size(); ++j)
      {
        const Tensor<1, dim> d = neighbours[j] - centroid;
        weights[j]             = inverse * d / d.norm_square();
      }
  }

  CorrectionLimiter::CorrectionLimiter(const HistoryField &field,
                                       const unsigned int  offset,
                                       const unsigned int  dim)
    : scalar(field.shape == HistoryField::Shape::scalar)
    , bounded(!scalar &&
              (std::isfinite(field.lower) || std::isfinite(field.upper)))
    , field_lower(field.lower)
    , field_upper(field.upper)
    , offset(offset)
    , n(n_values(field.shape, dim))
    , dim(dim)
  {}

  std::array<double, 2>
  CorrectionLimiter::eigenvalues(const double *correction,
                                 const double  scale) const
  {
    std::array<double, most_values> t;
    for (unsigned int i = 0; i < n; ++i)
      t[i] = low[i] + (scale == 0. ? 0. : scale * correction[i]);
    const Spectral s = spectral(unpack(t.data(), dim));
    return {{s.values[2], s.values[0]}};
  }

  double
  CorrectionLimiter::product(const double *a, const double *b) const
  {
    double result = 0.;
    for (unsigned int i = 0; i < n; ++i)
      result += (i < 3 ? 1. : 2.) * a[i] * b[i];
    return result;
  }

  double
  CorrectionLimiter::largest(const double *direction) const
  {
    double result = -std::numeric_limits<double>::max();
    for (const double *record : around)
      result = std::max(result, product(record + offset, direction));
    return result;
  }

  void
  CorrectionLimiter::set(const double                      *low_record,
                         const std::vector<const double *> &records)
  {
    low    = low_record + offset;
    around = records;
    if (scalar)
      {
        lower = upper = *low;
        for (const double *record : around)
          {
            lower = std::min(lower, record[offset]);
            upper = std::max(upper, record[offset]);
          }
        tolerance = round_off * std::max(std::abs(lower), std::abs(upper));
        return;
      }
    largest_norm = 0.;
    for (const double *record : around)
      largest_norm =
        std::max(largest_norm, product(record + offset, record + offset));
    largest_norm = std::sqrt(largest_norm);
    tolerance    = round_off * largest_norm;
    if (bounded)
      {
        // A first-order value beyond the bounds comes from old ones there.
        const auto range = eigenvalues(nullptr, 0.);
        lower            = std::min(range[0], field_lower);
        upper            = std::max(range[1], field_upper);
      }
  }

  bool
  CorrectionLimiter::admits(const double      *record,
                            const unsigned int level) const
  {
    const double *value = record + offset;
    if (level > (scalar ? 0 : 1))
      return true;
    if (scalar)
      return *value >= lower - tolerance && *value <= upper + tolerance;

    if (!(std::sqrt(product(value, value)) <= largest_norm + tolerance))
      return false;
    if (bounded)
      {
        const Spectral s = spectral(unpack(value, dim));
        if (!(s.values[2] >= lower - tolerance &&
              s.values[0] <= upper + tolerance))
          return false;
      }
    if (level == 1)
      return true;
    std::array<double, most_values> change;
    for (unsigned int i = 0; i < n; ++i)
      change[i] = value[i] - low[i];
    const double size = std::sqrt(product(change.data(), change.data()));
    return product(value, change.data()) <=
           largest(change.data()) + tolerance * size;
  }

  void
  CorrectionLimiter::factors(const std::vector<const double *> &corrections,
                             const unsigned int                 level,
                             std::vector<double>               &result) const
  {
    result.assign(corrections.size(), 1.);
    const auto quotient = [](const double room, const double wish) {
      return wish > room ? std::max(0., room) / wish : 1.;
    };
    if (scalar)
      {
        double up = 0., down = 0.;
        for (const double *correction : corrections)
          {
            up += std::max(0., correction[offset]);
            down += std::max(0., -correction[offset]);
          }
        for (unsigned int f = 0; f < corrections.size(); ++f)
          if (corrections[f][offset] > 0.)
            result[f] = quotient(upper - *low, up);
          else if (corrections[f][offset] < 0.)
            result[f] = quotient(*low - lower, down);
        return;
      }

    std::vector<double> norms;
    double              sum = 0.;
    for (const double *correction : corrections)
      {
        norms.push_back(
          std::sqrt(product(correction + offset, correction + offset)));
        sum += norms.back();
      }
    for (unsigned int f = 0; f < corrections.size(); ++f)
      {
        const double *own = corrections[f] + offset;
        if (norms[f] == 0.)
          continue;
        // Zalesak's factor for the component in the direction of this
        // correction.
        double up = 0.;
        for (const double *correction : corrections)
          up += std::max(0., product(correction + offset, own));
        result[f] = quotient(largest(own) - product(low, own), up);
        if (level < 2)
          continue;

        // The value is the mean, with weights norm_f / sum, of the values with
        // the correction l_f own sum / norm_f: each of these within the norm.
        // |low + s own / norm| = largest_norm for s =
        const double along = product(low, own) / norms[f];
        const double reach =
          std::max(0., largest_norm * largest_norm - product(low, low));
        const double s = along > 0.
                           ? reach / (along + std::sqrt(along * along + reach))
                           : std::sqrt(along * along + reach) - along;
        result[f]      = std::min(result[f], quotient(s, sum));

        // The same for the eigenvalues: the smallest one is a concave, the
        // largest one a convex function of the factor.
        if (!bounded)
          continue;
        const auto at_0 = eigenvalues(nullptr, 0.);
        const auto at_1 = eigenvalues(own, sum / norms[f]);
        result[f]       = std::min({result[f],
                                    quotient(at_0[0] - lower, at_0[0] - at_1[0]),
                                    quotient(upper - at_0[1], at_1[1] - at_0[1])});
      }
  }

  template void
  gradient_weights(const Point<2> &,
                   const std::vector<Point<2>> &,
                   std::vector<Tensor<1, 2>> &);
  template void
  gradient_weights(const Point<3> &,
                   const std::vector<Point<3>> &,
                   std::vector<Tensor<1, 3>> &);
} // namespace alveolus
