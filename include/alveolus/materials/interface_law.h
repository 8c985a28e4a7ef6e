// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_interface_law_h
#define alveolus_materials_interface_law_h

#include <alveolus/base/registry.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/tensor.h>

#include <string>

namespace alveolus
{
  /**
   * A traction law of a thin layer that is not meshed, between a body
   * ("bone") and another one ("tooth"). It derives from an energy, so its
   * tangent is symmetric. Three-dimensional vectors also for plane strain.
   */
  class InterfaceLaw
  {
  public:
    virtual ~InterfaceLaw() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /**
     * Check the parameters after parsing and read tables.
     * @param where path of the subsection, for messages
     * @param input_directory folder that relative file names refer to
     * @throws InputError
     */
    virtual void
    initialize(const std::string &where,
               const std::string &input_directory = ".") = 0;

    /**
     * @param jump     displacement of the tooth minus that of the bone [mm]
     * @param normal   unit normal of the surface, from the bone into the tooth
     * @param traction d energy/d jump [MPa]: +traction acts on the bone,
     *                 -traction on the tooth (the layer pulls them together)
     * @param tangent  d traction/d jump [MPa/mm], symmetric
     * @param energy   per area of the surface [N/mm]
     */
    virtual void
    evaluate(const dealii::Tensor<1, 3> &jump,
             const dealii::Tensor<1, 3> &normal,
             dealii::Tensor<1, 3>       &traction,
             dealii::Tensor<2, 3>       &tangent,
             double                     &energy) const = 0;

    /** Engineering strain normal to the layer, positive if it opens. */
    virtual double
    normal_strain(const dealii::Tensor<1, 3> &jump,
                  const dealii::Tensor<1, 3> &normal) const = 0;

    /** Engineering shear |slip|/thickness of the layer. */
    virtual double
    shear_strain(const dealii::Tensor<1, 3> &jump,
                 const dealii::Tensor<1, 3> &normal) const = 0;
  };
} // namespace alveolus

#endif
