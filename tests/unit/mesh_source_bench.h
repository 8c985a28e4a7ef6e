// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_mesh_source_bench_h
#define alveolus_tests_unit_mesh_source_bench_h

// Meshes from sources and their settings, and what they measure.
#include "files_and_messages.h"

#include <alveolus/mesh/mesh_source.h>

#include <deal.II/base/parameter_handler.h>

#include <map>

namespace alveolus::bench
{
  using namespace dealii;

  using Settings = std::map<std::string, std::string>;

  /** The mesh that a source of this type makes from the settings. */
  template <int dim>
  Mesh<dim>
  make(const std::string &type,
       const Settings    &settings,
       const std::string &input_directory = folder())
  {
    const auto source = Registry<MeshSource<dim>>::create(type, "Mesh / Type");
    ParameterHandler prm;
    source->declare_parameters(prm);
    for (const auto &setting : settings)
      prm.set(setting.first, setting.second);
    return source->create(MPI_COMM_WORLD, input_directory, folder());
  }

  /** what() of the user error that making the mesh ends with. */
  template <class Error, int dim>
  std::string
  message(const std::string &type, const Settings &settings)
  {
    try
      {
        make<dim>(type, settings);
      }
    catch (const Error &error)
      {
        return error.what();
      }
    catch (const std::exception &error)
      {
        return std::string("wrong type of error: ") + error.what();
      }
    return "no error";
  }

  /** Area or volume of a region. */
  template <int dim>
  double
  measure(const Mesh<dim> &mesh, const std::string &region)
  {
    const auto &ids    = mesh.names.region(region, "test");
    double      result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned() && ids.count(cell->material_id()) != 0)
        result += cell->measure();
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  /** Length of a curve in 2D; an inner line is seen from two cells. */
  inline double
  length(const Mesh<2> &mesh, const std::string &curve)
  {
    double result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (mesh.names.is_on_curve(face, curve))
            result += face->measure() * (face->at_boundary() ? 1. : 0.5);
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }

  /** Length or area of a boundary. */
  template <int dim>
  double
  boundary_measure(const Mesh<dim> &mesh, const std::string &name)
  {
    const auto &ids    = mesh.names.boundary(name, "test");
    double      result = 0.;
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->is_locally_owned())
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary() && ids.count(face->boundary_id()) != 0)
            result += face->measure();
    return Utilities::MPI::sum(result, MPI_COMM_WORLD);
  }
} // namespace alveolus::bench

#endif
