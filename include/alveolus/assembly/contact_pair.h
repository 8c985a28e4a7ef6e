// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_pair_h
#define alveolus_assembly_contact_pair_h

#include <alveolus/assembly/condition.h>
#include <alveolus/assembly/contact_forces.h>
#include <alveolus/assembly/contact_multipliers.h>
#include <alveolus/assembly/contact_search.h>

namespace alveolus
{
  /**
   * Unilateral contact of one outline (the slave, the softer body) against
   * another one (the master) of a plane mesh, in the Lagrangian phase of a
   * step: x = x_n + du.
   *
   * The contact traction is integrated along the slave lines of x_n by
   * Simpson's rule on pieces between slave nodes and the feet of master nodes
   * (quarters of parabolas as well), so that the integrands are smooth on each
   * piece and no node of either side is far from a point. Points keep their
   * place on the slave line within a step. A point with the weight w, the
   * multiplier l, the penalty e and the gap g over the master surface receives
   * the force
   *
   *   w p n,   p = <l - e g> >= 0,
   *
   * along the normal n of the smoothed surface (see ContactSurface), and the
   * master nodes the opposite at its foot, so that forces and moments of both
   * sides are in balance. The matrix is its exact derivative, with the motion
   * of foot and normal; it is not symmetric where the normal turns along the
   * surface.
   *
   * Where a point sticks, its force derives from the potential
   *
   *   w (<l - e g>^2/(2 e) + (e/2) (s + r + q/e)^2)
   *
   * with its offset (g, s) since t_n from the place of the master line where it
   * was, the slip r left over from former steps and the shear multiplier q. A
   * point that comes into contact begins to stick at the end of that step.
   *
   * Multipliers are continuous and linear on each slave line. Augmentation
   * (Uzawa) sets l to the positive part of the projection of p, q to that of
   * e (s + r) + q, until no coefficient changes by more than e times the
   * tolerance of length. What is left of the gap is zero in the mean; locally,
   * where kinked lines do not fit each other, the penalty alone bounds it.
   * Every process knows both outlines and computes all of it, which is little
   * beside the cells, and takes its rows of forces and matrix.
   *
   * (Segments and multipliers are those of mortar methods, e.g. Puso and
   * Laursen, Comput. Methods Appl. Mech. Eng. 193 (2004) 601-629; the gap is
   * kept at the points, so that none of them goes deep.)
   */
  class ContactPair
  {
  public:
    struct Parameters
    {
      double       stiffness = 100.;     ///< e [MPa/mm]
      double       tolerance = 1e-3;     ///< of penetration [mm]
      double       reach     = 0.;       ///< of the search [mm]
      double       kink      = 40.;      ///< sharp from this angle on [degrees]
      unsigned int n_augmentations = 20; ///< largest number in a step
      /** No slip under pressure; else none of friction. */
      bool sticks = false;
    };

    /** What the last forces were. */
    struct Summary
    {
      dealii::Tensor<1, 2> force;         ///< on the slave [N/mm]
      dealii::Point<2>     centre;        ///< of pressure [mm]
      double               length   = 0.; ///< with pressure [mm]
      double               pressure = 0.; ///< greatest, projected [MPa]
      double slave_penetration      = 0.; ///< of points of slave lines [mm]
      double master_penetration     = 0.; ///< of master nodes [mm]
    };

    /** @throws InputError for unknown names and lines in both outlines */
    ContactPair(const Nodes<2>    &nodes,
                const Parameters  &parameters,
                const NodalVector &positions,
                const std::string &slaves,
                const std::string &masters,
                const std::string &where);

    /** Go on with the multipliers of a pair on another mesh. */
    void
    take_over(const ContactPair &old);

    /**
     * Place the points on the slave lines at x_n, find the master lines each of
     * them may touch, and take the multipliers of the last accepted step.
     */
    void
    begin_step(const NodalVector &positions);

    /** Forces and matrix at x_n + @p increment. */
    void
    add_forces(const NodalVector &increment, const AssemblyTarget &target);

    /**
     * Tell the matrix which dofs of both bodies depend on each other in this
     * step.
     */
    void
    add_couplings(DofGroups &couplings) const;

    /** Grows when add_couplings() has others than before. */
    unsigned int
    couplings_revision() const
    {
      return revision;
    }

    /**
     * Improve the multipliers for the positions of the last add_forces().
     * @return whether any point had to change
     * @throws RunError after too many augmentations, or if a point has got into
     *         a master line that was out of reach at x_n
     */
    bool
    augment();

    /** Keep what the last add_forces() found as the state of t_{n+1}. */
    void
    commit();

    /** Into and from blocks of a checkpoint. @throws InputError */
    void
    save(const std::string &prefix, BlockFile &blocks) const;
    /** The same back. @throws InputError if blocks are missing or damaged */
    void
    load(const std::string &prefix, const BlockFile &blocks);

    /** Of the last add_forces(). */
    Summary
    summary() const;

    /** Augmentations of the current step so far. */
    unsigned int
    n_augmentations() const
    {
      return n_augmented;
    }

    /** Distance within which master lines are searched for [mm]. */
    double
    reach() const
    {
      return search_reach;
    }

  private:
    /** A quadrature point on a slave line. */
    struct SlavePoint
    {
      unsigned int edge;
      double       xi;
      double       weight; ///< length of x_n [mm]

      double            old_slip; ///< r, at t_n [mm]
      ContactProjection anchor;   ///< where it sticks; or none

      // Of the last add_forces():
      double pressure   = 0.; ///< [MPa]
      double slip       = 0.; ///< s + r [mm]
      double shear_now  = 0.; ///< [MPa]
      bool   in_contact = false;

      dealii::Tensor<1, 2> traction; ///< on the slave [MPa]
    };

    void
    place_points(const unsigned int      edge,
                 const ContactSurface   &surface,
                 const ContactArcLength &arc_length);
    /** Projection of a quantity of the points onto the multiplier space. */
    std::vector<double>
    projected(double SlavePoint::*quantity) const;
    double
    smallest_gap(const ContactSearch &search) const;

    void
    scatter(const SlavePoint     &point,
            const ContactForces  &forces,
            const AssemblyTarget &target) const;

    const Parameters  parameters;
    const std::string where;
    ContactOutline    slave, master;
    double            search_reach = 0.;

    ContactMultipliers      committed;
    std::vector<SlavePoint> points;
    ContactMultiplierSpace  space;
    std::vector<double>     pressure, shear;           ///< multipliers [MPa]
    std::vector<std::vector<unsigned int>> candidates; ///< of each slave edge
    std::vector<dealii::Point<2>>          slave_n, master_n; ///< x_n
    std::vector<dealii::Point<2>>          slave_now, master_now;
    std::vector<bool> slave_smooth, master_smooth; ///< joints
    unsigned int      n_augmented = 0;

    std::vector<std::set<unsigned int>> coupled; ///< master edges of each slave
    unsigned int                        revision = 0;
  };
} // namespace alveolus

#endif
