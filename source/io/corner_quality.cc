// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/io/corner_quality.h>
#include <alveolus/io/rigid_motion.h>
#include <alveolus/mesh/quality.h>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Interior angle [degrees] at vertex @p v of a quadrilateral. */
    double
    interior_angle(const std::vector<Point<2>> &x, const unsigned int v)
    {
      const Tensor<1, 2> a = x[v ^ 1u] - x[v], b = x[v ^ 2u] - x[v];
      // a follows b anticlockwise at vertices 1 and 2
      const double sign = (v == 0 || v == 3) ? 1. : -1.;
      double angle      = std::atan2(sign * (a[0] * b[1] - a[1] * b[0]), a * b);
      if (angle < 0.)
        angle += 2. * numbers::PI;
      return angle * 180. / numbers::PI;
    }
  } // namespace



  template <int dim>
  void
  CornerQuality<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Named points, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter("Region",
                      region,
                      "Named regions of the mesh whose elements count, "
                      "separated by commas.",
                      Patterns::Anything());
  }



  template <int dim>
  void
  CornerQuality<dim>::attach(const State<dim> &state, const std::string &where)
  {
    const auto &configuration = state.configuration;
    const auto  ids =
      region_ids(configuration.mesh.names, region, where + " / Region");
    corners.clear();
    std::vector<NodeId> nodes;
    for (const auto &name : Utilities::split_string_list(on, ','))
      {
        Corner       corner{name, {}};
        const NodeId point = state.nodes.point(name, where + " / On");
        for (const auto &cell :
             configuration.dof_handler.active_cell_iterators())
          if (cell->is_locally_owned() && ids.count(cell->material_id()) > 0)
            {
              state.nodes.cell_nodes(cell, nodes);
              for (const unsigned int v : cell->vertex_indices())
                if (nodes[v] == point)
                  corner.cells.emplace_back(cell, v);
            }
        if (Utilities::MPI::sum(corner.cells.size(),
                                configuration.communicator()) == 0)
          throw InputError(where + " / Region",
                           "no element of '" + region +
                             "' has a corner at point '" + name + "'",
                           "name the region that the point belongs to");
        corners.push_back(std::move(corner));
      }
  }



  template <int dim>
  std::vector<Recorded>
  CornerQuality<dim>::record(const State<dim> &state, const NodalVector &) const
  {
    const auto           &configuration = state.configuration;
    const MPI_Comm        communicator  = configuration.communicator();
    const NodalVector     positions     = configuration.positions();
    std::vector<NodeId>   nodes;
    std::vector<Recorded> row;
    for (const Corner &corner : corners)
      {
        double at_corner = std::numeric_limits<double>::max();
        double anywhere  = at_corner;
        // Angles are gathered and sorted: the same sum on any number of
        // processes.
        std::vector<double> angles;
        for (const auto &[cell, vertex] : corner.cells)
          {
            state.nodes.cell_nodes(cell, nodes);
            std::vector<Point<dim>> x;
            for (const unsigned int v : cell->vertex_indices())
              x.push_back(state.nodes.get(positions, nodes[v]));
            at_corner = std::min(at_corner, scaled_jacobian(x, vertex));
            for (const unsigned int v : cell->vertex_indices())
              anywhere = std::min(anywhere, scaled_jacobian(x, v));
            if constexpr (dim == 2)
              angles.push_back(interior_angle(x, vertex));
          }
        row.emplace_back(corner.name + " elements",
                         Utilities::MPI::sum(corner.cells.size(),
                                             communicator));
        row.emplace_back(corner.name + " scaled Jacobian at the corner",
                         Utilities::MPI::min(at_corner, communicator));
        row.emplace_back(corner.name + " scaled Jacobian of the elements",
                         Utilities::MPI::min(anywhere, communicator));
        if (dim == 2)
          {
            std::vector<double> all;
            for (const auto &part :
                 Utilities::MPI::all_gather(communicator, angles))
              all.insert(all.end(), part.begin(), part.end());
            std::sort(all.begin(), all.end());
            double sum = 0.;
            for (const double angle : all)
              sum += angle;
            row.emplace_back(corner.name + " angle [degrees]", sum);
          }
      }
    return row;
  }

  template class CornerQuality<2>;
  template class CornerQuality<3>;

  ALVEOLUS_REGISTER_DIM(
    Recorder,
    CornerQuality,
    "corner quality",
    "The elements of `Region` that meet at each of the points `On`: their "
    "number, their smallest scaled Jacobian at that corner and over all their "
    "corners, and in 2D the angle [degrees] that they fill there.")
} // namespace alveolus
