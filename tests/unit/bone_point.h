// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_unit_bone_point_h
#define alveolus_tests_unit_bone_point_h

// Random states of bone and of elastic materials at a point.
#include "material_point.h"

#include <random>

namespace alveolus::bench
{
  using namespace dealii;

  inline const RemodelledBone &
  as_bone(const std::unique_ptr<Material> &material)
  {
    return dynamic_cast<const RemodelledBone &>(*material);
  }

  inline std::mt19937 generator(11);

  /** In [-1, 1]. */
  inline double
  random_number()
  {
    return std::uniform_real_distribution<double>(-1., 1.)(generator);
  }

  /** Velocity gradient; in the plane for dim = 2. */
  inline Tensor<2, 3>
  random_velocity(const unsigned int dim, const double size)
  {
    Tensor<2, 3> l;
    for (unsigned int i = 0; i < dim; ++i)
      for (unsigned int j = 0; j < dim; ++j)
        l[i][j] = size * random_number();
    return l;
  }

  inline SymmetricTensor<2, 3>
  random_symmetric(const unsigned int dim, const double size)
  {
    SymmetricTensor<2, 3> t;
    for (unsigned int i = 0; i < 3; ++i)
      for (unsigned int j = i; j < 3; ++j)
        if (dim == 3 || i == j || (i < 2 && j < 2))
          t[i][j] = size * random_number();
    return t;
  }

  /**
   * Largest difference between tangent and central differences of the stress,
   * relative to the largest tangent entry.
   */
  inline double
  tangent_error(Sample &point, const Tensor<2, 3> &f)
  {
    const MaterialResponse at    = point.evaluate(f);
    double                 error = 0., size = 0.;
    for (unsigned int k = 0; k < point.layout.dim; ++k)
      for (unsigned int l = 0; l < point.layout.dim; ++l)
        {
          SymmetricTensor<2, 3> difference;
          // fourth-order central difference
          for (const auto &[step, weight] :
               {std::pair<int, double>{1, 2. / 3.}, {2, -1. / 12.}})
            for (const int sign : {1, -1})
              {
                Tensor<2, 3> velocity;
                velocity[k][l] = sign * step * 2e-5;
                difference += sign * weight / 2e-5 *
                              point.evaluate(f + velocity * f, false).stress;
              }
          error = std::max(error, (difference - at.tangent[k][l]).norm());
          size  = std::max(size, at.tangent[k][l].norm());
        }
    return error / size;
  }

  /** Bone in the matrix reading. */
  inline const Parameters matrix = {{"Undamaged density", "1.9"}};

  /** Strain, density and fabric of a bone within their bounds. */
  inline void
  randomize(Sample &point, const double strain, const bool fabric)
  {
    const unsigned int dim = point.layout.dim;
    point.set("elastic strain", random_symmetric(dim, strain));
    point.value("density") = 1.0 + 0.4 * random_number();
    if (fabric)
      point.set("log fabric", deviator(random_symmetric(dim, 0.5)));
  }
} // namespace alveolus::bench

#endif
