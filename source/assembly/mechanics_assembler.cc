// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/mechanics_assembler.h>

#include <deal.II/base/work_stream.h>

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
    double       energy = 0., energy_moved = 0., dissipation = 0.;
    std::string  failure;  ///< of the material
    unsigned int slot = 0; ///< of the cell
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
  {
    // Local indices are those of any vector of the configuration: its own
    // entries first, then the ghosts.
    const auto &configuration = state.configuration;
    const auto &partitioner   = *internal_forces.get_partitioner();
    std::vector<types::global_dof_index> dofs(
      configuration.fe.n_dofs_per_cell());
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned())
        {
          cells.push_back(cell->active_cell_index());
          cell->get_dof_indices(dofs);
          for (const auto dof : dofs)
            local_dofs.push_back(partitioner.global_to_local(dof));
        }
    cells.shrink_to_fit();
    local_dofs.shrink_to_fit();
  }



  template <int dim>
  std::string
  MechanicsAssembler<dim>::place_of(const unsigned int slot) const
  {
    // The middle of the vertices, and the displacement of the first one
    const auto        &configuration = state.configuration;
    const unsigned int n             = configuration.fe.n_dofs_per_cell();
    Point<dim>         place;
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->active_cell_index() == cells[slot])
        place = cell->center();
    for (unsigned int d = 0; d < dim; ++d)
      place[d] += configuration.mesh_displacement().local_element(
        local_dofs[slot * n +
                   configuration.fe.component_to_system_index(d, 0)]);
    std::ostringstream text;
    text << place;
    return text.str();
  }



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
    AssemblyResult result;
    const auto    &configuration = state.configuration;
    internal_forces              = 0.;
    target.residual              = 0.;
    if (target.system != nullptr)
      target.system->clear();
    if (target.lifted != nullptr)
      *target.lifted = 0.;

    const unsigned int n_dofs      = configuration.fe.n_dofs_per_cell();
    const auto        &partitioner = *increment.get_partitioner();
    using Iterator                 = std::vector<unsigned int>::const_iterator;

    const auto worker =
      [&](const Iterator &cell, Scratch &scratch, Copy &copy) {
        copy.failure.clear();
        copy.slot                 = cell - cells.begin();
        const unsigned int *local = local_dofs.data() + copy.slot * n_dofs;
        for (unsigned int i = 0; i < n_dofs; ++i)
          {
            scratch.increment[i] = increment.local_element(local[i]);
            copy.dofs[i]         = partitioner.local_to_global(local[i]);
          }
        try
          {
            copy.status =
              scratch.kernel.evaluate(*cell,
                                      regions[state.history.region(*cell)],
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
                moved_weights[*cell * geometry.n_points + q] =
                  scratch.kernel.moved_weight(q);
          }
        catch (const RunError &error)
          {
            copy.status  = CellKernel<dim>::Status::not_finite;
            copy.failure = error.what();
          }
      };
    const auto copier = [&](const Copy &copy) {
      const unsigned int *local = local_dofs.data() + copy.slot * n_dofs;
      if (copy.status != CellKernel<dim>::Status::good)
        {
          if (result.good)
            result.reason =
              (copy.status == CellKernel<dim>::Status::inverted
                 ? "an element turned inside out at a quadrature point near ("
                 : "a material gave no valid stress near (") +
              place_of(copy.slot) + ") mm" +
              (copy.failure.empty() ? "" : ": " + copy.failure);
          result.good = false;
          return;
        }
      double *const forces   = internal_forces.begin();
      double *const residual = target.residual.begin();
      for (unsigned int i = 0; i < n_dofs; ++i)
        {
          forces[local[i]] += copy.forces[i];
          residual[local[i]] += copy.forces[i];
          result.force_scale += std::abs(copy.forces[i]);
        }
      result.energy += copy.energy;
      result.energy_moved += copy.energy_moved;
      result.dissipation += copy.dissipation;
      if (target.system == nullptr)
        return;
      target.system->add_cell(copy.slot, copy.matrix, copy.dofs);
      target.add_lifted(copy.matrix, copy.dofs);
    };
    if (!cells.empty())
      WorkStream::run(cells.begin(),
                      cells.end(),
                      worker,
                      copier,
                      Scratch(configuration, geometry),
                      Copy(n_dofs));
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
