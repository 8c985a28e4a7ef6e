// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/problems.h>
#include <alveolus/materials/elastic_material.h>
#include <alveolus/scene/scene.h>

#include <ostream>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  Scene<dim>::Scene(const ParameterText &statements)
    : all_statements(statements)
    , accuracy_levels(statements)
    , text(accuracy_levels.statements())
  {
    declare();
    text.apply(prm, problems, unknown);
    check_parts();
    mesh_source->set_largest_number_of_cells(largest_number_of_cells);

    if (output_directory.empty())
      {
        std::string name = text.file_name.substr(
          text.file_name.find_last_of('/') == std::string::npos
            ? 0
            : text.file_name.find_last_of('/') + 1);
        output_directory = "output/" + name.substr(0, name.rfind(".prm"));
      }
  }



  template <int dim>
  void
  Scene<dim>::check_parts()
  {
    Problems found;
    for (auto &law : interface_law_list)
      {
        found.collect([&]() { law.object->initialize(law.where); });
        interface_laws[law.name] = std::move(law.object);
      }
    for (auto &law : remodelling_laws)
      found.collect([&]() { law.object->initialize(law.where); });

    // What a region names; without it nothing more can be said of the region.
    std::vector<const Region *> complete;
    for (const auto &region : regions)
      if (found.collect([&]() { material_of(region); }) &
          found.collect([&]() { remodelling_of(region); }))
        complete.push_back(&region);

    // Bone stores density and fabric only where some region remodels them.
    for (const Region *const region : complete)
      found.collect([&]() {
        const unsigned int material = material_of(*region);
        const int          law      = remodelling_of(*region);
        if (law < 0)
          return;
        auto *bone =
          dynamic_cast<RemodelledBone *>(materials[material].object.get());
        if (bone == nullptr)
          throw InputError("Regions / " + region->name + " / Remodelling",
                           "material '" + region->material + "' is a " +
                             materials[material].type +
                             ", which cannot remodel",
                           "use a material of type remodelled bone, or none");
        for (const auto &other : regions)
          if (other.material == region->material &&
              other.remodelling != region->remodelling)
            throw InputError("Regions / " + other.name + " / Remodelling",
                             "is '" + other.remodelling + "', but region '" +
                               region->name +
                               "' uses the same material with '" +
                               region->remodelling + "'",
                             "define a material of its own for it");
        bone->set_remodelled(true,
                             remodelling_laws[law].object->changes_fabric());
      });
    for (auto &material : materials)
      found.collect(
        [&]() { material.object->initialize(dim, material.where); });
    for (const Region *const region : complete)
      if (region->deformation != "history" &&
          dynamic_cast<const ElasticMaterial *>(
            materials[material_of(*region)].object.get()) == nullptr)
        found.add(text.origin("Regions/" + region->name +
                              "/Transfer of deformation") +
                    ": Regions / " + region->name +
                    " / Transfer of deformation",
                  "material '" + region->material + "' is a " +
                    materials[material_of(*region)].type +
                    ", whose stress does not follow from the total "
                    "deformation alone",
                  "use history, or a hyperelastic material");

    if (regions.empty())
      found.add(text.origin("Regions/Names"),
                "the scene has no region",
                "list at least one in Regions / Names");
    if (remesher && degree > remesher->largest_degree())
      found.add(text.origin("Mesh/Degree") + ": Mesh / Degree",
                "it is " + std::to_string(degree) + ", the remesher '" +
                  remesher_type + "' makes meshes of degree " +
                  std::to_string(remesher->largest_degree()) +
                  " at most (hanging nodes)",
                "set it to " + std::to_string(remesher->largest_degree()) +
                  ", or choose another `Remeshing / Type`");
    if (remesher && !remesher->can_keep_lattices())
      for (const auto &rule : rezoning_rules)
        if (rule.object->needs_lattices())
          found.add(text.origin("Rezoning/" + rule.name + "/Type") + ": " +
                      rule.where + " / Type",
                    "the rule '" + rule.type +
                      "' needs regions whose cells form lattices, and the "
                      "remesher '" +
                      remesher_type + "' makes none",
                    "use Giuliani or barrier for these regions");
    if (!rezoning_rules.empty())
      found.collect([&]() { rezoning_plan.check("Rezoning"); });
    if (time.initial_step < time.minimum_step)
      found.add("Time / Initial step",
                "is smaller than Time / Minimum step",
                "make it at least as large");
    found.throw_if_any();
  }



  template <int dim>
  template <class Interface>
  std::vector<typename Scene<dim>::template Named<Interface>>
  Scene<dim>::make_collection(const std::string &section)
  {
    std::vector<Named<Interface>> members;
    prm.enter_subsection(section);
    prm.declare_entry("Names",
                      "",
                      Patterns::Anything(),
                      "Members, each a subsection of its own.");
    for (const auto &name : text.names(section))
      {
        Named<Interface> member;
        member.name            = name;
        member.where           = section + " / " + name;
        const std::string path = section + "/" + name + "/Type";
        member.type            = text.value(path, "");
        try
          {
            if (member.type.empty())
              throw InputError(text.origin(section + "/Names"),
                               "'" + name + "' has no Type",
                               "write subsection " + section +
                                 " / subsection " + name +
                                 " / set Type = one of: " +
                                 Registry<Interface>::names(", "));
            member.object = Registry<Interface>::create(
              member.type, text.origin(path) + ": " + member.where + " / Type");
          }
        catch (const InputError &error)
          {
            problems.push_back(error.what());
            unknown.insert(section + "/" + name);
            continue;
          }
        prm.enter_subsection(name);
        prm.declare_entry("Type", member.type, Patterns::Anything(), "");
        member.object->declare_parameters(prm);
        prm.leave_subsection();
        members.push_back(std::move(member));
      }
    prm.leave_subsection();
    return members;
  }



  template <int dim>
  void
  Scene<dim>::declare()
  {
    prm.add_parameter("Title", title, "One line.", Patterns::Anything());
    prm.declare_entry("Dimension",
                      "2",
                      Patterns::Integer(2, 3),
                      "Dimension of the scene; 2 is plane strain.");
    accuracy_levels.declare(prm);

    prm.enter_subsection("Mesh");
    prm.add_parameter("Degree",
                      degree,
                      "Polynomial degree of displacement and geometry.",
                      Patterns::Integer(1, 2));
    prm.add_parameter("Largest number of cells",
                      largest_number_of_cells,
                      "A mesh of more cells is refused before it is made: a "
                      "slip in a number of refinements would take all memory.",
                      Patterns::Integer(1));
    mesh_type = text.value("Mesh/Type", "");
    if (mesh_type.empty())
      throw InputError(text.file_name,
                       "there is no Mesh / Type",
                       "set it to one of: " +
                         Registry<MeshSource<dim>>::names(", "));
    prm.declare_entry("Type", mesh_type, Patterns::Anything(), "");
    mesh_source = Registry<MeshSource<dim>>::create(mesh_type,
                                                    text.origin("Mesh/Type") +
                                                      ": Mesh / Type");
    prm.enter_subsection(mesh_type);
    mesh_source->declare_parameters(prm);
    prm.leave_subsection();
    prm.leave_subsection();

    prm.enter_subsection("Regions");
    prm.declare_entry("Names", "", Patterns::Anything(), "Regions modelled.");
    regions.resize(text.names("Regions").size());
    for (unsigned int r = 0; r < regions.size(); ++r)
      {
        regions[r].name = text.names("Regions")[r];
        prm.enter_subsection(regions[r].name);
        prm.add_parameter("On",
                          regions[r].on,
                          "Named regions of the mesh, separated by commas.",
                          Patterns::Anything());
        prm.add_parameter("Material",
                          regions[r].material,
                          "A name from Materials / Names.",
                          Patterns::Anything());
        prm.add_parameter("Volumetric treatment",
                          regions[r].treatment,
                          "mean dilatation, or none for full integration.",
                          Patterns::Selection("mean dilatation|none"));
        prm.add_parameter("Remodelling",
                          regions[r].remodelling,
                          "A name from Remodelling / Names, or none.",
                          Patterns::Anything());
        prm.add_parameter(
          "Transfer of deformation",
          regions[r].deformation,
          "How the elastic strain of a region comes to a new mesh. history: "
          "transferred like all history. reference map: made anew from the "
          "nodal places X = x - u of the undeformed body, F = (dX/dx)^-1 "
          "(elastic materials only). isochoric reference map: so its "
          "isochoric part, while the volume change is transferred (nearly "
          "incompressible bodies).",
          Patterns::Selection("history|reference map|isochoric reference map"));
        prm.leave_subsection();
      }
    prm.leave_subsection();

    materials          = make_collection<Material>("Materials");
    interface_law_list = make_collection<InterfaceLaw>("Interfaces");
    remodelling_laws   = make_collection<RemodellingLaw>("Remodelling");
    prm.enter_subsection("Remodelling");
    coupling.declare(prm);
    prm.leave_subsection();
    conditions = make_collection<Condition<dim>>("Conditions");

    prm.enter_subsection("Solver");
    solver.declare(prm);
    prm.leave_subsection();

    rezoning_rules = make_collection<RezoningRule<dim>>("Rezoning");
    prm.enter_subsection("Rezoning");
    rezoning_plan.declare(prm);
    prm.leave_subsection();

    prm.enter_subsection("Transfer");
    prm.add_parameter("Scheme",
                      transfer_scheme,
                      "Transfer of history between meshes of the same "
                      "connectivity.",
                      Patterns::Selection(
                        Registry<TransferScheme<dim>>::names("|")));
    prm.add_parameter("Largest donor fraction",
                      largest_donor_fraction,
                      "Part of a sub-cell's volume that may leave it in one "
                      "sub-cycle.",
                      Patterns::Double(0.01, 1.));
    prm.leave_subsection();

    prm.enter_subsection("Remeshing");
    remesher_type = text.value("Remeshing/Type", "none");
    prm.declare_entry("Type", remesher_type, Patterns::Anything(), "");
    if (remesher_type != "none")
      {
        remesher = Registry<Remesher<dim>>::create(
          remesher_type,
          text.origin("Remeshing/Type") +
            ": Remeshing / Type (none for no remeshing)");
        remesh_plan.declare(prm);
        prm.enter_subsection(remesher_type);
        remesher->declare_parameters(prm);
        prm.leave_subsection();
      }
    prm.leave_subsection();

    prm.enter_subsection("Monitor");
    prm.add_parameter("Inverted corners",
                      inverted_corners,
                      "What a vertex with a non-positive Jacobian does to a "
                      "step: stop rejects it, report counts it.",
                      Patterns::Selection("stop|report"));
    prm.add_parameter("Warn below quality",
                      warn_quality,
                      "The log tells when the smallest scaled Jacobian falls "
                      "below this, once each time; -1 is never.",
                      Patterns::Double(-1., 1.));
    prm.add_parameter("Minimum quality",
                      minimum_quality,
                      "A run whose smallest scaled Jacobian falls below this "
                      "stops; -1 is never.",
                      Patterns::Double(-1., 1.));
    prm.add_parameter("Energy balance",
                      energy_balance,
                      "Keep books of work and energy, with columns in the "
                      "history and totals in the summary (costs one assembly "
                      "of forces a step).",
                      Patterns::Bool());
    prm.leave_subsection();

    prm.enter_subsection("Time");
    time.declare(prm);
    prm.leave_subsection();

    recorders = make_collection<Recorder<dim>>("Records");

    prm.enter_subsection("Output");
    prm.add_parameter("Directory",
                      output_directory,
                      "Folder for all results; empty: output/ and the name of "
                      "the parameter file.",
                      Patterns::Anything());
    prm.add_parameter("Fields",
                      fields,
                      "Write fields for ParaView.",
                      Patterns::Bool());
    prm.add_parameter("Field interval",
                      field_interval,
                      "Time between two writings of the fields [T]; 0: first "
                      "and last state only.",
                      Patterns::Double(0.));
    prm.leave_subsection();

    prm.enter_subsection("Checkpoint");
    checkpoint.declare(prm);
    prm.leave_subsection();
  }



  template <int dim>
  int
  Scene<dim>::remodelling_of(const Region &region) const
  {
    if (region.remodelling == "none")
      return -1;
    for (unsigned int i = 0; i < remodelling_laws.size(); ++i)
      if (remodelling_laws[i].name == region.remodelling)
        return static_cast<int>(i);
    throw InputError(text.origin("Regions/" + region.name + "/Remodelling"),
                     "there is no remodelling law '" + region.remodelling + "'",
                     "write none, or a name from Remodelling / Names");
  }



  template <int dim>
  unsigned int
  Scene<dim>::material_of(const Region &region) const
  {
    for (unsigned int i = 0; i < materials.size(); ++i)
      if (materials[i].name == region.material)
        return i;
    throw InputError(text.origin("Regions/" + region.name + "/Material") +
                       ": Regions / " + region.name + " / Material",
                     "there is no material '" + region.material + "'",
                     "write a name from Materials / Names");
  }



  template <int dim>
  void
  Scene<dim>::write_resolved(std::ostream &out) const
  {
    // print_parameters is not const in deal.II 9.4, though it changes nothing
    const_cast<ParameterHandler &>(prm).print_parameters(
      out, ParameterHandler::Text | ParameterHandler::KeepDeclarationOrder);
  }

  template class Scene<2>;
  template class Scene<3>;
} // namespace alveolus
