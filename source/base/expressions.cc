// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/expressions.h>

#include <deal.II/base/utilities.h>

#include <iostream>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Text of a deal.II exception on one line, without banner and stack. */
    std::string
    reason(const ExceptionBase &error)
    {
      std::ostringstream text;
      error.print_info(text);
      std::string result = text.str();
      for (char &c : result)
        if (c == '\n')
          c = ' ';
      return Utilities::trim(result);
    }



    /** deal.II writes parts of the message to std::cerr before it throws. */
    class Quiet
    {
    public:
      Quiet()
        : former(std::cerr.rdbuf(nullptr))
      {}

      Quiet(const Quiet &) = delete;
      Quiet &
      operator=(const Quiet &) = delete;

      ~Quiet()
      {
        std::cerr.rdbuf(former);
        std::cerr.clear();
      }

    private:
      std::streambuf *former;
    };



    /** @param variables names, e.g. "x,y"; one more than dim if one is time. */
    template <int dim>
    std::unique_ptr<FunctionParser<dim>>
    parse(const std::string &expressions,
          const unsigned int n_components,
          const std::string &variables,
          const bool         with_time,
          const std::string &where)
    {
      const auto list = Utilities::split_string_list(expressions, ';');
      if (list.size() != n_components)
        throw InputError(where,
                         "'" + expressions + "' has " +
                           std::to_string(list.size()) + " expressions",
                         n_components == 1
                           ? "one is needed"
                           : std::to_string(n_components) +
                               " are needed, separated by semicolons");
      auto function = std::make_unique<FunctionParser<dim>>(n_components);
      const Quiet quiet;
      try
        {
          function->initialize(variables,
                               list,
                               {{"pi", numbers::PI}},
                               with_time);
          // Each expression is parsed when it is first evaluated.
          for (unsigned int c = 0; c < n_components; ++c)
            function->value(Point<dim>(), c);
        }
      catch (const ExceptionBase &error)
        {
          throw InputError(where,
                           "'" + expressions + "' cannot be evaluated (" +
                             reason(error) + ")",
                           "use expressions in " + variables);
        }
      return function;
    }
  } // namespace



  template <int dim>
  std::unique_ptr<FunctionParser<dim>>
  parse_function(const std::string &expressions,
                 const unsigned int n_components,
                 const std::string &where)
  {
    return parse<dim>(
      expressions, n_components, dim == 2 ? "x,y,t" : "x,y,z,t", true, where);
  }



  template <int dim>
  std::unique_ptr<FunctionParser<dim>>
  parse_function_of_place(const std::string &expressions,
                          const unsigned int n_components,
                          const std::string &where)
  {
    return parse<dim>(
      expressions, n_components, dim == 2 ? "x,y" : "x,y,z", false, where);
  }



  std::unique_ptr<FunctionParser<1>>
  parse_function_of_time(const std::string &expressions,
                         const unsigned int n_components,
                         const std::string &where)
  {
    return parse<1>(expressions, n_components, "t", false, where);
  }



  Tensor<1, 3>
  parse_vector(const std::string &text, const std::string &where)
  {
    Tensor<1, 3> v;
    const auto   list = Utilities::split_string_list(text, ',');
    try
      {
        AssertThrow(list.size() == 2 || list.size() == 3, ExcInternalError());
        for (unsigned int i = 0; i < list.size(); ++i)
          v[i] = Utilities::string_to_double(list[i]);
      }
    catch (const ExceptionBase &)
      {
        throw InputError(where,
                         "'" + text + "' is not a list of 2 or 3 numbers",
                         "write for example 0, -8");
      }
    return v;
  }

  template std::unique_ptr<FunctionParser<2>>
  parse_function(const std::string &, const unsigned int, const std::string &);
  template std::unique_ptr<FunctionParser<3>>
  parse_function(const std::string &, const unsigned int, const std::string &);
  template std::unique_ptr<FunctionParser<2>>
  parse_function_of_place(const std::string &,
                          const unsigned int,
                          const std::string &);
  template std::unique_ptr<FunctionParser<3>>
  parse_function_of_place(const std::string &,
                          const unsigned int,
                          const std::string &);
} // namespace alveolus
