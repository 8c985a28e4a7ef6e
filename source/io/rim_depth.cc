// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/io/rim_depth.h>

namespace alveolus
{
  using namespace dealii;

  void
  RimDepth::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "A named boundary piece, not closed.",
                      Patterns::Anything());
  }



  void
  RimDepth::attach(const State<2> &state, const std::string &where)
  {
    const auto &configuration = state.configuration;
    const auto &ids = configuration.mesh.names.boundary(on, where + " / On");
    const NodeCurve found = state.nodes.curve(on, where + " / On");
    if (found.closed)
      throw InputError(where + " / On",
                       "'" + on + "' is closed and has no chord",
                       "name a piece with two ends");
    curve = found.nodes;
    // The end nodes of the faces in the order in which the body lies on the
    // left: of the unit cell's faces 0 and 3 in reverse.
    constexpr unsigned int ends[4][2] = {{2, 0}, {1, 3}, {0, 1}, {3, 2}};
    std::vector<NodeId>    nodes;
    faces.clear();
    for (const auto &[cell, face] : boundary_faces(configuration, ids))
      {
        state.nodes.cell_nodes(cell, nodes);
        faces.emplace_back(nodes[ends[face][0]], nodes[ends[face][1]]);
      }
  }



  std::vector<Recorded>
  RimDepth::record(const State<2> &state, const NodalVector &) const
  {
    const NodalVector  positions = state.configuration.positions();
    const auto         x         = state.nodes.gather(positions, curve);
    const Tensor<1, 2> chord     = x.back() - x.front();
    const double       length    = chord.norm();
    // Right of the chord; outwards is right of the faces.
    const Tensor<1, 2> right = Point<2>(chord[1], -chord[0]) / length;
    double             along = 0.;
    for (const auto &[a, b] : faces)
      along +=
        (state.nodes.get(positions, b) - state.nodes.get(positions, a)) * chord;
    along = Utilities::MPI::sum(along, state.configuration.communicator());
    const double sign  = along > 0. ? 1. : -1.;
    double       depth = 0.;
    for (const auto &point : x)
      {
        const double distance = sign * ((point - x.front()) * right);
        if (std::abs(distance) > std::abs(depth))
          depth = distance;
      }
    return {{"depth [mm]", depth}, {"chord [mm]", length}};
  }

  ALVEOLUS_REGISTER(
    Recorder<2>,
    RimDepth,
    "rim depth",
    "Depth [mm] of the boundary piece `On` from the chord between its ends: the "
    "distance of its nodes that is largest in magnitude, positive outwards "
    "(convex); and the length of the chord [mm]. 2D only.")
} // namespace alveolus
