// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_ligament_point_h
#define alveolus_tests_unit_ligament_point_h

// Materials of the ligament at a point, by Table 2.
#include "material_point.h"

#include <alveolus/materials/hencky_tabulated.h>

#include <algorithm>
#include <random>

namespace alveolus::bench
{
  using namespace dealii;

  inline const std::string table_file =
    ALVEOLUS_SOURCE_DIR "/prm/tables/ligament-table-2.csv";

  /** The parameters and the file of Table 2. */
  inline Parameters
  with_table(Parameters parameters)
  {
    parameters.emplace_back("Table file", table_file);
    return parameters;
  }

  /** The table as printed, jumps and all. */
  inline const TangentTable &
  printed()
  {
    static const TangentTable table(TangentTable::read(table_file, ""), "");
    return table;
  }

  /** Along the axes. */
  inline Tensor<2, 3>
  stretch(const double x, const double y, const double z)
  {
    Tensor<2, 3> f;
    f[0][0] = x;
    f[1][1] = y;
    f[2][2] = z;
    return f;
  }

  /** Numbers and states at random, the same in each run. */
  class Random
  {
  public:
    double
    operator()(const double size)
    {
      return std::uniform_real_distribution<double>(-size, size)(generator);
    }

    /** Velocity gradient; in the plane for dim = 2. */
    Tensor<2, 3>
    velocity(const unsigned int dim, const double size)
    {
      Tensor<2, 3> l;
      for (unsigned int i = 0; i < dim; ++i)
        for (unsigned int j = 0; j < dim; ++j)
          l[i][j] = (*this)(size);
      return l;
    }

    SymmetricTensor<2, 3>
    symmetric(const unsigned int dim, const double size)
    {
      SymmetricTensor<2, 3> t;
      for (unsigned int i = 0; i < 3; ++i)
        for (unsigned int j = i; j < 3; ++j)
          if (dim == 3 || i == j || (i < 2 && j < 2))
            t[i][j] = (*this)(size);
      return t;
    }

  private:
    std::mt19937 generator{11};
  };

  /**
   * Largest difference between tangent and central differences of the stress,
   * relative to the largest tangent entry. The modulus of a table has kinks:
   * the step is small, and states within it of a kink are to be avoided.
   */
  inline double
  tangent_error(Sample &point, const Tensor<2, 3> &f)
  {
    const MaterialResponse at    = point.evaluate(f);
    double                 error = 0., size = 0.;
    const double           step = 1e-6;
    for (unsigned int k = 0; k < point.layout.dim; ++k)
      for (unsigned int l = 0; l < point.layout.dim; ++l)
        {
          Tensor<2, 3> velocity;
          velocity[k][l]   = step;
          const auto plus  = point.evaluate(f + velocity * f, false).stress;
          const auto minus = point.evaluate(f - velocity * f, false).stress;
          error =
            std::max(error,
                     ((plus - minus) / (2. * step) - at.tangent[k][l]).norm());
          size = std::max(size, at.tangent[k][l].norm());
        }
    return error / size;
  }

  /**
   * Uniaxial test from the unloaded state to the axial stretch @p l in @p
   * n_steps equal steps: the lateral stretch follows from a free side.
   * @return engineering stress [MPa]
   */
  inline double
  uniaxial(const Material &material, const double l, const unsigned int n_steps)
  {
    Sample point(material, 3);
    double stress = 0.;
    for (unsigned int n = 1; n <= n_steps; ++n)
      {
        const double axial = std::pow(l, 1. / n_steps);
        double       y     = std::pow(axial, -0.49);
        for (unsigned int i = 0; i < 100; ++i)
          {
            const auto  &r        = point.evaluate(stretch(axial, y, y));
            const double residual = r.stress[1][1];
            const double slope  = r.tangent[1][1][1][1] + r.tangent[2][2][1][1];
            const double change = residual / slope;
            y *= std::exp(std::max(-0.05, std::min(0.05, -change)));
            if (std::abs(change) < 1e-15)
              break;
          }
        stress = point.commit(stretch(axial, y, y)).stress[0][0];
        // free to round-off of the bulk modulus
        EXPECT_LT(std::abs(point.response.stress[1][1]),
                  1e-14 * std::abs(point.response.tangent[1][1][1][1]));
      }
    return stress / l;
  }
} // namespace alveolus::bench

#endif
