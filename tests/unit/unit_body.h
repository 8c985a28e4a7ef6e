// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_unit_body_h
#define alveolus_tests_unit_unit_body_h

// A square or cube of one material with a random history, for tests of
// assembly.
#include <alveolus/assembly/mechanics_assembler.h>
#include <alveolus/materials/remodelled_bone.h>

#include <deal.II/grid/grid_generator.h>

#include <random>

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

  inline std::unique_ptr<Material>
  make_material(const std::string &type,
                const Settings    &settings,
                const unsigned int dim)
  {
    auto material = make<Material>(type, settings);
    if (auto *bone = dynamic_cast<RemodelledBone *>(material.get()))
      bone->set_remodelled(true, true);
    material->initialize(dim, "Materials / test");
    return material;
  }

  /** What a history starts from. */
  struct Prestrain
  {
    double strain  = 0.; ///< largest components of the elastic strain
    double density = 0.; ///< of bone
    double fabric  = 0.; ///< largest components of the log fabric
  };

  /** Unit square or cube of n^dim cells with one material, no conditions. */
  template <int dim>
  struct Body
  {
    Body(std::unique_ptr<Material> body_material,
         const unsigned int        degree,
         const unsigned int        n,
         const bool                mean_dilatation = true)
      : material(std::move(body_material))
      , mesh(unit_mesh(n))
      , regions({{"body", material.get(), mean_dilatation}})
      , state(mesh,
              degree,
              {{0, 0}},
              {HistoryLayout(material->history_fields(), dim)})
    {
      for (unsigned int c = 0; c < n_cells(); ++c)
        for (unsigned int q = 0; q < state.history.n_points; ++q)
          material->initial_history(state.history.old_record(c, q));
      state.history.trial_values = state.history.old_values;
    }

    static Mesh<dim>
    unit_mesh(const unsigned int n)
    {
      Mesh<dim> mesh;
      mesh.triangulation =
        std::make_unique<parallel::distributed::Triangulation<dim>>(
          MPI_COMM_WORLD);
      Point<dim> corner;
      for (unsigned int d = 0; d < dim; ++d)
        corner[d] = 1.;
      GridGenerator::subdivided_hyper_rectangle(*mesh.triangulation,
                                                std::vector<unsigned int>(dim,
                                                                          n),
                                                Point<dim>(),
                                                corner,
                                                true);
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        cell->set_material_id(0);
      mesh.names.boundaries = {{"left", {0}}, {"right", {1}}};
      for (unsigned int b = 0; b < 2 * dim; ++b)
        mesh.names.boundaries["all"].insert(b);
      mesh.names.regions["body"] = {0};
      return mesh;
    }

    unsigned int
    n_cells() const
    {
      return mesh.triangulation->n_active_cells();
    }

    double
    random(const double size)
    {
      return std::uniform_real_distribution<double>(-size, size)(generator);
    }

    SymmetricTensor<2, 3>
    random_tensor(const double size)
    {
      SymmetricTensor<2, 3> t;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          if (j < dim || i == j)
            t[i][j] = random(size);
      return t;
    }

    bool
    at_boundary(const Point<dim> &X) const
    {
      for (unsigned int d = 0; d < dim; ++d)
        if (X[d] < 1e-12 || X[d] > 1. - 1e-12)
          return true;
      return false;
    }

    /** Nodal vector of values f(X, x), X initial and x current position. */
    template <typename F>
    NodalVector
    nodal(const F &f) const
    {
      NodalVector       v = state.configuration.make_vector();
      const NodalVector x = state.configuration.positions();
      for (const NodeId node : state.nodes.relevant())
        state.nodes.set(
          v,
          node,
          f(state.nodes.get(state.configuration.initial_positions(), node),
            state.nodes.get(x, node)));
      v.update_ghost_values();
      return v;
    }

    /** Move nodes at random, by a part of their distance. */
    void
    distort(const bool inside_only)
    {
      const double size = 0.12 / (state.configuration.degree *
                                  std::round(std::pow(n_cells(), 1. / dim)));
      state.configuration.set_positions(
        nodal([&](const Point<dim> &X, const Point<dim> &x) {
          Point<dim> y = x;
          if (!inside_only || !at_boundary(X))
            for (unsigned int d = 0; d < dim; ++d)
              y[d] += random(size);
          return y;
        }));
    }

    /** Random history, the same at all points if @p uniform. */
    void
    strain(const Prestrain &prestrain, const bool uniform)
    {
      std::vector<double> record;
      const auto         &layout = state.history.layout(0);
      const int           rho    = layout.offset("density");
      const int           fabric = layout.offset("log fabric");
      for (unsigned int c = 0; c < n_cells(); ++c)
        for (unsigned int q = 0; q < state.history.n_points; ++q)
          {
            double *values = state.history.old_record(c, q);
            if (record.empty() || !uniform)
              {
                pack(random_tensor(prestrain.strain), values, dim);
                if (rho >= 0)
                  values[rho] = prestrain.density;
                if (fabric >= 0)
                  pack(deviator(random_tensor(prestrain.fabric)),
                       values + fabric,
                       dim);
                record.assign(values, values + layout.size);
              }
            else
              std::copy(record.begin(), record.end(), values);
          }
    }

    std::unique_ptr<Material> material;
    Mesh<dim>                 mesh;
    std::vector<Region>       regions;
    State<dim>                state;
    std::mt19937              generator{4711};
  };
} // namespace alveolus::bench

#endif
