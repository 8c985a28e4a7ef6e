// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_displacement_condition_h
#define alveolus_assembly_displacement_condition_h

#include <alveolus/assembly/condition.h>
#include <alveolus/base/expressions.h>

#include <memory>

namespace alveolus
{
  /**
   * Components of the displacement prescribed on boundaries, curves or points:
   * du = g(X, t_{n+1}) - g(X, t_n), with X = x - u where the material came
   * from. Without a function the components are held: du = 0, so a boundary
   * along which mesh nodes slide stays what it is.
   */
  template <int dim>
  class DisplacementCondition : public Condition<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    void
    prescribe(const State<dim>     &state,
              const Interval       &interval,
              PrescribedIncrements &increments) const override;
    std::string
    describe() const override;

  private:
    struct Parameters
    {
      std::string on;
      std::string components = "all";
      std::string function;
    } parameters;

    std::vector<unsigned int>                    components;
    std::vector<NodeId>                          nodes;
    std::unique_ptr<dealii::FunctionParser<dim>> function;
  };

  /**
   * Relevant nodes of a comma separated list of boundaries, curves or points.
   * @throws InputError for an unknown name
   */
  template <int dim>
  std::vector<NodeId>
  nodes_on(const Nodes<dim>  &nodes,
           const std::string &list,
           const std::string &where);
} // namespace alveolus

#endif
