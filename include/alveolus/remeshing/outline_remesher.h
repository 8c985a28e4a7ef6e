// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remeshing_outline_remesher_h
#define alveolus_remeshing_outline_remesher_h

#include <alveolus/remeshing/body_outline.h>
#include <alveolus/remeshing/remesher.h>
#include <alveolus/remeshing/zone_mesher.h>

#include <map>
#include <memory>

namespace alveolus
{
  /**
   * New meshes within the outlines and interfaces of the deformed body.
   * Outlines are taken apart (extract_outline()); a piece keeps its nodes, or
   * gets new ones on the cubic spline through its old ones. Regions are kept,
   * smoothed (inner vertices move), treated as strips (only the zones at their
   * ends are meshed anew, see mesh_zone()) or meshed anew as a whole.
   */
  class OutlineRemesher : public Remesher<2>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    /**
     * @throws InputError for unknown regions or curves, regions that are named
     *        twice, and strips without ends
     */
    void
    initialize(const NamedSets<2> &names, const std::string &where) override;

    /**
     * See Remesher; one candidate for each combination of zone meshes tried.
     */
    std::vector<RemeshCandidate<2>>
    candidates(const Configuration<2> &old,
               const std::string      &output_directory,
               const std::string      &name) const override;

  private:
    std::vector<std::string>      kept, smoothed, strips, strip_ends;
    std::vector<double>           zone_lengths = {0.6, 0.4, 0.9}; ///< [mm]
    std::map<std::string, double> edge_lengths;        ///< by curve [mm]
    std::map<std::string, unsigned int> edge_numbers;  ///< by curve
    std::map<std::string, double>       largest_edges; ///< by region [mm]
    double                              growth             = 0.25;
    double                              corner_angle       = 40.;  ///< [degree]
    double                              angle_of_two_cells = 130.; ///< [degree]
    double                              largest_area_change = 1e-3;
    unsigned int                        n_candidates        = 6;
    ZoneSettings                        zone_settings;
    PlanarMesher                        mesher;
    std::string                         where = "Remeshing";

    /** What becomes of a region. */
    enum class Treatment
    {
      keep,
      smooth,
      strip,
      mesh
    };

    Treatment
    treatment(const dealii::types::material_id material,
              const NamedSets<2>              &names) const;

    /** Nodes of a curve on the spline through its old ones, or these. */
    std::vector<dealii::Point<2>>
    nodes_of(const PlanarCurve  &curve,
             const LineIds      &ids,
             const NamedSets<2> &names) const;

    /** New meshes of the regions that are the same for all candidates, by their
     * first cells. */
    std::map<unsigned int, std::shared_ptr<const AreaMesh>>
    common_areas(const GatheredMesh &mesh,
                 const NamedSets<2> &names,
                 const MeshingJob   &job) const;
  };
} // namespace alveolus

#endif
