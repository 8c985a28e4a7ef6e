// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/node_sets.h>
#include <alveolus/rezoning/surface_rule.h>

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
    patches.clear();
    touched.clear();
    for (const std::string &name : on)
      {
        patches.emplace_back(nodes, positions, taken, name, where + "/On");
        const SurfacePatch &patch = patches.back();
        for (unsigned int i = 0; i < patch.nodes.size(); ++i)
          if (patch.is_free[i] && nodes.is_relevant(patch.nodes[i]))
            touched.push_back(patch.nodes[i]);
      }
  }



  void
  SurfaceRule::apply(const Nodes<3> &nodes,
                     const NodalVector & /*start*/,
                     const NodalVector &lagrangian,
                     NodalVector       &proposed,
                     RezoningReport & /*report*/) const
  {
    for (const SurfacePatch &patch : patches)
      {
        auto x = patch.harmonic(nodes.gather(proposed, patch.nodes));
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
