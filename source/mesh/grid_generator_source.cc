// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/expressions.h>
#include <alveolus/mesh/mesh_source.h>

#include <deal.II/grid/grid_generator.h>
#include <deal.II/grid/grid_tools.h>
#include <deal.II/grid/manifold.h>

#include <cstdlib>
#include <limits>
#include <map>
#include <sstream>

namespace alveolus
{
  namespace
  {
    const std::string section = "Mesh / grid generator";

    /** Text of a deal.II exception without its banner and stack trace. */
    std::string
    reason(const std::exception &error)
    {
      const auto *exception =
        dynamic_cast<const dealii::ExceptionBase *>(&error);
      if (exception == nullptr)
        return error.what();
      std::ostringstream text;
      exception->print_info(text);
      std::string result = text.str();
      for (char &c : result)
        if (c == '\n')
          c = ' ';
      return dealii::Utilities::trim(result);
    }

    /** The pairs of a list "name: value; name: value" divided by @p separator.
     */
    std::vector<std::pair<std::string, std::string>>
    named_values(const std::string &list,
                 const char         separator,
                 const std::string &where)
    {
      std::vector<std::pair<std::string, std::string>> result;
      for (const std::string &entry :
           dealii::Utilities::split_string_list(list, separator))
        {
          const std::size_t colon = entry.rfind(':');
          const std::string name  = dealii::Utilities::trim(
            entry.substr(0, std::min(colon, entry.size())));
          if (colon == std::string::npos || name.empty())
            throw InputError(where,
                             "'" + entry + "' is no pair 'name: value'",
                             std::string("write e.g. 'left: 0") + separator +
                               " right: 1'");
          result.emplace_back(name,
                              dealii::Utilities::trim(entry.substr(colon + 1)));
        }
      return result;
    }

    /**
     * Names for the ids that the mesh has: those of the list, which must exist,
     * and "<kind> <id>" for the others.
     */
    std::map<std::string, std::set<unsigned int>>
    name_ids(const std::string            &list,
             const std::set<unsigned int> &present,
             const std::string            &kind,
             const std::string            &where)
    {
      std::map<std::string, std::set<unsigned int>> result;
      std::set<unsigned int>                        unnamed = present;
      for (const auto &[name, value] : named_values(list, ',', where))
        {
          const bool is_number =
            !value.empty() && value.size() < 10 &&
            value.find_first_not_of("0123456789") == std::string::npos;
          if (!is_number || present.count(std::stoul(value)) == 0)
            {
              std::string known;
              for (const unsigned int id : present)
                known += (known.empty() ? "" : ", ") + std::to_string(id);
              throw InputError(where,
                               "the mesh has no " + kind + " with the id '" +
                                 value + "' for the name '" + name + "'",
                               "ids are: " + known);
            }
          result[name].insert(std::stoul(value));
          unnamed.erase(std::stoul(value));
        }
      for (const unsigned int id : unnamed)
        result[kind + " " + std::to_string(id)].insert(id);
      return result;
    }
  } // namespace



  /**
   * Meshes of deal.II's namespace GridGenerator, by function name, optionally
   * with their vertices moved and boundaries cut into named pieces.
   */
  template <int dim>
  class GridGeneratorSource : public MeshSource<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      prm.add_parameter("Function",
                        function,
                        "Function of deal.II's namespace GridGenerator, e.g. "
                        "hyper_cube, subdivided_hyper_rectangle, hyper_shell.");
      prm.add_parameter("Arguments",
                        arguments,
                        "Its arguments after the triangulation, divided by "
                        "colons, lengths in mm, e.g. '0 : 1 : true'. Many "
                        "functions end with 'colorize' (true or false), which "
                        "gives the sides boundary ids of their own.");
      prm.add_parameter("Map",
                        map,
                        "Where the vertices of the coarse mesh are moved to "
                        "[mm], an expression in x, y(, z) for each component, "
                        "separated by semicolons, e.g. 'x; y*(1+x/10)'; only "
                        "for meshes without curved manifolds.");
      prm.add_parameter("Refinements",
                        n_refinements,
                        "How often every cell is divided.",
                        dealii::Patterns::Integer(0, 20));
      prm.add_parameter("Boundary names",
                        boundary_names,
                        "Names of boundary ids, e.g. 'left: 0, right: 1'; a "
                        "name may be given several ids by repeating it. Others "
                        "are called 'boundary 0' and so on. In 2D curves have "
                        "the same names.");
      prm.add_parameter("Boundary pieces",
                        boundary_pieces,
                        "Names of parts cut out of the boundaries, each with a "
                        "condition in x, y(, z) [mm] that the middles of its "
                        "faces in the coarse mesh fulfil, separated by "
                        "semicolons, e.g. 'punch: y > 9.99 && x < 2'.");
      prm.add_parameter("Region names",
                        region_names,
                        "Names of material ids, e.g. 'body: 0'; others are "
                        "called 'region 0' and so on.");
      prm.add_parameter("Point names",
                        point_names,
                        "Names of vertices with their coordinates [mm], e.g. "
                        "'A: 0, 0; B: 1, 0'.");
    }

    Mesh<dim>
    create(const MPI_Comm &communicator,
           const std::string &,
           const std::string &) const override
    {
      Mesh<dim> mesh;
      mesh.triangulation =
        std::make_unique<dealii::parallel::distributed::Triangulation<dim>>(
          communicator);
      check_numbers_in_arguments();
      generate(*mesh.triangulation);
      this->check_number_of_cells(mesh.triangulation->n_active_cells(),
                                  n_refinements,
                                  section + " / Refinements");
      map_vertices(*mesh.triangulation);
      check_sizes(*mesh.triangulation);

      // Every process has all coarse cells, so every one sees all ids.
      std::set<unsigned int> boundary_ids, material_ids;
      for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
        {
          material_ids.insert(cell->material_id());
          for (const auto &face : cell->face_iterators())
            if (face->at_boundary())
              boundary_ids.insert(face->boundary_id());
        }
      mesh.names.boundaries = name_ids(boundary_names,
                                       boundary_ids,
                                       "boundary",
                                       section + " / Boundary names");
      cut_pieces(mesh, boundary_ids);
      mesh.names.regions = name_ids(region_names,
                                    material_ids,
                                    "region",
                                    section + " / Region names");
      if (dim == 2)
        name_curves(mesh);
      try
        {
          mesh.triangulation->refine_global(n_refinements);
        }
      catch (const dealii::ExceptionBase &)
        {
          // A manifold has no point there, e.g. at its centre.
          throw InputError(section + " / Refinements",
                           "the cells of '" + function + "' of '" + arguments +
                             "' cannot be divided",
                           "set it to 0, or change the arguments");
        }
      name_points(mesh);
      mesh.description =
        function + "(" + arguments +
        "): " + std::to_string(mesh.triangulation->n_global_active_cells()) +
        " cells";
      return mesh;
    }

  private:
    std::string  function      = "hyper_cube";
    std::string  arguments     = "0 : 1 : true";
    unsigned int n_refinements = 0;
    std::string map, boundary_names, boundary_pieces, region_names, point_names;

    /** Refuse cells with corners on each other, which cannot be divided. */
    void
    check_sizes(const dealii::Triangulation<dim> &triangulation) const
    {
      for (const auto &cell : triangulation.cell_iterators_on_level(0))
        if (!(cell->minimum_vertex_distance() > 1e-12 * cell->diameter()))
          {
            std::ostringstream place;
            place << cell->center();
            throw InputError(section + " / Arguments",
                             "'" + function + "' of '" + arguments +
                               "' makes a cell with two corners at one place, "
                               "near (" +
                               place.str() + ") mm",
                             "change the arguments; a disc is hyper_ball");
          }
    }

    /**
     * Functions with arguments that are numbers of cells take memory for them
     * before anybody can look at the result.
     */
    void
    check_numbers_in_arguments() const
    {
      // Functions and their arguments, from 0 on, that are such numbers
      static const std::map<std::string, std::vector<unsigned int>> numbers = {
        {"subdivided_hyper_cube", {0}},
        {"subdivided_hyper_rectangle", {0}},
        {"subdivided_parallelepiped", {0}},
        {"subdivided_cylinder", {0}},
        {"cheese", {0}},
        {"moebius", {0}},
        {"torus", {2}},
        {"hyper_shell", {3}},
        {"half_hyper_shell", {3}},
        {"quarter_hyper_shell", {3}},
        {"cylinder_shell", {3, 4}},
        {"concentric_hyper_shells", {3, 5}},
        {"hyper_cube_with_cylindrical_hole", {3, 4}},
        {"plate_with_a_hole", {10}},
        {"channel_with_cylinder", {1}}};
      const auto found = numbers.find(function);
      if (found == numbers.end())
        return;
      const auto list = dealii::Utilities::split_string_list(arguments, ':');
      double     n    = 1.;
      for (const unsigned int argument : found->second)
        if (argument < list.size())
          {
            const auto parts =
              dealii::Utilities::split_string_list(list[argument], ',');
            for (const std::string &part : parts)
              {
                const double value = std::strtod(part.c_str(), nullptr);
                // deal.II takes it for granted; of shells 0 is a default.
                if (!(value >= 1.) &&
                    (function.compare(0, 10, "subdivided") == 0 ||
                     function == "cheese"))
                  throw InputError(section + " / Arguments",
                                   "'" + part + "' is no number of cells of '" +
                                     function + "'",
                                   "write a positive integer");
                n *= std::max(1., std::abs(value));
              }
            if (parts.size() == 1 &&
                function.compare(0, 16, "subdivided_hyper") == 0)
              n = std::pow(n, dim);
          }
      this->check_number_of_cells(n, 0, section + " / Arguments");
    }

    void
    generate(dealii::Triangulation<dim> &triangulation) const
    {
      try
        {
          dealii::GridGenerator::generate_from_name_and_arguments(triangulation,
                                                                  function,
                                                                  arguments);
        }
      catch (const std::exception &error)
        {
          throw InputError(section,
                           "GridGenerator cannot make '" + function + "' of '" +
                             arguments + "': " + reason(error),
                           "see deal.II's documentation of GridGenerator for "
                           "the functions and their arguments");
        }
      if (triangulation.n_levels() != 1)
        throw InputError(section + " / Function",
                         "'" + function + "' makes a refined mesh",
                         "take a function that makes coarse cells only");
    }

    void
    map_vertices(dealii::Triangulation<dim> &triangulation) const
    {
      if (map.empty())
        return;
      const std::string where = section + " / Map";
      for (const auto id : triangulation.get_manifold_ids())
        if (id != dealii::numbers::flat_manifold_id)
          throw InputError(where,
                           "'" + function + "' has curved manifolds",
                           "map meshes with straight edges only");
      const auto f = parse_function_of_place<dim>(map, dim, where);
      dealii::GridTools::transform(
        [&](const dealii::Point<dim> &x) {
          dealii::Point<dim> y;
          for (unsigned int d = 0; d < dim; ++d)
            y[d] = f->value(x, d);
          return y;
        },
        triangulation);
    }

    /** Give the faces of each boundary piece an id of its own. */
    void
    cut_pieces(Mesh<dim> &mesh, const std::set<unsigned int> &ids) const
    {
      const std::string where = section + " / Boundary pieces";
      unsigned int      id    = *ids.rbegin();
      for (const auto &[name, condition] :
           named_values(boundary_pieces, ';', where))
        {
          ++id;
          const auto f = parse_function_of_place<dim>(condition, 1, where);
          bool       is_used = false;
          for (const auto &cell :
               mesh.triangulation->cell_iterators_on_level(0))
            for (const auto &face : cell->face_iterators())
              if (face->at_boundary() && f->value(face->center()) != 0.)
                {
                  face->set_boundary_id(id);
                  is_used = true;
                }
          if (!is_used)
            throw InputError(where,
                             "no face of the coarse mesh has its middle where "
                             "'" +
                               condition + "' is true",
                             "correct the condition of '" + name +
                               "', or divide the coarse mesh accordingly");
          mesh.names.boundaries[name].insert(id);
        }
    }

    /**
     * Lines of a curve are known by their manifold id where all manifolds are
     * flat, by their boundary id alone where a curved one needs that id.
     */
    void
    name_curves(Mesh<dim> &mesh) const
    {
      for (const auto &piece : mesh.names.boundaries)
        mesh.names.curves[piece.first];
      for (const auto id : mesh.triangulation->get_manifold_ids())
        if (id != dealii::numbers::flat_manifold_id)
          return;
      for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
        for (const auto &face : cell->face_iterators())
          if (face->at_boundary())
            face->set_manifold_id(face->boundary_id());
      for (const auto &piece : mesh.names.boundaries)
        for (const auto id : piece.second)
          {
            mesh.names.curves[piece.first].insert(id);
            mesh.triangulation->set_manifold(id, dealii::FlatManifold<dim>());
          }
    }

    void
    name_points(Mesh<dim> &mesh) const
    {
      const std::string where = section + " / Point names";
      for (const auto &[name, value] : named_values(point_names, ';', where))
        {
          dealii::Point<dim> point;
          try
            {
              const std::vector<double> numbers =
                dealii::Utilities::string_to_double(
                  dealii::Utilities::split_string_list(value));
              AssertThrow(numbers.size() == dim, dealii::ExcInternalError());
              std::copy(numbers.begin(), numbers.end(), point.begin_raw());
            }
          catch (const std::exception &)
            {
              throw InputError(where,
                               "'" + value + "' of point '" + name +
                                 "' are not " + std::to_string(dim) +
                                 " coordinates",
                               dim == 2
                                 ? "write e.g. 'A: 0, 0; B: 1, 0'"
                                 : "write e.g. 'A: 0, 0, 0; B: 1, 0, 0'");
            }
          check_is_vertex(*mesh.triangulation, point, name, where);
          mesh.names.points[name] = point;
        }
    }

    void
    check_is_vertex(
      const dealii::parallel::distributed::Triangulation<dim> &triangulation,
      const dealii::Point<dim>                                &point,
      const std::string                                       &name,
      const std::string                                       &where) const
    {
      double             distance = std::numeric_limits<double>::max();
      double             size     = 0.;
      dealii::Point<dim> nearest;
      for (const auto &cell : triangulation.active_cell_iterators())
        if (cell->is_locally_owned())
          for (const unsigned int v : cell->vertex_indices())
            if (point.distance(cell->vertex(v)) < distance)
              {
                nearest  = cell->vertex(v);
                distance = point.distance(nearest);
                size     = cell->diameter();
              }
      const auto smallest =
        dealii::Utilities::MPI::min_max_avg(distance,
                                            triangulation.get_communicator());
      const auto on_nearest =
        dealii::Utilities::MPI::broadcast(triangulation.get_communicator(),
                                          std::make_pair(nearest, size),
                                          smallest.min_index);
      if (smallest.min > 1e-8 * on_nearest.second)
        {
          std::ostringstream text;
          text << "there is no vertex at point '" << name << "' (" << point
               << "), the nearest one is at (" << on_nearest.first << ")";
          throw InputError(where, text.str(), "name points at vertices");
        }
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::MeshSource,
  alveolus::GridGeneratorSource,
  "grid generator",
  "A mesh of deal.II's namespace GridGenerator, by the name of the function and "
  "its arguments, its vertices mapped if asked for; names are given to its "
  "boundary ids, to pieces of boundaries, material ids and vertices.")
