// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/transfer/reference_outline.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Cosine of the angle at which a chain is broken, as remeshers do. */
    const double corner_cosine = std::cos(40. * numbers::PI / 180.);

    /** Chords of a spline between two nodes, by which it is found. */
    constexpr unsigned int n_chords = 4;

    /** Elements looked at: those with the nearest boxes. */
    constexpr unsigned int n_candidates = 16;

    bool
    contains(const OutlineKeys &all, const OutlineKeys &some)
    {
      return std::includes(all.begin(), all.end(), some.begin(), some.end());
    }

    template <int dim>
    Point<dim>
    nearest_on_segment(const Point<dim> &a,
                       const Point<dim> &b,
                       const Point<dim> &X,
                       double           &part)
    {
      const Tensor<1, dim> d = b - a;
      part = std::min(1., std::max(0., ((X - a) * d) / d.norm_square()));
      return a + part * d;
    }

    /** Nearest point of a point, segment or triangle. */
    template <int dim>
    Point<dim>
    nearest_on_simplex(const std::vector<Point<dim>> &p,
                       const Point<dim>              &X,
                       double                        &part)
    {
      part = 0.;
      if (p.size() == 1)
        return p[0];
      if (p.size() == 2)
        return nearest_on_segment(p[0], p[1], X, part);
      // In the plane of the triangle if that is inside, else on a side.
      const Tensor<1, dim> a = p[1] - p[0], b = p[2] - p[0], x = X - p[0];
      const double         aa = a * a, ab = a * b, bb = b * b;
      const double         det = aa * bb - ab * ab;
      const double         s   = ((x * a) * bb - (x * b) * ab) / det;
      const double         t   = ((x * b) * aa - (x * a) * ab) / det;
      if (s >= 0. && t >= 0. && s + t <= 1.)
        return p[0] + s * a + t * b;
      Point<dim> best = p[0];
      double     ignored;
      for (unsigned int i = 0; i < 3; ++i)
        {
          const Point<dim> y =
            nearest_on_segment(p[i], p[(i + 1) % 3], X, ignored);
          if (y.distance(X) < best.distance(X))
            best = y;
        }
      return best;
    }
  } // namespace

  template <int dim>
  std::vector<OutlineFace<dim>>
  outline_faces(const Configuration<dim>     &configuration,
                const HistoryStore<dim>      &store,
                const std::set<unsigned int> &regions)
  {
    std::vector<OutlineFace<dim>> faces;
    for (const auto &cell :
         configuration.mesh.triangulation->active_cell_iterators())
      {
        if (cell->is_artificial())
          continue;
        const unsigned int  c = cell->active_cell_index();
        const std::uint64_t r = store.region(c);
        if (regions.count(r) == 0)
          continue;
        for (const unsigned int f : cell->face_indices())
          if (cell->at_boundary(f))
            faces.push_back({c,
                             f,
                             (std::uint64_t(1) << 63) | (r << 32) |
                               cell->face(f)->boundary_id()});
          else
            {
              const auto neighbor = cell->neighbor(f)->is_active()
                                      ? cell->neighbor(f)
                                      : cell->neighbor_child_on_subface(f, 0);
              if (neighbor->is_artificial())
                continue;
              const std::uint64_t s =
                store.region(neighbor->active_cell_index());
              if (s != r)
                faces.push_back(
                  {c, f, (std::min(r, s) << 32) | std::max(r, s)});
            }
      }
    return faces;
  }

  template <int dim>
  std::vector<unsigned int>
  outline_nodes(const unsigned int face_no, const unsigned int degree)
  {
    const unsigned int        n = degree + 1;
    std::vector<unsigned int> nodes;
    for (unsigned int i = 0; i < Utilities::pow(n, dim); ++i)
      {
        unsigned int place = i;
        for (unsigned int d = 0; d < face_no / 2; ++d)
          place /= n;
        if (place % n == (face_no % 2) * degree)
          nodes.push_back(i);
      }
    return nodes;
  }

  template <int dim>
  struct ReferenceOutline<dim>::Gathered
  {
    using Id = types::global_dof_index;
    struct Node
    {
      Point<dim>              X;
      std::set<std::uint64_t> keys;
    };

    std::map<Id, Node> nodes;
    /** Segments with the keys of all faces that have them. */
    std::map<std::pair<Id, Id>, std::set<std::uint64_t>>  segments;
    std::set<std::pair<std::uint64_t, std::array<Id, 3>>> triangles; // 3D
  };

  template <int dim>
  typename ReferenceOutline<dim>::Gathered
  ReferenceOutline<dim>::gather(const Configuration<dim>     &configuration,
                                const HistoryStore<dim>      &store,
                                const std::set<unsigned int> &regions) const
  {
    using Id = typename Gathered::Id;
    const CellNodes<dim> cells(configuration);
    const NodalVector    x           = configuration.positions();
    const auto          &partitioner = *x.get_partitioner();
    const unsigned int   n           = configuration.degree + 1;
    const unsigned int   n_nodes     = Utilities::pow(n, dim - 1);

    std::vector<bool> is_owned(
      configuration.mesh.triangulation->n_active_cells());
    for (const auto &cell :
         configuration.mesh.triangulation->active_cell_iterators())
      is_owned[cell->active_cell_index()] = cell->is_locally_owned();

    // For each face: its key, and for each node its id and place.
    std::vector<std::uint64_t>           integers;
    std::vector<double>                  numbers;
    typename CellNodes<dim>::NodeTensors position;
    for (const auto &face : outline_faces(configuration, store, regions))
      if (is_owned[face.cell])
        {
          cells.gather(x, face.cell, position);
          integers.push_back(face.key);
          for (const unsigned int i :
               outline_nodes<dim>(face.face_no, configuration.degree))
            {
              integers.push_back(partitioner.local_to_global(
                cells.local_entries(face.cell, i)[0]));
              for (unsigned int d = 0; d < dim; ++d)
                numbers.push_back(position[i][d]);
            }
        }

    Gathered       result;
    const MPI_Comm communicator = configuration.communicator();
    const auto     all_integers =
      Utilities::MPI::all_gather(communicator, integers);
    const auto all_numbers = Utilities::MPI::all_gather(communicator, numbers);
    std::vector<Id> ids(n_nodes);
    for (unsigned int p = 0; p < all_integers.size(); ++p)
      {
        const double *number = all_numbers[p].data();
        for (std::size_t i = 0; i < all_integers[p].size(); i += 1 + n_nodes)
          {
            const std::uint64_t key = all_integers[p][i];
            for (unsigned int v = 0; v < n_nodes; ++v)
              {
                ids[v]     = all_integers[p][i + 1 + v];
                auto &node = result.nodes[ids[v]];
                node.keys.insert(key);
                for (unsigned int d = 0; d < dim; ++d)
                  node.X[d] = *(number++);
              }
            const auto segment = [&](const unsigned int a,
                                     const unsigned int b) {
              result
                .segments[{std::min(ids[a], ids[b]), std::max(ids[a], ids[b])}]
                .insert(key);
            };
            const auto triangle = [&](const unsigned int a,
                                      const unsigned int b,
                                      const unsigned int c) {
              std::array<Id, 3> corners = {{ids[a], ids[b], ids[c]}};
              std::sort(corners.begin(), corners.end());
              result.triangles.insert({key, corners});
            };
            if (dim == 2)
              for (unsigned int v = 0; v + 1 < n; ++v)
                segment(v, v + 1);
            else
              for (unsigned int k = 0; k + 1 < n; ++k)
                {
                  const unsigned int last = n * (n - 1);
                  segment(k, k + 1);
                  segment(last + k, last + k + 1);
                  segment(k * n, (k + 1) * n);
                  segment(k * n + n - 1, (k + 1) * n + n - 1);
                  for (unsigned int j = 0; j + 1 < n; ++j)
                    {
                      const unsigned int a = k * n + j;
                      triangle(a, a + 1, a + n);
                      triangle(a + 1, a + n, a + n + 1);
                    }
                }
          }
      }
    return result;
  }

  template <int dim>
  void
  ReferenceOutline<dim>::add_chains(const Gathered &all)
  {
    using Id = typename Gathered::Id;
    std::set<std::uint64_t> keys;
    for (const auto &segment : all.segments)
      keys.insert(segment.second.begin(), segment.second.end());
    for (const std::uint64_t key : keys)
      {
        std::map<Id, std::vector<Id>> around;
        for (const auto &[ends, of] : all.segments)
          if (of.count(key) > 0)
            {
              around[ends.first].push_back(ends.second);
              around[ends.second].push_back(ends.first);
            }
        const auto breaks = [&](const Id v) {
          const auto &next = around.at(v);
          if (next.size() != 2 || all.nodes.at(v).keys.size() > 1)
            return true;
          const Tensor<1, dim> a = all.nodes.at(v).X - all.nodes.at(next[0]).X;
          const Tensor<1, dim> b = all.nodes.at(next[1]).X - all.nodes.at(v).X;
          return a * b < corner_cosine * a.norm() * b.norm();
        };
        std::set<std::pair<Id, Id>> used;
        const auto                  follow = [&](const Id start, Id next) {
          Piece piece;
          piece.keys   = {key};
          piece.points = {all.nodes.at(start).X};
          Id before    = start;
          for (;;)
            {
              used.insert({before, next});
              used.insert({next, before});
              if (next == start && !breaks(start))
                {
                  piece.closed = true;
                  break;
                }
              piece.points.push_back(all.nodes.at(next).X);
              if (breaks(next))
                break;
              const auto &ahead = around.at(next);
              const Id    after = ahead[0] == before ? ahead[1] : ahead[0];
              before = next;
              next   = after;
            }
          pieces.push_back(piece);
        };
        for (const bool at_breaks : {true, false})
          for (const auto &[v, ends] : around)
            if (!at_breaks || breaks(v))
              for (const Id end : ends)
                if (used.count({v, end}) == 0)
                  follow(v, end);
      }
  }

  template <int dim>
  void
  ReferenceOutline<dim>::add_simplices(const Gathered &all)
  {
    for (const auto &[key, corners] : all.triangles)
      pieces.push_back({{key},
                        {all.nodes.at(corners[0]).X,
                         all.nodes.at(corners[1]).X,
                         all.nodes.at(corners[2]).X},
                        false});
    for (const auto &[ends, keys] : all.segments)
      if (keys.size() > 1)
        pieces.push_back(
          {OutlineKeys(keys.begin(), keys.end()),
           {all.nodes.at(ends.first).X, all.nodes.at(ends.second).X},
           false});
  }

  template <int dim>
  void
  ReferenceOutline<dim>::prepare()
  {
    for (unsigned int p = 0; p < pieces.size(); ++p)
      {
        const Piece &piece = pieces[p];
        const auto  &X     = piece.points;
        if (dim == 3 || X.size() == 1)
          {
            double size = 0.;
            for (const auto &a : X)
              size = std::max(size, a.distance(X[0]));
            elements.push_back({p, X, size});
            continue;
          }
        using Ends = typename CubicSpline<dim>::Ends;
        const CubicSpline<dim> &spline =
          splines
            .emplace(p,
                     CubicSpline<dim>(X,
                                      piece.closed ? Ends::closed
                                                   : Ends::not_a_knot))
            .first->second;
        const auto &t = spline.knots();
        for (unsigned int k = 0; k + 1 < t.size(); ++k)
          for (unsigned int i = 0; i < n_chords; ++i)
            {
              const double s0 = t[k] + (t[k + 1] - t[k]) * i / n_chords;
              const double s1 = t[k] + (t[k + 1] - t[k]) * (i + 1) / n_chords;
              elements.push_back({p,
                                  {spline.value(s0), spline.value(s1)},
                                  t[k + 1] - t[k],
                                  s0,
                                  s1});
            }
      }
    // A single point has the size of what meets there.
    for (Element &element : elements)
      if (element.points.size() == 1)
        for (const Element &other : elements)
          for (const auto &X : other.points)
            if (X.distance(element.points[0]) < 1e-12 * other.size)
              element.size = std::max(element.size, other.size);
  }

  template <int dim>
  ReferenceOutline<dim>::ReferenceOutline(
    const Configuration<dim>     &configuration,
    const HistoryStore<dim>      &store,
    const std::set<unsigned int> &regions)
  {
    const Gathered all = gather(configuration, store, regions);
    for (const auto &[id, node] : all.nodes)
      if (node.keys.size() > 1)
        pieces.push_back(
          {OutlineKeys(node.keys.begin(), node.keys.end()), {node.X}, false});
    if (dim == 2)
      add_chains(all);
    else
      add_simplices(all);
    prepare();
  }

  template <int dim>
  void
  ReferenceOutline<dim>::save(BlockFile &blocks) const
  {
    BlockFile::Integers integers;
    BlockFile::Numbers  numbers;
    for (const Piece &piece : pieces)
      {
        integers.push_back(piece.keys.size());
        integers.insert(integers.end(), piece.keys.begin(), piece.keys.end());
        integers.push_back(piece.points.size());
        integers.push_back(piece.closed);
        for (const auto &X : piece.points)
          for (unsigned int d = 0; d < dim; ++d)
            numbers.push_back(X[d]);
      }
    blocks.put("reference outline/pieces", std::move(integers));
    blocks.put("reference outline/points", std::move(numbers));
  }

  template <int dim>
  ReferenceOutline<dim>::ReferenceOutline(const BlockFile &blocks)
  {
    const std::string place    = "reference outline/pieces";
    const auto       &integers = blocks.integers(place);
    const auto       &numbers  = blocks.numbers("reference outline/points");
    std::size_t       i = 0, j = 0;
    const auto        next = [&]() {
      if (i >= integers.size())
        blocks.refuse(place, "is too short");
      return integers[i++];
    };
    while (i < integers.size())
      {
        Piece               piece;
        const std::uint64_t n_keys = next();
        for (std::uint64_t k = 0; k < n_keys; ++k)
          piece.keys.push_back(next());
        const std::uint64_t n_points = next();
        piece.closed                 = next() != 0;
        for (std::uint64_t k = 0; k < n_points; ++k)
          {
            if (j + dim > numbers.size())
              blocks.refuse("reference outline/points", "is too short");
            Point<dim> X;
            for (unsigned int d = 0; d < dim; ++d)
              X[d] = numbers[j++];
            piece.points.push_back(X);
          }
        pieces.push_back(std::move(piece));
      }
    prepare();
  }

  template <int dim>
  const typename ReferenceOutline<dim>::Index &
  ReferenceOutline<dim>::index_of(const OutlineKeys &keys) const
  {
    const auto known = indices.find(keys);
    if (known != indices.end())
      return known->second;
    std::vector<unsigned int> numbers;
    for (unsigned int e = 0; e < elements.size(); ++e)
      if (contains(pieces[elements[e].piece].keys, keys))
        numbers.push_back(e);
    // Pieces that met nowhere before meet now, e.g. in contact: then any of
    // them will do.
    if (numbers.empty())
      for (unsigned int e = 0; e < elements.size(); ++e)
        for (const auto key : keys)
          if (contains(pieces[elements[e].piece].keys, {key}) &&
              (numbers.empty() || numbers.back() != e))
            numbers.push_back(e);
    if (numbers.empty())
      throw RunError("Transfer",
                     "the mesh has a boundary piece that the undeformed body "
                     "does not have",
                     "use `Transfer of deformation = history`");
    std::vector<BoundingBox<dim>> boxes;
    for (const unsigned int e : numbers)
      boxes.push_back(
        BoxTree<dim>::around(elements[e].points, elements[e].points.size()));
    return indices.emplace(keys, Index{numbers, BoxTree<dim>(boxes)})
      .first->second;
  }

  template <int dim>
  Point<dim>
  ReferenceOutline<dim>::nearest(const OutlineKeys &keys,
                                 const Point<dim>  &X,
                                 double            &size) const
  {
    const Index              &index = index_of(keys);
    std::vector<unsigned int> found;
    index.tree.nearest(X, n_candidates, found);
    Point<dim>     best;
    const Element *element  = nullptr;
    double         distance = std::numeric_limits<double>::max(), part = 0.;
    for (const unsigned int i : found)
      {
        const Element   &candidate = elements[index.elements[i]];
        double           s;
        const Point<dim> y = nearest_on_simplex(candidate.points, X, s);
        if (y.distance(X) < distance)
          {
            distance = y.distance(X);
            best     = y;
            element  = &candidate;
            part     = s;
          }
      }
    AssertThrow(element != nullptr, ExcInternalError());
    size              = element->size;
    const auto spline = splines.find(element->piece);
    if (spline == splines.end())
      return best;

    // From the chord to the curve (Gauss-Newton: the foot is close)
    const auto  &curve  = spline->second;
    const bool   closed = pieces[element->piece].closed;
    const double first = curve.knots().front(), last = curve.knots().back();
    double       t = element->begin + part * (element->end - element->begin);
    for (unsigned int iteration = 0; iteration < 50; ++iteration)
      {
        const Tensor<1, dim> tangent = curve.derivative(t);
        const double         before  = t;
        t += ((X - curve.value(t)) * tangent) / tangent.norm_square();
        if (closed && (t < first || t > last))
          t += t < first ? last - first : first - last;
        t = std::min(last, std::max(first, t));
        if (std::abs(t - before) <= 1e-15 * (last - first))
          break;
      }
    return curve.value(t);
  }

#define INSTANTIATE(dim)                                                     \
  template std::vector<OutlineFace<dim>> outline_faces(                      \
    const Configuration<dim> &,                                              \
    const HistoryStore<dim> &,                                               \
    const std::set<unsigned int> &);                                         \
  template std::vector<unsigned int> outline_nodes<dim>(const unsigned int,  \
                                                        const unsigned int); \
  template class ReferenceOutline<dim>;
  INSTANTIATE(2)
  INSTANTIATE(3)
#undef INSTANTIATE
} // namespace alveolus
