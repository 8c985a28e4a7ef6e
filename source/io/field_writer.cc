// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/io/field_writer.h>
#include <alveolus/mesh/quality.h>

#include <deal.II/numerics/data_out.h>

#include <cstdio>
#include <fstream>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  std::vector<std::pair<std::string, Vector<float>>>
  cell_fields(const State<dim> &state, const std::vector<Region> &regions)
  {
    const unsigned int n_cells =
      state.configuration.mesh.triangulation->n_active_cells();
    const auto &history = state.history;

    // The union of the regions' quantities, in the order they first appear.
    std::vector<std::pair<std::string, Vector<float>>> fields;
    std::map<std::string, unsigned int>                index;
    const auto index_of = [&](const std::string &name) {
      const auto found = index.emplace(name, fields.size());
      if (found.second)
        {
          fields.emplace_back(name, Vector<float>(n_cells));
          // operator= asserts finite values
          std::fill(fields.back().second.begin(),
                    fields.back().second.end(),
                    std::numeric_limits<float>::quiet_NaN());
        }
      return found.first->second;
    };
    std::vector<std::vector<std::pair<unsigned int, unsigned int>>> scalars(
      regions.size());
    std::vector<std::vector<unsigned int>> derived(regions.size());
    for (unsigned int r = 0; r < regions.size(); ++r)
      {
        const HistoryLayout &layout = history.layout(r);
        for (unsigned int i = 0; i < layout.fields.size(); ++i)
          if (layout.fields[i].shape == HistoryField::Shape::scalar)
            scalars[r].emplace_back(index_of(layout.fields[i].name),
                                    layout.offsets[i]);
        for (const auto &name : regions[r].material->derived_names())
          derived[r].push_back(index_of(name.first));
      }

    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int  c = cell->active_cell_index();
          const unsigned int  r = history.region(c);
          std::vector<double> sum(fields.size(), 0.);
          for (unsigned int q = 0; q < history.n_points; ++q)
            {
              const double *record = history.old_record(c, q);
              for (const auto &[field, offset] : scalars[r])
                sum[field] += record[offset] / history.n_points;
              if (!derived[r].empty())
                {
                  const std::vector<double> values =
                    regions[r].material->derived_values(record);
                  for (unsigned int i = 0; i < values.size(); ++i)
                    sum[derived[r][i]] += values[i] / history.n_points;
                }
            }
          for (const auto &[field, offset] : scalars[r])
            fields[field].second[c] = sum[field];
          for (const unsigned int field : derived[r])
            fields[field].second[c] = sum[field];
        }
    return fields;
  }



  template <int dim>
  FieldWriter<dim>::FieldWriter(const std::string &directory)
    : directory(directory)
  {}



  template <int dim>
  void
  FieldWriter<dim>::write(const State<dim>          &state,
                          const std::vector<Region> &regions)
  {
    const auto           &configuration = state.configuration;
    DataOut<dim>          data_out;
    DataOutBase::VtkFlags flags;
    flags.time                     = state.time;
    flags.write_higher_order_cells = configuration.degree > 1;
    data_out.set_flags(flags);

    data_out.add_data_vector(
      configuration.dof_handler,
      state.displacement,
      std::vector<std::string>(dim, "displacement"),
      std::vector<DataComponentInterpretation::DataComponentInterpretation>(
        dim, DataComponentInterpretation::component_is_part_of_vector));

    auto               fields = cell_fields(state, regions);
    const unsigned int n_cells =
      configuration.mesh.triangulation->n_active_cells();
    Vector<float> quality(n_cells), region(n_cells);
    mesh_quality(configuration, configuration.positions(), {}, &quality);
    for (unsigned int c = 0; c < n_cells; ++c)
      region[c] = state.history.region(c);
    fields.emplace_back("scaled Jacobian", quality);
    fields.emplace_back("region", region);
    for (auto &field : fields)
      {
        std::string name = field.first;
        std::replace(name.begin(), name.end(), ' ', '_');
        data_out.add_data_vector(field.second,
                                 name,
                                 DataOut<dim>::type_cell_data);
      }

    data_out.build_patches(configuration.mapping(),
                           configuration.degree,
                           DataOut<dim>::curved_inner_cells);
    char number[16];
    std::snprintf(number,
                  sizeof(number),
                  "%05u",
                  static_cast<unsigned int>(times.size()));
    const std::string  base         = std::string("fields-") + number;
    const MPI_Comm     communicator = configuration.communicator();
    const unsigned int me    = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n     = Utilities::MPI::n_mpi_processes(communicator);
    const auto         piece = [&](const unsigned int rank) {
      return base + (n > 1 ? "." + std::to_string(rank) : "") + ".vtu";
    };
    bool written = true;
    {
      std::ofstream out(directory + "/" + piece(me));
      data_out.write_vtu(out);
      out.close();
      written = !out.fail();
    }
    std::string joined = piece(0);
    if (n > 1)
      joined = base + ".pvtu";
    times.emplace_back(state.time, joined);
    if (me == 0)
      {
        if (n > 1)
          {
            std::vector<std::string> pieces;
            for (unsigned int rank = 0; rank < n; ++rank)
              pieces.push_back(piece(rank));
            std::ofstream out(directory + "/" + joined);
            data_out.write_pvtu_record(out, pieces);
            written = written && out.good();
          }
        std::ofstream pvd(directory + "/fields.pvd");
        DataOutBase::write_pvd_record(pvd, times);
        written = written && pvd.good();
      }
    if (Utilities::MPI::min(written ? 1 : 0, communicator) == 0)
      throw RunError(directory + "/" + base,
                     "fields could not be written",
                     "is the disk full, or has the folder vanished?");
  }

  template std::vector<std::pair<std::string, Vector<float>>>
  cell_fields(const State<2> &, const std::vector<Region> &);
  template std::vector<std::pair<std::string, Vector<float>>>
  cell_fields(const State<3> &, const std::vector<Region> &);
  template class FieldWriter<2>;
  template class FieldWriter<3>;
} // namespace alveolus
