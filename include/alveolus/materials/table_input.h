// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_table_input_h
#define alveolus_materials_table_input_h

#include <alveolus/materials/tangent_table.h>

#include <deal.II/base/parameter_handler.h>

#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * The parameters by which a law takes a table of tangent moduli: a list or a
   * file, what becomes of the rupture at the end of the tension branch, and,
   * for laws that need a continuous tangent, the width over which jumps are
   * smoothed.
   */
  struct TableInput
  {
    /**
     * @param branch default of "Tension branch": "as printed" or "continued"
     * @param width  default of "Smoothing width" [-]; negative: the law takes
     *               jumps as they are and has no such parameter
     */
    TableInput(const std::string &branch, const double width);

    /** Add the parameters, bound to the members, to the current subsection. */
    void
    declare(dealii::ParameterHandler &prm);

    /**
     * Read the points, check them, and apply the tension branch and the
     * smoothing.
     * @param where           path of the subsection, for messages
     * @param input_directory folder that a relative file name refers to
     * @throws InputError
     */
    std::vector<std::pair<double, double>>
    points(const std::string &where,
           const std::string &input_directory = ".") const;

    /**
     * The table of points(), with a positive modulus at strain zero.
     * @throws InputError
     */
    TangentTable
    table(const std::string &where,
          const std::string &input_directory = ".") const;

    /** The parameter that the points came from, for messages. */
    std::string
    origin(const std::string &where) const;

    std::string list;            ///< points in the parameter file, or empty
    std::string file;            ///< name of a file of points, or empty
    std::string tension_branch;  ///< "continued" or "as printed"
    double      smoothing_width; ///< of jumps of the modulus, in strain [-]
  };
} // namespace alveolus

#endif
