// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/surface_rule.h>

#include <deal.II/base/mpi.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  void
  SurfaceRule::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Smooth surfaces: boundaries, and interfaces of two "
                      "regions as 'a|b'.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter("Stay on material",
                      stay,
                      "Whether the nodes go back onto the surface where the "
                      "material took it, or keep the harmonic positions, e.g. "
                      "on an interface of two blocks of the same material, "
                      "which is part of the mesh only.",
                      Patterns::Bool());
  }



  RezoningRule<3>::Stage
  SurfaceRule::stage(const NamedSets<3> & /*names*/,
                     const std::string & /*where*/) const
  {
    return Stage::surfaces;
  }



  void
  SurfaceRule::attach(const Nodes<3>         &nodes,
                      const NodalVector      &positions,
                      const std::set<NodeId> &taken,
                      const std::string      &where)
  {
    require_names(on, where);
    const MPI_Comm communicator = nodes.configuration.communicator();
    patches.clear();
    touched.clear();
    solver.clear();
    batches.clear();
    std::vector<std::size_t> load(
      Utilities::MPI::n_mpi_processes(communicator));
    std::set<NodeId> freed; // by the batch
    for (const std::string &name : on)
      {
        patches.emplace_back(nodes, positions, taken, name, where + "/On");
        SurfacePatch &patch = patches.back();
        solver.push_back(std::min_element(load.begin(), load.end()) -
                         load.begin());
        load[solver.back()] += patch.nodes.size();
        if (solver.back() == Utilities::MPI::this_mpi_process(communicator))
          patch.factorise();
        bool depends = batches.empty();
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          if (!patch.is_free[i] && freed.count(patch.nodes[i]) > 0)
            depends = true;
        if (depends)
          {
            batches.push_back(
              Batch{static_cast<unsigned int>(patches.size()) - 1, 0});
            freed.clear();
          }
        batches.back().last = patches.size();
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          if (patch.is_free[i])
            {
              freed.insert(patch.nodes[i]);
              if (nodes.is_relevant(patch.nodes[i]))
                touched.push_back(patch.nodes[i]);
            }
      }
  }



  std::vector<std::vector<SurfacePatch::Place>>
  SurfaceRule::harmonic(const Batch       &batch,
                        const Nodes<3>    &nodes,
                        const NodalVector &proposed) const
  {
    const MPI_Comm communicator = nodes.configuration.communicator();
    // First what all take part in, so that no process waits for another's
    // solution
    std::vector<std::vector<SurfacePatch::Place>> x;
    for (unsigned int p = batch.first; p < batch.last; ++p)
      x.push_back(nodes.gather(proposed, patches[p].nodes));
    std::vector<double> all; // each from its process, the others add zero
    for (unsigned int p = batch.first; p < batch.last; ++p)
      if (solver[p] == Utilities::MPI::this_mpi_process(communicator))
        for (const auto &place : patches[p].harmonic(x[p - batch.first]))
          for (unsigned int c = 0; c < 3; ++c)
            all.push_back(place[c]);
      else
        all.resize(all.size() + 3 * patches[p].nodes.size(), 0.);
    Utilities::MPI::sum(all, communicator, all);
    const double *next = all.data();
    for (auto &places : x)
      for (auto &place : places)
        for (unsigned int c = 0; c < 3; ++c)
          place[c] = *next++;
    return x;
  }



  void
  SurfaceRule::apply(const Nodes<3> &nodes,
                     const NodalVector & /*start*/,
                     const NodalVector &lagrangian,
                     NodalVector       &proposed,
                     RezoningReport & /*report*/) const
  {
    for (const Batch &batch : batches)
      {
        auto positions = harmonic(batch, nodes, proposed);
        for (unsigned int p = batch.first; p < batch.last; ++p)
          {
            const SurfacePatch &patch = patches[p];
            auto               &x     = positions[p - batch.first];
            if (stay)
              {
                std::vector<bool> wanted(x.size());
                for (unsigned int i = 0; i < x.size(); ++i)
                  wanted[i] = nodes.is_owned(patch.nodes[i]);
                patch.project(nodes.gather(lagrangian, patch.nodes), wanted, x);
              }
            for (unsigned int i = 0; i < x.size(); ++i)
              if (patch.is_free[i] && nodes.is_owned(patch.nodes[i]))
                nodes.set(proposed, patch.nodes[i], x[i]);
          }
      }
    proposed.update_ghost_values();
  }
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::RezoningRule<3>,
  alveolus::SurfaceRule,
  "surface",
  "The nodes inside each surface of `On` (a boundary, or the interface a|b of "
  "two regions; 3D) are smoothed on the surface they lie on: first their "
  "displacement since the start or the last remesh becomes harmonic between "
  "the rim of the surface and nodes that rules of earlier stages set, sum w_j "
  "(d_j - d) = 0 with the weights of linear finite elements on the triangles "
  "of a node with its neighbours, as in the rule Giuliani; then (`Stay on "
  "material`) they go back onto the surface through the Lagrangian positions, a quadratic height "
  "function around each node. Planes stay planes, and there all affine motions "
  "of the rim are followed exactly. The rim keeps what line rules or the "
  "material gave. A surface must not have edges inside. Runs with the "
  "surfaces.")
