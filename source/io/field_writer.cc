// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/io/field_writer.h>
#include <alveolus/mesh/quality.h>

#include <deal.II/numerics/data_out.h>

#include <cstdio>
#include <limits>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** With deal.II's functions, which throw its own kind of error. */
    template <typename Function>
    void
    write_whole_file(const std::string &name, const Function &write)
    {
      WholeFile file(name);
      try
        {
          write(file.stream());
        }
      catch (const ExcIO &)
        {
          file.stream().setstate(std::ios::failbit);
        }
      file.commit();
    }
  } // namespace



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
    // The other processes learn of a failure before anything refers to the
    // files.
    std::string problem;
    const auto  attempt = [&](const auto &action) {
      try
        {
          action();
        }
      catch (const RunError &error)
        {
          problem = error.what();
        }
      const unsigned int first =
        Utilities::MPI::min(problem.empty() ? n : me, communicator);
      if (first < n)
        throw RunError("fields",
                       Utilities::MPI::broadcast(communicator, problem, first),
                       "");
    };
    attempt([&]() {
      write_whole_file(directory + "/" + piece(me),
                       [&](std::ostream &out) { data_out.write_vtu(out); });
    });
    std::string joined = piece(0);
    if (n > 1)
      joined = base + ".pvtu";
    auto all = times;
    all.emplace_back(state.time, joined);
    attempt([&]() {
      if (me != 0)
        return;
      if (n > 1)
        {
          std::vector<std::string> pieces;
          for (unsigned int rank = 0; rank < n; ++rank)
            pieces.push_back(piece(rank));
          write_whole_file(directory + "/" + joined, [&](std::ostream &out) {
            data_out.write_pvtu_record(out, pieces);
          });
        }
      write_whole_file(directory + "/fields.pvd", [&](std::ostream &out) {
        DataOutBase::write_pvd_record(out, all);
      });
    });
    times = std::move(all);
  }



  template <int dim>
  void
  FieldWriter<dim>::save(BlockFile &blocks) const
  {
    BlockFile::Numbers when;
    std::string        files;
    for (const auto &[time, file] : times)
      {
        when.push_back(time);
        files += file + '\n';
      }
    blocks.put("fields/times", std::move(when));
    blocks.put("fields/files", std::move(files));
  }



  template <int dim>
  void
  FieldWriter<dim>::load(const BlockFile &blocks)
  {
    times.clear();
    std::istringstream files(blocks.text("fields/files"));
    std::string        file;
    for (const double time : blocks.numbers("fields/times"))
      {
        if (!std::getline(files, file))
          blocks.refuse("fields/files", "is shorter than the times");
        times.emplace_back(time, file);
      }
  }

  template std::vector<std::pair<std::string, Vector<float>>>
  cell_fields(const State<2> &, const std::vector<Region> &);
  template std::vector<std::pair<std::string, Vector<float>>>
  cell_fields(const State<3> &, const std::vector<Region> &);
  template class FieldWriter<2>;
  template class FieldWriter<3>;
} // namespace alveolus
