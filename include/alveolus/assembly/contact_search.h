// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_search_h
#define alveolus_assembly_contact_search_h

#include <alveolus/assembly/contact_surface.h>

#include <memory>

namespace alveolus
{
  /**
   * Which edges of a surface are near (an R-tree of their boxes).
   */
  class ContactSearch
  {
  public:
    /** @param surface must outlive this object */
    explicit ContactSearch(const ContactSurface &surface);
    ~ContactSearch();

    /** Edges not farther than @p reach from @p curve [mm], ascending. */
    std::vector<unsigned int>
    near(const EdgeCurve &curve, const double reach) const;

    /** Edges not farther than @p reach from @p x [mm], ascending. */
    std::vector<unsigned int>
    near(const dealii::Point<2> &x, const double reach) const;

    /**
     * Of @p edges those that a boundary with the outward normal @p normal can
     * lie against: n . n_edge < 0.2. It must be more than the cosine of a right
     * angle, so that an edge is there before a closing wedge needs it.
     */
    std::vector<unsigned int>
    facing(const std::vector<unsigned int> &edges,
           const dealii::Tensor<1, 2>      &normal) const;

    /** ContactSurface::project() onto the facing edges near @p x. */
    ContactProjection
    project(const dealii::Point<2>     &x,
            const dealii::Tensor<1, 2> &normal,
            const double                reach) const;

  private:
    struct Tree;

    const ContactSurface &surface;
    std::unique_ptr<Tree> tree;
  };
} // namespace alveolus

#endif
