// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/rezoning/giuliani_rule.h>
#include <alveolus/rezoning/node_sets.h>

#include <deal.II/base/mpi.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <unordered_set>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /**
     * H n times the squared measure of the base, for unit mean determinant, of
     * a base with vertices @p x: its normal on the side of the element.
     */
    inline Tensor<1, 2>
    inward_normal(const std::array<Point<2>, 2> &x)
    {
      const Tensor<1, 2> base = x[1] - x[0];
      return Tensor<1, 2>({-base[1], base[0]});
    }

    inline Tensor<1, 3>
    inward_normal(const std::array<Point<3>, 3> &x)
    {
      return -cross_product_3d(x[1] - x[0], x[2] - x[0]);
    }

    template <int dim, typename LocalNode>
    inline Point<dim>
    get(const NodalVector &field, const LocalNode &node)
    {
      Point<dim> value;
      for (unsigned int c = 0; c < dim; ++c)
        value[c] = field.local_element(node[c]);
      return value;
    }

    template <int dim, typename LocalNode>
    inline void
    set(NodalVector &field, const LocalNode &node, const Point<dim> &value)
    {
      for (unsigned int c = 0; c < dim; ++c)
        field.local_element(node[c]) = value[c];
    }

    /**
     * Parents of the node k of a cell of degree 2 in the numbering of FE_Q,
     * with weights: Coons interpolation at the middle of its line, face or
     * cell.
     */
    template <int dim>
    std::vector<std::pair<double, unsigned int>>
    middle_weights(const unsigned int k)
    {
      using Cell                   = GeometryInfo<dim>;
      constexpr unsigned int line0 = Cell::vertices_per_cell;
      constexpr unsigned int face0 = line0 + Cell::lines_per_cell;
      std::vector<std::pair<double, unsigned int>> weights;
      if (k < face0)
        for (unsigned int v = 0; v < 2; ++v)
          weights.emplace_back(0.5, Cell::line_to_cell_vertices(k - line0, v));
      else if (dim == 3 && k < face0 + Cell::faces_per_cell)
        {
          for (unsigned int l = 0; l < Cell::lines_per_face; ++l)
            weights.emplace_back(0.5,
                                 line0 +
                                   Cell::face_to_cell_lines(k - face0, l));
          for (unsigned int v = 0; v < Cell::vertices_per_face; ++v)
            weights.emplace_back(-0.25,
                                 Cell::face_to_cell_vertices(k - face0, v));
        }
      else
        {
          if (dim == 3)
            for (unsigned int f = 0; f < Cell::faces_per_cell; ++f)
              weights.emplace_back(0.5, face0 + f);
          for (unsigned int l = 0; l < Cell::lines_per_cell; ++l)
            weights.emplace_back(dim == 3 ? -0.25 : 0.5, line0 + l);
          for (unsigned int v = 0; v < Cell::vertices_per_cell; ++v)
            weights.emplace_back(dim == 3 ? 0.125 : -0.25, v);
        }
      return weights;
    }
  } // namespace

  template <int dim>
  void
  GiulianiRule<dim>::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("On",
                      on,
                      "Regions whose inner nodes are smoothed.",
                      Patterns::List(Patterns::Anything()));
    prm.add_parameter(
      "Shapes",
      shapes,
      "initial: triangles keep, as far as possible, the shapes "
      "they had at the start (or at the last remesh), so that a "
      "graded mesh stays graded; equal: upright triangles of "
      "equal areas, as published, for nearly uniform meshes.",
      Patterns::Selection("initial|equal"));
    prm.add_parameter(
      "Iteration",
      iteration,
      "Jacobi: sweeps as published; Chebyshev: the same sweeps accelerated, "
      "whose number grows with the number of nodes along the region instead of "
      "its square: for large meshes, with `Shapes` = initial only.",
      Patterns::Selection("Jacobi|Chebyshev"));
    prm.add_parameter("Tolerance",
                      tolerance,
                      "Distance from its target at which a node may stop, "
                      "relative to the local size of the mesh [-].",
                      Patterns::Double(1e-15, 1.));
    prm.add_parameter("Relaxation",
                      relaxation,
                      "Part of the way to its target that a node goes in a "
                      "sweep [-]; near 1 chequered motions hardly decay.",
                      Patterns::Double(0.01, 1.));
    prm.add_parameter("Largest number of sweeps",
                      largest_sweeps,
                      "Sweeps after which the iteration ends as it is, which "
                      "is counted in the report.",
                      Patterns::Integer(1));
  }

  template <int dim>
  typename RezoningRule<dim>::Stage
  GiulianiRule<dim>::stage(const NamedSets<dim> & /*names*/,
                           const std::string & /*where*/) const
  {
    return Stage::volumes;
  }

  template <int dim>
  void
  GiulianiRule<dim>::attach(const Nodes<dim>       &nodes,
                            const NodalVector      &positions,
                            const std::set<NodeId> &taken,
                            const std::string      &where)
  {
    require_names(on, where);
    if (iteration == "Chebyshev" && shapes != "initial")
      throw InputError(where + "/Iteration",
                       "Chebyshev with Shapes = " + shapes,
                       "use Jacobi, or Shapes = initial");
    constexpr unsigned int n_vertices    = GeometryInfo<dim>::vertices_per_cell;
    const auto            &configuration = nodes.configuration;

    const auto local = [&](const NodeId node) {
      LocalNode   indices;
      const auto &dofs = nodes.dofs(node);
      for (unsigned int c = 0; c < dim; ++c)
        indices[c] = positions.get_partitioner()->global_to_local(dofs[c]);
      return indices;
    };

    // Cells around each vertex, and the first cell that sees a middle node
    std::map<NodeId, std::vector<Corner>>                  corners_of;
    std::array<std::map<NodeId, std::vector<NodeId>>, dim> parents_of;
    std::array<std::map<NodeId, unsigned int>, dim>        place_of;
    std::vector<NodeId>                                    cell_nodes;
    touched.clear();
    for (const std::string &name : on)
      {
        const auto &ids = configuration.mesh.names.region(name, where + "/On");
        const auto  inside = inner_nodes(name, nodes, taken, where);
        const std::unordered_set<NodeId> moved(inside.begin(), inside.end());
        for (const auto &cell :
             configuration.dof_handler.active_cell_iterators())
          if (!cell->is_artificial() && ids.count(cell->material_id()) > 0)
            {
              nodes.cell_nodes(cell, cell_nodes);
              for (unsigned int k = 0; k < cell_nodes.size(); ++k)
                {
                  const NodeId node = cell_nodes[k];
                  if (moved.count(node) == 0)
                    continue;
                  if (k < n_vertices)
                    {
                      Corner corner;
                      bool   odd = false;
                      for (unsigned int a = 0; a < dim; ++a)
                        {
                          corner.neighbours[a] =
                            local(cell_nodes[k ^ (1u << a)]);
                          odd = odd != ((k & (1u << a)) != 0);
                        }
                      if (odd)
                        std::swap(corner.neighbours[0], corner.neighbours[1]);
                      corners_of[node].push_back(corner);
                      continue;
                    }
                  const unsigned int first_face =
                    n_vertices + GeometryInfo<dim>::lines_per_cell;
                  const unsigned int kind = k < first_face ? 0
                                            : k + 1 < cell_nodes.size()
                                              ? 1
                                              : dim - 1;
                  if (place_of[kind].emplace(node, k).second)
                    parents_of[kind][node] = cell_nodes;
                }
            }
        touched.insert(touched.end(), inside.begin(), inside.end());
      }

    equalise = shapes == "equal";
    vertices.clear();
    corners.clear();
    first_corner.assign(1, 0);
    for (auto &entry : corners_of)
      {
        vertices.push_back(local(entry.first));
        // Published: the mean of the middles of the bases
        for (Corner &corner : entry.second)
          corner.weights.fill(1. / (dim * entry.second.size()));
        if (!equalise)
          keep_shapes(positions, vertices.back(), entry.second);
        corners.insert(corners.end(), entry.second.begin(), entry.second.end());
        first_corner.push_back(corners.size());
      }
    if (iteration == "Chebyshev")
      prepare_chebyshev(positions);
    for (unsigned int kind = 0; kind < dim; ++kind)
      {
        middles[kind].clear();
        for (const auto &entry : parents_of[kind])
          {
            MiddleNode middle;
            middle.node = local(entry.first);
            for (const auto &parent :
                 middle_weights<dim>(place_of[kind][entry.first]))
              middle.parents.emplace_back(parent.first,
                                          local(entry.second[parent.second]));
            middles[kind].push_back(middle);
          }
      }
  }

  template <int dim>
  void
  GiulianiRule<dim>::keep_shapes(const NodalVector   &positions,
                                 const LocalNode     &vertex,
                                 std::vector<Corner> &around) const
  {
    const Point<dim> here = get<dim>(positions, vertex);
    double           sum  = 0.;
    for (Corner &corner : around)
      {
        // Row of the P1 stiffness of the simplex of P and its neighbours:
        // grad N_a are the rows of the inverse of the edges (as columns).
        Tensor<2, dim> edges;
        for (unsigned int a = 0; a < dim; ++a)
          {
            const Tensor<1, dim> edge =
              get<dim>(positions, corner.neighbours[a]) - here;
            for (unsigned int d = 0; d < dim; ++d)
              edges[d][a] = edge[d];
          }
        const Tensor<2, dim> gradients = invert(edges);
        Tensor<1, dim>       gradient_P;
        for (unsigned int a = 0; a < dim; ++a)
          gradient_P -= gradients[a];
        for (unsigned int a = 0; a < dim; ++a)
          {
            corner.weights[a] =
              -(gradients[a] * gradient_P) * determinant(edges);
            sum += corner.weights[a];
          }
      }
    for (Corner &corner : around)
      for (double &weight : corner.weights)
        weight /= sum;
  }

  template <int dim>
  void
  GiulianiRule<dim>::prepare_chebyshev(const NodalVector &positions)
  {
    using Link = typename ChebyshevSweeps<dim>::Link;
    std::vector<std::vector<Link>> links(vertices.size());
    for (unsigned int v = 0; v < vertices.size(); ++v)
      {
        std::map<LocalNode, double> weights;
        for (unsigned int i = first_corner[v]; i < first_corner[v + 1]; ++i)
          for (unsigned int a = 0; a < dim; ++a)
            weights[corners[i].neighbours[a]] += corners[i].weights[a];
        for (const auto &weight : weights)
          links[v].emplace_back(weight.second, weight.first);
      }
    chebyshev.reinit(positions, vertices, links);
  }



  template <int dim>
  std::pair<Point<dim>, double>
  GiulianiRule<dim>::target(const NodalVector &positions,
                            const unsigned int v) const
  {
    const Point<dim> here = get<dim>(positions, vertices[v]);
    double           mean = 0.; // of 2 x area, 6 x volume
    Tensor<1, dim>   feet, heights;
    for (unsigned int i = first_corner[v]; i < first_corner[v + 1]; ++i)
      {
        std::array<Point<dim>, dim> x;
        Tensor<2, dim>              edges;
        for (unsigned int a = 0; a < dim; ++a)
          {
            x[a]     = get<dim>(positions, corners[i].neighbours[a]);
            edges[a] = x[a] - here;
            feet += corners[i].weights[a] * x[a];
          }
        mean += determinant(edges);
        if (equalise)
          {
            const Tensor<1, dim> normal = inward_normal(x);
            heights += normal / normal.norm_square();
          }
      }
    const double n = first_corner[v + 1] - first_corner[v];
    mean /= n;
    return {Point<dim>(feet + heights * (mean / n)),
            dim == 2 ? std::sqrt(std::abs(mean)) : std::cbrt(std::abs(mean))};
  }

  template <int dim>
  void
  GiulianiRule<dim>::apply(const Nodes<dim> &nodes,
                           const NodalVector & /*start*/,
                           const NodalVector & /*lagrangian*/,
                           NodalVector    &proposed,
                           RezoningReport &report) const
  {
    const MPI_Comm          communicator = nodes.configuration.communicator();
    std::vector<Point<dim>> moved(vertices.size());
    bool                    converged = false;
    const bool              sweeps    = iteration == "Jacobi";
    if (!sweeps)
      {
        std::vector<double> sizes(vertices.size());
        for (unsigned int v = 0; v < vertices.size(); ++v)
          sizes[v] = target(proposed, v).second;
        const auto done =
          chebyshev.solve(proposed, sizes, tolerance, largest_sweeps);
        report.sweeps += done.n_sweeps;
        converged = done.converged;
      }
    for (unsigned int sweep = 0; sweeps && sweep < largest_sweeps && !converged;
         ++sweep)
      {
        double furthest = 0.;
        for (unsigned int v = 0; v < vertices.size(); ++v)
          {
            const Point<dim> here = get<dim>(proposed, vertices[v]);
            const auto       aim  = target(proposed, v);
            const auto       way  = aim.first - here;
            const double     rest = way.norm() / aim.second;
            // A number that is none is never close.
            if (!(rest <= furthest))
              furthest =
                std::isnan(rest) ? std::numeric_limits<double>::max() : rest;
            moved[v] = here + relaxation * way;
          }
        for (unsigned int v = 0; v < vertices.size(); ++v)
          set<dim>(proposed, vertices[v], moved[v]);
        proposed.update_ghost_values();
        ++report.sweeps;
        converged = Utilities::MPI::max(furthest, communicator) <= tolerance;
      }
    if (!converged)
      ++report.unconverged_rules;

    if (nodes.configuration.degree == 2)
      for (const auto &kind : middles)
        {
          for (const MiddleNode &middle : kind)
            {
              Point<dim> x;
              for (const auto &parent : middle.parents)
                x += parent.first * get<dim>(proposed, parent.second);
              set<dim>(proposed, middle.node, x);
            }
          proposed.update_ghost_values();
        }
  }

  template class GiulianiRule<2>;
  template class GiulianiRule<3>;
} // namespace alveolus

ALVEOLUS_REGISTER_DIM(
  alveolus::RezoningRule,
  alveolus::GiulianiRule,
  "Giuliani",
  "Smoothing of the nodes inside each region of `On` after Giuliani (Nucl. "
  "Eng. Des. 72 (1982) 205): around a node P, in the triangle of P with its "
  "neighbours A and B along the edges of an element, P should stand above the "
  "middle m of AB, at the height H = 2 S/|AB| that gives the triangle the mean "
  "area S of those around P. With the unit normal n of AB: x_P = mean of (m + "
  "H n) over the elements, the least squares of shear offset and height error. "
  "In 3D tetrahedra with the base ABC, H = 3 V/|ABC|. With `Shapes` = initial, "
  "P keeps instead its place among its neighbours in the sense of the "
  "Laplacian on these triangles as they were at the start: x_P = sum w_j x_j "
  "with the weights of the linear finite element stiffness, so that the mesh "
  "of the start and all its affine images are kept. Jacobi sweeps x <- x + "
  "`Relaxation` (x_P - x), until no node is further from x_P than `Tolerance` "
  "times the local size. Nodes at the boundary of a region, at that of the "
  "domain, and nodes of points, lines and surfaces with rules stay where they "
  "are. For degree 2 nodes inside lines, faces and cells are then put between "
  "their neighbours. Runs with the volumes.")
