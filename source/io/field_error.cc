// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/io/field_error.h>
#include <alveolus/io/rigid_motion.h>
#include <alveolus/state/reproducible_sum.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  FieldError<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Named regions of the mesh, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter("Field",
                      field,
                      "A history field, e.g. elastic strain.",
                      Patterns::Anything());
    prm.add_parameter("Function",
                      text,
                      "What it should be: an expression in x, y(, z) [mm] "
                      "(current place) and t [T], for tensors one for each of "
                      "xx, yy, zz, xy(, xz, yz), separated by semicolons.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  FieldError<dim>::attach(const State<dim> &state, const std::string &where)
  {
    ids = region_ids(state.configuration.mesh.names, on, where + " / On");
    if (ids.empty())
      throw InputError(where + " / On", "names no region", "name at least one");
    int found = 0; // 1: scalar, 2: tensor
    int least = 2; // whether all cells have it
    for (const auto &cell :
         state.configuration.mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        {
          int here = 0;
          for (const HistoryField &f :
               state.history
                 .layout(state.history.region(cell->active_cell_index()))
                 .fields)
            if (f.name == field)
              here = f.shape == HistoryField::Shape::scalar ? 1 : 2;
          found = std::max(found, here);
          least = std::min(least, here);
        }
    // Every process must hear of it.
    const MPI_Comm communicator = state.configuration.communicator();
    if (Utilities::MPI::min(least, communicator) == 0)
      throw InputError(where + " / Field",
                       "a material of '" + on + "' keeps no history field '" +
                         field + "'",
                       "name a field that all of these regions have");
    shape        = Utilities::MPI::max(found, communicator) == 1
                     ? HistoryField::Shape::scalar
                     : HistoryField::Shape::symmetric_tensor;
    n_components = n_values(shape, dim);
    function = parse_function<dim>(text, n_components, where + " / Function");
  }



  template <int dim>
  std::vector<Recorded>
  FieldError<dim>::record(const State<dim> &state, const NodalVector &) const
  {
    const auto   &configuration = state.configuration;
    FEValues<dim> fe_values(configuration.mapping(),
                            configuration.fe,
                            QGauss<dim>(configuration.degree + 1),
                            update_quadrature_points | update_JxW_values);
    function->set_time(state.time);
    // Off-diagonal components of a symmetric tensor count twice.
    const auto square = [this](const Vector<double> &v) {
      double sum = 0.;
      for (unsigned int k = 0; k < n_components; ++k)
        sum += (k < 3 ? 1. : 2.) * v[k] * v[k];
      return sum;
    };
    std::vector<double> error, norm, mean_error, mean_norm;
    Vector<double>      exact(n_components), mean(n_components),
      mean_exact(n_components), difference(n_components);
    for (const auto &cell : configuration.dof_handler.active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
        {
          fe_values.reinit(cell);
          const unsigned int c = cell->active_cell_index();
          const int          offset =
            state.history.layout(state.history.region(c)).offset(field);
          double volume = 0., error_here = 0., norm_here = 0.;
          mean       = 0.;
          mean_exact = 0.;
          for (const unsigned int q : fe_values.quadrature_point_indices())
            {
              const double *value = state.history.old_record(c, q) + offset;
              const double  dv    = fe_values.JxW(q);
              function->vector_value(fe_values.quadrature_point(q), exact);
              for (unsigned int k = 0; k < n_components; ++k)
                {
                  difference[k] = value[k] - exact[k];
                  mean[k] += value[k] * dv;
                  mean_exact[k] += exact[k] * dv;
                }
              error_here += square(difference) * dv;
              norm_here += square(exact) * dv;
              volume += dv;
            }
          error.push_back(error_here);
          norm.push_back(norm_here);
          mean -= mean_exact;
          mean_error.push_back(square(mean) / volume);
          mean_norm.push_back(square(mean_exact) / volume);
        }
    const auto relative = [&](const std::vector<double> &part,
                              const std::vector<double> &whole) {
      const MPI_Comm communicator = configuration.communicator();
      const double   size         = reproducible_sum(whole, communicator);
      return std::sqrt(reproducible_sum(part, communicator) /
                       (size > 0. ? size : 1.));
    };
    return {{"error", relative(error, norm)},
            {"error of cell means", relative(mean_error, mean_norm)}};
  }

  template class FieldError<2>;
  template class FieldError<3>;

  ALVEOLUS_REGISTER_DIM(
    Recorder,
    FieldError,
    "field error",
    "How far the history field `Field` is from `Function` in the regions `On`: "
    "the L2 norm of the difference over that of the function, at the quadrature "
    "points and for the means over each cell; absolute if the function is zero "
    "everywhere.")
} // namespace alveolus
