// SPDX-License-Identifier: LGPL-2.1-or-later
// Contact: derivatives against differences, balance of forces, the patch test
// on meshes that do not match, Hertz' line contact, a wedge that closes, rough
// contact against a tied body, multipliers on another mesh.
#include <alveolus/assembly/contact_gap.h>
#include <alveolus/assembly/contact_pair.h>
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/solver/equilibrium.h>

#include <gtest/gtest.h>

#include <random>

using namespace dealii;
using namespace alveolus;

namespace
{
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



  /** A matrix of all entries, no constraints, no solver. */
  class DenseSystem : public LinearSystem
  {
  public:
    explicit DenseSystem(const unsigned int n)
      : matrix(n, n)
    {}
    void
    clear() override
    {
      matrix = 0.;
    }
    void
    add(const FullMatrix<double>                   &cell_matrix,
        const std::vector<types::global_dof_index> &dofs) override
    {
      for (unsigned int i = 0; i < dofs.size(); ++i)
        for (unsigned int j = 0; j < dofs.size(); ++j)
          matrix(dofs[i], dofs[j]) += cell_matrix(i, j);
    }
    void
    compress() override
    {}
    void
    solve(NodalVector &, const NodalVector &) override
    {}
    std::string
    name() const override
    {
      return "dense";
    }

    FullMatrix<double> matrix;
  };
} // namespace



namespace
{
  /** A crooked outline of three edges as the top of a block. */
  struct Crooked
  {
    explicit Crooked(const unsigned int degree)
    {
      Blocks blocks;
      blocks.add("a", 3, 1, Point<2>(0., -1.), Point<2>(3., 0.));
      mesh          = blocks.build();
      configuration = std::make_unique<Configuration<2>>(mesh, degree);
      nodes         = std::make_unique<Nodes<2>>(*configuration);
      outline       = ContactOutline(*nodes, "a top", "test");
      positions     = outline.get(configuration->initial_positions());
      for (auto &x : positions)
        for (unsigned int d = 0; d < 2; ++d)
          x[d] += 0.07 * random();
    }

    double
    random()
    {
      return std::uniform_real_distribution<double>(-1., 1.)(generator);
    }

    /** Coordinate @p i of a patch with the point @p x. */
    double &
    coordinate(const ContactPatch &patch, const unsigned int i)
    {
      return i < 2 ? x[i] : positions[patch.nodes[i / 2 - 1]][i % 2];
    }

    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
    std::unique_ptr<Nodes<2>>         nodes;
    ContactOutline                    outline;
    std::vector<Point<2>>             positions;
    Point<2>                          x;
    std::mt19937                      generator{4711};
  };
} // namespace



// Gap, foot and normal over smoothed and sharp joints, straight lines and
// parabolas, on both sides: derivatives against differences. The foot is one,
// and the gap is that to the lines themselves.
TEST(ContactGap, DerivativesAreThoseOfDifferences)
{
  for (const unsigned int degree : {1, 2})
    for (const bool smooth : {true, false})
      for (unsigned int trial = 0; trial < 30; ++trial)
        {
          Crooked test(degree);
          test.generator.seed(trial);
          test.x =
            Point<2>(1.5 + 1.3 * test.random(), 0.1 * test.random() - 0.02);
          const std::vector<bool> joints(3, smooth);
          const auto              project = [&]() {
            return ContactSurface(test.outline, test.positions, joints)
              .project(test.x, Point<2>(0., -1.), {0, 1, 2});
          };
          const auto evaluate = [&]() {
            return ContactGap(test.x,
                              ContactSurface(test.outline,
                                             test.positions,
                                             joints),
                              project());
          };
          const ContactProjection projection = project();
          if (!projection.found())
            continue; // beyond the ends
          const ContactGap exact = evaluate();
          EXPECT_NEAR(exact.gap, projection.gap, 1e-15);
          EXPECT_LE((test.x -
                     test.outline.curve(projection.edge, test.positions)
                       .point(projection.xi) -
                     exact.gap * exact.normal)
                      .norm(),
                    1e-14);
          for (unsigned int i = 0; i < exact.patch.size(); ++i)
            {
              const double h       = 1e-6;
              double      &z       = test.coordinate(exact.patch, i);
              const double middle  = z;
              z                    = middle + h;
              const ContactGap p   = evaluate();
              const double     xi  = project().xi;
              z                    = middle - h;
              const ContactGap m   = evaluate();
              const double     dxi = xi - project().xi;
              z                    = middle;
              EXPECT_NEAR(exact.d_gap[i], (p.gap - m.gap) / (2. * h), 1e-8);
              EXPECT_NEAR(exact.d_foot[i], dxi / (2. * h), 1e-8);
              for (unsigned int d = 0; d < 2; ++d)
                EXPECT_NEAR(exact.d_normal[d][i],
                            (p.normal[d] - m.normal[d]) / (2. * h),
                            1e-8);
            }
        }
}



// First and second derivatives of the offset from a place on a line
TEST(ContactOffset, DerivativesAreThoseOfDifferences)
{
  for (const unsigned int degree : {1, 2})
    {
      Crooked test(degree);
      test.x              = Point<2>(1.4, 0.15);
      const auto evaluate = [&]() {
        const ContactSurface surface(test.outline,
                                     test.positions,
                                     std::vector<bool>(3, true));
        return ContactOffset(test.x, surface, 1, 0.3);
      };
      const ContactOffset exact = evaluate();
      for (unsigned int i = 0; i < exact.patch.size(); ++i)
        {
          const double h        = 1e-5;
          double      &z        = test.coordinate(exact.patch, i);
          const double middle   = z;
          z                     = middle + h;
          const ContactOffset p = evaluate();
          z                     = middle - h;
          const ContactOffset m = evaluate();
          z                     = middle;
          for (const auto measure : {&ContactOffset::gap, &ContactOffset::slip})
            {
              EXPECT_NEAR((exact.*measure).gradient[i],
                          ((p.*measure).value - (m.*measure).value) / (2. * h),
                          1e-8);
              for (unsigned int j = 0; j < exact.patch.size(); ++j)
                EXPECT_NEAR((exact.*measure).hessian[j][i],
                            ((p.*measure).gradient[j] -
                             (m.*measure).gradient[j]) /
                              (2. * h),
                            1e-7);
            }
        }
    }
}



namespace
{
  /** An outline of two edges from (-1, -slope) to the origin to (1, -slope). */
  struct Kink
  {
    explicit Kink(const double slope)
    {
      Blocks blocks;
      blocks.add("a", 2, 1, [=](const double s, const double t) {
        const double x = 2. * s - 1.;
        return Point<2>(x, t < 0.5 ? -3. : -slope * std::abs(x));
      });
      mesh          = blocks.build();
      configuration = std::make_unique<Configuration<2>>(mesh, 1);
      nodes         = std::make_unique<Nodes<2>>(*configuration);
      outline       = ContactOutline(*nodes, "a top", "test");
      positions     = outline.get(configuration->initial_positions());
    }

    Mesh<2>                           mesh;
    std::unique_ptr<Configuration<2>> configuration;
    std::unique_ptr<Nodes<2>>         nodes;
    ContactOutline                    outline;
    std::vector<Point<2>>             positions;
  };
} // namespace



// Walking round a vertex, convex or concave, inside or outside, smoothed or
// sharp, the gap never jumps; at a smoothed one the normal does not either.
// Beyond the ends of the outline there is no gap.
TEST(ContactSurface, GapIsContinuousAtKinks)
{
  for (const bool smooth : {false, true})
    for (const double slope : {-0.8, -0.1, 0.1, 0.8})
      for (const double height : {-0.3, -0.01, 0.01, 0.3})
        {
          const Kink           kink(slope);
          const ContactSurface surface(kink.outline,
                                       kink.positions,
                                       {smooth, smooth});
          double               last = 0.;
          Tensor<1, 2>         last_normal;
          const Tensor<1, 2>   down({0., -1.});
          const double         step = 1e-3;
          for (double x = -0.5; x < 0.5; x += step)
            {
              const Point<2>          point(x, height - slope * std::abs(x));
              const ContactProjection found =
                surface.project(point, down, {0, 1});
              ASSERT_TRUE(found.found());
              const Tensor<1, 2> normal =
                ContactGap(point, surface, found).normal;
              if (x > -0.5)
                {
                  // The point moves by step*sqrt(1 + slope^2).
                  EXPECT_LE(std::abs(found.gap - last), 3. * step)
                    << slope << ' ' << height << ' ' << x;
                  if (smooth)
                    {
                      EXPECT_LE((normal - last_normal).norm(), 4. * step)
                        << slope << ' ' << height << ' ' << x;
                    }
                }
              EXPECT_GT(found.gap * height, 0.);
              last        = found.gap;
              last_normal = normal;
            }
          // Over the end of the right edge, and past it along the edge
          const Tensor<1, 2> along({1., -slope}), across({slope, 1.});
          const Point<2>     end(1., -slope);
          EXPECT_TRUE(
            surface.project(end - 0.01 * along + 0.1 * across, down, {0, 1})
              .found());
          EXPECT_FALSE(
            surface.project(end + 0.01 * along + 0.1 * across, down, {0, 1})
              .found());
        }
}



// Round-off of large coordinates does not keep a point from its foot.
TEST(ContactSurface, FeetAreFoundFarFromTheOrigin)
{
  for (const unsigned int degree : {1, 2})
    {
      Crooked test(degree);
      for (auto &x : test.positions)
        x = Point<2>(1000. + 0.05 * x[0], 2000. + 0.05 * x[1]);
      const ContactSurface surface(test.outline,
                                   test.positions,
                                   std::vector<bool>(3, true));
      for (unsigned int i = 0; i < 1000; ++i)
        {
          const Point<2> x(1000.01 + 1.3e-4 * i, 2000. + 0.001 * test.random());
          EXPECT_TRUE(surface.project(x, Point<2>(0., -1.), {0, 1, 2}).found())
            << x;
        }
    }
}



namespace
{
  /** A block with a kinked top and a soft one pressed into it, 3 to 2 lines. */
  std::unique_ptr<Bodies>
  pressed_blocks(const unsigned int degree)
  {
    Blocks blocks;
    blocks.add("hard", 3, 1, [](const double s, const double t) {
      return Point<2>(3. * s, t * (1. + 0.03 * std::sin(5. * s)));
    });
    blocks.add("soft", 2, 1, [](const double s, const double t) {
      return Point<2>(0.4 + 2. * s, 1.04 + t + 0.02 * std::cos(3. * s));
    });
    return std::make_unique<Bodies>(blocks.build(),
                                    std::vector<double>{100., 1.},
                                    0.3,
                                    degree);
  }



  /** Relative deviation of a condition's matrix from force differences. */
  double
  stiffness_error(const State<2> &state,
                  Condition<2>   &condition,
                  NodalVector    &increment)
  {
    const unsigned int n = state.configuration.dof_handler.n_dofs();
    DenseSystem        system(n);
    NodalVector        forces = state.configuration.make_vector();
    condition.add_forces(state, increment, AssemblyTarget{forces, &system});
    const auto evaluate = [&]() {
      NodalVector result = state.configuration.make_vector();
      condition.add_forces(state, increment, AssemblyTarget{result});
      return result;
    };
    double largest = 0.;
    for (unsigned int b = 0; b < n; ++b)
      {
        const double h = 1e-6, middle = increment(b);
        increment(b)        = middle + h;
        const NodalVector p = evaluate();
        increment(b)        = middle - h;
        const NodalVector m = evaluate();
        increment(b)        = middle;
        for (unsigned int a = 0; a < n; ++a)
          largest =
            std::max(largest,
                     std::abs(system.matrix(a, b) - (p(a) - m(a)) / (2. * h)));
      }
    EXPECT_GT(system.matrix.linfty_norm(), 1.);
    return largest / system.matrix.linfty_norm();
  }
} // namespace



// With multipliers from a former step, in the middle of a step: the matrix is
// the derivative; forces and moments of both sides add to zero.
TEST(Contact, MatrixIsTheDerivativeAndForcesAreInBalance)
{
  for (const unsigned int degree : {1, 2})
    for (const std::string friction : {"none", "sticking"})
      {
        SCOPED_TRACE("degree " + std::to_string(degree) + ", " + friction);
        const auto bodies  = pressed_blocks(degree);
        auto      &state   = *bodies->state;
        auto      &contact = bodies->add("contact",
                                    {{"On", "soft bottom"},
                                          {"Against", "hard top"},
                                          {"Stiffness", "20"},
                                          {"Penetration tolerance", "1e-3"},
                                          {"Search distance", "0.8"},
                                          {"Friction", friction}});
        contact.begin_step(state, {0., 1.});
        NodalVector first  = bodies->nodal("soft", [](const Point<2> &) {
          return Point<2>(0.02, -0.12);
        });
        NodalVector forces = state.configuration.make_vector();
        contact.add_forces(state, first, AssemblyTarget{forces});
        EXPECT_TRUE(contact.augment(state, first));
        contact.add_forces(state, first, AssemblyTarget{forces});
        state.accept(first);
        contact.commit();

        contact.begin_step(state, {1., 2.});
        std::mt19937                           generator(4711);
        std::uniform_real_distribution<double> random(-0.01, 0.01);
        NodalVector second = bodies->nodal("soft", [&](const Point<2> &) {
          return Point<2>(0.05 + random(generator), 0.02 + random(generator));
        });
        second += bodies->nodal("hard", [&](const Point<2> &) {
          return Point<2>(random(generator), random(generator));
        });
        EXPECT_LE(stiffness_error(state, contact, second), 1e-7);

        forces = 0.;
        contact.add_forces(state, second, AssemblyTarget{forces});
        const NodalVector x = state.configuration.positions();
        Tensor<1, 2>      sum;
        double            moment = 0., scale = 0.;
        for (const NodeId node : state.nodes.relevant())
          {
            const Point<2>     f = state.nodes.get(forces, node);
            const Tensor<1, 2> arm =
              state.nodes.get(x, node) +
              Tensor<1, 2>(state.nodes.get(second, node));
            sum += Tensor<1, 2>(f);
            moment += arm[0] * f[1] - arm[1] * f[0];
            scale += Tensor<1, 2>(f).norm();
          }
        EXPECT_GT(scale, 1.);
        EXPECT_LE(sum.norm(), 1e-14 * scale);
        EXPECT_LE(std::abs(moment), 1e-14 * scale);
      }
}



// Bodies that part: no force at all, whatever the multipliers
TEST(Contact, DoesNotAttract)
{
  const auto  bodies  = pressed_blocks(1);
  auto       &state   = *bodies->state;
  auto       &contact = bodies->add("contact",
                              {{"On", "soft bottom"},
                                     {"Against", "hard top"},
                                     {"Stiffness", "20"},
                                     {"Search distance", "0.8"}});
  NodalVector forces  = state.configuration.make_vector();
  for (const double lift : {-0.1, 0.2})
    {
      const NodalVector increment =
        bodies->nodal("soft",
                      [&](const Point<2> &) { return Point<2>(0., lift); });
      contact.begin_step(state, {0., 1.});
      forces = 0.;
      contact.add_forces(state, increment, AssemblyTarget{forces});
      if (lift < 0.)
        EXPECT_GT(forces.linfty_norm(), 0.1);
      else
        EXPECT_EQ(forces.linfty_norm(), 0.);
      state.accept(increment);
      contact.commit();
    }
}



namespace
{
  /** Two blocks of 3 mm on rollers, 3 lines against 5, under a pressure. */
  std::unique_ptr<Bodies>
  stacked_blocks(const unsigned int         degree,
                 const std::vector<double> &young,
                 const Settings            &settings)
  {
    Blocks blocks;
    blocks.add("lower", 3, 2, Point<2>(0., 0.), Point<2>(3., 1.));
    blocks.add("upper", 5, 2, Point<2>(0., 1.), Point<2>(3., 2.));
    auto bodies = std::make_unique<Bodies>(blocks.build(), young, 0.3, degree);
    bodies->add("displacement",
                {{"On", "lower left, upper left"}, {"Components", "x"}});
    bodies->add("displacement", {{"On", "lower bottom"}, {"Components", "y"}});
    bodies->add("pressure", {{"On", "upper top"}, {"Function", "min(t, 1)"}});
    Settings all = {{"On", "upper bottom"},
                    {"Against", "lower top"},
                    {"Stiffness", "100"}};
    all.insert(all.end(), settings.begin(), settings.end());
    bodies->add("contact", all);
    bodies->start();
    return bodies;
  }



  /** Largest difference of strain between the points of a region. */
  double
  nonuniformity(Bodies &bodies, const unsigned int region)
  {
    double             largest = 0.;
    const auto        &history = bodies.state->history;
    const unsigned int size    = history.layout(region).size;
    const double      *first   = nullptr;
    for (unsigned int c = 0; c < bodies.mesh.triangulation->n_active_cells();
         ++c)
      if (history.region(c) == region)
        for (unsigned int q = 0; q < history.n_points; ++q)
          {
            const double *record = history.old_record(c, q);
            if (first == nullptr)
              first = record;
            for (unsigned int i = 0; i < size; ++i)
              largest = std::max(largest, std::abs(record[i] - first[i]));
          }
    return largest;
  }
} // namespace



// The contact patch test: a pressure goes through lines that do not match
// without any disturbance, with straight and with curved lines, with and
// without augmentation. Penetration is the pressure over the stiffness where
// nothing is augmented, below the tolerance where it is.
TEST(Contact, PatchTest)
{
  for (const unsigned int degree : {1, 2})
    for (const bool augmented : {false, true})
      {
        SCOPED_TRACE("degree " + std::to_string(degree) +
                     (augmented ? ", augmented" : ", penalty"));
        const auto bodies =
          stacked_blocks(degree,
                         {10., 10.},
                         {{"Penetration tolerance", augmented ? "1e-9" : "1"}});
        const auto &contact = *bodies->conditions.back();
        bodies->step(1.);
        for (const unsigned int region : {0, 1})
          EXPECT_LE(nonuniformity(*bodies, region), 1e-11);
        // The pressure acts on the deformed width.
        const double width = bodies->recorded(contact, "length [mm]");
        EXPECT_GT(width, 3.01);
        EXPECT_NEAR(bodies->recorded(contact, "force y [N]"), width, 1e-10);
        EXPECT_NEAR(bodies->recorded(contact, "greatest pressure [MPa]"),
                    1.,
                    1e-10);
        for (const std::string side : {"penetration of lines [mm]",
                                       "penetration of opposite nodes [mm]"})
          {
            const double penetration = bodies->recorded(contact, side);
            if (augmented)
              EXPECT_LE(penetration, 1e-9);
            else // p is counted per line of x_n
              EXPECT_NEAR(penetration, 0.01 * width / 3., 1e-10);
          }
        EXPECT_EQ(bodies->recorded(contact, "augmentations") > 0., augmented);
      }
}



// An attempt that is given up leaves no trace.
TEST(Contact, RejectedStepsLeaveNoTrace)
{
  std::vector<NodalVector> results;
  for (const bool detour : {false, true})
    {
      const auto bodies =
        stacked_blocks(1, {10., 10.}, {{"Penetration tolerance", "1e-6"}});
      bodies->step(0.3);
      if (detour)
        {
          EXPECT_EQ(bodies->attempt(0.9), "");
        }
      bodies->step(0.6);
      results.push_back(bodies->state->displacement);
    }
  results[0] -= results[1];
  EXPECT_EQ(results[0].linfty_norm(), 0.);
}



// Matrix entries beyond the cells' follow the contact where it goes.
TEST(Contact, MatrixFollowsASlidingBody)
{
  Blocks blocks;
  blocks.add("rail", 20, 1, Point<2>(0., 0.), Point<2>(20., 1.));
  blocks.add("slider", 6, 1, [](const double s, const double t) {
    const double x = 2. * s - 1.;
    return Point<2>(2. + x, 1. + (1. - t) * 0.3 * x * x + t);
  });
  Bodies bodies(blocks.build(), {10., 10.}, 0.3, 1);
  bodies.add("displacement", {{"On", "rail bottom"}});
  bodies.add("displacement",
             {{"On", "slider top"}, {"Function", "t; -0.1*min(t, 1)"}});
  auto &contact = bodies.add("contact",
                             {{"On", "slider bottom"},
                              {"Against", "rail top"},
                              {"Stiffness", "5000"},
                              {"Search distance", "0.6"}});
  bodies.start();
  const unsigned int revision = contact.couplings_revision();
  double             force    = 0.;
  for (unsigned int i = 1; i <= 60; ++i)
    {
      bodies.step(0.25 * i);
      if (i == 12)
        force = bodies.recorded(contact, "force y [N]");
      EXPECT_LE(bodies.recorded(contact, "penetration of lines [mm]"), 1.01e-3);
      EXPECT_LE(bodies.recorded(contact, "penetration of opposite nodes [mm]"),
                1.01e-3);
    }
  EXPECT_GT(contact.couplings_revision(), revision + 5);
  EXPECT_GT(force, 0.5);
  // The rail is the same everywhere but at its ends: 12 lines on.
  EXPECT_NEAR(bodies.recorded(contact, "force y [N]") / force, 1., 1e-2);
}



// Rough contact under pressure is a welded joint; multipliers of both
// directions make it one to within the tolerance.
TEST(Contact, StickingUnderPressureIsWelded)
{
  std::vector<double> tips;
  for (const bool welded : {true, false})
    {
      Blocks blocks;
      blocks.add("lower", 6, 2, Point<2>(-0.5, 0.), Point<2>(2.5, 1.));
      blocks.add("upper", 4, 2, Point<2>(0., 1.), Point<2>(2., 2.));
      if (welded)
        blocks.weld();
      Bodies bodies(blocks.build(), {20., 10.}, 0.3, 1);
      bodies.add("displacement", {{"On", "lower bottom"}});
      bodies.add("displacement",
                 {{"On", "upper top"},
                  {"Function", "0.05*max(t - 1, 0); -0.1*min(t, 1)"}});
      Condition<2> *contact = nullptr;
      if (!welded)
        contact = &bodies.add("contact",
                              {{"On", "upper bottom"},
                               {"Against", "lower top"},
                               {"Stiffness", "300"},
                               {"Augmentations", "60"},
                               {"Friction", "sticking"},
                               {"Penetration tolerance", "1e-7"}});
      bodies.start();
      // The first touch is without friction: let it be a light one.
      for (const double t : {1e-4, 1., 1.5, 2.})
        bodies.step(t);
      double tip = 0.;
      for (const NodeId node : bodies.state->nodes.relevant())
        if (bodies.state->nodes
              .get(bodies.state->configuration.initial_positions(), node)
              .distance(Point<2>(2., 1.)) < 1e-9)
          tip = bodies.state->nodes.get(bodies.state->displacement, node)[0];
      tips.push_back(tip);
      if (contact != nullptr)
        {
          EXPECT_LT(bodies.recorded(*contact, "force x [N]"), -0.1);
          EXPECT_NEAR(bodies.recorded(*contact, "length [mm]"), 2., 0.1);
        }
    }
  EXPECT_GT(tips[0], 0.01);
  EXPECT_NEAR(tips[0], tips[1], 3e-6);
}



// Multipliers are functions of the place on the outline: another mesh of it
// gets the same forces.
TEST(Contact, MultipliersPassToAnotherMesh)
{
  const auto make_bodies = [](const unsigned int n) {
    Blocks blocks;
    blocks.add("lower", 3, 1, Point<2>(0., 0.), Point<2>(3., 1.));
    blocks.add("upper", n, 1, Point<2>(0., 1.), Point<2>(3., 2.));
    return std::make_unique<Bodies>(blocks.build(),
                                    std::vector<double>{1., 1.},
                                    0.3,
                                    1);
  };
  const Settings settings = {{"On", "upper bottom"},
                             {"Against", "lower top"},
                             {"Stiffness", "10"}};
  const auto     coarse = make_bodies(3), fine = make_bodies(7);
  auto          &old = coarse->add("contact", settings);
  auto          &now = fine->add("contact", settings);

  // Turn the underside of the upper block into the lower one, by 0.1 x.
  NodalVector increment = coarse->state->configuration.make_vector();
  for (const NodeId node :
       coarse->state->nodes.boundary("upper bottom", "test"))
    coarse->state->nodes.set(
      increment,
      node,
      Point<2>(0.,
               -0.1 *
                 coarse->state->nodes.get(
                   coarse->state->configuration.initial_positions(), node)[0]));
  NodalVector forces = coarse->state->configuration.make_vector();
  old.begin_step(*coarse->state, {0., 1.});
  old.add_forces(*coarse->state, increment, AssemblyTarget{forces});
  EXPECT_NEAR(coarse->recorded(old, "force y [N]"), 4.5, 1e-12);
  EXPECT_NEAR(coarse->recorded(old, "centre x [mm]"), 2., 1e-12);
  old.commit();

  // On the fine mesh, just touching: the pressure x/sqrt(1.01) of the line
  // that has become longer, and no more.
  now.take_over(old);
  forces    = fine->state->configuration.make_vector();
  increment = forces;
  now.begin_step(*fine->state, {1., 2.});
  now.add_forces(*fine->state, increment, AssemblyTarget{forces});
  EXPECT_NEAR(fine->recorded(now, "force y [N]"), 4.5 / std::sqrt(1.01), 1e-12);
  EXPECT_NEAR(fine->recorded(now, "centre x [mm]"), 2., 1e-12);
}



namespace
{
  /** A wall with a soft block grown onto its lower half; rim at y = 0. */
  Blocks
  wall_and_block(const double width, const unsigned int n_x)
  {
    Blocks blocks;
    blocks.add("soft", n_x, 8, Point<2>(0., -1.), Point<2>(width, 0.));
    blocks.add("wall", 1, 16, Point<2>(-0.5, -1.), Point<2>(0., 1.));
    blocks.weld();
    return blocks;
  }
} // namespace



// The rim of a soft block turns about the corner that it shares with the wall:
// nothing happens until the angle between rim and wall is closed; then the
// moment about the corner is that of the pressure e r sin(a) on the length 1.
TEST(Contact, WedgeClosesAtItsCorner)
{
  Bodies      bodies(wall_and_block(1., 4).build(), {1., 1.}, 0.3, 1);
  auto       &state   = *bodies.state;
  auto       &contact = bodies.add("contact",
                             {{"On", "soft top"},
                                    {"Against", "wall right"},
                                    {"Stiffness", "30"},
                                    {"Search distance", "0.6"}});
  NodalVector forces  = state.configuration.make_vector();
  const auto  rim     = state.nodes.boundary("soft top", "test");
  double      was     = 90.;
  // Degrees between rim and wall; more than 90 is below the horizontal.
  for (const double angle : {120., 175., 80., 30., 5., 0.01, -0.5, -2., 10.})
    {
      const double a         = angle * numbers::PI / 180.;
      NodalVector  increment = state.configuration.make_vector();
      const auto   X         = state.configuration.initial_positions();
      for (const NodeId node : rim)
        {
          const double r = state.nodes.get(X, node)[0];
          state.nodes.set(increment,
                          node,
                          Point<2>(r * std::sin(a), r * std::cos(a)) -
                            Tensor<1, 2>(state.nodes.get(
                              state.configuration.positions(), node)));
        }
      forces = 0.;
      contact.begin_step(state, {0., 1.});
      contact.add_forces(state, increment, AssemblyTarget{forces});
      if (angle > 0.)
        {
          EXPECT_EQ(forces.linfty_norm(), 0.) << was << " to " << angle;
        }
      else
        {
          double moment = 0.; // of the rim's forces on the wall
          for (const NodeId node : rim)
            {
              const double   r = state.nodes.get(X, node)[0];
              const Point<2> f = state.nodes.get(forces, node);
              moment += r * (std::sin(a) * f[1] - std::cos(a) * f[0]);
            }
          EXPECT_NEAR(moment, -30. * std::sin(a) * std::cos(a) / 3., 1e-12)
            << angle;
          EXPECT_NEAR(bodies.recorded(contact, "length [mm]"), 1., 0.1);
          EXPECT_NEAR(bodies.recorded(contact, "penetration of lines [mm]"),
                      -std::sin(a),
                      1e-12);
        }
      state.accept(increment);
      was = angle;
    }
}



// The edge of a soft body that sinks away from a corner it shares with a hard
// one, up to where the wedge of material between them is narrower than a right
// angle and its points lie behind the outer slope: no contact.
TEST(Contact, NoneOverASharpCrest)
{
  Blocks blocks;
  blocks.add("bone", 4, 4, Point<2>(-1., -1.), Point<2>(0., 0.));
  blocks.add("soft", 4, 4, Point<2>(0., -1.), Point<2>(1., 0.));
  blocks.weld();
  Bodies      bodies(blocks.build(), {1., 1.}, 0.3, 1);
  auto       &state   = *bodies.state;
  auto       &contact = bodies.add("contact",
                             {{"On", "soft top"},
                                    {"Against", "bone top"},
                                    {"Search distance", "0.6"}});
  NodalVector forces  = state.configuration.make_vector();
  const auto  X       = state.configuration.initial_positions();
  // Degrees between bone top and soft top through the space above them
  for (const double angle : {200., 240., 265., 275., 290., 305., 280.})
    {
      const double a         = (180. - angle) * numbers::PI / 180.;
      NodalVector  increment = state.configuration.make_vector();
      for (const NodeId node : state.nodes.boundary("soft top", "test"))
        {
          const double r = state.nodes.get(X, node)[0];
          state.nodes.set(increment,
                          node,
                          Point<2>(r * std::cos(a), r * std::sin(a)) -
                            Tensor<1, 2>(state.nodes.get(
                              state.configuration.positions(), node)));
        }
      forces = 0.;
      contact.begin_step(state, {0., 1.});
      contact.add_forces(state, increment, AssemblyTarget{forces});
      EXPECT_EQ(forces.linfty_norm(), 0.) << angle;
      EXPECT_FALSE(contact.augment(state, increment));
      EXPECT_EQ(bodies.recorded(contact, "penetration of lines [mm]"), 0.);
      EXPECT_EQ(bodies.recorded(contact, "penetration of opposite nodes [mm]"),
                0.);
      state.accept(increment);
    }
}



// The same corner in equilibrium: the wall goes down and squeezes the block,
// which rolls its rim onto it, with and without friction. Without contact it
// goes through the wall.
TEST(Contact, SqueezedBlockLeansAgainstTheWall)
{
  const auto squeeze = [](const unsigned int degree,
                          const Settings    &settings,
                          const double       limit) {
    Bodies bodies(wall_and_block(0.5, 8 / degree).build(),
                  {0.07, 100.},
                  0.4,
                  degree);
    bodies.add("displacement", {{"On", "soft right"}});
    bodies.add("displacement",
               {{"On", "wall left"}, {"Function", "0.2*t; -0.55*t"}});
    Settings all = {{"On", "soft top"},
                    {"Against", "wall right"},
                    {"Stiffness", "300"}};
    all.insert(all.end(), settings.begin(), settings.end());
    auto &contact = bodies.add("contact", all);
    bodies.start();
    unsigned int n_iterations = 0, n_augmentations = 0;
    for (unsigned int i = 1; i <= 20; ++i)
      {
        bodies.step(0.05 * i);
        n_iterations += bodies.report.n_iterations;
        n_augmentations += bodies.report.n_augmentations;
        for (const std::string side : {"penetration of lines [mm]",
                                       "penetration of opposite nodes [mm]"})
          EXPECT_LE(bodies.recorded(contact, side), limit) << i;
      }
    const double length = bodies.recorded(contact, "length [mm]");
    const double x      = bodies.recorded(contact, "force x [N]");
    const double y      = bodies.recorded(contact, "force y [N]");
    std::cout << "Squeezed block, degree " << degree << ": length " << length
              << " mm, force " << x << ", " << y << " N/mm, penetration "
              << bodies.recorded(contact, "penetration of lines [mm]") << ", "
              << bodies.recorded(contact, "penetration of opposite nodes [mm]")
              << " mm; " << n_iterations << " iterations, " << n_augmentations
              << " augmentations in 20 steps" << std::endl;
    return std::array<double, 3>{
      {length,
       std::abs(y / x),
       bodies.recorded(contact, "penetration of lines [mm]")}};
  };
  for (const unsigned int degree : {1, 2})
    {
      const auto smooth = squeeze(degree, {}, 2e-3);
      EXPECT_GT(smooth[0], 0.1);
      EXPECT_LT(smooth[1], 0.02); // the wall stays nearly upright
      const auto rough = squeeze(degree, {{"Friction", "sticking"}}, 2e-3);
      EXPECT_GT(rough[0], 0.1);
      EXPECT_GT(rough[1], 0.05);
    }
  // A tolerance that nothing exceeds, and hardly any stiffness, is no contact.
  EXPECT_GT(squeeze(1,
                    {{"Stiffness", "1e-9"}, {"Penetration tolerance", "10"}},
                    1.)[2],
            0.03);
}



namespace
{
  struct HertzErrors
  {
    double pressure, width, centre;
  };

  /**
   * A stiff cylinder on an elastic block, half of it: relative errors of the
   * greatest pressure, half-width and centre of pressure against Hertz' at the
   * force of the solution (K. L. Johnson, Contact Mechanics, 1985, section
   * 4.2): b^2 = 4 P R/(pi E*), p = 2 P/(pi b) (1 - x^2/b^2)^(1/2).
   */
  HertzErrors
  hertz(const unsigned int n, const unsigned int degree)
  {
    const double R = 100., E = 1000., nu = 0.3, hard = 1e3;
    // Two thirds of the lines are equal ones, the others grow outwards.
    const auto graded =
      [](const double s, const double fine, const double all) {
        return s < 2. / 3. ? fine * 1.5 * s
                           : fine * std::pow(all / fine, 3. * (s - 2. / 3.));
      };
    Blocks blocks;
    blocks.add("block", n, n, [=](const double s, const double t) {
      return Point<2>(graded(s, 0.8, 20.), -graded(1. - t, 0.8, 20.));
    });
    blocks.add("cylinder", n, n / 2, [=](const double s, const double t) {
      const double angle = graded(s, 1., 4.) / R;
      const double r     = R - graded(t, 0.8, 8.);
      return Point<2>(r * std::sin(angle), R - r * std::cos(angle));
    });
    Bodies bodies(blocks.build(), {E, hard * E}, nu, degree);
    bodies.add("displacement",
               {{"On", "block left, cylinder left, block right"},
                {"Components", "x"}});
    bodies.add("displacement", {{"On", "block bottom"}, {"Components", "y"}});
    bodies.add("displacement",
               {{"On", "cylinder top"},
                {"Components", "y"},
                {"Function", "-0.0035*t"}});
    auto &contact = bodies.add("contact",
                               {{"On", "block top"},
                                {"Against", "cylinder bottom"},
                                {"Stiffness", "1e5"},
                                {"Search distance", "0.2"},
                                {"Penetration tolerance", "1e-7"}});
    bodies.start();
    // Round-off of the stiff cylinder stops Newton's method at 1e-9.
    bodies.parameters.tolerance = 1e-8;
    for (unsigned int i = 1; i <= 4; ++i)
      bodies.step(0.25 * i);

    const double P = -2. * bodies.recorded(contact, "force y [N]");
    const double stiffness =
      E / (1. - nu * nu) / (1. + 1. / hard); // E*, of both bodies
    const double b = std::sqrt(4. * P * R / (numbers::PI * stiffness));
    HertzErrors  errors{bodies.recorded(contact, "greatest pressure [MPa]") /
                           (2. * P / (numbers::PI * b)) -
                         1.,
                       bodies.recorded(contact, "length [mm]") / b - 1.,
                       bodies.recorded(contact, "centre x [mm]") /
                           (4. * b / (3. * numbers::PI)) -
                         1.};
    std::cout << "Hertz, " << n << " lines, degree " << degree << ": P = " << P
              << " N, b = " << b << " mm = " << b * n / 1.2
              << " lines; relative errors: pressure " << errors.pressure
              << ", width " << errors.width << ", centre " << errors.centre
              << "; " << bodies.report.n_iterations << " iterations, "
              << bodies.report.n_augmentations << " augmentations" << std::endl;
    return errors;
  }
} // namespace



// Half the width of contact is 8 and 16 lines of the block: the ends of contact
// are known to a fraction of one, pressures and their centre better.
TEST(Contact, HertzLineContact)
{
  const HertzErrors coarse = hertz(24, 1), fine = hertz(48, 1),
                    quadratic = hertz(24, 2);
  for (const auto &errors : {coarse, fine, quadratic})
    {
      EXPECT_LT(std::abs(errors.pressure), 0.01);
      EXPECT_LT(std::abs(errors.width), 0.03);
      EXPECT_LT(std::abs(errors.centre), 0.01);
    }
  EXPECT_LT(std::abs(fine.pressure), 0.6 * std::abs(coarse.pressure));
  EXPECT_LT(std::abs(fine.centre), 0.6 * std::abs(coarse.centre));
}
