// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_remodelling_remodelling_law_h
#define alveolus_remodelling_remodelling_law_h

#include <alveolus/base/registry.h>
#include <alveolus/materials/remodelled_bone.h>

#include <deal.II/base/parameter_handler.h>

namespace alveolus
{
  /** Rates of the remodelling variables at a point. */
  struct RemodellingRates
  {
    double                        density = 0.; ///< [g/cc/T]
    dealii::SymmetricTensor<2, 3> log_fabric;   ///< trace 0 [1/T]
  };

  /**
   * A law of bone adaptation at a point: from the mechanical state to the rates
   * of density and fabric. It knows neither mesh nor time integration.
   */
  class RemodellingLaw
  {
  public:
    virtual ~RemodellingLaw() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /** Check the parameters after parsing. @throws InputError */
    virtual void
    initialize(const std::string &where) = 0;

    /** True if the law turns and sharpens the fabric. */
    virtual bool
    changes_fabric() const = 0;

    /** The stimulus that a point of @p bone sees: signed energy density [MPa].
     */
    virtual double
    stimulus(const RemodelledBone &bone, const BonePoint &point) const = 0;

    /** Rates for a (possibly filtered) stimulus. */
    virtual RemodellingRates
    rates(const RemodelledBone &bone,
          const BonePoint      &point,
          const double          stimulus) const = 0;
  };
} // namespace alveolus

#endif
