// SPDX-License-Identifier: LGPL-2.1-or-later
// What a Newton iteration of a scene is made of, beside the bare factorisation
// of the same matrix.
//
//   newton STEPS SCENE.prm [Section/Parameter=value ...]
//
// takes STEPS Lagrangian steps of the scene (their mesh is not rezoned), then
// repeats each part of an iteration and prints the medians of its processor
// seconds as one line of JSON. One thread, two dimensions.
#include <alveolus/algebra/serial_system.h>
#include <alveolus/driver/model.h>
#include <alveolus/scene/parameter_text.h>

#include <deal.II/base/multithread_info.h>
#include <deal.II/lac/sparse_direct.h>
#include <deal.II/lac/sparse_matrix.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <functional>
#include <iostream>
#include <numeric>

using namespace dealii;
using namespace alveolus;

namespace
{
  double
  processor_seconds()
  {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return now.tv_sec + 1e-9 * now.tv_nsec;
  }

  /** Median of at least 7 repetitions, of more if they are short. */
  double
  median_seconds(const std::function<void()> &action)
  {
    std::vector<double> seconds;
    double              total = 0.;
    while (seconds.size() < 7 || (total < 0.3 && seconds.size() < 101))
      {
        const double start = processor_seconds();
        action();
        seconds.push_back(processor_seconds() - start);
        total += seconds.back();
      }
    std::nth_element(seconds.begin(),
                     seconds.begin() + seconds.size() / 2,
                     seconds.end());
    return seconds[seconds.size() / 2];
  }

  int
  measure(const unsigned int              n_steps,
          const std::string              &file,
          const std::vector<std::string> &settings)
  {
    constexpr int       dim   = 2;
    const ParameterText text  = ParameterText::read(file, settings);
    const auto          scene = std::make_shared<Scene<dim>>(text);
    TimerOutput timer(std::cout, TimerOutput::never, TimerOutput::cpu_times);
    Model<dim>  model(scene,
                     scene->mesh_source->create(
                       MPI_COMM_WORLD,
                       ".",
                       std::filesystem::temp_directory_path().string()),
                     timer);
    State<dim> &state = *model.state;

    Interval interval;
    for (unsigned int step = 0; step < n_steps; ++step)
      {
        interval = {state.time, state.time + scene->time.initial_step};
        EquilibriumReport  report;
        RemodellingSummary summary;
        const Verdict      verdict =
          model.staggered_step->solve(interval, report, summary);
        if (verdict.repeats())
          throw RunError("newton", verdict.reason, "take fewer steps");
        state.accept(model.equilibrium->increment);
        for (auto &condition : model.conditions)
          condition->commit();
        state.time      = interval.end;
        state.last_step = interval.end - interval.begin;
      }

    // An iteration of the next step
    interval = {state.time, state.time + scene->time.initial_step};
    MechanicsAssembler<dim> assembler(state, model.regions, model.conditions);
    assembler.begin_step(interval);
    PrescribedIncrements increments;
    for (const auto &condition : model.conditions)
      condition->prescribe(state, interval, increments);
    AffineConstraints<double> held(state.configuration.locally_relevant);
    NodalVector               du = state.increment;
    du.zero_out_ghost_values();
    for (const auto &[dof, value] : increments.all())
      {
        held.add_line(dof);
        du(dof) = value.first;
      }
    du.update_ghost_values();
    held.close();
    const auto  system   = make_linear_system(state.configuration.dof_handler,
                                           held,
                                           "UMFPACK",
                                           1e-12);
    NodalVector residual = state.configuration.make_vector();
    NodalVector correction(residual);

    const double geometry =
      median_seconds([&]() { assembler.begin_step(interval); });
    const double forces = median_seconds(
      [&]() { assembler.assemble(du, AssemblyTarget{residual}); });
    const double assembly = median_seconds([&]() {
      assembler.assemble(du, AssemblyTarget{residual, system.get()});
    });
    const double solution =
      median_seconds([&]() { system->solve(correction, residual); });

    const CsrMatrix &matrix = dynamic_cast<const SerialSystem &>(*system).csr();
    Umfpack          umfpack;
    umfpack.factorize(matrix);
    const double factorisation =
      median_seconds([&]() { umfpack.factorize(matrix); });
    Vector<double> x(matrix.size()), b(matrix.size());
    for (unsigned int i = 0; i < b.size(); ++i)
      b[i] = residual.local_element(i);
    const double substitution = median_seconds([&]() { umfpack.solve(x, b); });

    // How well the factors alone solve the system
    double error = 0.;
    for (std::size_t i = 0; i < matrix.size(); ++i)
      {
        double sum = -b[i];
        for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
          sum += matrix.values[k] * x[matrix.columns[k]];
        error += std::abs(sum);
      }
    error /= b.l1_norm();

    // deal.II's own wrapper, which analyses the pattern each time
    DynamicSparsityPattern entries(matrix.size());
    for (std::size_t i = 0; i < matrix.size(); ++i)
      for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
        entries.add(i, matrix.columns[k]);
    SparsityPattern pattern;
    pattern.copy_from(entries);
    SparseMatrix<double> copy(pattern);
    for (std::size_t i = 0; i < matrix.size(); ++i)
      for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
        copy.set(i, matrix.columns[k], matrix.values[k]);
    const double with_analysis = median_seconds([&]() {
      SparseDirectUMFPACK direct;
      direct.factorize(copy);
    });

    const double cells = model.mesh.triangulation->n_active_cells();
    std::cout << "{\"cells\": " << cells
              << ", \"degree\": " << state.configuration.degree
              << ", \"unknowns\": " << matrix.size()
              << ", \"nonzeros\": " << matrix.values.size()
              << ", \"points\": " << cells * state.history.n_points
              << ", \"shapes\": " << geometry << ", \"forces\": " << forces
              << ", \"assembly\": " << assembly
              << ", \"solution\": " << solution
              << ", \"factorisation\": " << factorisation
              << ", \"substitution\": " << substitution
              << ", \"residual of the factors\": " << error
              << ", \"deal.II factorisation\": " << with_analysis
              << ", \"history bytes per cell\": "
              << state.history.memory_consumption() / cells
              << ", \"matrix bytes per cell\": "
              << system->memory_consumption() / cells
              << ", \"factor bytes per cell\": "
              << system->expected_factor_bytes() / cells << "}\n";
    return 0;
  }
} // namespace



int
main(int argc, char **argv)
{
  if (argc < 3)
    {
      std::cerr << "usage: newton STEPS SCENE.prm [PARAMETER=VALUE ...]\n";
      return 2;
    }
  int                              name_only = 1;
  Utilities::MPI::MPI_InitFinalize mpi(name_only, argv, 1);
  MultithreadInfo::set_thread_limit(1);
  try
    {
      return measure(std::stoi(argv[1]),
                     argv[2],
                     std::vector<std::string>(argv + 3, argv + argc));
    }
  catch (const std::exception &error)
    {
      std::cerr << "newton: " << error.what() << "\n";
      return 1;
    }
}
