// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_material_h
#define alveolus_materials_material_h

#include <alveolus/base/history_field.h>
#include <alveolus/base/registry.h>

#include <deal.II/base/parameter_handler.h>
#include <deal.II/base/symmetric_tensor.h>
#include <deal.II/base/tensor.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace alveolus
{
  /** What a material returns at a point. */
  struct MaterialResponse
  {
    /** Kirchhoff stress [MPa]. */
    dealii::SymmetricTensor<2, 3> stress;

    /**
     * tangent[k][l] is the derivative of the Kirchhoff stress [MPa] in the
     * direction of the velocity gradient e_k (x) e_l: for a variation
     * df = l f of the deformation increment, dtau = sum_kl tangent[k][l] l_kl.
     * (It contains the convective terms.)
     */
    std::array<std::array<dealii::SymmetricTensor<2, 3>, 3>, 3> tangent;

    /** Stored energy per volume of the undeformed material [MPa]. */
    double energy = 0.;

    /**
     * Plastic work lost in the increment, per volume of the undeformed material
     * [MPa]. The caller sets it to zero; laws without dissipation leave it.
     */
    double dissipation = 0.;

    /**
     * Set by the caller: the deformation is one of plane strain, so that the
     * tangent is only asked for k, l < 2 and for k = l = 2.
     */
    bool plane_strain = false;

    /**
     * Set by the caller: the energy of the record as it stands is wanted. A
     * record beyond the yield surface, as transfer may leave it, would flow
     * plastically even without deformation; with this it stays elastic.
     */
    bool no_flow = false;
  };

  /**
   * A constitutive law at a point, in incremental form: from the history at
   * t_n and the deformation increment f = dx_{n+1}/dx_n (3x3, also in plane
   * strain) to the Kirchhoff stress, its consistent tangent and the new
   * history. evaluate() is const and thread-safe: the old history is never
   * changed. Materials know neither mesh nor solver.
   */
  class Material
  {
  public:
    virtual ~Material() = default;

    /** Add the parameters, bound to members, to the current subsection. */
    virtual void
    declare_parameters(dealii::ParameterHandler &prm) = 0;

    /**
     * Check and convert the parameters after parsing.
     * @param dim   dimension of the mesh, decides how tensors are stored
     * @param where path of the subsection, for messages
     * @throws InputError
     */
    virtual void
    initialize(const unsigned int dim, const std::string &where) = 0;

    /** The history the law needs at each point; only what this scene uses. */
    virtual std::vector<HistoryField>
    history_fields() const = 0;

    /** Write the history of the initial state to @p values. */
    virtual void
    initial_history(double *values) const = 0;

    /**
     * @param f      deformation increment, det f > 0
     * @param old    record of the point at t_n
     * @param trial  record at t_{n+1}, written
     * @param need_tangent false: response.tangent need not be filled
     */
    virtual void
    evaluate(const dealii::Tensor<2, 3> &f,
             const double               *old,
             double                     *trial,
             const bool                  need_tangent,
             MaterialResponse           &response) const = 0;

    /**
     * J_n = dv_n/dV of a record: current over undeformed volume of the
     * material, by which stress and energy per undeformed volume become those
     * per volume of the current mesh. This one is for laws whose record begins
     * with the total or elastic Hencky strain and whose other deformation
     * keeps the volume: exp(tr h).
     */
    virtual double
    volume_ratio(const double *history) const
    {
      return std::exp(history[0] + history[1] + history[2]);
    }

    /**
     * Bring a record back into the admissible set after a transfer, e.g. the
     * fabric onto its bounds.
     * @return number of values that had to be limited
     */
    virtual unsigned int
    make_admissible(double * /*history*/) const
    {
      return 0;
    }

    /** Names and units of derived quantities for output. */
    virtual std::vector<std::pair<std::string, std::string>>
    derived_names() const
    {
      return {};
    }

    /** Values of derived_names() from the record of a point. */
    virtual std::vector<double>
    derived_values(const double * /*history*/) const
    {
      return {};
    }
  };
} // namespace alveolus

#endif
