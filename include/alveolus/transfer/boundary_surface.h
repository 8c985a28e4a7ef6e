// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_boundary_surface_h
#define alveolus_transfer_boundary_surface_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/face_history.h>

#include <deal.II/base/point.h>

#include <array>
#include <vector>

namespace alveolus
{
  /**
   * A boundary face in space with its history, kept by every process. It is
   * divided into sub-quadrilaterals, one for each point of the history, by a
   * grid of lines in its unit coordinates.
   */
  struct BoundaryFace
  {
    /** Ids of the vertices, lexicographic in the face's coordinates. */
    std::array<dealii::types::global_dof_index, 4> vertex;
    std::vector<dealii::Point<3>> before; ///< grid points, lexicographic [mm]
    std::vector<dealii::Point<3>> after;  ///< the same, moved [mm]
    dealii::Point<3>              inside; ///< of its cell: middle, before [mm]
    std::vector<double>           values; ///< by sub-quadrilateral, component

    /** For Boost.Serialization. */
    template <class Archive>
    void
    serialize(Archive &archive, const unsigned int)
    {
      archive &vertex &before &after &inside &values;
    }
  };

  /**
   * The faces of all processes, those of each in the order of its records
   * (collective).
   * @param first_own number of the first face of this process
   */
  std::vector<BoundaryFace>
  gather_faces(const Configuration<3> &configuration,
               const FaceHistory<3>   &history,
               const NodalVector      &x_before,
               const NodalVector      &x_after,
               unsigned int           &first_own);

  /**
   * The sub-quadrilaterals of faces as a surface: which share which edges, and
   * how history passes through these when the nodes slide along the surface.
   */
  class BoundarySurface
  {
  public:
    /**
     * @param faces the values of which will be moved
     * @throws RunError if more than two sub-quadrilaterals meet in an edge, or
     *         two that have opposite sides
     */
    BoundarySurface(std::vector<BoundaryFace> &faces,
                    const unsigned int         n_points,
                    const unsigned int         n_components);

    /** Number of sub-quadrilaterals, face by face. */
    unsigned int
    n_subs() const
    {
      return corners.size();
    }

    /** Corners of a sub-quadrilateral, before [mm], counterclockwise seen from
     * outside. */
    std::array<dealii::Point<3>, 4>
    places(const unsigned int sub) const
    {
      std::array<dealii::Point<3>, 4> result;
      for (unsigned int k = 0; k < 4; ++k)
        result[k] = before[corners[sub][k]];
      return result;
    }

    /** Areas [mm^2] and integrals of all components [unit mm^2]. */
    double
    integrate(const bool after, std::vector<double> &integral) const;

    /**
     * Move the values from the positions before to those after. Through each
     * edge goes the area that it sweeps, times the value of the
     * sub-quadrilateral that gives it away; where one would give more than half
     * of its area, in several parts. An edge at the rim takes its own value
     * along.
     * @throws RunError if a sub-quadrilateral vanishes on the way
     * @return largest motion of a point normal to the surface [mm]
     */
    double
    transfer();

  private:
    /** An edge with its sub-quadrilaterals. */
    struct Edge
    {
      std::array<unsigned int, 2> corner; ///< as the first one goes round
      std::array<unsigned int, 2> side;   ///< the second one may be none
    };

    /** Position of a corner after part @p fraction of its way. */
    dealii::Point<3>
    place(const unsigned int corner, const double fraction) const;
    /** Area times normal of a sub-quadrilateral. */
    dealii::Tensor<1, 3>
    area(const unsigned int sub, const double fraction) const;
    /**
     * Find the areas at part @p from of the way, and what edges sweep from
     * there to part @p to; @return the largest part of its area that a
     * sub-quadrilateral gives away.
     */
    double
    sweep(const double from, const double to);
    /** What @p sub gains by its edge number @p k [mm^2]. */
    double
    gain(const unsigned int sub, const unsigned int k) const;

    std::vector<BoundaryFace>               &faces;
    const unsigned int                       n_points, n_components;
    std::vector<dealii::Point<3>>            before, after; ///< of the corners
    std::vector<std::array<unsigned int, 4>> corners; ///< of each, outside left
    std::vector<Edge>                        edges;
    std::vector<std::array<unsigned int, 4>> edges_of; ///< of each
    std::vector<double>                      sizes;    ///< of each [mm^2]
    std::vector<double> swept; ///< by edge, for its first side [mm^2]
  };
} // namespace alveolus

#endif
