// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_recorder_h
#define alveolus_io_recorder_h

#include <alveolus/assembly/cell_kernel.h>
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

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Offer the regions with their materials, before attach(). */
    virtual void
    offer_regions(const std::vector<Region> & /*regions*/)
    {}

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

  /** Displacement of the material at a named point, or its magnitude [mm]. */
  template <int dim>
  class PointDisplacement : public Recorder<dim>
  {
  public:
    /** Adds `On`, a named point, and `Components`. */
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
    bool                      magnitude = false;
    NodeId                    node      = 0;
  };

  /** Sum of the reactions on a boundary: what holds the body there [N]. */
  template <int dim>
  class Resultant : public Recorder<dim>
  {
  public:
    /** Adds `On`, boundaries, curves or points, and `Components`. */
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

  /**
   * Least and greatest value of a scalar history field, or of a derived
   * quantity of a material, at the quadrature points of the regions that have
   * it; and, if a bound is given, the number of points where the value does not
   * exceed it, e.g. where a law is no longer elliptic.
   */
  template <int dim>
  class FieldExtremes : public Recorder<dim>
  {
  public:
    /** Adds `Field`, its name, `On`, regions, and `Count up to`. */
    void
    declare_parameters(dealii::ParameterHandler &prm) override;
    void
    offer_regions(const std::vector<Region> &regions) override;
    void
    attach(const State<dim> &state, const std::string &where) override;
    std::vector<Recorded>
    record(const State<dim>  &state,
           const NodalVector &reactions) const override;

  private:
    /** Where the field is found in a region; none if both are negative. */
    struct Place
    {
      int             offset   = -1; ///< in the history record
      int             derived  = -1; ///< number of the derived quantity
      const Material *material = nullptr;
    };

    std::string                   field, bound_text;
    double                        bound = 0.;
    std::vector<const Material *> materials; ///< by region
    std::vector<Place>            places;    ///< by region
  };
} // namespace alveolus

#endif
