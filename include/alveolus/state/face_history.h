// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_face_history_h
#define alveolus_state_face_history_h

#include <deal.II/distributed/tria.h>

#include <map>
#include <set>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * History of a boundary, e.g. the displacement jump across an interface, in
   * two flat arrays, `old` (t_n) and `trial` (t_{n+1}): for each face with one
   * of the given boundary ids of a locally owned cell, at each face sub-cell
   * (tensor product of the Gauss weights in dim-1 directions, lexicographic in
   * the face's own unit coordinates), n_components numbers. It knows nothing of
   * the meaning of the numbers and of transport.
   */
  template <int dim>
  class FaceHistory
  {
  public:
    /** Of the mesh whose boundary it is. */
    using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

    /** A boundary face by its cell. */
    struct Face
    {
      /** That the face belongs to. */
      typename Triangulation::active_cell_iterator cell;
      /** Its number on the cell. */
      unsigned int face_no;
    };

    /**
     * @param boundary_ids of the faces that have history
     * @param n_components numbers at each point
     */
    FaceHistory(const Triangulation                        &triangulation,
                const std::set<dealii::types::boundary_id> &boundary_ids,
                const unsigned int                          n_points_per_face,
                const unsigned int                          n_components);

    /** Faces of locally owned cells, in the order of the records. */
    const std::vector<Face> &
    faces() const
    {
      return face_list;
    }

    /**
     * Number of the record of face @p face_no of the cell with active index
     * @p cell, or dealii::numbers::invalid_unsigned_int.
     */
    unsigned int
    index(const unsigned int cell, const unsigned int face_no) const;

    /** The numbers of a point of a face at t_n. */
    double *
    old_record(const unsigned int face, const unsigned int point)
    {
      return old_values.data() + (face * n_points + point) * n_components;
    }
    /** The numbers of a point of a face at t_n. */
    const double *
    old_record(const unsigned int face, const unsigned int point) const
    {
      return old_values.data() + (face * n_points + point) * n_components;
    }
    /** The same at the end of the step that is tried. */
    double *
    trial_record(const unsigned int face, const unsigned int point)
    {
      return trial_values.data() + (face * n_points + point) * n_components;
    }
    /** The same at the end of the step that is tried. */
    const double *
    trial_record(const unsigned int face, const unsigned int point) const
    {
      return trial_values.data() + (face * n_points + point) * n_components;
    }

    /** The accepted step becomes the past: old <- trial. */
    void
    commit()
    {
      old_values = trial_values;
    }

    /** All values, for snapshots and checkpoints. */
    std::vector<double> old_values;
    std::vector<double> trial_values; ///< All values, those of t_{n+1}.

    const Triangulation &triangulation; ///< whose faces these are
    const unsigned int   n_points;      ///< of each face
    const unsigned int   n_components;  ///< numbers at each point

  private:
    std::vector<Face>                                             face_list;
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> indices;
  };
} // namespace alveolus

#endif
