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

    /** Tangent modulus [MPa]; at a jump the value on the side of zero. */
    double
    modulus(const double strain) const;

    /** Engineering stress [MPa]. */
    double
    stress(const double strain) const;

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
    };

    const Segment &
    find(const double strain) const;

    std::vector<Segment> compression, tension;
  };
} // namespace alveolus

#endif
