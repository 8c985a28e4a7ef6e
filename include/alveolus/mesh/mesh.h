// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_mesh_h
#define alveolus_mesh_mesh_h

#include <deal.II/base/point.h>
#include <deal.II/distributed/tria.h>

#include <map>
#include <memory>
#include <set>
#include <string>

namespace alveolus
{
  /**
   * Names of points, curves, boundaries and regions, and the ids by which the
   * triangulation knows them. Every line of the mesh that belongs to a named
   * curve carries the tag of its elementary curve as manifold id, and as
   * boundary id too where it is at the boundary (in 3D boundary faces carry the
   * tag of their elementary surface as boundary id); both are inherited under
   * refinement. A name stands for one or several tags.
   *
   * In 2D a curve that lies at the boundary may have no tag of its own where
   * the manifold id is needed for a curved manifold: whether a line is on a
   * curve is therefore a question to is_on_curve(), never to the ids alone.
   */
  template <int dim>
  struct NamedSets
  {
    std::map<std::string, dealii::Point<dim>> points; ///< in the initial mesh
    /** Manifold ids of the lines of a curve (interior or at the boundary). */
    std::map<std::string, std::set<dealii::types::manifold_id>> curves;
    /** Boundary ids of the faces of a boundary piece. */
    std::map<std::string, std::set<dealii::types::boundary_id>> boundaries;
    /** Material ids of the cells of a region. */
    std::map<std::string, std::set<dealii::types::material_id>> regions;

    /**
     * Ids of the named set, or an InputError that names @p where (the
     * parameter that used the name) and lists the known names.
     */
    const dealii::Point<dim> &
    point(const std::string &name, const std::string &where) const;
    /** Manifold ids of a curve. @throws InputError */
    const std::set<dealii::types::manifold_id> &
    curve(const std::string &name, const std::string &where) const;
    /** Boundary ids of a piece of boundary. @throws InputError */
    const std::set<dealii::types::boundary_id> &
    boundary(const std::string &name, const std::string &where) const;
    /** Material ids of a region. @throws InputError */
    const std::set<dealii::types::material_id> &
    region(const std::string &name, const std::string &where) const;

    /**
     * Whether @p line (an iterator to a line, in 2D a face, of the
     * triangulation or of a DoFHandler on it) is part of the curve @p name: its
     * manifold id is one of the curve's or, in 2D, it is at the boundary with a
     * boundary id of the boundary piece of that name.
     * @throws InputError if there is no such curve
     */
    template <class LineIterator>
    bool
    is_on_curve(const LineIterator &line, const std::string &name) const
    {
      if (curve(name, "curve").count(line->manifold_id()) != 0)
        return true;
      if constexpr (dim == 2)
        {
          const auto piece = boundaries.find(name);
          return piece != boundaries.end() && line->at_boundary() &&
                 piece->second.count(line->boundary_id()) != 0;
        }
      else
        return false;
    }
  };

  /** A triangulation with its names. Its vertices never move. */
  template <int dim>
  struct Mesh
  {
    std::unique_ptr<dealii::parallel::distributed::Triangulation<dim>>
                   triangulation; ///< cells and ids, at the initial positions
    NamedSets<dim> names;         ///< names of ids and points
    std::string    description;   ///< one line for the log
  };
} // namespace alveolus

#endif
