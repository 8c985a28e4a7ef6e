// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/geometry/box_tree.h>

#include <deal.II/boost_adaptors/bounding_box.h>
#include <deal.II/boost_adaptors/point.h>

// Newer versions of Boost do not include what their R-tree needs for boxes.
#include <boost/geometry/algorithms/comparable_distance.hpp>
#include <boost/geometry/algorithms/distance.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <algorithm>
#include <iterator>

namespace alveolus
{
  using namespace dealii;
  namespace bgi = boost::geometry::index;

  namespace
  {
    template <int dim>
    using Entry = std::pair<BoundingBox<dim>, unsigned int>;

    /** The numbers of found entries, put in order. */
    template <int dim>
    void
    sorted_numbers(const std::vector<Entry<dim>> &found,
                   std::vector<unsigned int>     &numbers)
    {
      numbers.clear();
      for (const auto &entry : found)
        numbers.push_back(entry.second);
      std::sort(numbers.begin(), numbers.end());
    }
  } // namespace

  template <int dim>
  struct BoxTree<dim>::Tree
  {
    explicit Tree(const std::vector<Entry<dim>> &entries)
      : rtree(entries)
    {}

    bgi::rtree<Entry<dim>, bgi::linear<16>> rtree;
  };

  template <int dim>
  BoxTree<dim>::BoxTree(const std::vector<Box> &boxes)
  {
    std::vector<Entry<dim>> entries;
    entries.reserve(boxes.size());
    for (unsigned int i = 0; i < boxes.size(); ++i)
      entries.emplace_back(boxes[i], i);
    tree = std::make_unique<Tree>(entries);
  }

  template <int dim>
  BoxTree<dim>::~BoxTree() = default;

  template <int dim>
  BoxTree<dim>::BoxTree(BoxTree &&) noexcept = default;

  template <int dim>
  BoxTree<dim> &
  BoxTree<dim>::operator=(BoxTree &&) noexcept = default;

  template <int dim>
  void
  BoxTree<dim>::meeting(const Box                 &box,
                        std::vector<unsigned int> &numbers) const
  {
    std::vector<Entry<dim>> found;
    tree->rtree.query(bgi::intersects(box), std::back_inserter(found));
    sorted_numbers<dim>(found, numbers);
  }

  template <int dim>
  void
  BoxTree<dim>::nearest(const Point<dim>          &x,
                        const unsigned int         n,
                        std::vector<unsigned int> &numbers) const
  {
    std::vector<Entry<dim>> found;
    tree->rtree.query(bgi::nearest(x, n), std::back_inserter(found));
    sorted_numbers<dim>(found, numbers);
  }

  template class BoxTree<2>;
  template class BoxTree<3>;
} // namespace alveolus
