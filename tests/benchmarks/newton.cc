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

  /**
   * Medians of at least 7 repetitions, of more if they are short. The actions
   * take turns, so that a machine that is slow for a second is slow for all.
   */
  std::vector<double>
  median_seconds(const std::vector<std::function<void()>> &actions)
  {
    std::vector<std::vector<double>> seconds(actions.size());
    double                           total = 0.;
    while (seconds[0].size() < 7 || (total < 2. && seconds[0].size() < 101))
      for (unsigned int i = 0; i < actions.size(); ++i)
        {
          const double start = processor_seconds();
          actions[i]();
          seconds[i].push_back(processor_seconds() - start);
          total += seconds[i].back();
        }
    std::vector<double> medians;
    for (auto &of : seconds)
      {
        std::nth_element(of.begin(), of.begin() + of.size() / 2, of.end());
        medians.push_back(of[of.size() / 2]);
      }
    return medians;
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

    assembler.assemble(du, AssemblyTarget{residual, system.get()});
    const CsrMatrix &matrix = dynamic_cast<const SerialSystem &>(*system).csr();
    Umfpack          umfpack;
    umfpack.factorize(matrix);
    Vector<double> x(matrix.size()), b(matrix.size());

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
    const std::vector<double> medians = median_seconds(
      {[&]() { assembler.begin_step(interval); },
       [&]() { assembler.assemble(du, AssemblyTarget{residual}); },
       [&]() {
         assembler.assemble(du, AssemblyTarget{residual, system.get()});
       },
       [&]() { system->solve(correction, residual); },
       [&]() { umfpack.factorize(matrix); },
       [&]() { umfpack.solve(x, b); },
       [&]() {
         SparseDirectUMFPACK direct;
         direct.factorize(copy);
       }});

    // How well the factors alone solve the system
    for (unsigned int i = 0; i < b.size(); ++i)
      b[i] = residual.local_element(i);
    umfpack.solve(x, b);
    double error = 0.;
    for (std::size_t i = 0; i < matrix.size(); ++i)
      {
        double sum = -b[i];
        for (int k = matrix.row_begin[i]; k < matrix.row_begin[i + 1]; ++k)
          sum += matrix.values[k] * x[matrix.columns[k]];
        error += std::abs(sum);
      }
    error /= b.l1_norm();

    const double cells = model.mesh.triangulation->n_active_cells();
    std::cout << "{\"cells\": " << cells
              << ", \"degree\": " << state.configuration.degree
              << ", \"unknowns\": " << matrix.size()
              << ", \"nonzeros\": " << matrix.values.size()
              << ", \"points\": " << cells * state.history.n_points
              << ", \"shapes\": " << medians[0]
              << ", \"forces\": " << medians[1]
              << ", \"assembly\": " << medians[2]
              << ", \"solution\": " << medians[3]
              << ", \"factorisation\": " << medians[4]
              << ", \"substitution\": " << medians[5]
              << ", \"residual of the factors\": " << error
              << ", \"deal.II factorisation\": " << medians[6]
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
