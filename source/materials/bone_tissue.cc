// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/materials/bone_tissue.h>

#include <cmath>

namespace alveolus
{
  namespace bone_tissue
  {
    namespace
    {
      bool
      is_dense(const double density)
      {
        static const double crossing = std::pow(2014. / 1763., 1. / 0.7);
        return density > crossing;
      }
    } // namespace

    double
    young_modulus(const double density)
    {
      return is_dense(density) ? 1763. * std::pow(density, 3.2)
                               : 2014. * density * density * std::sqrt(density);
    }



    double
    stiffness_exponent(const double density)
    {
      return is_dense(density) ? 3.2 : 2.5;
    }



    double
    specific_surface(const double n)
    {
      return n * (32.3 + n * (-93.9 + n * (134. + n * (-101. + n * 28.8))));
    }
  } // namespace bone_tissue
} // namespace alveolus
