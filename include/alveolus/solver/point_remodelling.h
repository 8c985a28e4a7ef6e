// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_solver_point_remodelling_h
#define alveolus_solver_point_remodelling_h

#include <alveolus/remodelling/local_integrator.h>
#include <alveolus/state/state.h>

#include <string>
#include <vector>

namespace alveolus
{
  /** The remodelling of one region: null pointers where there is none. */
  struct RegionRemodelling
  {
    const RemodellingLaw *law  = nullptr; ///< rates of density and fabric
    const RemodelledBone *bone = nullptr; ///< the material that they change
  };

  /** What remodelling did in a step, over all processes. */
  struct RemodellingSummary
  {
    double largest_density_change = 0.; ///< at a point [g/cc]
    /** Points whose fabric was kept in its bounds. */
    unsigned int n_fabric_limited      = 0;
    unsigned int n_at_lower_bound      = 0; ///< points at the lowest density
    unsigned int n_at_upper_bound      = 0; ///< points at the highest density
    unsigned int n_coupling_iterations = 0; ///< equilibria of an iterated step
    /** Points integrated by another process than that of their cell. */
    unsigned int n_shared = 0;
    std::string  failure; ///< why a point could not be integrated, if any

    // Where the books of energy are kept [mJ (per mm)]:
    /** Change of the stored energy by density and fabric at fixed strain. */
    double energy = 0.;
    /**
     * Stored at the end less stored by the last equilibrium, with the weights
     * of the mesh x_n.
     */
    double stored       = 0.;
    double stored_moved = 0.; ///< the same with those of the moved mesh
  };

  /**
   * Integrates density and fabric of all points over a step. Points in the lazy
   * zone cost nothing, others much, and these are neighbours, so that processes
   * with equally many cells have unequal work. No point needs another: on
   * several processes the first point of each cell is integrated by its owner
   * and tells the cost of the others; of these, processes with more work than
   * the mean send some to those with less, and get their records back. Who
   * integrates a point makes no difference to its result, to the last bit.
   */
  template <int dim>
  class PointRemodelling
  {
  public:
    /**
     * @param laws      by region
     * @param cells     active indices of those owned and remodelled
     * @param tolerance of the integration at a point [g/cc, and relative]
     */
    PointRemodelling(State<dim>                           &state,
                     const std::vector<RegionRemodelling> &laws,
                     const std::vector<unsigned int>      &cells,
                     const double                          tolerance);

    /**
     * Advance every trial record from the density it has over @p dt [T]
     * (collective).
     * @param stimulus of each point of the cells, in their order, instead of
     *        the points' own; or null
     * @return all but the energies
     */
    RemodellingSummary
    advance(const double dt, const std::vector<double> *stimulus) const;

  private:
    /** Some points of a cell, wherever their records are. */
    struct Task
    {
      unsigned int  region;
      unsigned int  n_points;
      double       *records;  ///< of the first one; the others follow
      const double *stimulus; ///< of the points, or null
    };

    /** What became of tasks. */
    struct Outcome
    {
      RemodellingSummary  summary; ///< of this process
      std::vector<double> seconds; ///< by task
    };

    /** For each cell the task of its points from @p first to before @p last. */
    std::vector<Task>
    tasks_of(const unsigned int         first,
             const unsigned int         last,
             const std::vector<double> *stimulus) const;

    /** Integrate the points of all @p tasks by all threads. */
    Outcome
    work_off(const std::vector<Task> &tasks, const double dt) const;

    /**
     * Integrate the points of @p mine, or let other processes do it
     * (collective).
     * @param costs of each task, in any unit that is the same for all [s]
     * @param filtered whether the tasks of all processes have a stimulus
     */
    RemodellingSummary
    share(const std::vector<Task>   &mine,
          const std::vector<double> &costs,
          const bool                 filtered,
          const double               dt) const;

    State<dim>                           &state;
    const std::vector<RegionRemodelling> &laws;
    const std::vector<unsigned int>      &cells;
    const double                          tolerance;
  };
} // namespace alveolus

#endif
