// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/tensors.h>
#include <alveolus/state/reproducible_sum.h>
#include <alveolus/transfer/reference_map.h>

#include <deal.II/fe/fe_dgp.h>
#include <deal.II/lac/full_matrix.h>

#include <cmath>
#include <set>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * X of a boundary node farther from the outline than this part of the edges
     * there comes from outside the body: the mesh was led through a boundary.
     */
    constexpr double farthest = 0.5;

    /** Part of the edges below which X is where it should be. */
    constexpr double in_place = 1e-12;

    template <int dim>
    std::set<unsigned int>
    keys_of(const std::map<unsigned int, ReferenceMapRegion> &regions)
    {
      std::set<unsigned int> keys;
      for (const auto &region : regions)
        keys.insert(region.first);
      return keys;
    }
  } // namespace

  std::string
  ReferenceMapReport::objection() const
  {
    std::ostringstream text;
    if (!(smallest_jacobian > 0.))
      text << "the reference map is not invertible on the new mesh (smallest "
              "det dX/dx relative to a cell's mean: "
           << smallest_jacobian << ")";
    else if (!(largest_relative_distance <= farthest))
      text << "the reference map of a boundary node is "
           << largest_relative_distance
           << " edge lengths away from the undeformed outline: material would "
              "come from outside the body";
    return text.str();
  }

  template <int dim>
  ReferenceMap<dim>::ReferenceMap(
    const Configuration<dim>                         &configuration,
    const HistoryStore<dim>                          &store,
    const std::map<unsigned int, ReferenceMapRegion> &regions,
    const std::string                                &field)
    : configuration(configuration)
    , regions(regions)
    , cells(configuration)
    , quadrature(configuration.degree + 1)
  {
    for (const auto &[r, settings] : regions)
      {
        const int place = store.layout(r).offset(field);
        if (place < 0)
          throw RunError("Transfer",
                         "region " + std::to_string(r) + " has no field '" +
                           field + "'",
                         "use `Transfer of deformation = history`");
        offset[r] = place;
      }
    for (const auto &cell :
         configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c = cell->active_cell_index();
          if (regions.count(store.region(c)) > 0)
            {
              owned.push_back(c);
              region_of.push_back(store.region(c));
            }
        }

    typename CellNodes<dim>::NodeNumbers values;
    typename CellNodes<dim>::NodeTensors gradients;
    const auto                           add = [&](const Point<dim> &xi) {
      cells.shape_gradients(xi, values, gradients);
      shape_gradients.push_back(gradients);
    };
    for (const Point<dim> &xi : quadrature.get_points())
      add(xi);
    for (const unsigned int v : GeometryInfo<dim>::vertex_indices())
      add(GeometryInfo<dim>::unit_cell_vertex(v));

    const FE_DGP<dim> pressure(configuration.degree - 1);
    for (unsigned int m = 0; m < pressure.n_dofs_per_cell(); ++m)
      {
        polynomials.emplace_back();
        for (const Point<dim> &xi : quadrature.get_points())
          polynomials.back().push_back(pressure.shape_value(m, xi));
      }

    // The faces around an owned node belong to owned and ghost cells.
    const unsigned int n_owned =
      configuration.mesh_displacement().locally_owned_size();
    std::map<unsigned int, std::set<std::uint64_t>>               keys;
    std::map<unsigned int, std::pair<unsigned int, unsigned int>> place;
    for (const auto &face :
         outline_faces(configuration, store, keys_of<dim>(regions)))
      for (const unsigned int i :
           alveolus::outline_nodes<dim>(face.face_no, configuration.degree))
        {
          const unsigned int entry = cells.local_entries(face.cell, i)[0];
          if (entry >= n_owned)
            continue;
          keys[entry].insert(face.key);
          place[entry] = {face.cell, i};
        }
    for (const auto &[entry, of] : keys)
      outline_nodes.push_back({place[entry].first,
                               place[entry].second,
                               OutlineKeys(of.begin(), of.end())});
  }

  template <int dim>
  void
  ReferenceMap<dim>::gather(
    const NodalVector                    &x,
    const NodalVector                    &u,
    const unsigned int                    cell,
    typename CellNodes<dim>::NodeTensors &position,
    typename CellNodes<dim>::NodeTensors &reference) const
  {
    cells.gather(x, cell, position);
    cells.gather(u, cell, reference);
    for (unsigned int i = 0; i < cells.n_nodes; ++i)
      reference[i] = position[i] - reference[i];
    // Relative to one node: round-off is then relative to the cell's size.
    for (unsigned int i = cells.n_nodes; i-- > 0;)
      {
        position[i] -= position[0];
        reference[i] -= reference[0];
      }
  }

  template <int dim>
  typename ReferenceMap<dim>::Maps
  ReferenceMap<dim>::maps_at(
    const unsigned int                          point,
    const typename CellNodes<dim>::NodeTensors &position,
    const typename CellNodes<dim>::NodeTensors &reference) const
  {
    Maps maps;
    for (unsigned int i = 0; i < cells.n_nodes; ++i)
      {
        maps.x += outer_product(position[i], shape_gradients[point][i]);
        maps.X += outer_product(reference[i], shape_gradients[point][i]);
      }
    return maps;
  }

  template <int dim>
  ReferenceMapReport
  ReferenceMap<dim>::admit(const ReferenceOutline<dim> &outline,
                           const NodalVector           &x,
                           NodalVector                 &u) const
  {
    const MPI_Comm     communicator = configuration.communicator();
    ReferenceMapReport report;
    typename CellNodes<dim>::NodeTensors position, reference;
    std::vector<std::pair<const unsigned int *, Tensor<1, dim>>> moves;
    for (const OutlineNode &node : outline_nodes)
      {
        const unsigned int *entry = cells.local_entries(node.cell, node.node);
        Point<dim>          X;
        for (unsigned int d = 0; d < dim; ++d)
          X[d] = x.local_element(entry[d]) - u.local_element(entry[d]);
        double               size;
        const Tensor<1, dim> move = outline.nearest(node.keys, X, size) - X;
        if (move.norm() <= in_place * size)
          continue;
        ++report.n_projected;
        report.largest_distance =
          std::max(report.largest_distance, move.norm());
        report.largest_relative_distance =
          std::max(report.largest_relative_distance, move.norm() / size);
        moves.emplace_back(entry, move);
      }
    u.zero_out_ghost_values();
    for (const auto &[entry, move] : moves)
      for (unsigned int d = 0; d < dim; ++d)
        u.local_element(entry[d]) -= move[d];
    u.update_ghost_values();

    for (const unsigned int c : owned)
      {
        gather(x, u, c, position, reference);
        double              mean = 0.;
        std::vector<double> jacobians;
        for (unsigned int q = 0; q < shape_gradients.size(); ++q)
          {
            const Maps maps = maps_at(q, position, reference);
            jacobians.push_back(determinant(maps.X));
            if (q < quadrature.size())
              mean += quadrature.weight(q) * jacobians.back();
          }
        for (const double jacobian : jacobians)
          // Not std::min, which would swallow a NaN.
          if (!(jacobian / mean >= report.smallest_jacobian) || !(mean > 0.))
            report.smallest_jacobian = mean > 0. ? jacobian / mean : -1.;
      }
    if (!std::isfinite(report.smallest_jacobian))
      report.smallest_jacobian = -1.;
    report.smallest_jacobian =
      Utilities::MPI::min(report.smallest_jacobian, communicator);
    report.n_projected = Utilities::MPI::sum(report.n_projected, communicator);
    report.largest_distance =
      Utilities::MPI::max(report.largest_distance, communicator);
    report.largest_relative_distance =
      Utilities::MPI::max(report.largest_relative_distance, communicator);
    return report;
  }

  template <int dim>
  void
  ReferenceMap<dim>::apply(const NodalVector &x,
                           const NodalVector &u,
                           HistoryStore<dim> &target) const
  {
    const unsigned int                   n = quadrature.size();
    const unsigned int                   m = polynomials.size();
    typename CellNodes<dim>::NodeTensors position, reference;
    std::vector<Maps>                    maps(n);
    std::vector<double>                  det_X(n), ratio(n);
    FullMatrix<double>                   mass(m, m);
    Vector<double>                       moments(m), coefficients(m);
    unsigned int                         n_bad = 0;
    for (unsigned int k = 0; k < owned.size(); ++k)
      {
        const unsigned int        c        = owned[k];
        const ReferenceMapRegion &settings = regions.at(region_of[k]);
        gather(x, u, c, position, reference);
        mass      = 0.;
        moments   = 0.;
        bool good = true;
        for (unsigned int q = 0; q < n; ++q)
          {
            maps[q]            = maps_at(q, position, reference);
            det_X[q]           = determinant(maps[q].X);
            const double det_x = determinant(maps[q].x);
            good               = good && det_X[q] > 0. && det_x > 0.;
            ratio[q]           = det_x / det_X[q];
            const double w     = quadrature.weight(q);
            for (unsigned int i = 0; i < m; ++i)
              {
                moments[i] += w * polynomials[i][q] * det_x;
                for (unsigned int j = 0; j < m; ++j)
                  mass(i, j) +=
                    w * polynomials[i][q] * polynomials[j][q] * det_X[q];
              }
          }
        if (good && settings.mean_dilatation)
          {
            mass.gauss_jordan();
            mass.vmult(coefficients, moments);
            for (unsigned int q = 0; q < n; ++q)
              {
                ratio[q] = 0.;
                for (unsigned int i = 0; i < m; ++i)
                  ratio[q] += coefficients[i] * polynomials[i][q];
                good = good && ratio[q] > 0.;
              }
          }
        if (!good)
          {
            ++n_bad;
            continue;
          }
        for (unsigned int q = 0; q < n; ++q)
          {
            const Tensor<2, dim> F = maps[q].x * invert(maps[q].X);
            Tensor<2, 3>         full;
            for (unsigned int i = 0; i < 3; ++i)
              full[i][i] = 1.;
            for (unsigned int i = 0; i < dim; ++i)
              for (unsigned int j = 0; j < dim; ++j)
                full[i][j] = F[i][j];
            const SymmetricTensor<2, 3> total =
              0.5 * log(symmetrize(full * transpose(full)));
            double *record = target.old_record(c, q) + offset.at(region_of[k]);
            const double volume = settings.with_volume
                                    ? std::log(ratio[q])
                                    : record[0] + record[1] + record[2];
            pack(deviator(total) + volume / 3. * unit_symmetric_tensor<3>(),
                 record,
                 dim);
          }
      }
    n_bad = Utilities::MPI::sum(n_bad, configuration.communicator());
    if (n_bad > 0)
      throw RunError("Transfer",
                     "the reference map is not invertible in " +
                       std::to_string(n_bad) + " cells of the new mesh",
                     "transfer more often, or use `Transfer of deformation = "
                     "history`");
  }

  template <int dim>
  std::vector<double>
  ReferenceMap<dim>::volumes_at_rest(const NodalVector &x,
                                     const NodalVector &u) const
  {
    std::map<unsigned int, std::vector<double>> parts;
    typename CellNodes<dim>::NodeTensors        position, reference;
    for (unsigned int k = 0; k < owned.size(); ++k)
      {
        gather(x, u, owned[k], position, reference);
        double sum = 0.;
        for (unsigned int q = 0; q < quadrature.size(); ++q)
          sum += quadrature.weight(q) *
                 determinant(maps_at(q, position, reference).X);
        parts[region_of[k]].push_back(sum);
      }
    std::vector<double> result;
    for (const unsigned int r : region_indices())
      result.push_back(
        reproducible_sum(parts[r], configuration.communicator()));
    return result;
  }

  template <int dim>
  std::vector<unsigned int>
  ReferenceMap<dim>::region_indices() const
  {
    std::vector<unsigned int> result;
    for (const auto &region : regions)
      result.push_back(region.first);
    return result;
  }

  template class ReferenceMap<2>;
  template class ReferenceMap<3>;
} // namespace alveolus
