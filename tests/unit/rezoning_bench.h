// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_rezoning_bench_h
#define alveolus_tests_unit_rezoning_bench_h

// Meshes, maps of their nodes and rules from settings, for tests of rezoning.
#include <alveolus/rezoning/rezoner.h>

#include <deal.II/grid/grid_generator.h>

#include <cmath>
#include <functional>
#include <sstream>

namespace alveolus::bench
{
  using namespace dealii;

  template <int dim>
  using Map = std::function<Point<dim>(const Point<dim> &)>;

  template <int dim>
  Mesh<dim>
  empty_mesh(const MPI_Comm communicator = MPI_COMM_WORLD)
  {
    Mesh<dim> mesh;
    mesh.triangulation =
      std::make_unique<parallel::distributed::Triangulation<dim>>(communicator);
    return mesh;
  }

  /** Unit square or cube; the region "right block" is x > 1/2. */
  template <int dim>
  Mesh<dim>
  unit_mesh(const unsigned int n, const MPI_Comm communicator = MPI_COMM_WORLD)
  {
    Mesh<dim>  mesh = empty_mesh<dim>(communicator);
    Point<dim> corner;
    for (unsigned int c = 0; c < dim; ++c)
      corner[c] = 1.;
    GridGenerator::subdivided_hyper_rectangle(*mesh.triangulation,
                                              std::vector<unsigned int>(dim, n),
                                              Point<dim>(),
                                              corner,
                                              true);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      cell->set_material_id(cell->center()[0] > 0.5);
    auto &names                  = mesh.names;
    names.points["O"]            = Point<dim>();
    names.points["X"]            = Point<dim>::unit_vector(0);
    names.points["Y"]            = Point<dim>::unit_vector(1);
    names.points["M"]            = 0.5 * corner;
    names.boundaries             = {{"left", {0}},
                                    {"right", {1}},
                                    {"bottom", {2}},
                                    {"top", {3}},
                                    {"around", {0, 1, 2, 3}}};
    names.regions["all"]         = {0, 1};
    names.regions["left block"]  = {0};
    names.regions["right block"] = {1};
    return mesh;
  }

  /** A mesh with its nodes, and what a test does to them. */
  template <int dim>
  struct Bench
  {
    Bench(Mesh<dim> m, const unsigned int degree)
      : mesh(std::move(m))
      , configuration(mesh, degree)
      , nodes(configuration)
      , initial(configuration.positions())
    {
      initial.update_ghost_values();
    }

    /** Positions f(X) of all nodes. */
    NodalVector
    map(const Map<dim> &f) const
    {
      NodalVector x = configuration.make_vector();
      for (const NodeId node : nodes.relevant())
        if (nodes.is_owned(node))
          nodes.set(x, node, f(nodes.get(initial, node)));
      x.update_ghost_values();
      return x;
    }

    /** Largest distance of x from f(X), over nodes with X where @p where. */
    double
    distance(
      const NodalVector                             &x,
      const Map<dim>                                &f,
      const std::function<bool(const Point<dim> &)> &where =
        [](const Point<dim> &) { return true; }) const
    {
      double largest = 0.;
      for (const NodeId node : nodes.relevant())
        {
          // Ghosts, too: they have to be up to date.
          const Point<dim> X = nodes.get(initial, node);
          if (where(X))
            largest = std::max(largest, nodes.get(x, node).distance(f(X)));
        }
      return Utilities::MPI::max(largest, MPI_COMM_WORLD);
    }

    const Mesh<dim>          mesh;
    const Configuration<dim> configuration;
    const Nodes<dim>         nodes;
    NodalVector              initial;
  };

  using Settings = std::vector<std::pair<std::string, std::string>>;

  template <int dim>
  std::unique_ptr<RezoningRule<dim>>
  make_rule(const std::string &type, const Settings &settings)
  {
    auto             rule = Registry<RezoningRule<dim>>::create(type, "test");
    ParameterHandler prm;
    rule->declare_parameters(prm);
    for (const auto &s : settings)
      prm.set(s.first, s.second);
    std::ostringstream out;
    prm.print_parameters(out, ParameterHandler::ShortText);
    std::istringstream in(out.str());
    prm.parse_input(in);
    return rule;
  }

  /** Attach the rules to @p attached and run them on a step. */
  template <int dim>
  struct Rezoning
  {
    Rezoning(const Bench<dim> &bench)
      : bench(bench)
    {}

    Rezoning &
    add(const std::string &type, const Settings &settings)
    {
      rezoner.add(make_rule<dim>(type, settings),
                  "Rezoning/" + type + std::to_string(++n));
      return *this;
    }

    NodalVector
    operator()(const NodalVector &attached,
               const NodalVector &start,
               const NodalVector &lagrangian)
    {
      rezoner.attach(bench.nodes, attached);
      return rezoner.propose(bench.nodes, start, lagrangian, report);
    }

    const Bench<dim> &bench;
    Rezoner<dim>      rezoner;
    RezoningReport    report;
    unsigned int      n = 0;
  };

  /** A number in [-1, 1] that looks random, from a place and a seed. */
  template <int dim>
  double
  noise(const Point<dim> &X, const unsigned int seed)
  {
    double phase = 0.7 + 3.1 * seed;
    for (unsigned int c = 0; c < dim; ++c)
      phase += (12.9898 + 65.2 * c + 1.37 * seed) * X[c];
    const double s = std::sin(phase) * 43758.5453;
    return 2. * (s - std::floor(s)) - 1.;
  }

  /** True strictly inside of the unit cell. */
  template <int dim>
  bool
  is_inside(const Point<dim> &X)
  {
    bool inside = true;
    for (unsigned int c = 0; c < dim; ++c)
      inside = inside && X[c] > 1e-10 && X[c] < 1. - 1e-10;
    return inside;
  }

  /** X with inner vertices moved by up to amplitude. */
  template <int dim>
  Map<dim>
  perturbed(const double amplitude, const unsigned int seed)
  {
    return [=](const Point<dim> &X) {
      Point<dim> x = X;
      if (is_inside(X))
        for (unsigned int c = 0; c < dim; ++c)
          x[c] += amplitude * noise(X, seed + 17 * c);
      return x;
    };
  }

  /** x -> graded in each direction. */
  template <int dim>
  Point<dim>
  grade(const Point<dim> &X)
  {
    Point<dim> x;
    for (unsigned int c = 0; c < dim; ++c)
      x[c] = X[c] * (0.4 + 0.1 * c + (0.6 - 0.1 * c) * X[c]);
    return x;
  }
} // namespace alveolus::bench

#endif
