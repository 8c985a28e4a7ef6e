// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/transfer/limited_linear.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Begins of equally large blocks, one for each active cell. */
    std::vector<std::size_t>
    equal_blocks(const unsigned int n_cells, const std::size_t size)
    {
      std::vector<std::size_t> begin(n_cells + 1);
      for (unsigned int c = 0; c <= n_cells; ++c)
        begin[c] = c * size;
      return begin;
    }
  } // namespace

  template <int dim>
  void
  LimitedLinear<dim>::attach(const SubCells<dim>     &cells,
                             const HistoryStore<dim> &store)
  {
    neighbours = std::make_unique<SubCellNeighbours<dim>>(cells, store);
  }

  template <int dim>
  void
  LimitedLinear<dim>::reconstruct(const SweptStep<dim> &step,
                                  const unsigned int    stride,
                                  std::vector<double>  &correction) const
  {
    const SubCells<dim>        &cells = step.cells;
    std::vector<Point<dim>>     centroid, around;
    std::vector<double>         volume;
    std::vector<Tensor<1, dim>> moment, weights;
    cells.centroids(step.x_before, centroid, volume);
    cells.swept_moments(step.x_before, step.x_after, moment);

    // Component k of the gradient of value v of sub-cell s is at
    // [(s * stride + v) * dim + k].
    const std::size_t   block = cells.n_points * stride * dim;
    std::vector<double> gradient(cells.n_sub_cells() * stride * dim, 0.);
    for (const unsigned int c : cells.owned_cells())
      for (unsigned int s = c * cells.n_points; s < (c + 1) * cells.n_points;
           ++s)
        {
          const auto        &list = (*neighbours)[s];
          const unsigned int size =
            step.store.layout(step.store.region(c)).size;
          around.clear();
          for (const unsigned int other : list)
            around.push_back(centroid[other]);
          gradient_weights(centroid[s], around, weights);
          const double *own = step.record(s);
          double       *g   = gradient.data() + s * stride * dim;
          for (unsigned int j = 0; j < list.size(); ++j)
            {
              const double *other = step.record(list[j]);
              for (unsigned int v = 0; v < size; ++v)
                for (unsigned int k = 0; k < dim; ++k)
                  g[v * dim + k] += weights[j][k] * (other[v] - own[v]);
            }
        }
    step.store.ghost_exchange().update(
      gradient, equal_blocks(cells.n_sub_cells() / cells.n_points, block));

    for (unsigned int f = 0; f < cells.faces().size(); ++f)
      {
        if (step.swept[f] == 0. && moment[f] == Tensor<1, dim>())
          continue;
        const auto        &face = cells.faces()[f];
        const unsigned int donor =
          step.swept[f] > 0. && face.sub_cell[1] != SubCells<dim>::none
            ? face.sub_cell[1]
            : face.sub_cell[0];
        const Tensor<1, dim> arm =
          moment[f] - step.swept[f] * Tensor<1, dim>(centroid[donor]);
        const double      *g = gradient.data() + donor * stride * dim;
        const unsigned int size =
          step.store.layout(step.store.region(donor / cells.n_points)).size;
        for (unsigned int v = 0; v < size; ++v)
          for (unsigned int k = 0; k < dim; ++k)
            correction[f * stride + v] += g[v * dim + k] * arm[k];
      }
  }

  template <int dim>
  void
  LimitedLinear<dim>::limit(const SweptStep<dim> &step,
                            const unsigned int    stride,
                            std::vector<double>  &correction) const
  {
    const SubCells<dim> &cells    = step.cells;
    const unsigned int   n_faces  = cells.faces_per_sub_cell;
    unsigned int         n_fields = 0;
    for (unsigned int r = 0; r < step.store.n_regions(); ++r)
      n_fields =
        std::max<unsigned int>(n_fields, step.store.layout(r).fields.size());

    // First-order values of the owned sub-cells, as in SweptTransfer.
    std::vector<double> low(cells.n_sub_cells() * stride, 0.);
    for (const unsigned int c : cells.owned_cells())
      for (unsigned int s = c * cells.n_points; s < (c + 1) * cells.n_points;
           ++s)
        {
          const unsigned int size =
            step.store.layout(step.store.region(c)).size;
          const double *own   = step.record(s);
          double       *value = low.data() + s * stride;
          std::copy(own, own + size, value);
          for (unsigned int i = 0; i < n_faces; ++i)
            {
              const auto incidence = cells.incidences(s)[i];
              if (incidence.face == SubCells<dim>::none)
                continue;
              const double       gain = incidence.side == 0
                                          ? step.swept[incidence.face]
                                          : -step.swept[incidence.face];
              const unsigned int other =
                cells.faces()[incidence.face].sub_cell[1 - incidence.side];
              if (gain > 0. && other != SubCells<dim>::none)
                for (unsigned int v = 0; v < size; ++v)
                  value[v] += gain / step.volume_after[s] *
                              (step.record(other)[v] - own[v]);
            }
        }

    // The factor that a sub-cell asks for, for each of its faces and fields,
    // and the smaller one of both sides. Sub-cells whose value keeps the bounds
    // ask for nothing; one that does not asks for factors that are right
    // whatever the others do, so that it need not be looked at again.
    const unsigned int  n_all = cells.faces().size();
    std::vector<double> wish(cells.n_sub_cells() * n_faces * n_fields, 1.);
    std::vector<double> factor(n_all * n_fields, 1.);
    std::vector<unsigned char> level(cells.n_sub_cells() * n_fields, 0);
    const auto begin = equal_blocks(cells.n_sub_cells() / cells.n_points,
                                    cells.n_points * n_faces * n_fields);

    std::vector<double>         sum(stride), parts(n_faces * stride), wishes;
    std::vector<const double *> around, corrections;
    for (unsigned int i = 0; i < n_faces; ++i)
      corrections.push_back(parts.data() + i * stride);

    const auto judge = [&](const unsigned int s, const HistoryLayout &layout) {
      const auto *faces = cells.incidences(s);
      bool        any   = false;
      for (unsigned int i = 0; i < n_faces; ++i)
        {
          if (faces[i].face == SubCells<dim>::none)
            {
              std::fill_n(parts.begin() + i * stride, layout.size, 0.);
              continue;
            }
          const double scale =
            (faces[i].side == 0 ? 1. : -1.) / step.volume_after[s];
          for (unsigned int v = 0; v < layout.size; ++v)
            {
              parts[i * stride + v] =
                scale * correction[faces[i].face * stride + v];
              any = any || parts[i * stride + v] != 0.;
            }
        }
      if (!any)
        return false;

      around.assign(1, step.record(s));
      for (const unsigned int other : (*neighbours)[s])
        around.push_back(step.record(other));
      any = false;
      for (unsigned int a = 0; a < layout.fields.size(); ++a)
        {
          const unsigned int first = layout.offsets[a];
          const unsigned int end =
            first + n_values(layout.fields[a].shape, dim);
          CorrectionLimiter limiter(layout.fields[a], first, dim);
          limiter.set(low.data() + s * stride, around);
          for (unsigned int v = first; v < end; ++v)
            {
              sum[v] = low[s * stride + v];
              for (unsigned int i = 0; i < n_faces; ++i)
                if (faces[i].face != SubCells<dim>::none)
                  sum[v] += factor[faces[i].face * n_fields + a] *
                            parts[i * stride + v];
            }
          if (limiter.admits(sum.data(), level[s * n_fields + a]))
            continue;
          ++level[s * n_fields + a];
          any = true;
          limiter.factors(corrections, level[s * n_fields + a], wishes);
          for (unsigned int i = 0; i < n_faces; ++i)
            wish[(s * n_faces + i) * n_fields + a] = wishes[i];
        }
      return any;
    };

    const MPI_Comm communicator = step.store.triangulation.get_communicator();
    while (true)
      {
        unsigned int n_new = 0;
        for (const unsigned int c : cells.owned_cells())
          for (unsigned int s = c * cells.n_points;
               s < (c + 1) * cells.n_points;
               ++s)
            n_new += judge(s, step.store.layout(step.store.region(c))) ? 1 : 0;
        if (Utilities::MPI::sum(n_new, communicator) == 0)
          break;
        step.store.ghost_exchange().update(wish, begin);
        for (unsigned int f = 0; f < n_all; ++f)
          for (const unsigned int s : cells.faces()[f].sub_cell)
            if (s != SubCells<dim>::none)
              for (unsigned int i = 0; i < n_faces; ++i)
                if (cells.incidences(s)[i].face == f)
                  for (unsigned int a = 0; a < n_fields; ++a)
                    factor[f * n_fields + a] =
                      std::min(factor[f * n_fields + a],
                               wish[(s * n_faces + i) * n_fields + a]);
      }

    for (unsigned int f = 0; f < n_all; ++f)
      {
        const HistoryLayout &layout = step.store.layout(
          step.store.region(cells.faces()[f].sub_cell[0] / cells.n_points));
        for (unsigned int a = 0; a < layout.fields.size(); ++a)
          for (unsigned int v = 0; v < n_values(layout.fields[a].shape, dim);
               ++v)
            correction[f * stride + layout.offsets[a] + v] *=
              factor[f * n_fields + a];
      }
  }

  template <int dim>
  void
  LimitedLinear<dim>::correct(const SweptStep<dim> &step,
                              const unsigned int    stride,
                              std::vector<double>  &correction) const
  {
    reconstruct(step, stride, correction);
    limit(step, stride, correction);
  }

  template class LimitedLinear<2>;
  template class LimitedLinear<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::TransferScheme,
  alveolus::LimitedLinear,
  "limited linear",
  "Second order: what passes through a sub-cell face is the mean over the swept "
  "volume of the donor's linear reconstruction phi + grad phi . (x - "
  "x_centroid) with the least-squares gradient from the sub-cells of the same "
  "region around. Where the new mean would leave the range of the old values "
  "around, the part beyond the first-order flux is reduced by a factor, one "
  "for each scalar and one for each tensor, which is judged by invariants. No "
  "new extrema, conservative; linear fields are moved exactly.")
