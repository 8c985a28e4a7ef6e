// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_types_h
#define alveolus_algebra_types_h

#include <deal.II/lac/la_parallel_vector.h>

namespace alveolus
{
  /** The one vector type: distributed, with ghost entries where asked for. */
  using NodalVector = dealii::LinearAlgebra::distributed::Vector<double>;
} // namespace alveolus

#endif
