// SPDX-License-Identifier: LGPL-2.1-or-later
// The only file that includes CGAL: its headers compile slowly.
#include <alveolus/base/errors.h>
#include <alveolus/geometry/plane_section.h>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/IO/STL.h>
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Polygon_mesh_slicer.h>
#include <CGAL/Surface_mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <vector>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    using Kernel   = CGAL::Exact_predicates_inexact_constructions_kernel;
    using Surface  = CGAL::Surface_mesh<Kernel::Point_3>;
    using Polyline = std::vector<Kernel::Point_3>;

    /** Corners and facets of an STL file. */
    struct Soup
    {
      std::vector<Kernel::Point_3>            points;
      std::vector<std::array<std::size_t, 3>> facets;
      std::size_t                             n_degenerate = 0;
    };

    Soup
    read_soup(const std::string &content, const std::string &source)
    {
      Soup               soup;
      std::istringstream stream(content, std::ios::binary);
      if (!CGAL::IO::read_STL(stream, soup.points, soup.facets) ||
          soup.facets.empty())
        throw InputError(source,
                         "this is no STL file, or not a complete one",
                         "export the surface as STL, text or binary");
      for (const auto &p : soup.points)
        for (unsigned int d = 0; d < 3; ++d)
          if (!std::isfinite(p[d]))
            throw InputError(source,
                             "a coordinate is not a finite number",
                             "export the surface anew");
      const std::size_t n = soup.facets.size();
      soup.facets.erase(std::remove_if(soup.facets.begin(),
                                       soup.facets.end(),
                                       [](const auto &f) {
                                         return f[0] == f[1] || f[1] == f[2] ||
                                                f[2] == f[0];
                                       }),
                        soup.facets.end());
      soup.n_degenerate = n - soup.facets.size();
      return soup;
    }

    /** The surface, closed. */
    Surface
    closed_surface(Soup &soup, const std::string &source)
    {
      namespace PMP = CGAL::Polygon_mesh_processing;
      // Gives points of edges with more than two facets several times.
      PMP::orient_polygon_soup(soup.points, soup.facets);
      if (!PMP::is_polygon_soup_a_polygon_mesh(soup.facets))
        throw InputError(source,
                         "its facets do not form a surface",
                         "repair it, e.g. in MeshLab");
      Surface surface;
      PMP::polygon_soup_to_polygon_mesh(soup.points, soup.facets, surface);
      std::size_t     n_open = 0;
      Kernel::Point_3 where(0., 0., 0.);
      for (const auto edge : surface.edges())
        if (surface.is_border(edge))
          {
            if (n_open++ == 0)
              where = surface.point(surface.vertex(edge, 0));
          }
      if (n_open > 0)
        {
          std::ostringstream text;
          text.precision(4);
          text << "the surface is not closed: " << n_open
               << " edges have one facet only, the first one at (" << where[0]
               << ", " << where[1] << ", " << where[2]
               << ") in the file's unit";
          throw InputError(
            source,
            text.str(),
            "close its holes, e.g. in MeshLab; facets are joined "
            "where their corners are exactly the same");
        }
      return surface;
    }

    std::string
    list_of(const std::vector<Outline> &loops)
    {
      std::ostringstream text;
      text.precision(4);
      for (std::size_t i = 0; i < loops.size(); ++i)
        {
          const Point<2> centre = centroid_of(loops[i].points);
          text << (i == 0 ? "" : "; ") << i + 1 << ": "
               << std::abs(signed_area(loops[i].points)) << " mm^2 around ("
               << centre[0] << ", " << centre[1] << ")";
        }
      return text.str();
    }
  } // namespace



  bool
  can_cut_surfaces()
  {
    return true;
  }



  Outline
  cut_surface(const std::string  &content,
              const std::string  &source,
              const double        unit,
              const SectionPlane &plane,
              const unsigned int  loop,
              const std::string  &where)
  {
    Soup               soup     = read_soup(content, source);
    const std::size_t  n_facets = soup.facets.size();
    const Surface      surface  = closed_surface(soup, source);
    const auto        &n        = plane.normal;
    const Tensor<1, 3> x_axis   = cross_product_3d(plane.up, n);
    // In the file's unit
    const Point<3>                             origin = plane.origin / unit;
    std::vector<Polyline>                      polylines;
    CGAL::Polygon_mesh_slicer<Surface, Kernel> slicer(surface);
    slicer(Kernel::Plane_3(n[0], n[1], n[2], -(n * origin)),
           std::back_inserter(polylines));

    std::vector<Outline> loops;
    for (const Polyline &polyline : polylines)
      if (polyline.size() > 3 && polyline.front() == polyline.back())
        {
          Outline outline;
          outline.source = source;
          for (std::size_t i = 0; i + 1 < polyline.size(); ++i)
            {
              const Point<3> p(polyline[i][0], polyline[i][1], polyline[i][2]);
              const Tensor<1, 3> r = unit * (p - origin);
              outline.points.emplace_back(r * x_axis, r * plane.up);
            }
          outline.labels.resize(outline.points.size());
          outline.lines.resize(outline.points.size());
          loops.push_back(std::move(outline));
        }
      else if (polyline.size() > 2)
        throw InputError(source,
                         "the plane goes along edges or facets of the surface",
                         "move `Section origin` a little");
    std::sort(loops.begin(), loops.end(), [](const auto &a, const auto &b) {
      return std::abs(signed_area(a.points)) > std::abs(signed_area(b.points));
    });
    if (loops.empty())
      {
        double least = std::numeric_limits<double>::max(), most = -least;
        for (const auto &p : soup.points)
          {
            const double d = unit * (n * (Point<3>(p[0], p[1], p[2]) - origin));
            least          = std::min(least, d);
            most           = std::max(most, d);
          }
        std::ostringstream text;
        text.precision(4);
        text << "the plane misses the surface, which lies from " << least
             << " to " << most << " mm along its normal";
        throw InputError(source,
                         text.str(),
                         "change `Section origin`, or `Outline unit`");
      }
    if (loop == 0 && loops.size() > 1)
      throw InputError(where,
                       "the plane cuts " + source + " in " +
                         std::to_string(loops.size()) +
                         " loops: " + list_of(loops),
                       "set it to the number of the loop to take");
    if (loop > loops.size())
      throw InputError(where,
                       "there is no loop " + std::to_string(loop) + ", only " +
                         list_of(loops),
                       "take one of these");
    Outline outline = loops[loop == 0 ? 0 : loop - 1];
    outline.remarks.push_back(
      "section of " + std::to_string(n_facets) + " facets" +
      (loops.size() > 1 ? ", loop " + std::to_string(loop) + " of " +
                            std::to_string(loops.size())
                        : "") +
      (soup.n_degenerate > 0
         ? ", " + std::to_string(soup.n_degenerate) + " facets without area"
         : ""));
    return checked_outline(std::move(outline));
  }
} // namespace alveolus
