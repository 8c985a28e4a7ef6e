// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_state_history_store_h
#define alveolus_state_history_store_h

#include <alveolus/base/history_field.h>
#include <alveolus/state/ghost_exchange.h>

#include <deal.II/distributed/tria.h>

#include <map>
#include <vector>

namespace alveolus
{
  /**
   * History of all quadrature points in two flat arrays, `old` (t_n) and
   * `trial` (t_{n+1}), by active cell index. Cells belong to regions; a region
   * has one layout, and a cell stores what its region's layout says, no more.
   * Ghost cells have room too, filled by update_ghosts(). It knows nothing of
   * materials and of transport. Point q of a cell is sub-cell q of the
   * tensor-product Gauss rule, x running fastest; the stored value is the mean
   * over the sub-cell.
   */
  template <int dim>
  class HistoryStore
  {
  public:
    /** Of the mesh whose history it is. */
    using Triangulation = dealii::parallel::distributed::Triangulation<dim>;

    /**
     * @param region_of_material region index of each material id
     * @param layouts            record layout of each region
     * @throws InputError for a material id without a region
     */
    HistoryStore(const Triangulation &triangulation,
                 const std::map<dealii::types::material_id, unsigned int>
                                                  &region_of_material,
                 const std::vector<HistoryLayout> &layouts,
                 const unsigned int                n_points_per_cell);

    /** Region index of a cell (owned or ghost) by its active cell index. */
    unsigned int
    region(const unsigned int cell) const
    {
      return cell_region[cell];
    }

    /** Which fields the records of a region have. */
    const HistoryLayout &
    layout(const unsigned int region) const
    {
      return layouts[region];
    }

    /** Number of regions. */
    unsigned int
    n_regions() const
    {
      return layouts.size();
    }

    /** The values of a point of a cell at t_n. */
    double *
    old_record(const unsigned int cell, const unsigned int point)
    {
      return old_values.data() + begin[cell] +
             point * layouts[cell_region[cell]].size;
    }
    /** The values of a point of a cell at t_n. */
    const double *
    old_record(const unsigned int cell, const unsigned int point) const
    {
      return old_values.data() + begin[cell] +
             point * layouts[cell_region[cell]].size;
    }
    /** The same at the end of the step that is tried. */
    double *
    trial_record(const unsigned int cell, const unsigned int point)
    {
      return trial_values.data() + begin[cell] +
             point * layouts[cell_region[cell]].size;
    }
    /** The same at the end of the step that is tried. */
    const double *
    trial_record(const unsigned int cell, const unsigned int point) const
    {
      return trial_values.data() + begin[cell] +
             point * layouts[cell_region[cell]].size;
    }

    /** The accepted step becomes the past: old <- trial. */
    void
    commit()
    {
      old_values = trial_values;
    }

    /** Fill old records of ghost cells from their owners (collective). */
    void
    update_ghosts();

    /**
     * Where the first record of each active cell begins in the arrays;
     * n_active_cells() + 1 entries.
     */
    const std::vector<std::size_t> &
    offsets() const
    {
      return begin;
    }

    /** The pattern behind update_ghosts(), for other per-cell data. */
    const GhostExchange<dim> &
    ghost_exchange() const
    {
      return exchange;
    }

    /** Bytes in both arrays on this process. */
    std::size_t
    memory_consumption() const;

    /** All old values, for snapshots and checkpoints. */
    std::vector<double> old_values;
    std::vector<double> trial_values; ///< All values, those of t_{n+1}.

    const Triangulation &triangulation; ///< whose cells these are
    const unsigned int   n_points;      ///< of each cell

  private:
    std::vector<HistoryLayout> layouts;
    std::vector<unsigned int>  cell_region;
    std::vector<std::size_t>   begin; ///< one more than active cells
    GhostExchange<dim>         exchange;
  };
} // namespace alveolus

#endif
