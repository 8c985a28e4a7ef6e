// SPDX-License-Identifier: LGPL-2.1-or-later
// mpirun=2
// Contact on several processes: scene/contact-patch and scene/incisor; here
// only what it refuses.
#include <alveolus/assembly/contact_condition.h>
#include <alveolus/base/errors.h>

#include <deal.II/grid/grid_generator.h>

#include <gtest/gtest.h>

using namespace dealii;
using namespace alveolus;



TEST(Contact, IsRefusedWithHangingNodesOnSeveralProcesses)
{
  Mesh<2> mesh;
  mesh.triangulation =
    std::make_unique<parallel::distributed::Triangulation<2>>(MPI_COMM_WORLD);
  GridGenerator::hyper_cube(*mesh.triangulation, 0., 1., true);
  mesh.triangulation->refine_global(2);
  for (const auto &cell : mesh.triangulation->active_cell_iterators())
    if (cell->is_locally_owned() && cell->center()[0] < 0.25)
      cell->set_refine_flag();
  mesh.triangulation->execute_coarsening_and_refinement();
  mesh.names.boundaries = {{"left", {0}}, {"right", {1}}};
  State<2> state(mesh, 1, {{0, 0}}, {HistoryLayout({}, 2)});

  auto             contact = Registry<Condition<2>>::create("contact", "Type");
  ParameterHandler prm;
  contact->declare_parameters(prm);
  prm.set("On", "left");
  prm.set("Against", "right");
  if (Utilities::MPI::n_mpi_processes(MPI_COMM_WORLD) == 1)
    contact->attach(state, "Conditions / contact");
  else
    EXPECT_THROW(contact->attach(state, "Conditions / contact"), InputError);
}
