// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/trace_projection.h>

#include <deal.II/base/quadrature_lib.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  TraceProjection<dim>::TraceProjection(const SubCells<dim> &cells,
                                        const std::string   &field)
    : cells(cells)
    , field(field)
  {
    // Monomials of total degree below the degree of the mesh, centred.
    const unsigned int n = cells.nodes.degree;
    const QGauss<dim>  gauss(n + 1);
    for (unsigned int k = 0; k < (dim == 3 ? n : 1); ++k)
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int i = 0; i < n; ++i)
          if (i + j + k < n)
            {
              polynomials.emplace_back();
              for (const Point<dim> &xi : gauss.get_points())
                polynomials.back().push_back(
                  std::pow(xi[0] - 0.5, i) * std::pow(xi[1] - 0.5, j) *
                  (dim == 3 ? std::pow(xi[dim - 1] - 0.5, k) : 1.));
            }
  }

  template <int dim>
  void
  TraceProjection<dim>::apply(HistoryStore<dim>            &store,
                              const NodalVector            &x,
                              const std::set<unsigned int> &regions) const
  {
    for (const unsigned int r : regions)
      {
        const HistoryLayout &layout = store.layout(r);
        bool                 found  = false;
        for (const HistoryField &f : layout.fields)
          found = found || (f.name == field &&
                            f.shape == HistoryField::Shape::symmetric_tensor);
        if (!found)
          throw RunError("Transfer",
                         "region " + std::to_string(r) +
                           " has no symmetric tensor '" + field + "'",
                         "project only regions whose material carries it");
      }

    std::vector<double> volume;
    cells.volumes(x, volume);
    const unsigned int               n = cells.n_points;
    std::vector<std::vector<double>> basis(polynomials);
    std::vector<double>              trace(n), fitted(n);
    for (const unsigned int c : cells.owned_cells())
      {
        if (regions.count(store.region(c)) == 0)
          continue;
        const unsigned int offset = store.layout(store.region(c)).offset(field);
        const double      *weight = volume.data() + c * n;
        const auto         product = [&](const std::vector<double> &a,
                                 const std::vector<double> &b) {
          double sum = 0.;
          for (unsigned int q = 0; q < n; ++q)
            sum += weight[q] * a[q] * b[q];
          return sum;
        };
        for (unsigned int q = 0; q < n; ++q)
          {
            const double *h = store.old_record(c, q) + offset;
            trace[q]        = h[0] + h[1] + h[2];
          }
        // Gram-Schmidt; the first polynomial is the constant.
        std::fill(fitted.begin(), fitted.end(), 0.);
        for (unsigned int k = 0; k < polynomials.size(); ++k)
          {
            basis[k] = polynomials[k];
            for (unsigned int l = 0; l < k; ++l)
              {
                const double part = product(basis[k], basis[l]);
                for (unsigned int q = 0; q < n; ++q)
                  basis[k][q] -= part * basis[l][q];
              }
            const double norm = std::sqrt(product(basis[k], basis[k]));
            for (unsigned int q = 0; q < n; ++q)
              basis[k][q] /= norm;
            const double part = product(trace, basis[k]);
            for (unsigned int q = 0; q < n; ++q)
              fitted[q] += part * basis[k][q];
          }
        for (unsigned int q = 0; q < n; ++q)
          {
            double *h = store.old_record(c, q) + offset;
            for (unsigned int i = 0; i < 3; ++i)
              h[i] += (fitted[q] - trace[q]) / 3.;
          }
      }
  }

  template class TraceProjection<2>;
  template class TraceProjection<3>;
} // namespace alveolus
