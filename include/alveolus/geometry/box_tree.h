// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_geometry_box_tree_h
#define alveolus_geometry_box_tree_h

#include <deal.II/base/bounding_box.h>

#include <memory>
#include <vector>

namespace alveolus
{
  /** Finds among many boxes those that meet a box or are near a point. */
  template <int dim>
  class BoxTree
  {
  public:
    /** Extent of an object, by its opposite corners [mm]. */
    using Box = dealii::BoundingBox<dim>;

    /** A packed R-tree (Boost.Geometry) of @p boxes. */
    explicit BoxTree(const std::vector<Box> &boxes);
    ~BoxTree();
    /** Takes the tree; the other is empty. */
    BoxTree(BoxTree &&) noexcept;
    BoxTree &
    operator=(BoxTree &&) noexcept; ///< Takes the tree; the other is empty.

    /** Numbers of the boxes that meet @p box or touch it, ascending. */
    void
    meeting(const Box &box, std::vector<unsigned int> &numbers) const;

    /** Numbers of the @p n boxes nearest to @p x, ascending. */
    void
    nearest(const dealii::Point<dim>  &x,
            const unsigned int         n,
            std::vector<unsigned int> &numbers) const;

    /** The smallest box around @p points. */
    template <class Points>
    static Box
    around(const Points &points, const unsigned int n)
    {
      std::pair<dealii::Point<dim>, dealii::Point<dim>> ends{points[0],
                                                             points[0]};
      for (unsigned int i = 1; i < n; ++i)
        for (unsigned int d = 0; d < dim; ++d)
          {
            ends.first[d]  = std::min(ends.first[d], points[i][d]);
            ends.second[d] = std::max(ends.second[d], points[i][d]);
          }
      return Box(ends);
    }

  private:
    struct Tree;
    std::unique_ptr<Tree> tree;
  };
} // namespace alveolus

#endif
