// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_history_field_h
#define alveolus_base_history_field_h

#include <deal.II/base/symmetric_tensor.h>

#include <limits>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * One quantity kept at every quadrature point: what it is, not how it is
   * moved. A symmetric tensor is a 3x3 tensor also in two dimensions (plane
   * strain), stored there by its four components xx, yy, zz, xy; in three
   * dimensions by xx, yy, zz, xy, xz, yz.
   */
  struct HistoryField
  {
    /** Which components a value has. */
    enum class Shape
    {
      scalar,
      symmetric_tensor
    };

    std::string name; ///< also the name in the output, e.g. "density"
    std::string unit; ///< "" for none
    Shape       shape = Shape::scalar; ///< of one value
    /** Bounds of a scalar, or of the eigenvalues of a tensor. */
    double lower = -std::numeric_limits<double>::infinity();
    /** The same from above. */
    double upper   = std::numeric_limits<double>::infinity();
    bool traceless = false; ///< trace is zero, e.g. log of a unimodular tensor
  };

  /** Number of values that a field of @p shape takes in @p dim dimensions. */
  inline unsigned int
  n_values(const HistoryField::Shape shape, const unsigned int dim)
  {
    return shape == HistoryField::Shape::scalar ? 1 : (dim == 2 ? 4 : 6);
  }

  /** The tensor whose stored values begin at @p values. */
  inline dealii::SymmetricTensor<2, 3>
  unpack(const double *values, const unsigned int dim)
  {
    dealii::SymmetricTensor<2, 3> t;
    for (unsigned int i = 0; i < 3; ++i)
      t[i][i] = values[i];
    t[0][1] = values[3];
    if (dim == 3)
      {
        t[0][2] = values[4];
        t[1][2] = values[5];
      }
    return t;
  }

  /** Store @p t from @p values on. */
  inline void
  pack(const dealii::SymmetricTensor<2, 3> &t,
       double                              *values,
       const unsigned int                   dim)
  {
    for (unsigned int i = 0; i < 3; ++i)
      values[i] = t[i][i];
    values[3] = t[0][1];
    if (dim == 3)
      {
        values[4] = t[0][2];
        values[5] = t[1][2];
      }
  }

  /** The fields of one material one after the other: the record of a point. */
  class HistoryLayout
  {
  public:
    HistoryLayout() = default;
    /**
     * @param fields one after the other in the record
     * @param dim of space: it says how many components a tensor needs
     */
    HistoryLayout(const std::vector<HistoryField> &fields,
                  const unsigned int               dim)
      : fields(fields)
      , dim(dim)
    {
      for (const auto &field : fields)
        {
          offsets.push_back(size);
          size += n_values(field.shape, dim);
        }
    }

    /** Offset of the field @p name in the record, or -1 if there is none. */
    int
    offset(const std::string &name) const
    {
      for (unsigned int i = 0; i < fields.size(); ++i)
        if (fields[i].name == name)
          return static_cast<int>(offsets[i]);
      return -1;
    }

    std::vector<HistoryField> fields;   ///< in the order of the record
    std::vector<unsigned int> offsets;  ///< of each field in the record
    unsigned int              size = 0; ///< values per quadrature point
    unsigned int              dim  = 0; ///< of space
  };
} // namespace alveolus

#endif
