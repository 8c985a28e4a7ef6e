// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// mpirun=3
// Meshes and fields of checkpoints: the same for any number of processes, and
// back to the last bit.
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_record.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/state/portable_fields.h>
#include <alveolus/state/state.h>

#include <deal.II/dofs/dof_tools.h>
#include <deal.II/fe/mapping_q.h>
#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

#include <sstream>

using namespace dealii;
using namespace alveolus;

namespace
{
  template <int dim>
  Mesh<dim>
  mesh_of(const MPI_Comm                                         &communicator,
          const std::string                                      &type,
          const std::vector<std::pair<std::string, std::string>> &settings)
  {
    const auto       source = Registry<MeshSource<dim>>::create(type, "test");
    ParameterHandler prm;
    source->declare_parameters(prm);
    for (const auto &[name, value] : settings)
      prm.set(name, value);
    return source->create(communicator, ".", ".");
  }

  Mesh<2>
  academic(const MPI_Comm &communicator, const std::string &refinements = "0")
  {
    return mesh_of<2>(communicator,
                      "file",
                      {{"File name",
                        ALVEOLUS_SOURCE_DIR "/meshes/academic-coarse.msh"},
                       {"Refinements", refinements}});
  }

  Mesh<3>
  block(const MPI_Comm &communicator, const std::string &refinements = "0")
  {
    return mesh_of<3>(communicator,
                      "grid generator",
                      {{"Function", "subdivided_hyper_rectangle"},
                       {"Arguments", "3, 2, 2 : 0, 0, 0 : 3, 2, 1 : true"},
                       {"Map", "x + y*y/10; y - z/7; z*(1 + x/5)"},
                       {"Boundary pieces", "piece: x < 1 && y > 1.5"},
                       {"Refinements", refinements}});
  }

  std::string
  bytes_of(const BlockFile &blocks)
  {
    std::ostringstream out;
    blocks.write(out);
    return out.str();
  }

  /** Degrees of freedom with their places, to the last bit. */
  template <int dim>
  std::map<types::global_dof_index, Point<dim>>
  places(const Mesh<dim> &mesh, const unsigned int degree)
  {
    const Configuration<dim>                      configuration(mesh, degree);
    std::map<types::global_dof_index, Point<dim>> result;
    DoFTools::map_dofs_to_support_points(MappingQ<dim>(1),
                                         configuration.dof_handler,
                                         result);
    return result;
  }

  template <int dim>
  void
  comes_back(const Mesh<dim> &mesh, const MPI_Comm &communicator)
  {
    ASSERT_TRUE(can_be_stored(mesh));
    BlockFile blocks;
    save_mesh(mesh, blocks);
    // By way of a file
    const Mesh<dim> again =
      load_mesh<dim>(BlockFile::parse(bytes_of(blocks), "FILE"), communicator);
    EXPECT_EQ(fingerprint(again), fingerprint(mesh));
    EXPECT_EQ(again.description, mesh.description);
    EXPECT_EQ(again.names.points, mesh.names.points);
    EXPECT_EQ(again.names.curves, mesh.names.curves);
    EXPECT_EQ(again.names.boundaries, mesh.names.boundaries);
    EXPECT_EQ(again.names.regions, mesh.names.regions);
    for (const unsigned int degree : {1, 2})
      EXPECT_EQ(places(again, degree), places(mesh, degree));
    BlockFile second;
    save_mesh(again, second);
    EXPECT_EQ(bytes_of(second), bytes_of(blocks));
  }
} // namespace



TEST(MeshRecord, PlaneMeshOfAFile)
{
  comes_back(academic(MPI_COMM_WORLD), MPI_COMM_WORLD);
  comes_back(academic(MPI_COMM_WORLD, "1"), MPI_COMM_WORLD);
}

TEST(MeshRecord, SolidWithIdsOnFacesAndLines)
{
  Mesh<3> mesh = block(MPI_COMM_WORLD);
  EXPECT_GT(mesh.names.boundaries.count("piece"), 0u);
  // Lines of curves, at the boundary and inside, and a face with a manifold
  unsigned int id = 20;
  for (const auto &cell : mesh.triangulation->cell_iterators_on_level(0))
    {
      cell->line(3)->set_manifold_id(id++);
      cell->face(1)->set_manifold_id(id++);
      cell->set_manifold_id(id++);
      cell->set_material_id(id++ % 3);
    }
  mesh.names.curves["edges"] = {20, 21};
  comes_back(mesh, MPI_COMM_WORLD);
  comes_back(block(MPI_COMM_WORLD, "1"), MPI_COMM_WORLD);
}

TEST(MeshRecord, FingerprintSeesEverything)
{
  const auto number = fingerprint(block(MPI_COMM_WORLD));
  EXPECT_EQ(fingerprint(block(MPI_COMM_SELF)), number);
  const auto changed = [&](const auto &change) {
    Mesh<3> mesh = block(MPI_COMM_WORLD);
    for (const auto &cell : mesh.triangulation->active_cell_iterators())
      if (cell->id().to_string() == "5_0:")
        change(cell);
    return fingerprint(mesh) != number;
  };
  EXPECT_FALSE(changed([](const auto &) {}));
  EXPECT_TRUE(changed([](const auto &cell) { cell->set_material_id(70); }));
  EXPECT_TRUE(changed([](const auto &cell) { cell->set_manifold_id(7); }));
  EXPECT_TRUE(
    changed([](const auto &cell) { cell->face(1)->set_manifold_id(7); }));
  EXPECT_TRUE(
    changed([](const auto &cell) { cell->line(1)->set_manifold_id(7); }));
  EXPECT_TRUE(changed([](const auto &cell) {
    cell->vertex(0)[0] += std::numeric_limits<double>::epsilon();
  }));
}

TEST(MeshRecord, CurvedMeshesAreLeftToTheirSource)
{
  EXPECT_FALSE(can_be_stored(mesh_of<2>(
    MPI_COMM_WORLD,
    "grid generator",
    {{"Function", "hyper_shell"}, {"Arguments", "0, 0 : 1 : 2 : 12 : true"}})));
}

TEST(MeshRecord, InconsistentBlocksAreRefused)
{
  BlockFile good;
  save_mesh(academic(MPI_COMM_WORLD), good);
  const auto refused = [&](const auto &change) {
    BlockFile bad = good;
    change(bad);
    try
      {
        load_mesh<2>(bad, MPI_COMM_WORLD);
      }
    catch (const InputError &)
      {
        return true;
      }
    return false;
  };
  EXPECT_FALSE(refused([](BlockFile &) {}));
  for (const std::string name : {"mesh/vertices", "mesh/points"})
    EXPECT_TRUE(refused([&](BlockFile &bad) {
      auto values = bad.numbers(name);
      values.pop_back();
      bad.put(name, values);
    }))
      << name;
  for (const std::string name : {"mesh/cells", "mesh/lines"})
    {
      EXPECT_TRUE(refused([&](BlockFile &bad) {
        auto values = bad.integers(name);
        values.pop_back();
        bad.put(name, values);
      }))
        << name;
      EXPECT_TRUE(refused([&](BlockFile &bad) {
        auto values = bad.integers(name);
        values[0]   = 1u << 31;
        bad.put(name, values);
      }))
        << name;
    }
  EXPECT_TRUE(refused(
    [](BlockFile &bad) { bad.put("mesh/regions", std::string("3 1 2\n")); }));
  EXPECT_TRUE(
    refused([](BlockFile &bad) { bad.put_integer("mesh/refinements", 1000); }));
  // What p4est would end the program for
  EXPECT_TRUE(refused([](BlockFile &bad) {
    auto cells = bad.integers("mesh/cells");
    cells[6]   = cells[7]; // an edge of no length
    bad.put("mesh/cells", cells);
  }));
  EXPECT_TRUE(refused([](BlockFile &bad) {
    bad.put("state/displacement", BlockFile::Numbers(1000, 0.));
    bad.put_integer("mesh/refinements", 12); // more cells than values
  }));
}



namespace
{
  /** State with one scalar in some regions, and one more in the others. */
  template <int dim>
  std::unique_ptr<State<dim>>
  state_on(const Mesh<dim> &mesh, const unsigned int degree)
  {
    const HistoryField                                 density{"density", ""};
    const HistoryField                                 other{"other", ""};
    std::map<dealii::types::material_id, unsigned int> regions;
    unsigned int                                       n = 0;
    for (const auto &region : mesh.names.regions)
      for (const auto id : region.second)
        regions[id] = n++ % 2;
    return std::make_unique<State<dim>>(
      mesh,
      degree,
      regions,
      std::vector<HistoryLayout>{HistoryLayout({density}, dim),
                                 HistoryLayout({density, other}, dim)});
  }

  /**
   * Numbers that depend on the place only, not on the last digit of it: deal.II
   * makes a new vertex from the first cell that is divided, which is another
   * one on another number of processes.
   */
  template <int dim>
  double
  field(const Point<dim> &x, const unsigned int component)
  {
    const auto rounded = [](const double value) {
      return std::round(value * 1e6) / 1e6;
    };
    return std::sin(3. * rounded(x[0]) + component) + rounded(x[1]) / 7. +
           rounded(x[dim - 1]) / 11.;
  }

  template <int dim>
  struct Fields
  {
    Fields(const Mesh<dim> &mesh, const unsigned int degree, const bool filled)
      : state(state_on(mesh, degree))
      , faces(*mesh.triangulation, ids(mesh), 2, 3)
    {
      if (!filled)
        return;
      auto &u = state->displacement;
      u.zero_out_ghost_values();
      for (const NodeId node : state->nodes.relevant())
        if (state->nodes.is_owned(node))
          {
            const auto x =
              state->nodes.get(state->configuration.initial_positions(), node);
            for (unsigned int d = 0; d < dim; ++d)
              u(state->nodes.dofs(node)[d]) = field(x, d);
          }
      u.update_ghost_values();
      auto &history = state->history;
      for (const auto &cell : mesh.triangulation->active_cell_iterators())
        if (cell->is_locally_owned())
          {
            const unsigned int c = cell->active_cell_index();
            for (auto i = history.offsets()[c]; i < history.offsets()[c + 1];
                 ++i)
              history.old_values[i] =
                field(cell->center(), i - history.offsets()[c]);
          }
      for (unsigned int f = 0; f < faces.faces().size(); ++f)
        {
          const auto &face = faces.faces()[f];
          for (unsigned int q = 0; q < 2; ++q)
            for (unsigned int i = 0; i < 3; ++i)
              faces.old_record(f, q)[i] =
                field(face.cell->face(face.face_no)->center(), 3 * q + i);
        }
    }

    static std::set<types::boundary_id>
    ids(const Mesh<dim> &mesh)
    {
      std::set<types::boundary_id> result;
      for (const auto &piece : mesh.names.boundaries)
        result.insert(piece.second.begin(), piece.second.end());
      return result;
    }

    void
    save(BlockFile &blocks) const
    {
      const PortableFields<dim> portable(state->configuration);
      portable.save(state->displacement, "u", blocks);
      portable.save(state->history, "history", blocks);
      portable.save(faces, "faces", blocks);
    }

    void
    load(const BlockFile &blocks)
    {
      const PortableFields<dim> portable(state->configuration);
      portable.load(blocks, "u", state->displacement);
      portable.load(blocks, "history", state->history);
      portable.load(blocks, "faces", faces);
    }

    std::unique_ptr<State<dim>> state;
    FaceHistory<dim>            faces;
  };

  template <int dim, class Make>
  void
  travels(const Make &make, const unsigned int degree)
  {
    // One process alone, and all together
    const Mesh<dim>   mesh_alone = make(MPI_COMM_SELF);
    const Mesh<dim>   mesh       = make(MPI_COMM_WORLD);
    const Fields<dim> alone(mesh_alone, degree, true);
    const Fields<dim> together(mesh, degree, true);
    BlockFile         by_one, by_all;
    alone.save(by_one);
    together.save(by_all);
    if (Utilities::MPI::this_mpi_process(MPI_COMM_WORLD) == 0)
      {
        EXPECT_EQ(bytes_of(by_one), bytes_of(by_all));
      }

    Fields<dim> back(mesh, degree, false);
    back.load(by_one);
    const auto &u = back.state->displacement;
    for (const NodeId node : back.state->nodes.relevant()) // ghosts, too
      for (const auto dof : back.state->nodes.dofs(node))
        EXPECT_EQ(u(dof), together.state->displacement(dof));
    auto &history = together.state->history;
    history.update_ghosts();
    EXPECT_EQ(back.state->history.old_values, history.old_values);
    EXPECT_EQ(back.state->history.trial_values, history.old_values);
    EXPECT_EQ(back.faces.old_values, together.faces.old_values);
    EXPECT_EQ(back.faces.trial_values, together.faces.old_values);
  }
} // namespace



TEST(PortableFields, AnyNumberOfProcessesPlane)
{
  for (const unsigned int degree : {1, 2})
    for (const std::string refinements : {"0", "1"})
      travels<2>([&](const auto &comm) { return academic(comm, refinements); },
                 degree);
}

TEST(PortableFields, AnyNumberOfProcessesSolid)
{
  for (const unsigned int degree : {1, 2})
    travels<3>([](const auto &comm) { return block(comm, "1"); }, degree);
}

TEST(PortableFields, OtherMeshesAndLayoutsAreRefused)
{
  const Mesh<2>   coarse = academic(MPI_COMM_WORLD);
  const Mesh<2>   fine   = academic(MPI_COMM_WORLD, "1");
  const Mesh<2>   mesh   = academic(MPI_COMM_SELF);
  BlockFile       blocks;
  const Fields<2> saved(mesh, 1, true);
  saved.save(blocks);
  Fields<2> other_mesh(fine, 1, false), other_degree(coarse, 2, false);
  EXPECT_THROW(other_mesh.load(blocks), InputError);
  EXPECT_THROW(other_degree.load(blocks), InputError);
  const PortableFields<2> portable(other_degree.state->configuration);
  EXPECT_THROW(portable.load(blocks, "history", other_degree.state->history),
               InputError);
  auto sizes = blocks.integers("history per cell");
  sizes[0]   = ~std::uint64_t(0) - 5;
  blocks.put("history per cell", sizes);
  Fields<2> same(coarse, 1, false);
  EXPECT_THROW(same.load(blocks), InputError);
}
