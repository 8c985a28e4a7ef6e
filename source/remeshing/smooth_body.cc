// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/remeshing/smooth_body.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/vector.h>

#include <algorithm>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    constexpr unsigned int none = BodySurface::none;

    /** Smallest angle of a triangle as its cosine: the largest one. */
    double
    largest_cosine(const Point<3> &a, const Point<3> &b, const Point<3> &c)
    {
      const auto cosine = [](const Tensor<1, 3> &u, const Tensor<1, 3> &v) {
        return u * v / (u.norm() * v.norm());
      };
      return std::max(
        {cosine(b - a, c - a), cosine(a - b, c - b), cosine(a - c, b - c)});
    }

    /** Weights of the point of a triangle that is nearest to @p x. */
    std::array<double, 3>
    nearest_weights(const std::array<Point<3>, 3> &p, const Point<3> &x)
    {
      // Inside, if all weights are positive; else the best of the edges
      const Tensor<1, 3> a = p[1] - p[0], b = p[2] - p[0], y = x - p[0];
      const double       aa = a * a, ab = a * b, bb = b * b;
      const double       ay = a * y, by = b * y;
      const double       det = aa * bb - ab * ab;
      if (det > 0.)
        {
          const double s = (bb * ay - ab * by) / det;
          const double t = (aa * by - ab * ay) / det;
          if (s >= 0. && t >= 0. && s + t <= 1.)
            return {{1. - s - t, s, t}};
        }
      std::array<double, 3> best{{1., 0., 0.}};
      double                distance = std::numeric_limits<double>::max();
      for (unsigned int i = 0; i < 3; ++i)
        {
          const unsigned int j = (i + 1) % 3;
          const Tensor<1, 3> e = p[j] - p[i];
          const double       t =
            std::min(1., std::max(0., (x - p[i]) * e / e.norm_square()));
          const double d = x.distance(p[i] + t * e);
          if (d < distance)
            {
              distance = d;
              best     = {{0., 0., 0.}};
              best[i]  = 1. - t;
              best[j]  = t;
            }
        }
      return best;
    }
  } // namespace



  SmoothBody::SmoothBody(const BodySurface &body)
    : body(body)
    , patch_parts(body.n_patches)
    , triangles_of(body.n_patches)
  {
    patch_face.assign(body.n_patches, none);
    for (unsigned int f = 0; f < body.faces.size(); ++f)
      {
        const auto &face = body.faces[f];
        if (patch_face[face.patch] != none)
          continue;
        patch_face[face.patch] = f;
        for (const unsigned int c : face.components)
          if (c != none)
            {
              auto              &parts = patch_parts[face.patch];
              const unsigned int part  = body.components[c].part;
              if (std::count(parts.begin(), parts.end(), part) == 0)
                parts.push_back(part);
            }
      }
    for (const auto &curve : body.curves)
      {
        splines.emplace_back();
        for (const unsigned int part : curve.parts)
          {
            std::vector<Point<3>> points;
            for (const unsigned int node : curve.nodes)
              points.push_back(body.places[part][node]);
            if (curve.closed)
              points.pop_back();
            splines.back().emplace(
              part,
              CubicSpline<3>(points,
                             curve.closed ? CubicSpline<3>::Ends::closed
                                          : CubicSpline<3>::Ends::not_a_knot));
          }
      }
    divide_faces();
    fit_normals();
  }



  // By the diagonal that leaves the larger smallest angle, in the first part
  void
  SmoothBody::divide_faces()
  {
    std::vector<std::vector<BoundingBox<3>>> boxes(body.n_patches);
    for (const auto &face : body.faces)
      {
        const auto                       &x = body.places[body.part(face)];
        const auto                       &n = face.nodes;
        std::array<double, 2>             worst{};
        std::array<std::array<int, 6>, 2> ways{
          {{{0, 1, 2, 0, 2, 3}}, {{0, 1, 3, 1, 2, 3}}}};
        for (unsigned int k = 0; k < 2; ++k)
          worst[k] = std::max(largest_cosine(x[n[ways[k][0]]],
                                             x[n[ways[k][1]]],
                                             x[n[ways[k][2]]]),
                              largest_cosine(x[n[ways[k][3]]],
                                             x[n[ways[k][4]]],
                                             x[n[ways[k][5]]]));
        // Not by round-off where both are the same
        const unsigned int better = worst[1] < worst[0] - 1e-6 ? 1 : 0;
        for (unsigned int t = 0; t < 2; ++t)
          {
            const auto &way = ways[better];
            Triangle    triangle;
            triangle.patch = face.patch;
            std::array<Point<3>, 3> corners;
            for (unsigned int i = 0; i < 3; ++i)
              {
                triangle.nodes[i] = n[way[3 * t + i]];
                corners[i]        = x[triangle.nodes[i]];
              }
            triangles_of[face.patch].push_back(triangles.size());
            triangles.push_back(triangle);
            boxes[face.patch].push_back(BoxTree<3>::around(corners, 3));
          }
      }
    for (unsigned int p = 0; p < body.n_patches; ++p)
      trees.push_back(std::make_unique<BoxTree<3>>(boxes[p]));
  }



  void
  SmoothBody::fit_normals()
  {
    // Nodes of each patch with those in common faces
    std::vector<std::map<unsigned int, std::set<unsigned int>>> ring(
      body.n_patches);
    std::map<std::pair<unsigned int, unsigned int>, Normals> means;
    for (const auto &face : body.faces)
      {
        for (const unsigned int a : face.nodes)
          for (const unsigned int b : face.nodes)
            if (a != b)
              ring[face.patch][a].insert(b);
        for (const unsigned int part : patch_parts[face.patch])
          {
            const auto &x = body.places[part];
            for (unsigned int i = 0; i < 4; ++i)
              {
                const unsigned int at = face.nodes[i];
                means[{face.patch, part}][at] +=
                  cross_product_3d(x[face.nodes[(i + 1) % 4]] - x[at],
                                   x[face.nodes[(i + 3) % 4]] - x[at]);
              }
          }
      }
    for (auto &entry : means)
      for (auto &[node, mean] : entry.second)
        {
          const unsigned int patch = entry.first.first;
          const auto        &x     = body.places[entry.first.second];
          mean /= mean.norm();
          Tensor<1, 3> &normal        = normals[entry.first][node];
          normal                      = mean;
          std::set<unsigned int> near = ring[patch].at(node);
          if (near.size() < 8)
            for (const unsigned int j : ring[patch].at(node))
              near.insert(ring[patch].at(j).begin(), ring[patch].at(j).end());
          near.erase(node);
          if (near.size() < 6)
            {
              ++n_plain_normals;
              continue;
            }
          unsigned int least = 0;
          for (unsigned int c = 1; c < 3; ++c)
            if (std::abs(mean[c]) < std::abs(mean[least]))
              least = c;
          Tensor<1, 3> e1 =
            cross_product_3d(mean, Point<3>::unit_vector(least));
          e1 /= e1.norm();
          const Tensor<1, 3> e2   = cross_product_3d(mean, e1);
          double             size = 0.;
          for (const unsigned int j : ring[patch].at(node))
            size = std::max(size, x[j].distance(x[node]));
          FullMatrix<double> matrix(5, 5);
          Vector<double>     right(5), solution(5);
          for (const unsigned int j : near)
            {
              const Tensor<1, 3> way = (x[j] - x[node]) / size;
              const double       s = way * e1, t = way * e2, h = way * mean;
              const double       weight = 1. / way.norm_square();
              const std::array<double, 5> row{
                {s, t, 0.5 * s * s, s * t, 0.5 * t * t}};
              for (unsigned int a = 0; a < 5; ++a)
                {
                  right[a] += weight * row[a] * h;
                  for (unsigned int b = 0; b < 5; ++b)
                    matrix(a, b) += weight * row[a] * row[b];
                }
            }
          // Where nodes lie on two lines, there is no quadratic function
          FullMatrix<double> scaled(matrix);
          for (unsigned int a = 0; a < 5; ++a)
            for (unsigned int b = 0; b < 5; ++b)
              scaled(a, b) /= std::sqrt(matrix(a, a) * matrix(b, b));
          if (!(scaled.determinant() > 1e-6))
            {
              ++n_plain_normals;
              continue;
            }
          matrix.gauss_jordan();
          matrix.vmult(solution, right);
          Tensor<1, 3> fitted = mean - solution[0] * e1 - solution[1] * e2;
          fitted /= fitted.norm();
          if (fitted * mean > 0.8)
            normal = fitted;
          else
            ++n_plain_normals;
        }
  }



  std::pair<unsigned int, double>
  SmoothBody::interval(const unsigned int curve, double u) const
  {
    const auto        &c = body.curves[curve];
    const unsigned int n = c.nodes.size() - 1;
    if (c.closed)
      u -= n * std::floor(u / n);
    const unsigned int i =
      std::min<unsigned int>(n - 1, std::max(0., std::floor(u)));
    return {i, u - i};
  }



  Point<3>
  SmoothBody::on_curve(const unsigned int curve,
                       const double       u,
                       const unsigned int part) const
  {
    const auto  place = interval(curve, u);
    const auto &nodes = body.curves[curve].nodes;
    // Nodes stay where they are to the last bit
    if (place.second == 0. || place.second == 1.)
      return body.places[part][nodes[place.first + (place.second > 0.5)]];
    const auto &spline = splines[curve].at(part);
    const auto &t      = spline.knots();
    return spline.value(t[place.first] +
                        place.second * (t[place.first + 1] - t[place.first]));
  }



  double
  SmoothBody::arc_length(const unsigned int curve, const double u) const
  {
    const auto  place  = interval(curve, u);
    const auto &spline = splines[curve].begin()->second;
    const auto &t      = spline.knots();
    double      whole  = 0.;
    if (body.curves[curve].closed)
      whole =
        spline.length() * std::floor(u / (body.curves[curve].nodes.size() - 1));
    return whole + spline.arc_length(t[place.first] +
                                     place.second *
                                       (t[place.first + 1] - t[place.first]));
  }



  double
  SmoothBody::parameter(const unsigned int curve, const double length) const
  {
    const auto &spline = splines[curve].begin()->second;
    const auto &knots  = spline.knots();
    double      s = length, turns = 0.;
    if (body.curves[curve].closed)
      {
        turns = std::floor(s / spline.length());
        s -= turns * spline.length();
      }
    const double       t = spline.parameter_at(std::max(0., s));
    const unsigned int n = knots.size() - 1;
    const unsigned int i = std::min<unsigned int>(
      n - 1,
      std::max<std::ptrdiff_t>(0,
                               std::upper_bound(knots.begin(), knots.end(), t) -
                                 knots.begin() - 1));
    return turns * n + i + (t - knots[i]) / (knots[i + 1] - knots[i]);
  }



  double
  SmoothBody::size_on_curve(const unsigned int curve, const double u) const
  {
    const auto  place = interval(curve, u);
    const auto &nodes = body.curves[curve].nodes;
    return (1. - place.second) * sizes[nodes[place.first]] +
           place.second * sizes[nodes[place.first + 1]];
  }



  SmoothBody::Place
  SmoothBody::nearest(const unsigned int patch, const Point<3> &x) const
  {
    std::vector<unsigned int> near;
    trees[patch]->nearest(x, 12, near);
    const auto &places   = body.places[patch_parts[patch][0]];
    double      smallest = std::numeric_limits<double>::max();
    Place       result;
    for (const unsigned int k : near)
      {
        const unsigned int      t = triangles_of[patch][k];
        std::array<Point<3>, 3> p;
        for (unsigned int i = 0; i < 3; ++i)
          p[i] = places[triangles[t].nodes[i]];
        const auto weights = nearest_weights(p, x);
        const auto at =
          Point<3>(weights[0] * p[0] + weights[1] * p[1] + weights[2] * p[2]);
        const double distance = at.distance(x);
        // Of equally near ones the first
        if (distance < smallest - 1e-9 * (p[1].distance(p[0])))
          {
            smallest = distance;
            result   = {t, weights};
          }
      }
    return result;
  }



  Point<3>
  SmoothBody::on_patch(const Place &place, const unsigned int part) const
  {
    const Triangle &triangle = triangles[place.triangle];
    const auto     &x        = body.places[part];
    const auto     &n        = normals.at({triangle.patch, part});
    Point<3>        y;
    for (unsigned int i = 0; i < 3; ++i)
      y += place.weights[i] * x[triangle.nodes[i]];
    Tensor<1, 3> correction;
    for (unsigned int i = 0; i < 3; ++i)
      {
        const Tensor<1, 3> &normal = n.at(triangle.nodes[i]);
        correction += 0.5 * place.weights[i] *
                      ((x[triangle.nodes[i]] - y) * normal) * normal;
      }
    return y + correction;
  }



  double
  SmoothBody::size_on_patch(const Place &place) const
  {
    double result = 0.;
    for (unsigned int i = 0; i < 3; ++i)
      result += place.weights[i] * sizes[triangles[place.triangle].nodes[i]];
    return result;
  }
} // namespace alveolus
