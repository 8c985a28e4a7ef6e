// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_rim_depth_h
#define alveolus_io_rim_depth_h

#include <alveolus/io/recorder.h>

namespace alveolus
{
  /**
   * Depth of a free boundary, such as a meniscus of the ligament, in 2D: of the
   * nodes of a named boundary piece the distance from the chord between its
   * ends that is largest in magnitude [mm], positive outwards (convex),
   * negative into the body (concave); and the length of the chord [mm].
   */
  class RimDepth : public Recorder<2>
  {
  public:
    /** Adds `On`, a boundary piece that is not closed. */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    /** Find the piece and its two ends. @throws InputError */
    void
    attach(const State<2> &state, const std::string &where) override;
    /** Depths now [mm]. */
    std::vector<Recorded>
    record(const State<2> &state, const NodalVector &reactions) const override;

  private:
    std::string         on;
    std::vector<NodeId> curve;
    /** End nodes of its faces on owned cells, the body on their left. */
    std::vector<std::pair<NodeId, NodeId>> faces;
  };
} // namespace alveolus

#endif
