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
                      "List of x, y, z, or all.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  PointDisplacement<dim>::attach(const State<dim>  &state,
                                 const std::string &where)
  {
    components = chosen_components<dim>(component_list, where);
    node       = state.nodes.point(on, where + " / On");
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
                      "A scalar history field, e.g. plastic strain.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  FieldExtremes<dim>::attach(const State<dim> &state, const std::string &where)
  {
    std::string known;
    for (unsigned int r = 0; r < state.history.n_regions(); ++r)
      for (const auto &f : state.history.layout(r).fields)
        if (f.shape == HistoryField::Shape::scalar)
          {
            if (f.name == field)
              return;
            known += (known.empty() ? "" : ", ") + f.name;
          }
    throw InputError(where + " / Field",
                     "no region has a scalar history field '" + field + "'",
                     known.empty() ? "this scene has none"
                                   : "this scene has " + known);
  }



  template <int dim>
  std::vector<Recorded>
  FieldExtremes<dim>::record(const State<dim> &state, const NodalVector &) const
  {
    double least = std::numeric_limits<double>::max(), greatest = -least;
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        {
          const unsigned int c = cell->active_cell_index();
          const int          offset =
            state.history.layout(state.history.region(c)).offset(field);
          if (offset >= 0)
            for (unsigned int q = 0; q < state.history.n_points; ++q)
              {
                const double value = state.history.old_record(c, q)[offset];
                least              = std::min(least, value);
                greatest           = std::max(greatest, value);
              }
        }
    const MPI_Comm communicator = state.configuration.communicator();
    return {{"least", Utilities::MPI::min(least, communicator)},
            {"greatest", Utilities::MPI::max(greatest, communicator)}};
  }

  template class PointDisplacement<2>;
  template class PointDisplacement<3>;
  template class Resultant<2>;
  template class Resultant<3>;
  template class FieldExtremes<2>;
  template class FieldExtremes<3>;

  ALVEOLUS_REGISTER_DIM(Recorder,
                        PointDisplacement,
                        "point displacement",
                        "Displacement of the material at the point `On` [mm].")
  ALVEOLUS_REGISTER_DIM(Recorder,
                        Resultant,
                        "resultant",
                        "Sum of internal minus external nodal forces on `On` "
                        "[N, per mm of thickness in 2D]: the reaction there.")
  ALVEOLUS_REGISTER_DIM(Recorder,
                        FieldExtremes,
                        "extremes",
                        "Least and greatest value of a scalar history `Field` "
                        "at the quadrature points.")
} // namespace alveolus
