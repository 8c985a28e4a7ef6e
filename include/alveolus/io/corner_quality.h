// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_corner_quality_h
#define alveolus_io_corner_quality_h

#include <alveolus/io/recorder.h>

namespace alveolus
{
  /**
   * The elements of named regions that meet at named points, such as those of
   * the ligament at the corners of its margin: how many there are, their
   * smallest scaled Jacobian at that corner, and over all their corners, and
   * (2D) the angle [degrees] that they fill there. An angle of an element
   * beyond 180 degrees counts as such: between 180 and 360.
   */
  template <int dim>
  class CornerQuality : public Recorder<dim>
  {
  public:
    /** Adds `On`, named points, and `Region`, whose elements count. */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    using Cell = typename dealii::DoFHandler<dim>::active_cell_iterator;
    struct Corner
    {
      std::string name;
      /** Owned cells of the regions there, and which vertex it is of them. */
      std::vector<std::pair<Cell, unsigned int>> cells;
    };

    std::string         on, region;
    std::vector<Corner> corners;
  };
} // namespace alveolus

#endif
