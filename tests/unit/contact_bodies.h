// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_contact_bodies_h
#define alveolus_tests_unit_contact_bodies_h

// Blocks that touch, and what a test does with them: the bodies of contact.
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/solver/equilibrium.h>

#include <gtest/gtest.h>

namespace alveolus::bench
{
  using namespace dealii;

  using Settings = std::vector<std::pair<std::string, std::string>>;

  template <class Interface>
  std::unique_ptr<Interface>
  make(const std::string &type, const Settings &settings)
  {
    auto             object = Registry<Interface>::create(type, "Type");
    ParameterHandler prm;
    object->declare_parameters(prm);
    for (const auto &[key, value] : settings)
      prm.set(key, value);
    return object;
  }



  /** Structured blocks, each a body of its own unless they are welded. */
  struct Blocks
  {
    MeshDescription<2> description;

    /**
     * n_x times n_y cells at f(s, t), s and t in [0, 1]; the region and the
     * sides have the names @p name, "name left", "name right", "name bottom"
     * and "name top".
     */
    void
    add(const std::string                                         &name,
        const unsigned int                                         n_x,
        const unsigned int                                         n_y,
        const std::function<Point<2>(const double, const double)> &f)
    {
      const unsigned int first = description.vertices.size();
      for (unsigned int j = 0; j <= n_y; ++j)
        for (unsigned int i = 0; i <= n_x; ++i)
          {
            description.vertices.push_back(f(double(i) / n_x, double(j) / n_y));
            description.vertex_numbers.push_back(description.vertices.size());
          }
      const auto v = [&](const unsigned int i, const unsigned int j) {
        return first + j * (n_x + 1) + i;
      };
      const unsigned int region = ++tag;
      description.regions[name].insert(region);
      for (unsigned int j = 0; j < n_y; ++j)
        for (unsigned int i = 0; i < n_x; ++i)
          {
            DescribedElement<2> cell;
            cell.vertices = {
              {v(i, j), v(i + 1, j), v(i, j + 1), v(i + 1, j + 1)}};
            cell.tag    = region;
            cell.number = description.cells.size() + 1;
            description.cells.push_back(cell);
          }
      const auto side = [&](const std::string &where,
                            const unsigned int n,
                            const auto        &vertex) {
        description.curves[name + " " + where].insert(++tag);
        for (unsigned int k = 0; k < n; ++k)
          {
            DescribedElement<1> line;
            line.vertices = {{vertex(k), vertex(k + 1)}};
            line.tag      = tag;
            description.lines.push_back(line);
          }
      };
      side("bottom", n_x, [&](const unsigned int k) { return v(k, 0); });
      side("top", n_x, [&](const unsigned int k) { return v(k, n_y); });
      side("left", n_y, [&](const unsigned int k) { return v(0, k); });
      side("right", n_y, [&](const unsigned int k) { return v(n_x, k); });
    }

    /** A rectangle. */
    void
    add(const std::string &name,
        const unsigned int n_x,
        const unsigned int n_y,
        const Point<2>    &low,
        const Point<2>    &high)
    {
      add(name, n_x, n_y, [=](const double s, const double t) {
        return Point<2>(low[0] + s * (high[0] - low[0]),
                        low[1] + t * (high[1] - low[1]));
      });
    }

    /** Make one vertex of those at the same place. */
    void
    weld()
    {
      auto                     &vertices = description.vertices;
      std::vector<unsigned int> first(vertices.size());
      for (unsigned int i = 0; i < vertices.size(); ++i)
        for (first[i] = 0; vertices[first[i]].distance(vertices[i]) > 1e-9;)
          ++first[i];
      for (auto &cell : description.cells)
        for (auto &v : cell.vertices)
          v = first[v];
      // Lines between two blocks are inside now.
      std::map<std::set<unsigned int>, unsigned int> count;
      for (auto &line : description.lines)
        {
          for (auto &v : line.vertices)
            v = first[v];
          ++count[{line.vertices[0], line.vertices[1]}];
        }
      auto &lines = description.lines;
      lines.erase(
        std::remove_if(lines.begin(),
                       lines.end(),
                       [&](const auto &line) {
                         return count[{line.vertices[0], line.vertices[1]}] > 1;
                       }),
        lines.end());
    }

    Mesh<2>
    build()
    {
      check_description(description, true);
      return build_mesh(description, MPI_COMM_WORLD);
    }

    unsigned int tag = 0;
  };



  struct Bodies
  {
    /** @param young Young's modulus of each region in alphabetical order */
    Bodies(Mesh<2>                    blocks,
           const std::vector<double> &young,
           const double               poisson,
           const unsigned int         degree)
      : mesh(std::move(blocks))
    {
      std::map<types::material_id, unsigned int> region_of;
      std::vector<HistoryLayout>                 layouts;
      for (const auto &[name, ids] : mesh.names.regions)
        {
          for (const auto id : ids)
            region_of[id] = regions.size();
          materials.push_back(make<Material>(
            "Hencky elastic",
            {{"Young's modulus", std::to_string(young[regions.size()])},
             {"Poisson's ratio", std::to_string(poisson)}}));
          materials.back()->initialize(2, "Materials / " + name);
          regions.push_back({name, materials.back().get(), false});
          layouts.emplace_back(materials.back()->history_fields(), 2);
        }
      state = std::make_unique<State<2>>(mesh, degree, region_of, layouts);
      for (unsigned int c = 0; c < mesh.triangulation->n_active_cells(); ++c)
        for (unsigned int q = 0; q < state->history.n_points; ++q)
          regions[state->history.region(c)].material->initial_history(
            state->history.old_record(c, q));
      state->history.trial_values = state->history.old_values;
    }

    Condition<2> &
    add(const std::string &type, const Settings &settings)
    {
      conditions.push_back(make<Condition<2>>(type, settings));
      conditions.back()->attach(*state, "Conditions / " + type);
      return *conditions.back();
    }

    /** Make the solver; to be called once all conditions are there. */
    void
    start()
    {
      parameters.tolerance          = 1e-10;
      parameters.absolute_tolerance = 0.;
      parameters.max_iterations     = 40;
      parameters.max_line_search    = 12;
      equilibrium                   = std::make_unique<Equilibrium<2>>(
        *state, regions, conditions, parameters, timer);
    }

    /** One step to time @p t; what is wrong with it. */
    std::string
    attempt(const double t)
    {
      report = EquilibriumReport();
      return equilibrium->solve({state->time, t}, report).reason;
    }

    void
    accept(const double t)
    {
      state->accept(equilibrium->increment);
      for (auto &condition : conditions)
        condition->commit();
      state->last_step = t - state->time;
      state->time      = t;
    }

    void
    step(const double t)
    {
      ASSERT_EQ(attempt(t), "");
      accept(t);
    }

    double
    recorded(const Condition<2> &condition, const std::string &name) const
    {
      for (const auto &[key, value] :
           condition.record(*state, equilibrium->residual()))
        if (key == name)
          return value;
      ADD_FAILURE() << name;
      return 0.;
    }

    /** Nodal vector f(x) of the current positions x on one region, else 0. */
    NodalVector
    nodal(const std::string                               &region,
          const std::function<Point<2>(const Point<2> &)> &f) const
    {
      NodalVector       v = state->configuration.make_vector();
      const NodalVector x = state->configuration.positions();
      for (const NodeId node : state->nodes.region(region, "test"))
        state->nodes.set(v, node, f(state->nodes.get(x, node)));
      v.update_ghost_values();
      return v;
    }

    Mesh<2>                                mesh;
    std::vector<std::unique_ptr<Material>> materials;
    std::vector<Region>                    regions;
    std::unique_ptr<State<2>>              state;
    MechanicsAssembler<2>::Conditions      conditions;
    Equilibrium<2>::Parameters             parameters;
    TimerOutput timer{std::cout, TimerOutput::never, TimerOutput::wall_times};
    std::unique_ptr<Equilibrium<2>> equilibrium;
    EquilibriumReport               report;
  };
} // namespace alveolus::bench

#endif
