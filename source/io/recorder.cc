// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/displacement_condition.h>
#include <alveolus/io/recorder.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    const char *const axis_names[] = {"x", "y", "z"};

    template <int dim>
    std::vector<unsigned int>
    chosen_components(const std::string &list, const std::string &where)
    {
      return parse_components(
        list == "all" ? (dim == 2 ? "x, y" : "x, y, z") : list, dim, where);
    }
  } // namespace

  template <int dim>
  void
  PointDisplacement<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On", on, "A named point.", Patterns::Anything());
    prm.add_parameter("Components",
                      component_list,
                      "List of x, y, z and magnitude, or all (components).",
                      Patterns::Anything());
  }



  template <int dim>
  void
  PointDisplacement<dim>::attach(const State<dim>  &state,
                                 const std::string &where)
  {
    std::string list;
    magnitude = false;
    for (const auto &name : Utilities::split_string_list(component_list, ','))
      if (name == "magnitude")
        magnitude = true;
      else
        list += (list.empty() ? "" : ", ") + name;
    components.clear();
    if (!list.empty() || !magnitude)
      components = chosen_components<dim>(list, where);
    node = state.nodes.point(on, where + " / On");
  }



  template <int dim>
  std::vector<Recorded>
  PointDisplacement<dim>::record(const State<dim> &state,
                                 const NodalVector &) const
  {
    const Point<dim>      u = state.nodes.gather(state.displacement, {node})[0];
    std::vector<Recorded> row;
    for (const unsigned int c : components)
      row.emplace_back(std::string("displacement ") + axis_names[c] + " [mm]",
                       u[c]);
    if (magnitude)
      row.emplace_back("displacement [mm]", u.norm());
    return row;
  }



  template <int dim>
  void
  Resultant<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Boundaries, curves or points.",
                      Patterns::Anything());
    prm.add_parameter("Components",
                      component_list,
                      "List of x, y, z, or all.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  Resultant<dim>::attach(const State<dim> &state, const std::string &where)
  {
    components = chosen_components<dim>(component_list, where);
    nodes      = nodes_on(state.nodes, on, where + " / On");
  }



  template <int dim>
  std::vector<Recorded>
  Resultant<dim>::record(const State<dim>  &state,
                         const NodalVector &reactions) const
  {
    std::vector<Recorded> row;
    for (const unsigned int c : components)
      {
        double sum = 0.;
        for (const NodeId node : nodes)
          if (state.nodes.is_owned(node))
            sum += reactions(state.nodes.dofs(node)[c]);
        row.emplace_back(
          std::string("force ") + axis_names[c] + " [N]",
          Utilities::MPI::sum(sum, state.configuration.communicator()));
      }
    return row;
  }



  template <int dim>
  void
  FieldExtremes<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Field",
                      field,
                      "A scalar history field, e.g. plastic strain, or a "
                      "derived quantity of a material, e.g. ellipticity.",
                      Patterns::Anything());
    prm.add_parameter("Count up to",
                      bound_text,
                      "If given, the number of points where the value does not "
                      "exceed it is recorded, too.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  FieldExtremes<dim>::offer_regions(const std::vector<Region> &regions)
  {
    materials.clear();
    for (const Region &region : regions)
      materials.push_back(region.material);
  }



  template <int dim>
  void
  FieldExtremes<dim>::attach(const State<dim> &state, const std::string &where)
  {
    if (!bound_text.empty())
      try
        {
          bound = Utilities::string_to_double(bound_text);
        }
      catch (const ExceptionBase &)
        {
          throw InputError(where + " / Count up to",
                           "'" + bound_text + "' is not a number",
                           "write a number, or nothing");
        }
    std::set<std::string> known;
    places.assign(state.history.n_regions(), Place());
    bool found = false;
    for (unsigned int r = 0; r < state.history.n_regions(); ++r)
      {
        Place &place = places[r];
        for (const auto &f : state.history.layout(r).fields)
          if (f.shape == HistoryField::Shape::scalar)
            known.insert(f.name);
        if (known.count(field) > 0)
          place.offset = state.history.layout(r).offset(field);
        if (r < materials.size())
          {
            const auto names = materials[r]->derived_names();
            for (unsigned int i = 0; i < names.size(); ++i)
              {
                known.insert(names[i].first);
                if (names[i].first == field && place.offset < 0)
                  {
                    place.derived  = i;
                    place.material = materials[r];
                  }
              }
          }
        found = found || place.offset >= 0 || place.derived >= 0;
      }
    if (found)
      return;
    std::string list;
    for (const auto &name : known)
      list += (list.empty() ? "" : ", ") + name;
    throw InputError(where + " / Field",
                     "no region has a scalar history field or derived "
                     "quantity '" +
                       field + "'",
                     list.empty() ? "this scene has none"
                                  : "this scene has " + list);
  }



  template <int dim>
  std::vector<Recorded>
  FieldExtremes<dim>::record(const State<dim> &state, const NodalVector &) const
  {
    double       least = std::numeric_limits<double>::max(), greatest = -least;
    unsigned int n = 0;
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c     = cell->active_cell_index();
          const Place       &place = places[state.history.region(c)];
          if (place.offset < 0 && place.derived < 0)
            continue;
          for (unsigned int q = 0; q < state.history.n_points; ++q)
            {
              const double *record = state.history.old_record(c, q);
              const double  value =
                place.offset >= 0
                   ? record[place.offset]
                   : place.material->derived_values(record)[place.derived];
              least    = std::min(least, value);
              greatest = std::max(greatest, value);
              if (!(value > bound))
                ++n;
            }
        }
    const MPI_Comm        communicator = state.configuration.communicator();
    std::vector<Recorded> row          = {
               {"least", Utilities::MPI::min(least, communicator)},
               {"greatest", Utilities::MPI::max(greatest, communicator)}};
    if (!bound_text.empty())
      row.emplace_back("points up to " + bound_text,
                       Utilities::MPI::sum(n, communicator));
    return row;
  }

  template class PointDisplacement<2>;
  template class PointDisplacement<3>;
  template class Resultant<2>;
  template class Resultant<3>;
  template class FieldExtremes<2>;
  template class FieldExtremes<3>;

  ALVEOLUS_REGISTER_DIM(
    Recorder,
    PointDisplacement,
    "point displacement",
    "Displacement of the material at the point `On` [mm], its "
    "`Components` or the magnitude.")
  ALVEOLUS_REGISTER_DIM(Recorder,
                        Resultant,
                        "resultant",
                        "Sum of internal minus external nodal forces on `On` "
                        "[N, per mm of thickness in 2D]: the reaction there.")
  ALVEOLUS_REGISTER_DIM(Recorder,
                        FieldExtremes,
                        "extremes",
                        "Least and greatest value at the quadrature points of "
                        "`Field`, a scalar history field or a derived "
                        "quantity of a material, and the number of points "
                        "where it does not exceed `Count up to`, e.g. of "
                        "`ellipticity` those where it is lost (0).")
} // namespace alveolus
