// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_scene_scene_h
#define alveolus_scene_scene_h

#include <alveolus/assembly/mechanics_assembler.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/io/recorder.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/remeshing/remesh_plan.h>
#include <alveolus/remeshing/remesher.h>
#include <alveolus/rezoning/rezoner.h>
#include <alveolus/rezoning/rezoning_plan.h>
#include <alveolus/scene/accuracy.h>
#include <alveolus/scene/parameter_text.h>
#include <alveolus/solver/staggered_step.h>
#include <alveolus/solver/step_control.h>
#include <alveolus/transfer/transfer_scheme.h>

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <memory>

namespace alveolus
{
  /**
   * A parameter file turned into objects. A scene is composed of named parts:
   * the collections Regions, Materials, Interfaces, Remodelling, Conditions,
   * Rezoning and Records list their members in `Names`; each member is a
   * subsection whose `Type` chooses a registered class, which declares its own
   * parameters. The constructor makes the objects, so that they can declare,
   * and then sets every entry strictly.
   */
  template <int dim>
  class Scene
  {
  public:
    /** @throws InputError with every problem of the parameter file */
    explicit Scene(const ParameterText &text);
    Scene(const Scene &) = delete; // `text` refers to a member
    Scene &
    operator=(const Scene &) = delete;

    struct Region
    {
      std::string name;     ///< of its subsection
      std::string on;       ///< regions of the mesh, by commas
      std::string material; ///< name in Materials
      /** Of volume, against locking. */
      std::string treatment   = "mean dilatation";
      std::string remodelling = "none"; ///< name in Remodelling, or "none"
      /** history, reference map or isochoric reference map */
      std::string deformation = "history";
    };

    template <class Interface>
    struct Named
    {
      std::string                name;   ///< of its subsection
      std::string                where;  ///< path of the subsection
      std::string                type;   ///< registered name of its class
      std::unique_ptr<Interface> object; ///< with its parameters
    };

    std::string  title;      ///< for reports and pictures
    unsigned int degree = 1; ///< of elements: 1 or 2
    /** Larger meshes are refused. */
    unsigned int largest_number_of_cells = 10000000;
    std::string  mesh_type; ///< registered name of the mesh source

    std::unique_ptr<MeshSource<dim>> mesh_source; ///< makes the first mesh
    std::vector<Region>              regions;     ///< every cell is in one
    std::vector<Named<Material>>     materials;   ///< by name, for regions
    /** By name, for conditions. */
    InterfaceLaws interface_laws;
    /** By name, for regions. */
    std::vector<Named<RemodellingLaw>> remodelling_laws;
    /** Loads, supports, rigid bodies, contacts, layers. */
    std::vector<Named<Condition<dim>>> conditions;
    /** In the order of the file. */
    std::vector<Named<RezoningRule<dim>>> rezoning_rules;
    /** Columns of the history file. */
    std::vector<Named<Recorder<dim>>> recorders;

    typename Equilibrium<dim>::Parameters solver; ///< of Newton's method
    /** Of equilibrium and remodelling. */
    typename StaggeredStep<dim>::Parameters coupling;

    RezoningPlan rezoning_plan; ///< when to rezone

    std::string transfer_scheme = "Godunov"; ///< registered name
    /** Of a sub-cell swept in a subcycle of the transfer [-]. */
    double largest_donor_fraction = 0.5;

    /** Registered name, or "none". */
    std::string                    remesher_type = "none";
    std::unique_ptr<Remesher<dim>> remesher; ///< null if there is none
    /** When to remesh, and what is accepted. */
    RemeshPlan::Parameters remesh_plan;

    /** "stop" rejects the step, "report" counts. */
    std::string inverted_corners = "stop";
    double      minimum_quality  = -1.;  ///< the run stops below it; -1: never
    bool        energy_balance   = true; ///< whether books of energy are kept
    /** The log tells what is below; -1: never. */
    double warn_quality = 0.3;

    StepControl::Parameters time; ///< of steps and the end

    std::string output_directory;    ///< created if need be
    double      field_interval = 0.; ///< of files [T]; 0: first and last state
    bool        fields         = true; ///< whether there are files of fields

    CheckpointFolder::Parameters checkpoint; ///< when to write them

    /** Index of the remodelling law of a region, or -1. */
    int
    remodelling_of(const Region &region) const;
    /** Index of the material of a region. */
    unsigned int
    material_of(const Region &region) const;

    /**
     * The same scene once more, with objects of its own: for another mesh,
     * since conditions, rules and recorders are attached to one.
     */
    std::shared_ptr<Scene<dim>>
    another() const
    {
      return std::make_shared<Scene<dim>>(all_statements);
    }

    /** The statements the scene was made of, with all accuracy levels. */
    const ParameterText &
    parameter_text() const
    {
      return all_statements;
    }

    /** The accuracy levels and what was chosen. */
    const AccuracyLevels &
    accuracy() const
    {
      return accuracy_levels;
    }

    /** The resolved parameters, with defaults, in the input format. */
    void
    write_resolved(std::ostream &out) const;

  private:
    void
    declare();

    template <class Interface>
    std::vector<Named<Interface>>
    make_collection(const std::string &section);

    /** References between parts: every problem. @throws InputError */
    void
    check_parts();

    const ParameterText             &all_statements;
    AccuracyLevels                   accuracy_levels;
    const ParameterText             &text;     ///< of the chosen level
    std::vector<std::string>         problems; ///< until all is declared
    std::set<std::string>            unknown;  ///< parts of unknown types
    dealii::ParameterHandler         prm;
    std::vector<Named<InterfaceLaw>> interface_law_list;
  };

  /**
   * Reference of every registered class with its text and parameters, and of
   * the fixed sections, as Markdown.
   */
  void
  write_reference(std::ostream &out);
} // namespace alveolus

#endif
