// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_forces.h>

namespace alveolus
{
  using namespace dealii;

  ContactForces
  pressing_forces(const ContactGap &gap, const double pressure, const double e)
  {
    ContactForces      forces{gap.patch, {}, {}};
    const unsigned int n_nodes =
      gap.patch.n_nodes_of_edge; // only these feel the force
    for (unsigned int a = 0; a <= n_nodes; ++a)
      {
        const double factor       = a == 0 ? -1. : gap.shapes[a - 1];
        const double factor_slope = a == 0 ? 0. : gap.shape_derivatives[a - 1];
        for (unsigned int d = 0; d < 2; ++d)
          {
            forces.value[2 * a + d] = factor * pressure * gap.normal[d];
            for (unsigned int j = 0; j < gap.patch.size(); ++j)
              forces.matrix[2 * a + d][j] =
                factor * (-e * gap.d_gap[j] * gap.normal[d] +
                          pressure * gap.d_normal[d][j]) +
                factor_slope * gap.d_foot[j] * pressure * gap.normal[d];
          }
      }
    return forces;
  }



  ContactForces
  sticking_forces(const ContactOffset &offset,
                  const double         pressure,
                  const double         shear,
                  const double         e)
  {
    ContactForces forces{offset.patch, {}, {}};
    const auto   &g = offset.gap, &s = offset.slip;
    for (unsigned int i = 0; i < offset.patch.size(); ++i)
      {
        forces.value[i] = -pressure * g.gradient[i] + shear * s.gradient[i];
        for (unsigned int j = 0; j < offset.patch.size(); ++j)
          forces.matrix[i][j] =
            e *
              (g.gradient[i] * g.gradient[j] + s.gradient[i] * s.gradient[j]) -
            pressure * g.hessian[i][j] + shear * s.hessian[i][j];
      }
    return forces;
  }
} // namespace alveolus
