// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_expressions_h
#define alveolus_base_expressions_h

#include <deal.II/base/function_parser.h>
#include <deal.II/base/tensor.h>

#include <memory>
#include <string>

namespace alveolus
{
  /**
   * A function of place and time from expressions in x, y(, z) and t (and pi),
   * separated by semicolons, one for each component.
   * @throws InputError that says what is wrong in it
   */
  template <int dim>
  std::unique_ptr<dealii::FunctionParser<dim>>
  parse_function(const std::string &expressions,
                 const unsigned int n_components,
                 const std::string &where);

  /** The same without t. @throws InputError */
  template <int dim>
  std::unique_ptr<dealii::FunctionParser<dim>>
  parse_function_of_place(const std::string &expressions,
                          const unsigned int n_components,
                          const std::string &where);

  /**
   * A function of t alone: its value at t is that at Point<1>(t).
   * @throws InputError
   */
  std::unique_ptr<dealii::FunctionParser<1>>
  parse_function_of_time(const std::string &expressions,
                         const unsigned int n_components,
                         const std::string &where);

  /**
   * A vector from two or three numbers separated by commas; what is left out
   * is zero. @throws InputError
   */
  dealii::Tensor<1, 3>
  parse_vector(const std::string &text, const std::string &where);
} // namespace alveolus

#endif
