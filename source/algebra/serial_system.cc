// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/algebra/serial_system.h>
#include <alveolus/base/errors.h>

#include <cmath>
#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int nowhere = std::numeric_limits<unsigned int>::max();
  } // namespace



  SerialSystem::SerialSystem(const DynamicSparsityPattern    &pattern,
                             const AffineConstraints<double> &constraints,
                             const unsigned int               n_slots)
    : constraints(constraints)
    , n_slots(n_slots)
    , umfpack(/*refine*/ false) // Newton's method does
  {
    matrix.reinit(pattern);
    right_hand_side.reinit(matrix.size());
    solution.reinit(matrix.size());
  }



  void
  SerialSystem::clear()
  {
    std::fill(matrix.values.begin(), matrix.values.end(), 0.);
  }



  double &
  SerialSystem::entry(const types::global_dof_index row,
                      const types::global_dof_index column)
  {
    const std::size_t position = matrix.position(row, column);
    AssertThrow(position < matrix.values.size(),
                ExcMessage("an entry outside of the sparsity pattern"));
    return matrix.values[position];
  }



  void
  SerialSystem::add_diagonal(const FullMatrix<double> &cell_matrix,
                             const Dofs               &dofs,
                             const unsigned int        i)
  {
    double size = std::abs(cell_matrix(i, i));
    if (size == 0.)
      for (unsigned int j = 0; j < dofs.size(); ++j)
        size += std::abs(cell_matrix(j, j)) / dofs.size();
    entry(dofs[i], dofs[i]) += size;
  }



  void
  SerialSystem::add(const FullMatrix<double> &cell_matrix, const Dofs &dofs)
  {
    using Line = std::vector<std::pair<types::global_dof_index, double>>;
    std::vector<Line> lines(dofs.size());
    for (unsigned int i = 0; i < dofs.size(); ++i)
      if (!constraints.is_constrained(dofs[i]))
        lines[i].emplace_back(dofs[i], 1.);
      else
        {
          if (const Line *line = constraints.get_constraint_entries(dofs[i]))
            lines[i] = *line;
          add_diagonal(cell_matrix, dofs, i);
        }
    for (unsigned int i = 0; i < dofs.size(); ++i)
      for (const auto &[row, row_weight] : lines[i])
        for (unsigned int j = 0; j < dofs.size(); ++j)
          for (const auto &[column, weight] : lines[j])
            entry(row, column) += row_weight * weight * cell_matrix(i, j);
  }



  void
  SerialSystem::find_positions(const unsigned int slot, const Dofs &dofs)
  {
    const std::size_t n = dofs.size();
    if (kinds.empty())
      {
        kinds.assign(n_slots, Kind::unknown);
        positions.assign(n_slots * n * n, nowhere);
      }
    AssertIndexRange(slot, n_slots);
    AssertDimension(positions.size(), n_slots * n * n);
    kinds[slot] =
      matrix.values.size() < nowhere ? Kind::free : Kind::constrained;
    for (const auto dof : dofs)
      if (constraints.is_constrained(dof))
        {
          const auto *line = constraints.get_constraint_entries(dof);
          if (line != nullptr && !line->empty())
            kinds[slot] = Kind::constrained;
          else if (kinds[slot] == Kind::free)
            kinds[slot] = Kind::held;
        }
    if (kinds[slot] == Kind::constrained)
      return;
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        if (!constraints.is_constrained(dofs[i]) &&
            !constraints.is_constrained(dofs[j]))
          positions[(slot * n + i) * n + j] = static_cast<unsigned int>(
            &entry(dofs[i], dofs[j]) - matrix.values.data());
  }



  void
  SerialSystem::add_cell(const unsigned int        slot,
                         const FullMatrix<double> &cell_matrix,
                         const Dofs               &dofs)
  {
    if (kinds.empty() || kinds[slot] == Kind::unknown)
      find_positions(slot, dofs);
    const std::size_t   n    = dofs.size();
    const unsigned int *at   = positions.data() + slot * n * n;
    const double       *from = &cell_matrix(0, 0);
    double             *to   = matrix.values.data();
    switch (kinds[slot])
      {
        case Kind::free:
          for (std::size_t k = 0; k < n * n; ++k)
            to[at[k]] += from[k];
          break;
        case Kind::held:
          for (std::size_t k = 0; k < n * n; ++k)
            if (at[k] != nowhere)
              to[at[k]] += from[k];
          for (unsigned int i = 0; i < n; ++i)
            if (constraints.is_constrained(dofs[i]))
              add_diagonal(cell_matrix, dofs, i);
          break;
        default:
          add(cell_matrix, dofs);
      }
  }



  std::size_t
  SerialSystem::memory_consumption() const
  {
    return matrix.memory_consumption() + kinds.capacity() * sizeof(Kind) +
           positions.capacity() * sizeof(unsigned int) +
           (right_hand_side.size() + solution.size()) * sizeof(double);
  }



  void
  SerialSystem::solve(NodalVector &x, const NodalVector &b)
  {
    umfpack.factorize(matrix);
    for (unsigned int i = 0; i < right_hand_side.size(); ++i)
      right_hand_side[i] =
        constraints.is_constrained(i) ? 0. : b.local_element(i);
    umfpack.solve(solution, right_hand_side);
    constraints.distribute(solution);
    x.zero_out_ghost_values();
    for (unsigned int i = 0; i < solution.size(); ++i)
      x.local_element(i) = solution[i];
    x.update_ghost_values();
  }
} // namespace alveolus
