// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_multipliers_h
#define alveolus_assembly_contact_multipliers_h

#include <alveolus/assembly/contact_outline.h>
#include <alveolus/base/block_file.h>

#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * What contact remembers: piecewise linear functions of the relative arc
   * length of each chain of an outline, from 0 at its begin to 1 at its end. So
   * they outlive nodes that slide along the outline, and another mesh of it.
   */
  class ContactMultipliers
  {
  public:
    struct Value
    {
      double pressure = 0.; ///< multiplier [MPa]
      double shear    = 0.; ///< multiplier, along the other's tangent [MPa]
      double slip     = 0.; ///< not yet undone by the shear [mm]
      double touching = 0.; ///< 1 in contact, 0 elsewhere
    };

    /** Relative arc length and value. */
    using Sample = std::pair<double, Value>;

    /**
     * Set the function of a chain; where two samples have the same place their
     * mean is taken.
     */
    void
    set(const unsigned int chain, std::vector<Sample> samples);

    /** Zero where nothing has been set. */
    Value
    get(const unsigned int chain, const double arc_length) const;

    /**
     * Forget the chains of @p outline that are closed: where they begin is not
     * the same on another mesh.
     */
    void
    forget_closed(const ContactOutline &outline);

    /** Into and from blocks of a checkpoint. @throws InputError */
    void
    save(const std::string &prefix, BlockFile &blocks) const;
    /** The same back. @throws InputError if blocks are missing or damaged */
    void
    load(const std::string &prefix, const BlockFile &blocks);

  private:
    std::vector<std::vector<Sample>> functions;
  };

  /**
   * Continuous piecewise linear functions on some edges of an outline, the
   * space of the multipliers: a richer one, e.g. a multiplier at each
   * quadrature point, would let pressures oscillate without bound.
   */
  class ContactMultiplierSpace
  {
  public:
    ContactMultiplierSpace() = default;

    /** @param used for each edge whether it belongs to the domain */
    ContactMultiplierSpace(const ContactOutline    &outline,
                           const std::vector<bool> &used);

    /** Number of the coefficient at the begin (0) or end (1) of an edge. */
    unsigned int
    index(const unsigned int edge, const unsigned int end) const
    {
      return indices[edge][end];
    }

    /** Number of coefficients. */
    unsigned int
    size() const
    {
      return n;
    }

    /**
     * The function with these coefficients at the parameter @p xi of an edge.
     */
    double
    value(const std::vector<double> &coefficients,
          const unsigned int         edge,
          const double               xi) const
    {
      return (1. - xi) * coefficients[indices[edge][0]] +
             xi * coefficients[indices[edge][1]];
    }

    /** A value at a place with the weight of a quadrature rule. */
    struct Sample
    {
      unsigned int edge;   ///< of the outline
      double       xi;     ///< parameter on the edge, in [0, 1]
      double       weight; ///< of the quadrature [mm]
      double       value;  ///< to be approximated, e.g. a pressure [MPa]
    };

    /** The nearest function, in the least squares sense. */
    std::vector<double>
    project(const std::vector<Sample> &samples) const;

  private:
    std::vector<std::array<unsigned int, 2>> indices;
    unsigned int                             n = 0;
  };

  /** Relative arc lengths of an outline at given positions. */
  class ContactArcLength
  {
  public:
    /** @param positions of the outline's nodes [mm] */
    ContactArcLength(const ContactOutline                &outline,
                     const std::vector<dealii::Point<2>> &positions);

    /** Of the point @p xi of an edge, within its chain. */
    double
    operator()(const unsigned int edge, const double xi) const;

    /** Whose chains are measured; must outlive this object. */
    const ContactOutline     &outline;
    std::vector<unsigned int> chain; ///< of each edge

  private:
    std::vector<EdgeCurve> curves;
    std::vector<double>    before; ///< each edge, in its chain [mm]
    std::vector<double>    total;  ///< of each chain [mm]
  };
} // namespace alveolus

#endif
