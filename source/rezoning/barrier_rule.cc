// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/barrier_rule.h>
#include <alveolus/rezoning/mesh_newton.h>
#include <alveolus/rezoning/node_sets.h>

#include <deal.II/base/mpi.h>

#include <cmath>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  BarrierRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Regions whose inner nodes are smoothed.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter(
      "Shapes",
      shapes,
      "The wanted cells. initial: those of the start (or of the last remesh), "
      "so that a graded mesh stays graded; equal: equal squares (cubes).",
      Patterns::Selection("initial|equal"));
    prm.add_parameter("Size weight",
                      size_weight,
                      "Weight g of the size beside the shape [-].",
                      Patterns::Double(0., 0.99));
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Strain of the cells by a whole Newton step that is the "
                      "last one [-]; the error is about its square.",
                      Patterns::Double(1e-14, 1.));
    prm.add_parameter("Largest number of iterations",
                      largest_iterations,
                      "Newton iterations after which it ends as it is, which "
                      "is counted in the report.",
                      Patterns::Integer(1));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  BarrierRule<dim>::stage(const NamedSets<dim> & /*names*/,
                          const std::string & /*where*/) const
  {
    return Stage::volumes;
  }

  template <int dim>
  void
  BarrierRule<dim>::attach(const Nodes<dim>       &nodes,
                           const NodalVector      &positions,
                           const std::set<NodeId> &taken,
                           const std::string      &where)
  {
    require_names(on, where);
    const auto &configuration = nodes.configuration;
    system.reset(); // refers to the constraints
    energy.reset();

    touched.clear();
    std::vector<std::set<types::material_id>> regions;
    for (const std::string &name : on)
      {
        regions.push_back(configuration.mesh.names.region(name, where + "/On"));
        const auto inside = inner_nodes(name, nodes, taken, where);
        touched.insert(touched.end(), inside.begin(), inside.end());
      }

    is_free = configuration.make_vector();
    is_free.zero_out_ghost_values();
    for (const NodeId node : touched)
      for (const auto dof : nodes.dofs(node))
        is_free(dof) = 1.;
    is_free.update_ghost_values();
    constraints.clear();
    constraints.reinit(configuration.locally_relevant);
    for (const auto dof : configuration.locally_relevant)
      if (is_free(dof) == 0.)
        constraints.add_line(dof);
    constraints.close();

    if (is_free.linfty_norm() == 0.)
      return;
    energy = std::make_unique<MeshEnergy<dim>>(nodes,
                                               positions,
                                               regions,
                                               is_free,
                                               shapes == "initial",
                                               ShapeMetric<dim>(size_weight),
                                               where);
    system = make_linear_system(configuration.dof_handler,
                                constraints,
                                "automatic",
                                1e-12);
  }

  template <int dim>
  bool
  BarrierRule<dim>::approach(const NodalVector &lagrangian,
                             const NodalVector &proposed,
                             NodalVector       &x,
                             RezoningReport    &report) const
  {
    constexpr double       least_stage = 1. / 64.;
    constexpr double       rough       = 0.1;
    constexpr unsigned int few         = 10;

    x = lagrangian;
    x.update_ghost_values();
    NodalVector motion(x), force(x), trial(x);
    const auto  is_valid = [&](const double stage) {
      trial = x;
      trial.zero_out_ghost_values();
      trial.add(stage, motion);
      trial.update_ghost_values();
      return std::isfinite(energy->value(trial));
    };
    if (!std::isfinite(energy->value(x)))
      return false;
    double done = 0.;
    while (done < 1.)
      {
        // The motion of the boundary; inside its tangent, so that the energy
        // stays smallest. The tangent is that of a minimum only.
        report.sweeps += minimise(*energy, *system, rough, few, x).iterations;
        for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
          motion.local_element(i) =
            is_free.local_element(i) != 0.
              ? 0.
              : proposed.local_element(i) - lagrangian.local_element(i);
        motion.update_ghost_values();
        energy->hessian_times(x, motion, force);
        energy->hessian(x, *system, false);
        force *= -1.;
        system->solve(trial, force);
        motion.zero_out_ghost_values();
        trial.zero_out_ghost_values();
        motion += trial;

        double stage = 1. - done;
        while (!is_valid(stage))
          {
            stage *= 0.5;
            if (stage < least_stage)
              return false;
          }
        // Half of what is possible: from the brink it takes many iterations.
        if (stage < 1. - done)
          is_valid(stage *= 0.5);
        x.swap(trial);
        done += stage;
      }
    return true;
  }

  template <int dim>
  void
  BarrierRule<dim>::apply(const Nodes<dim> & /*nodes*/,
                          const NodalVector & /*start*/,
                          const NodalVector &lagrangian,
                          NodalVector       &proposed,
                          RezoningReport    &report) const
  {
    if (!energy)
      return;
    energy->fit_sizes(proposed);
    NodalVector x(proposed);
    x.update_ghost_values();
    if (!std::isfinite(energy->value(x)) &&
        !approach(lagrangian, proposed, x, report))
      {
        ++report.unconverged_rules;
        return;
      }
    const auto result =
      minimise(*energy, *system, tolerance, largest_iterations, x);
    report.sweeps += result.iterations;
    if (!result.converged)
      ++report.unconverged_rules;
    // The nodes that do not move must keep every digit.
    for (unsigned int i = 0; i < x.locally_owned_size(); ++i)
      if (is_free.local_element(i) != 0.)
        proposed.local_element(i) = x.local_element(i);
    proposed.update_ghost_values();
  }

  template class BarrierRule<2>;
  template class BarrierRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::BarrierRule,
  "barrier",
  "Smoothing of the nodes inside each region of `On` that cannot invert a "
  "valid mesh: target-matrix optimisation (Knupp, Eng. Comput. 28 (2012) 419; "
  "Dobrev et al., SIAM J. Sci. Comput. 41 (2019) B50). The nodes go where the "
  "mean of mu(T) over sample points of the cells is smallest, T = c A W^-1, A "
  "the Jacobian of a cell, W that of the wanted one (`Shapes`), c a number "
  "that makes the wanted cells fill the region, d the dimension, mu = (1 - g) "
  "(|T|^d / (d^(d/2) det T) - 1) + g ((det T + 1/det T)/2 - 1), g = `Size "
  "weight`. Samples are the points where the quality is measured and the "
  "quadrature points: at all of them mu is infinite for det T <= 0, the "
  "barrier. With `Shapes` = initial the mesh of the start and all its affine "
  "images are kept. Newton's method for all nodes at once with a line search "
  "over valid meshes, until a whole step strains no cell by more than "
  "`Tolerance`; iterations count as sweeps. Where earlier rules move the "
  "boundary so far that the mesh becomes invalid, the boundary goes there in "
  "stages; if the Lagrangian mesh is invalid, nothing is moved, which counts "
  "as not converged. Nodes at the boundary of a region, at that of the "
  "domain, and nodes of points, lines and surfaces with rules stay where they "
  "are. Runs with the volumes.")
