// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/block_file.h>
#include <alveolus/base/errors.h>
#include <alveolus/mesh/hanging_nodes.h>
#include <alveolus/mesh/mesh_record.h>
#include <alveolus/mesh/quality.h>
#include <alveolus/remeshing/remesher.h>

#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <algorithm>
#include <map>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Text of a cell's id, and of its parent and children. */
    std::string
    parent_of(const std::string &id)
    {
      const auto        colon = id.find(':'), line = id.find('_');
      const std::string path = id.substr(colon + 1);
      return path.empty()
               ? ""
               : id.substr(0, line + 1) + std::to_string(path.size() - 1) +
                   ":" + path.substr(0, path.size() - 1);
    }

    std::string
    child_of(const std::string &id, const unsigned int child)
    {
      const auto        colon = id.find(':'), line = id.find('_');
      const std::string path = id.substr(colon + 1) + std::to_string(child);
      return id.substr(0, line + 1) + std::to_string(path.size()) + ":" + path;
    }
  } // namespace

  /**
   * Divides cells where the indicator jumps and joins them where it does not:
   * the same body on a mesh with hanging nodes.
   */
  template <int dim>
  class RefinementRemesher : public Remesher<dim>
  {
  public:
    static constexpr unsigned int n_vertices =
      GeometryInfo<dim>::vertices_per_cell;

    void
    declare_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Indicator",
                        asked,
                        "What jumps from cell to cell: strain energy (density "
                        "of the stored energy) or density (of the bone). none: "
                        "every cell of Regions is divided.",
                        Patterns::Selection("strain energy|density|none"));
      prm.add_parameter("Regions",
                        regions,
                        "Where cells may be divided; empty: everywhere.",
                        Patterns::List(Patterns::Anything(), 0));
      prm.add_parameter("Refine part",
                        refine_part,
                        "Part of all cells that is divided: those with the "
                        "largest indicator.",
                        Patterns::Double(0., 1.));
      prm.add_parameter("Coarsen part",
                        coarsen_part,
                        "Part of all cells that may be joined with their "
                        "siblings: those with the smallest indicator.",
                        Patterns::Double(0., 1.));
      prm.add_parameter("Largest level",
                        largest_level,
                        "How often a coarse cell may be divided in all.",
                        Patterns::Integer(0, 20));
      prm.add_parameter("Smallest level",
                        smallest_level,
                        "Cells divided no more often than this are not joined.",
                        Patterns::Integer(0, 20));
    }

    void
    initialize(const NamedSets<dim> &names, const std::string &path) override
    {
      where = path;
      for (const std::string &region : regions)
        names.region(region, where + " / Regions");
      if (asked == "none" && regions.empty())
        throw InputError(where + " / Regions",
                         "no region is named and there is no indicator",
                         "name the regions to be divided, or choose an "
                         "indicator");
    }

    unsigned int
    largest_degree() const override
    {
      return 1;
    }

    std::string
    indicator() const override
    {
      return asked == "none" ? "" : asked;
    }

    void
    tell(const std::vector<double> &cell_values) override
    {
      values = cell_values;
    }

    std::vector<RemeshCandidate<dim>>
    candidates(const Configuration<dim> &old,
               const std::string &,
               const std::string &name) const override
    {
      if (!can_be_stored(old.mesh))
        throw RunError(where,
                       "the mesh has curved manifolds",
                       "use a mesh of straight lines");
      const auto marks = decide(old);

      // A copy of the mesh, to be divided
      BlockFile blocks("refinement");
      save_mesh(old.mesh, blocks);
      std::vector<RemeshCandidate<dim>> result(1);
      Mesh<dim>                        &mesh = result[0].mesh;
      mesh                  = load_mesh<dim>(blocks, old.communicator());
      unsigned int n_marked = 0;
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const auto mark = marks.find(cell->id().to_string());
            if (mark == marks.end() || mark->second == 0)
              continue;
            ++n_marked;
            if (mark->second > 0)
              cell->set_refine_flag();
            else
              cell->set_coarsen_flag();
          }
      if (Utilities::MPI::sum(n_marked, old.communicator()) == 0)
        throw RunError(where, "there is nothing to refine", "");
      mesh.triangulation->execute_coarsening_and_refinement();

      result[0].positions = positions_of(old);
      result[0].quality =
        mesh_quality(old, old.positions()).smallest_scaled_jacobian;
      std::ostringstream text;
      text << name << ": " << mesh.triangulation->n_global_active_cells()
           << " cells of " << mesh.triangulation->n_global_levels()
           << " sizes, before "
           << old.mesh.triangulation->n_global_active_cells();
      result[0].describe(text.str());
      return result;
    }

  private:
    /** 1 for cells to be divided, -1 for cells to be joined; by id; the same
     * on all processes. */
    std::map<std::string, int>
    decide(const Configuration<dim> &old) const
    {
      struct Judged
      {
        double      jump;
        std::string id;
        int         level;
        bool        may_refine;
      };
      std::set<types::material_id> materials;
      for (const std::string &region : regions)
        {
          const auto &ids = old.mesh.names.region(region, where);
          materials.insert(ids.begin(), ids.end());
        }

      const QGauss<dim>        quadrature(2);
      FEValues<dim>            fe_values(old.mapping(),
                              old.fe,
                              quadrature,
                              update_JxW_values);
      std::vector<double>      numbers;
      std::vector<std::string> ids;
      for (const auto &cell : old.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            double       jump = 0.;
            const double own =
              asked == "none" ? 0. : values[cell->active_cell_index()];
            const auto compare = [&](const auto &other) {
              if (asked != "none" &&
                  other->material_id() == cell->material_id())
                jump =
                  std::max(jump,
                           std::abs(own - values[other->active_cell_index()]));
            };
            for (const unsigned int f : cell->face_indices())
              if (cell->at_boundary(f))
                continue;
              else if (cell->face(f)->has_children())
                for (unsigned int k = 0; k < cell->face(f)->n_children(); ++k)
                  compare(cell->neighbor_child_on_subface(f, k));
              else
                compare(cell->neighbor(f));
            fe_values.reinit(cell);
            double volume = 0.;
            for (const double JxW : fe_values.get_JxW_values())
              volume += JxW;
            ids.push_back(cell->id().to_string());
            numbers.push_back(jump * volume);
            numbers.push_back(cell->level());
            numbers.push_back(materials.empty() ||
                              materials.count(cell->material_id()) > 0);
          }
      const auto all_ids = Utilities::MPI::all_gather(old.communicator(), ids);
      const auto all_numbers =
        Utilities::MPI::all_gather(old.communicator(), numbers);
      std::vector<Judged> cells;
      for (unsigned int p = 0; p < all_ids.size(); ++p)
        for (unsigned int i = 0; i < all_ids[p].size(); ++i)
          cells.push_back({all_numbers[p][3 * i],
                           all_ids[p][i],
                           static_cast<int>(all_numbers[p][3 * i + 1]),
                           all_numbers[p][3 * i + 2] > 0.});
      std::sort(cells.begin(),
                cells.end(),
                [](const Judged &a, const Judged &b) {
                  return a.jump != b.jump ? a.jump > b.jump : a.id < b.id;
                });
      std::map<std::string, int> marks;
      const unsigned int         n   = cells.size();
      const bool                 all = asked == "none";
      for (unsigned int i = 0; i < n; ++i)
        {
          const Judged &cell = cells[i];
          if ((all || (i < refine_part * n && cell.jump > 0.)) &&
              cell.may_refine && cell.level < static_cast<int>(largest_level))
            marks[cell.id] = 1;
          else if (!all && i >= (1. - coarsen_part) * n &&
                   cell.level > static_cast<int>(smallest_level))
            marks[cell.id] = -1;
        }
      return marks;
    }

    /** The places of the nodes of the divided mesh in the old cells. */
    std::function<NodalVector(const Configuration<dim> &)>
    positions_of(const Configuration<dim> &old) const
    {
      using Corners = std::array<Point<dim>, n_vertices>;
      std::vector<std::string>             ids;
      std::vector<double>                  numbers;
      const NodalVector                    x = old.positions();
      std::vector<types::global_dof_index> dofs(old.fe.n_dofs_per_cell());
      for (const auto &cell : old.dof_handler.active_cell_iterators())
        if (cell->is_locally_owned())
          {
            ids.push_back(cell->id().to_string());
            cell->get_dof_indices(dofs);
            for (unsigned int v = 0; v < n_vertices; ++v)
              for (unsigned int d = 0; d < dim; ++d)
                numbers.push_back(
                  x(dofs[old.fe.component_to_system_index(d, v)]));
          }
      std::map<std::string, Corners> corners;
      const auto all_ids = Utilities::MPI::all_gather(old.communicator(), ids);
      const auto all_numbers =
        Utilities::MPI::all_gather(old.communicator(), numbers);
      for (unsigned int p = 0; p < all_ids.size(); ++p)
        {
          const double *number = all_numbers[p].data();
          for (const std::string &id : all_ids[p])
            for (Point<dim> &corner : corners[id])
              for (unsigned int d = 0; d < dim; ++d)
                corner[d] = *(number++);
        }

      return [corners](const Configuration<dim> &fresh) {
        NodalVector result = fresh.make_vector();
        result.zero_out_ghost_values();
        std::vector<types::global_dof_index> dofs(fresh.fe.n_dofs_per_cell());
        for (const auto &cell : fresh.dof_handler.active_cell_iterators())
          if (!cell->is_artificial())
            {
              const std::string id   = cell->id().to_string();
              std::string       from = id;
              while (!from.empty() && corners.count(from) == 0)
                from = parent_of(from);
              const std::string path = id.substr(id.find(':') + 1);
              cell->get_dof_indices(dofs);
              for (unsigned int v = 0; v < n_vertices; ++v)
                {
                  Point<dim> place;
                  if (from.empty()) // joined of 2^dim cells
                    place = corners.at(child_of(id, v))[v];
                  else
                    {
                      Point<dim> xi = GeometryInfo<dim>::unit_cell_vertex(v);
                      const std::size_t first =
                        from.size() - from.find(':') - 1;
                      for (std::size_t k = path.size(); k-- > first;)
                        xi = GeometryInfo<dim>::child_to_cell_coordinates(
                          xi, path[k] - '0');
                      const Corners &of = corners.at(from);
                      place             = of[0];
                      for (unsigned int w = 1; w < n_vertices; ++w)
                        place +=
                          GeometryInfo<dim>::d_linear_shape_function(xi, w) *
                          (of[w] - of[0]);
                    }
                  for (unsigned int d = 0; d < dim; ++d)
                    {
                      const auto dof =
                        dofs[fresh.fe.component_to_system_index(d, v)];
                      if (fresh.locally_owned.is_element(dof))
                        result(dof) = place[d];
                    }
                }
            }
        result.update_ghost_values();
        // Joined cells may have left nodes hanging beside the middle.
        HangingNodes<dim>(fresh).distribute(result);
        return result;
      };
    }

    std::string              asked = "strain energy";
    std::vector<std::string> regions;
    double                   refine_part = 0.2, coarsen_part = 0.05;
    unsigned int             largest_level = 3, smallest_level = 0;
    std::string              where = "Remeshing";
    std::vector<double>      values;
  };

  ALVEOLUS_REGISTER_DIM(
    Remesher,
    RefinementRemesher,
    "refinement",
    "The same mesh with cells divided in 2^dim where an indicator jumps, and "
    "joined again where it does not. The indicator of a cell is its volume "
    "times the largest difference of the cell means of `Indicator` between it "
    "and its neighbours of the same material; the `Refine part` of the cells "
    "with the largest indicator are divided, of the `Coarsen part` with the "
    "smallest those whose siblings are among them are joined. Neighbours differ "
    "by one division at most. Nodes in the middle of a neighbour's edge hang: "
    "displacements, forces and rezoned positions keep them there. Degree 1, "
    "meshes without curved manifolds. Rules for "
    "lattices (transfinite) need their regions undivided.")
} // namespace alveolus
