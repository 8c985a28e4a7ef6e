// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_transfer_overlap_transfer_h
#define alveolus_transfer_overlap_transfer_h

#include <alveolus/mesh/configuration.h>
#include <alveolus/state/history_store.h>
#include <alveolus/transfer/cell_search.h>
#include <alveolus/transfer/history_picture.h>
#include <alveolus/transfer/sub_cell_overlap.h>

#include <string>
#include <vector>

namespace alveolus
{
  /** What an overlap transfer did (over all processes). */
  struct OverlapReport
  {
    /** One region; contents of the chosen scalar field [unit mm^dim]. */
    struct Region
    {
      double volume_before = 0.; ///< of the old mesh [mm^dim]
      double volume_after  = 0.; ///< of the new mesh [mm^dim]
      /** Part of the new region that no old sub-cell of it covers [mm^dim]. */
      double uncovered = 0.;
      /** Smallest covered part of a new sub-cell's volume. */
      double least_covered  = 1.;
      double content_before = 0.; ///< on the old mesh [unit mm^dim]
      double content_after  = 0.; ///< on the new mesh [unit mm^dim]
      /** What the parts of the new region that no old sub-cell covers have, and
       * what those of the old one had that no new one covers. So content_after
       * = content_before + gained - lost but for round-off and for values
       * brought back into bounds. */
      double content_gained = 0.;
      double content_lost   = 0.; ///< see content_gained
    };

    std::vector<Region> regions; ///< in the scene's order
    /** New sub-cells outside the old region, which took the nearest value. */
    unsigned int n_uncovered = 0;
    /** Values brought back into field bounds from beyond round-off. */
    unsigned int n_limited = 0;
    /** Old pieces with inverted corners, of which a part was taken. */
    unsigned int n_folded = 0;

    /** New nodes outside the old mesh. */
    unsigned int n_nodes_outside  = 0;
    double       largest_distance = 0.; ///< of those from the old mesh [mm]

    /** Sum of the contents of all regions. */
    double
    content_before() const;
    /** The same on the new mesh. */
    double
    content_after() const;
    /** Of all regions, what is gained less what is lost at outlines. */
    double
    content_gained() const;
    /** Largest uncovered part of a region's volume. */
    double
    largest_uncovered_part() const;
  };

  /**
   * History and nodal fields from an old mesh to an unrelated new one (theory,
   * section 7): the new mean over a sub-cell is that of the old function, by
   * the exact overlap of old and new sub-cells of the same region (regions
   * never mix). With the scheme "Godunov" the old function is constant on each
   * old sub-cell (first order), with "limited linear" it is phi + l grad phi .
   * (x - x_centroid) (second order), where l = 1 unless a new mean would leave
   * the range of the old values around (see CorrectionLimiter; no new extrema).
   * Where the old and new region coincide, contents (sums of volume x value)
   * are conserved; where they do not, the mean is over the covered part, so
   * that constants are always exact.
   *
   * The constructor takes a picture of the old state (see HistoryPicture),
   * which may be gone or changed when transfer() is called. Results do not
   * depend on the number of processes.
   *
   * Sub-cells are what SubCellShapes makes of them: exact for degree 1 in 2D;
   * their areas are exact for degree 2 in 2D, their volumes for degree 1 in 3D.
   * Cells without hanging nodes only.
   */
  template <int dim>
  class OverlapTransfer
  {
  public:
    /** How much the new mesh may leave the old one. */
    struct Limits
    {
      /** Uncovered part of a region's volume. */
      double uncovered = 0.02;
      /** Distance of a node in unit coordinates of the nearest old cell. */
      double excess = 1.;
    };

    /**
     * Takes the picture (collective).
     * @param scheme        name of the transfer scheme
     * @param content_field the scalar field whose contents are reported
     */
    OverlapTransfer(const Configuration<dim> &old_configuration,
                    const HistoryStore<dim>  &old_store,
                    const std::string        &scheme,
                    const std::string        &content_field = "density",
                    const Limits             &limits        = Limits());

    /**
     * Fill the old records of @p new_store, owned and ghost ones (collective).
     * Regions and layouts must be those of the old store; trial records are
     * not touched.
     * @throws RunError if more of a region is uncovered than allowed, or the
     *         stores do not fit together
     */
    OverlapReport
    transfer(const Configuration<dim> &new_configuration,
             HistoryStore<dim>        &new_store) const;

    /**
     * The nodal vector @p u_old of the old configuration, evaluated at the
     * current positions of the nodes of the new one (collective). A node is
     * searched in the old cells of the regions it belongs to; one that
     * coincides with an old node gets its value to the last bit. A node outside
     * takes the polynomial of the nearest cell and is counted in @p report.
     * @param new_store gives the regions of the new cells
     * @return a ghosted nodal vector of the new configuration
     * @throws RunError if a node is farther outside than allowed
     */
    NodalVector
    nodal(const NodalVector        &u_old,
          const Configuration<dim> &new_configuration,
          const HistoryStore<dim>  &new_store,
          OverlapReport            &report) const;

  private:
    using NodeTensors = typename CellNodes<dim>::NodeTensors;

    using Target = OverlapTarget<dim>;

    void
    check_fit(const HistoryStore<dim> &new_store) const;

    /** Gradients of the old means. */
    void
    reconstruct();

    /** The new mean of the old constants. */
    void
    constant_part(const Target      &target,
                  const unsigned int size,
                  double            *result) const;

    /** Add the part of the old gradients to the new means (collective). */
    void
    add_linear_part(const std::vector<Target> &targets,
                    HistoryStore<dim>         &new_store) const;

    const Limits              limits;
    const std::string         content_field;
    const bool                second_order;
    const HistoryPicture<dim> old;
    const SubCellOverlap<dim> overlap;
    const CellSearch<dim>     search;
    std::vector<double>       old_volume, old_content; ///< by region
    /** By old sub-cell, value and direction, if of second order. */
    std::vector<std::vector<double>> gradient;
  };
} // namespace alveolus

#endif
