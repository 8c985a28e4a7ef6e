// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_algebra_serial_system_h
#define alveolus_algebra_serial_system_h

#include <alveolus/algebra/linear_system.h>
#include <alveolus/algebra/umfpack.h>

namespace alveolus
{
  /**
   * The linear system of one process: compressed rows and UMFPACK. A cell
   * matrix is condensed by the constraints C as C^T K C; the rows of
   * constrained degrees of freedom keep a diagonal of the size of K's.
   */
  class SerialSystem : public LinearSystem
  {
  public:
    /**
     * @param pattern     entries between unconstrained degrees of freedom
     * @param constraints homogeneous; which dofs are constrained, and by what,
     *                    must stay
     * @param n_slots     of add_cell()
     */
    SerialSystem(const dealii::DynamicSparsityPattern    &pattern,
                 const dealii::AffineConstraints<double> &constraints,
                 const unsigned int                       n_slots);

    void
    clear() override;

    void
    add(const dealii::FullMatrix<double>                   &cell_matrix,
        const std::vector<dealii::types::global_dof_index> &dofs) override;

    /** The first call for a slot finds the positions of its entries. */
    void
    add_cell(const unsigned int                                  slot,
             const dealii::FullMatrix<double>                   &cell_matrix,
             const std::vector<dealii::types::global_dof_index> &dofs) override;

    void
    compress() override
    {}

    void
    solve(NodalVector &x, const NodalVector &b) override;

    double
    pivot_ratio() const override
    {
      return umfpack.pivot_ratio();
    }

    std::size_t
    n_nonzeros() const override
    {
      return matrix.columns.size();
    }

    std::size_t
    memory_consumption() const override;

    std::size_t
    expected_factor_bytes() override
    {
      return umfpack.expected_bytes(matrix);
    }

    std::string
    name() const override
    {
      return "UMFPACK";
    }

    /** The matrix as it is. */
    const CsrMatrix &
    csr() const
    {
      return matrix;
    }

  private:
    using Dofs = std::vector<dealii::types::global_dof_index>;

    /** Where the entries of a slot belong. */
    enum class Kind : unsigned char
    {
      unknown,
      free,        ///< no constraint: all entries by position
      held,        ///< some dofs held at zero: the others by position
      constrained, ///< hanging nodes: by add()
    };

    void
    find_positions(const unsigned int slot, const Dofs &dofs);
    double &
    entry(const dealii::types::global_dof_index row,
          const dealii::types::global_dof_index column);
    /** What keeps the row of a held dof regular. */
    void
    add_diagonal(const dealii::FullMatrix<double> &cell_matrix,
                 const Dofs                       &dofs,
                 const unsigned int                i);

    const dealii::AffineConstraints<double> &constraints;
    const std::size_t                        n_slots;
    CsrMatrix                                matrix;
    Umfpack                                  umfpack;
    dealii::Vector<double>                   right_hand_side;
    dealii::Vector<double>                   solution;
    std::vector<Kind>                        kinds; ///< of each slot
    /** Positions in matrix.values, [slot][row][column]; all slots have the same
     * number of dofs. */
    std::vector<unsigned int> positions;
  };
} // namespace alveolus

#endif
