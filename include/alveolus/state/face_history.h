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
    using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

    /** A boundary face by its cell. */
    struct Face
    {
      typename Triangulation::active_cell_iterator cell;
      unsigned int                                 face_no;
    };

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

    double *
    old_record(const unsigned int face, const unsigned int point)
    {
      return old_values.data() + (face * n_points + point) * n_components;
    }
    const double *
    old_record(const unsigned int face, const unsigned int point) const
    {
      return old_values.data() + (face * n_points + point) * n_components;
    }
    double *
    trial_record(const unsigned int face, const unsigned int point)
    {
      return trial_values.data() + (face * n_points + point) * n_components;
    }
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
    std::vector<double> trial_values;

    const Triangulation &triangulation;
    const unsigned int   n_points;
    const unsigned int   n_components;

  private:
    std::vector<Face>                                             face_list;
    std::map<std::pair<unsigned int, unsigned int>, unsigned int> indices;
  };
} // namespace alveolus

#endif
