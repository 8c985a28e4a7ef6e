// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/assembly/contact_search.h>

// Newer versions of Boost do not include what their R-tree needs for boxes.
#include <boost/geometry/algorithms/comparable_distance.hpp>
#include <boost/geometry/algorithms/distance.hpp>
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point_xy.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/geometry/strategies/strategies.hpp>

#include <limits>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    namespace bg = boost::geometry;

    using BoxPoint = bg::model::d2::point_xy<double>;
    using Box      = bg::model::box<BoxPoint>;
    using Item     = std::pair<Box, unsigned int>;

    /** Box of points; a parabola lies in that of its control points. */
    Box
    box_of(const std::vector<Point<2>> &points, const double margin)
    {
      Point<2> low = points[0], high = points[0];
      for (const auto &x : points)
        for (unsigned int d = 0; d < 2; ++d)
          {
            low[d]  = std::min(low[d], x[d]);
            high[d] = std::max(high[d], x[d]);
          }
      return Box(BoxPoint(low[0] - margin, low[1] - margin),
                 BoxPoint(high[0] + margin, high[1] + margin));
    }

    Box
    box_of(const EdgeCurve &curve, const double margin)
    {
      std::vector<Point<2>> points = {curve.nodes[0], curve.nodes[1]};
      if (curve.n_nodes == 3)
        points.push_back(Point<2>(2. * curve.nodes[2] -
                                  0.5 * (curve.nodes[0] + curve.nodes[1])));
      return box_of(points, margin);
    }

    double
    clamped(const double xi)
    {
      return std::min(std::max(xi, 0.), 1.);
    }

    double
    distance(const Point<2> &x, const EdgeCurve &curve)
    {
      return x.distance(curve.point(clamped(curve.foot(x))));
    }

    /** Distance of two curves, from points on each of them. */
    double
    distance(const EdgeCurve &a, const EdgeCurve &b)
    {
      double smallest = std::numeric_limits<double>::max();
      for (const double xi : {0., 0.25, 0.5, 0.75, 1.})
        smallest = std::min(
          {smallest, distance(a.point(xi), b), distance(b.point(xi), a)});
      return smallest;
    }
  } // namespace



  struct ContactSearch::Tree
  {
    bg::index::rtree<Item, bg::index::rstar<8>> rtree;
  };



  ContactSearch::ContactSearch(const ContactSurface &surface)
    : surface(surface)
    , tree(std::make_unique<Tree>())
  {
    std::vector<Item> items;
    for (unsigned int e = 0; e < surface.outline.n_edges(); ++e)
      items.emplace_back(box_of(surface.curve(e), 0.), e);
    tree->rtree = decltype(tree->rtree)(items); // packed
  }



  ContactSearch::~ContactSearch() = default;



  std::vector<unsigned int>
  ContactSearch::near(const EdgeCurve &curve, const double reach) const
  {
    std::vector<Item> items;
    tree->rtree.query(bg::index::intersects(box_of(curve, reach)),
                      std::back_inserter(items));
    std::vector<unsigned int> edges;
    for (const Item &item : items)
      if (distance(curve, surface.curve(item.second)) <= reach)
        edges.push_back(item.second);
    std::sort(edges.begin(), edges.end());
    return edges;
  }



  std::vector<unsigned int>
  ContactSearch::near(const Point<2> &x, const double reach) const
  {
    std::vector<Item> items;
    tree->rtree.query(bg::index::intersects(box_of({x}, reach)),
                      std::back_inserter(items));
    std::vector<unsigned int> edges;
    for (const Item &item : items)
      if (distance(x, surface.curve(item.second)) <= reach)
        edges.push_back(item.second);
    std::sort(edges.begin(), edges.end());
    return edges;
  }



  std::vector<unsigned int>
  ContactSearch::facing(const std::vector<unsigned int> &edges,
                        const Tensor<1, 2>              &normal) const
  {
    std::vector<unsigned int> result;
    for (const unsigned int e : edges)
      if (surface.curve(e).normal(0.5) * normal < 0.2)
        result.push_back(e);
    return result;
  }



  ContactProjection
  ContactSearch::project(const Point<2>     &x,
                         const Tensor<1, 2> &normal,
                         const double        reach) const
  {
    return surface.project(x, normal, facing(near(x, reach), normal));
  }
} // namespace alveolus
