// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_materials_tangent_table_h
#define alveolus_materials_tangent_table_h

#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * Uniaxial law given by its tangent modulus over the engineering strain:
   * linear between the given points, which may jump (two points of the same
   * strain), constant beyond them. Stress and energy are its exact integrals
   * from strain zero.
   */
  class TangentTable
  {
  public:
    TangentTable() = default;

    /**
     * @param points pairs (strain, modulus [MPa]) of not decreasing strain
     * @param where  for messages
     * @throws InputError if there are none, strains decrease or appear more
     *         than twice, or a modulus is negative
     */
    TangentTable(const std::vector<std::pair<double, double>> &points,
                 const std::string                            &where);

    /** Points from a list such as "-0.25: 0.68, 0: 0.068, 0.14: 1.35". */
    static std::vector<std::pair<double, double>>
    parse(const std::string &list, const std::string &where);

    /**
     * Points from a file of two columns, strain and modulus, separated by a
     * comma or blanks; lines that begin with # are comments, a first line of
     * words is a heading.
     * @throws InputError naming file and line
     */
    static std::vector<std::pair<double, double>>
    read(const std::string &file, const std::string &where);

    /**
     * The points with every jump replaced by a straight line over @p width of
     * strain, half of it on either side, where it meets the lines of the
     * table. Modulus and integrals beyond those widths change only by what the
     * width cuts off, of order width^2 times the slopes in the stress.
     * @throws InputError if another point lies within half a width of a jump
     */
    static std::vector<std::pair<double, double>>
    without_jumps(const std::vector<std::pair<double, double>> &points,
                  const double                                  width,
                  const std::string                            &where);

    /** Tangent modulus [MPa]; at a jump the value on the side of zero. */
    double
    modulus(const double strain) const;

    /** Engineering stress [MPa]. */
    double
    stress(const double strain) const;

    /**
     * Integral of the modulus over the logarithmic strain, int E(e)/(1+e) de
     * [MPa]: the stress of a law whose increments of true stress and
     * logarithmic strain are related by the table. Strain above -1.
     */
    double
    logarithmic_stress(const double strain) const;

    /** Energy per undeformed volume [MPa]. */
    double
    energy(const double strain) const;

  private:
    /** A stretch between two strains of the same sign, going away from 0. */
    struct Segment
    {
      double begin, end;     ///< |strain|, end may be infinite
      double modulus, slope; ///< at begin, per |strain|
      double stress, energy; ///< magnitudes at begin
      double logarithmic;    ///< magnitude of the logarithmic stress at begin
    };

    /** int E/(1+e) de over the first @p d of a segment, its magnitude. */
    static double
    logarithmic_part(const Segment &s, const double sign, const double d);

    const Segment &
    find(const double strain) const;

    std::vector<Segment> compression, tension;
  };
} // namespace alveolus

#endif
