// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_material_point_h
#define alveolus_tests_unit_material_point_h

// A material at a point, its history and response.
#include <alveolus/materials/remodelled_bone.h>

#include <gtest/gtest.h>

namespace alveolus::bench
{
  using namespace dealii;

  using Parameters = std::vector<std::pair<std::string, std::string>>;

  /** A material; bone has the history of the remodelling told. */
  inline std::unique_ptr<Material>
  make(const std::string &name,
       const Parameters  &parameters,
       const unsigned int dim,
       const bool         density = true,
       const bool         fabric  = true)
  {
    auto             material = Registry<Material>::create(name, "Type");
    ParameterHandler prm;
    material->declare_parameters(prm);
    for (const auto &[key, value] : parameters)
      prm.set(key, value);
    if (auto *bone = dynamic_cast<RemodelledBone *>(material.get()))
      bone->set_remodelled(density, fabric);
    material->initialize(dim, "Materials/test");
    return material;
  }

  /** A point with its history and everything evaluate() returns. */
  struct Sample
  {
    Sample(const Material &material, const unsigned int dim)
      : material(material)
      , layout(material.history_fields(), dim)
      , old(layout.size)
      , trial(layout.size)
    {
      material.initial_history(old.data());
    }

    double &
    value(const std::string &field)
    {
      EXPECT_GE(layout.offset(field), 0) << field;
      return old[layout.offset(field)];
    }

    void
    set(const std::string &field, const SymmetricTensor<2, 3> &t)
    {
      pack(t, &value(field), layout.dim);
    }

    SymmetricTensor<2, 3>
    get(const std::string &field)
    {
      return unpack(&value(field), layout.dim);
    }

    const MaterialResponse &
    evaluate(const Tensor<2, 3> &f, const bool need_tangent = true)
    {
      material.evaluate(f, old.data(), trial.data(), need_tangent, response);
      return response;
    }

    void
    commit()
    {
      old = trial;
    }

    const MaterialResponse &
    commit(const Tensor<2, 3> &f)
    {
      evaluate(f);
      commit();
      return response;
    }

    const Material     &material;
    HistoryLayout       layout;
    std::vector<double> old, trial;
    MaterialResponse    response;
  };

  inline const Tensor<2, 3> unit(unit_symmetric_tensor<3>());

  /** About an axis through the origin. */
  inline Tensor<2, 3>
  rotation(const Tensor<1, 3> &axis, const double angle)
  {
    // Rodrigues
    Tensor<2, 3> W;
    const auto   n = axis / axis.norm();
    W[2][1]        = n[0];
    W[1][2]        = -n[0];
    W[0][2]        = n[1];
    W[2][0]        = -n[1];
    W[1][0]        = n[2];
    W[0][1]        = -n[2];
    return unit + std::sin(angle) * W + (1. - std::cos(angle)) * W * W;
  }

  /** Largest difference between the stress and central differences of the
   * energy, relative to the stress. */
  inline double
  energy_error(Sample &point, const Tensor<2, 3> &f)
  {
    const SymmetricTensor<2, 3> stress = point.evaluate(f).stress;
    double                      error  = 0.;
    const double                step   = 1e-5;
    for (unsigned int k = 0; k < point.layout.dim; ++k)
      for (unsigned int l = 0; l < point.layout.dim; ++l)
        {
          Tensor<2, 3> velocity;
          velocity[k][l]     = step;
          const double plus  = point.evaluate(f + velocity * f, false).energy;
          const double minus = point.evaluate(f - velocity * f, false).energy;
          error =
            std::max(error,
                     std::abs((plus - minus) / (2. * step) - stress[k][l]));
        }
    return error / stress.norm();
  }
} // namespace alveolus::bench

#endif
