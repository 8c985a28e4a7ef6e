// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_condition_h
#define alveolus_assembly_contact_condition_h

#include <alveolus/assembly/contact_pair.h>

namespace alveolus
{
  /**
   * Unilateral contact between boundaries of one mesh, frictionless or
   * sticking, by an augmented Lagrangian (see ContactPair), in the plane. The
   * multipliers belong to places on the boundary by their relative arc length,
   * so they survive rezoning and remeshing.
   */
  template <int dim>
  class ContactCondition : public Condition<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    void
    take_over(const Condition<dim> &old) override;
    void
    begin_step(const State<dim> &state, const Interval &interval) override;
    void
    add_forces(const State<dim>     &state,
               const NodalVector    &increment,
               const AssemblyTarget &target) override;
    void
    add_couplings(DofGroups &couplings) const override;
    unsigned int
    couplings_revision() const override;
    bool
    augment(const State<dim> &state, const NodalVector &increment) override;
    void
    commit() override;
    bool
    is_contact() const override
    {
      return true;
    }
    void
    save(const PortableFields<dim> &fields,
         const std::string         &prefix,
         BlockFile                 &blocks) const override;
    void
    load(const PortableFields<dim> &fields,
         const std::string         &prefix,
         const BlockFile           &blocks) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;
    std::string
    describe() const override;

  private:
    struct Parameters
    {
      std::string             on;
      std::string             against;
      std::string             friction = "none";
      ContactPair::Parameters pair;
    } parameters;

    std::unique_ptr<ContactPair> pair;
  };
} // namespace alveolus

#endif
