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
    const MPI_Comm     communicator = nodes.configuration.communicator();
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
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
        for (unsigned int &process : solver.emplace_back())
          {
            process = std::min_element(load.begin(), load.end()) - load.begin();
            load[process] += patch.nodes.size();
          }
        if (std::count(solver.back().begin(), solver.back().end(), me) > 0)
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



  namespace
  {
    using Places = std::vector<std::vector<SurfacePatch::Place>>;

    /** Positions of the nodes of @p patches, patch by patch (collective). */
    Places
    gather(const Nodes<3>     &nodes,
           const NodalVector  &positions,
           const SurfacePatch *patches,
           const unsigned int  n_patches)
    {
      std::vector<NodeId> all;
      for (unsigned int p = 0; p < n_patches; ++p)
        all.insert(all.end(), patches[p].nodes.begin(), patches[p].nodes.end());
      const auto x    = nodes.gather(positions, all);
      auto       next = x.begin();
      Places     places(n_patches);
      for (unsigned int p = 0; p < n_patches; ++p)
        {
          places[p].assign(next, next + patches[p].nodes.size());
          next += patches[p].nodes.size();
        }
      return places;
    }

    /** What each process has found, where the others have zero (collective). */
    void
    sum(Places &places, const MPI_Comm &communicator)
    {
      std::vector<double> all;
      for (const auto &patch : places)
        for (const auto &place : patch)
          all.insert(all.end(), place.begin_raw(), place.end_raw());
      Utilities::MPI::sum(all, communicator, all);
      const double *next = all.data();
      for (auto &patch : places)
        for (auto &place : patch)
          for (unsigned int c = 0; c < 3; ++c)
            place[c] = *next++;
    }
  } // namespace



  void
  SurfaceRule::apply(const Nodes<3> &nodes,
                     const NodalVector & /*start*/,
                     const NodalVector &lagrangian,
                     NodalVector       &proposed,
                     RezoningReport & /*report*/) const
  {
    const MPI_Comm     communicator = nodes.configuration.communicator();
    const unsigned int me = Utilities::MPI::this_mpi_process(communicator);
    const unsigned int n  = Utilities::MPI::n_mpi_processes(communicator);
    for (const Batch &batch : batches)
      {
        const SurfacePatch *first     = &patches[batch.first];
        const unsigned int  n_patches = batch.last - batch.first;
        Places              x = gather(nodes, proposed, first, n_patches);
        for (unsigned int p = 0; p < n_patches; ++p)
          {
            const auto held = x[p];
            x[p].assign(held.size(), SurfacePatch::Place());
            for (unsigned int c = 0; c < 3; ++c)
              if (solver[batch.first + p][c] == me)
                first[p].harmonic(held, c, x[p]);
          }
        sum(x, communicator);

        if (stay)
          {
            // Each process takes as many nodes as the others, whoever owns them
            const Places surface = gather(nodes, lagrangian, first, n_patches);
            for (unsigned int p = 0; p < n_patches; ++p)
              {
                const std::size_t size  = x[p].size();
                const std::size_t begin = size * me / n;
                const std::size_t end   = size * (me + 1) / n;
                first[p].project(surface[p], begin, end, x[p]);
                for (std::size_t i = 0; i < size; ++i)
                  if (i < begin || i >= end)
                    x[p][i] = SurfacePatch::Place();
              }
            sum(x, communicator);
          }
        for (unsigned int p = 0; p < n_patches; ++p)
          for (unsigned int i = 0; i < x[p].size(); ++i)
            if (first[p].is_free[i] && nodes.is_owned(first[p].nodes[i]))
              nodes.set(proposed, first[p].nodes[i], x[p][i]);
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
