// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_ligament_interface_h
#define alveolus_materials_ligament_interface_h

#include <alveolus/materials/interface_law.h>
#include <alveolus/materials/table_input.h>

namespace alveolus
{
  /**
   * The periodontal ligament as a layer of thickness h without volume. With the
   * normal part u_n and the slip u_t of the jump, the energy per area is
   *     h W(u_n/h) + h V(|u_t|/h),
   * W the energy of the uniaxial table (engineering strain and stress), V' the
   * shear stress: slope E_t(gamma)/(2(1+nu)) along the tension branch of the
   * table, or the constant initial slope E_0/(2(1+nu)). (Mengoni, Ponthot and
   * Boman, Med. Eng. Phys. 38 (2016) 140, Table 2 and section on model 1; the
   * treatment of shear is ours.) Beyond an optional locking strain the layer is
   * stiff in both directions and in shear [ours]: without it a tooth that needs
   * hundreds of MPa passes far through the bone, whose tabulated ligament never
   * bears more than 13.5 MPa per unit of strain.
   */
  class LigamentInterface : public InterfaceLaw
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override;

    void
    initialize(const std::string &where,
               const std::string &input_directory = ".") override;

    void
    evaluate(const dealii::Tensor<1, 3> &jump,
             const dealii::Tensor<1, 3> &normal,
             dealii::Tensor<1, 3>       &traction,
             dealii::Tensor<2, 3>       &tangent,
             double                     &energy) const override;

    double
    normal_strain(const dealii::Tensor<1, 3> &jump,
                  const dealii::Tensor<1, 3> &normal) const override;

    double
    shear_strain(const dealii::Tensor<1, 3> &jump,
                 const dealii::Tensor<1, 3> &normal) const override;

    /** The table in use, after the choice of the tension branch. */
    const TangentTable &
    table() const
    {
      return law;
    }

  private:
    double      thickness       = 0.2;
    double      poisson         = 0.49;
    double      locking_strain  = 0.; ///< 0: the table goes on
    double      locking_modulus = 0.;
    std::string tangential      = "table";
    TableInput  input           = {"continued", -1.};

    TangentTable law;
    TangentTable shear_law; ///< before the division by 2 (1 + nu)
  };
} // namespace alveolus

#endif
