// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/materials/table_input.h>

namespace alveolus
{
  TableInput::TableInput(const std::string &branch, const double width)
    : tension_branch(branch)
    , smoothing_width(width)
  {}



  void
  TableInput::declare(dealii::ParameterHandler &prm)
  {
    prm.add_parameter("Tangent modulus",
                      list,
                      "Points 'strain: tangent modulus [MPa]' of the uniaxial "
                      "law by increasing engineering strain, separated by "
                      "commas; a strain listed twice is a jump.",
                      dealii::Patterns::Anything());
    prm.add_parameter("Table file",
                      file,
                      "File with the same points in two columns, used if no "
                      "points are listed.",
                      dealii::Patterns::Anything());
    prm.add_parameter("Tension branch",
                      tension_branch,
                      "as printed: all points of the table; continued: a jump "
                      "at the largest strain (rupture) is left out, and the "
                      "modulus before it goes on.",
                      dealii::Patterns::Selection("continued|as printed"));
    if (smoothing_width >= 0.)
      prm.add_parameter("Smoothing width",
                        smoothing_width,
                        "Engineering strain [-] over which each jump of the "
                        "modulus is replaced by a straight line, half of it on "
                        "either side, so that the tangent is continuous; 0: "
                        "jumps as they are.",
                        dealii::Patterns::Double(0.));
  }



  std::string
  TableInput::origin(const std::string &where) const
  {
    return where + (file.empty() ? "/Tangent modulus" : "/Table file");
  }



  std::vector<std::pair<double, double>>
  TableInput::points(const std::string &where,
                     const std::string &input_directory) const
  {
    if (!list.empty() && !file.empty())
      throw InputError(where + "/Table file",
                       "both a list of tangent moduli and a file are given",
                       "leave one of them empty");
    const std::string name = origin(where);
    auto              points =
      file.empty()
                     ? TangentTable::parse(list, name)
                     : TangentTable::read(file.front() == '/' ? file
                                                 : input_directory + "/" + file,
                             name);
    const TangentTable check(points, name); // throws for bad points
    const auto         n = points.size();
    if (tension_branch == "continued" && n > 1 && points[n - 1].first > 0. &&
        points[n - 1].first == points[n - 2].first)
      points.pop_back();
    if (smoothing_width > 0.)
      points = TangentTable::without_jumps(points, smoothing_width, name);
    return points;
  }



  TangentTable
  TableInput::table(const std::string &where,
                    const std::string &input_directory) const
  {
    const std::string  name = origin(where);
    const TangentTable result(points(where, input_directory), name);
    if (!(result.modulus(0.) > 0.))
      throw InputError(name,
                       "the modulus at strain zero is " +
                         std::to_string(result.modulus(0.)),
                       "it must be positive [MPa]");
    return result;
  }
} // namespace alveolus
