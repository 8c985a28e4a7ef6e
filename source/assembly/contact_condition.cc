// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_condition.h>

#include <sstream>

namespace alveolus
{
  using namespace dealii;

  template <int dim>
  void
  ContactCondition<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      parameters.on,
                      "Boundaries that may come into contact, those of the "
                      "softer body, separated by commas.",
                      Patterns::Anything());
    prm.add_parameter("Against",
                      parameters.against,
                      "Boundaries they may touch, separated by commas. A line "
                      "of `On` may begin at an end of one of these.",
                      Patterns::Anything());
    prm.add_parameter("Friction",
                      parameters.friction,
                      "none, or sticking: no slip while there is pressure, "
                      "from the end of the step on that brings contact.",
                      Patterns::Selection("none|sticking"));
    prm.add_parameter(
      "Stiffness",
      parameters.pair.stiffness,
      "Pressure per penetration e [MPa/mm]; some ten times "
      "Young's modulus of the softer body over its element "
      "length. Where lines with kinks do not fit each other they go into each "
      "other, or press across a gap, by up to p/e; a stiffer contact also needs "
      "fewer augmentations.",
      Patterns::Double(1e-12));
    prm.add_parameter("Sharp angle",
                      parameters.pair.kink,
                      "Where lines of `Against` meet with a smaller angle than "
                      "this [degrees] the direction of the pressure turns "
                      "gradually along them; at others it is each line's own.",
                      Patterns::Double(0., 180.));
    prm.add_parameter("Penetration tolerance",
                      parameters.pair.tolerance,
                      "Augmentation goes on until penetration, opening under "
                      "pressure, and slip while sticking, in the mean of each "
                      "line's neighbourhood, are no more than this [mm].",
                      Patterns::Double(1e-15));
    prm.add_parameter("Augmentations",
                      parameters.pair.n_augmentations,
                      "Augmentations after which a step is repeated with a "
                      "smaller increment.",
                      Patterns::Integer(0, 10000));
    prm.add_parameter(
      "Search distance",
      parameters.pair.reach,
      "Boundaries farther than this [mm] from each other at the "
      "beginning of a step do not touch in it; less than half "
      "the thickness of the bodies. 0: three times the longest "
      "line of `On`.",
      Patterns::Double(0.));
  }



  template <int dim>
  void
  ContactCondition<dim>::attach(const State<dim>  &state,
                                const std::string &path)
  {
    this->where               = path;
    const auto &triangulation = *state.configuration.mesh.triangulation;
    if (triangulation.has_hanging_nodes() &&
        Utilities::MPI::n_mpi_processes(state.configuration.communicator()) > 1)
      throw InputError(path,
                       "contact on a mesh with hanging nodes works on one "
                       "process only",
                       "start without mpirun, or refine everywhere");
    if constexpr (dim == 2)
      {
        parameters.pair.sticks = parameters.friction == "sticking";
        pair                   = std::make_unique<ContactPair>(state.nodes,
                                             parameters.pair,
                                             state.configuration.positions(),
                                             parameters.on,
                                             parameters.against,
                                             path);
      }
    else
      throw InputError(path,
                       "contact is not available in 3D",
                       "set Dimension = 2, or take the condition out");
  }



  template <int dim>
  void
  ContactCondition<dim>::take_over(const Condition<dim> &old)
  {
    const auto *contact = dynamic_cast<const ContactCondition<dim> *>(&old);
    if (contact != nullptr && contact->pair)
      pair->take_over(*contact->pair);
  }



  template <int dim>
  void
  ContactCondition<dim>::begin_step(const State<dim> &state, const Interval &)
  {
    pair->begin_step(state.configuration.positions());
  }



  template <int dim>
  void
  ContactCondition<dim>::add_forces(const State<dim> &,
                                    const NodalVector    &increment,
                                    const AssemblyTarget &target)
  {
    pair->add_forces(increment, target);
  }



  template <int dim>
  void
  ContactCondition<dim>::add_couplings(DofGroups &couplings) const
  {
    pair->add_couplings(couplings);
  }



  template <int dim>
  unsigned int
  ContactCondition<dim>::couplings_revision() const
  {
    return pair->couplings_revision();
  }



  template <int dim>
  bool
  ContactCondition<dim>::augment(const State<dim> &, const NodalVector &)
  {
    return pair->augment();
  }



  template <int dim>
  void
  ContactCondition<dim>::commit()
  {
    pair->commit();
  }



  template <int dim>
  void
  ContactCondition<dim>::save(const PortableFields<dim> &,
                              const std::string &prefix,
                              BlockFile         &blocks) const
  {
    pair->save(prefix, blocks);
  }



  template <int dim>
  void
  ContactCondition<dim>::load(const PortableFields<dim> &,
                              const std::string &prefix,
                              const BlockFile   &blocks)
  {
    pair->load(prefix, blocks);
  }



  template <int dim>
  std::vector<Recorded>
  ContactCondition<dim>::record(const State<dim> &, const NodalVector &) const
  {
    const ContactPair::Summary sum = pair->summary();
    return {{"force x [N]", sum.force[0]},
            {"force y [N]", sum.force[1]},
            {"length [mm]", sum.length},
            {"greatest pressure [MPa]", sum.pressure},
            {"centre x [mm]", sum.centre[0]},
            {"centre y [mm]", sum.centre[1]},
            {"penetration of lines [mm]", sum.slave_penetration},
            {"penetration of opposite nodes [mm]", sum.master_penetration},
            {"augmentations", static_cast<double>(pair->n_augmentations())}};
  }



  template <int dim>
  std::string
  ContactCondition<dim>::describe() const
  {
    std::ostringstream text;
    text << parameters.on << ": contact against " << parameters.against
         << (parameters.friction == "none" ? ", frictionless, "
                                           : ", sticking, ")
         << parameters.pair.stiffness << " MPa/mm, search " << pair->reach()
         << " mm";
    return text.str();
  }

  template class ContactCondition<2>;
  template class ContactCondition<3>;

  ALVEOLUS_REGISTER_DIM(
    Condition,
    ContactCondition,
    "contact",
    "Unilateral contact of the boundaries `On` (of the softer body) against "
    "`Against`, in the plane: gap g >= 0, pressure "
    "p = <l - e g> >= 0, p g = 0. By an augmented Lagrangian: the multiplier l "
    "follows p, with the penalty e = `Stiffness`, until penetration and opening "
    "under pressure are below `Penetration tolerance`; l is linear on each line "
    "of `On`, e g evens out the rest at each point. The traction is integrated "
    "along these lines between their nodes and the feet of nodes of `Against`. "
    "Where `On` and `Against` end in a common node, contact may begin there as "
    "the angle closes. `Friction` is none or sticking. Records the force on "
    "`On`, where it acts, the largest penetration of its lines and of opposite "
    "nodes, and the augmentations of the step.")
} // namespace alveolus
