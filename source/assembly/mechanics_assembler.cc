// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/mechanics_assembler.h>

#include <deal.II/base/work_stream.h>
#include <deal.II/grid/filtered_iterator.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  struct MechanicsAssembler<dim>::Scratch
  {
    Scratch(const Configuration<dim> &configuration,
            const StepGeometry<dim>  &geometry)
      : configuration(configuration)
      , geometry(geometry)
      , kernel(configuration, geometry)
      , increment(configuration.fe.n_dofs_per_cell())
    {}
    // WorkStream makes one scratch object for each thread by copying.
    Scratch(const Scratch &other)
      : Scratch(other.configuration, other.geometry)
    {}

    const Configuration<dim> &configuration;
    const StepGeometry<dim>  &geometry;
    CellKernel<dim>           kernel;
    Vector<double>            increment;
  };



  template <int dim>
  struct MechanicsAssembler<dim>::Copy
  {
    explicit Copy(const unsigned int n)
      : matrix(n, n)
      , forces(n)
      , dofs(n)
    {}

    typename CellKernel<dim>::Status     status = CellKernel<dim>::Status::good;
    FullMatrix<double>                   matrix;
    Vector<double>                       forces;
    std::vector<types::global_dof_index> dofs;
    double      energy = 0., energy_moved = 0., dissipation = 0.;
    std::string failure; ///< of the material
    Point<dim>  center;
  };



  template <int dim>
  MechanicsAssembler<dim>::MechanicsAssembler(
    State<dim>                &state,
    const std::vector<Region> &regions,
    Conditions                &conditions)
    : internal_forces(state.configuration.make_vector())
    , state(state)
    , regions(regions)
    , conditions(conditions)
    , geometry(state.configuration)
  {}



  template <int dim>
  void
  MechanicsAssembler<dim>::keep_moved_weights()
  {
    moved_weights.resize(
      state.configuration.mesh.triangulation->n_active_cells() *
      geometry.n_points);
  }



  template <int dim>
  void
  MechanicsAssembler<dim>::begin_step(const Interval &interval)
  {
    geometry.update();
    for (auto &condition : conditions)
      condition->begin_step(state, interval);
  }



  template <int dim>
  AssemblyResult
  MechanicsAssembler<dim>::assemble(const NodalVector    &increment,
                                    const AssemblyTarget &target)
  {
    using Iterator =
      FilteredIterator<typename DoFHandler<dim>::active_cell_iterator>;
    AssemblyResult result;
    const auto    &configuration = state.configuration;
    internal_forces              = 0.;
    target.residual              = 0.;
    if (target.system != nullptr)
      target.system->clear();
    if (target.lifted != nullptr)
      *target.lifted = 0.;

    const auto worker =
      [&](const Iterator &cell, Scratch &scratch, Copy &copy) {
        copy.failure.clear();
        cell->get_dof_indices(copy.dofs);
        for (unsigned int i = 0; i < copy.dofs.size(); ++i)
          scratch.increment[i] = increment(copy.dofs[i]);
        const unsigned int index = cell->active_cell_index();
        try
          {
            copy.status =
              scratch.kernel.evaluate(index,
                                      regions[state.history.region(index)],
                                      state.history,
                                      scratch.increment,
                                      target.system != nullptr ? &copy.matrix
                                                               : nullptr,
                                      copy.forces);
            copy.energy       = scratch.kernel.energy;
            copy.energy_moved = scratch.kernel.energy_moved;
            copy.dissipation  = scratch.kernel.dissipation;
            if (!moved_weights.empty() &&
                copy.status == CellKernel<dim>::Status::good)
              for (unsigned int q = 0; q < geometry.n_points; ++q)
                moved_weights[index * geometry.n_points + q] =
                  scratch.kernel.moved_weight(q);
          }
        catch (const RunError &error)
          {
            copy.status  = CellKernel<dim>::Status::not_finite;
            copy.failure = error.what();
          }
        if (copy.status != CellKernel<dim>::Status::good)
          copy.center = cell->center();
      };
    const auto copier = [&](const Copy &copy) {
      if (copy.status != CellKernel<dim>::Status::good)
        {
          if (result.good)
            {
              std::ostringstream reason;
              Point<dim>         place = copy.center;
              for (unsigned int d = 0; d < dim; ++d)
                place[d] +=
                  state.configuration.mesh_displacement()(copy.dofs[d]);
              reason << (copy.status == CellKernel<dim>::Status::inverted
                           ? "an element turned inside out at a quadrature "
                             "point near ("
                           : "a material gave no valid stress near (")
                     << place << ") mm"
                     << (copy.failure.empty() ? "" : ": " + copy.failure);
              result.reason = reason.str();
            }
          result.good = false;
          return;
        }
      for (unsigned int i = 0; i < copy.dofs.size(); ++i)
        {
          internal_forces(copy.dofs[i]) += copy.forces[i];
          result.force_scale += std::abs(copy.forces[i]);
        }
      result.energy += copy.energy;
      result.energy_moved += copy.energy_moved;
      result.dissipation += copy.dissipation;
      target.add(copy.matrix, copy.forces, copy.dofs);
    };
    WorkStream::run(Iterator(IteratorFilters::LocallyOwnedCell(),
                             configuration.dof_handler.begin_active()),
                    Iterator(IteratorFilters::LocallyOwnedCell(),
                             configuration.dof_handler.end()),
                    worker,
                    copier,
                    Scratch(configuration, geometry),
                    Copy(configuration.fe.n_dofs_per_cell()));
    for (auto &condition : conditions)
      condition->add_forces(state, increment, target);

    internal_forces.compress(VectorOperation::add);
    target.residual.compress(VectorOperation::add);
    if (target.lifted != nullptr)
      target.lifted->compress(VectorOperation::add);
    if (target.system != nullptr)
      target.system->compress();

    const MPI_Comm communicator = configuration.communicator();
    for (double *sum : {&result.force_scale,
                        &result.energy,
                        &result.energy_moved,
                        &result.dissipation})
      *sum = Utilities::MPI::sum(*sum, communicator);
    // The message of the lowest process that has one is everybody's.
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n  = Utilities::MPI::n_mpi_processes(communicator);
    const unsigned int first_failed =
      Utilities::MPI::min(result.good ? n : me, communicator);
    if (first_failed < n)
      {
        result.good = false;
        result.reason =
          Utilities::MPI::broadcast(communicator, result.reason, first_failed);
      }
    return result;
  }

  template class MechanicsAssembler<2>;
  template class MechanicsAssembler<3>;
} // namespace alveolus
