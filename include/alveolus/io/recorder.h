// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_recorder_h
#define alveolus_io_recorder_h

#include <alveolus/assembly/condition.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Something measured after every accepted step and written to the history
   * file. Registered; the scene lists recorders under Records / Names, and the
   * name of the section begins the name of the column.
   */
  template <int dim>
  class Recorder
  {
  public:
    virtual ~Recorder() = default;

    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Resolve names. @throws InputError */
    virtual void
    attach(const State<dim> &state, const std::string &where) = 0;

    /**
     * Values now (collective), as (suffix with unit, value).
     * @param reactions internal minus external forces [N (per mm)]
     */
    virtual std::vector<Recorded>
    record(const State<dim> &state, const NodalVector &reactions) const = 0;
  };

  /** Displacement of the material at a named point [mm]. */
  template <int dim>
  class PointDisplacement : public Recorder<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string               on, component_list = "all";
    std::vector<unsigned int> components;
    NodeId                    node = 0;
  };

  /** Sum of the reactions on a boundary: what holds the body there [N]. */
  template <int dim>
  class Resultant : public Recorder<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string               on, component_list = "all";
    std::vector<unsigned int> components;
    std::vector<NodeId>       nodes;
  };

  /** Mean, least and greatest value of a scalar history field in its regions.
   */
  template <int dim>
  class FieldExtremes : public Recorder<dim>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    std::string field;
  };
} // namespace alveolus

#endif
