// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/best_first.h>
#include <alveolus/mesh/describe_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/remeshing/flat_tetrahedra.h>
#include <alveolus/remeshing/hex_optimiser.h>
#include <alveolus/remeshing/remesher.h>

#include <deal.II/base/numbers.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  /**
   * New hexahedra within the smooth boundary and interfaces of a deformed body
   * in three dimensions: triangles on its surfaces, tetrahedra between them,
   * each divided into four hexahedra; layers keep their columns.
   */
  class VolumeRemesher : public Remesher<3>
  {
  public:
    void
    declare_parameters(ParameterHandler &prm) override
    {
      prm.add_parameter("Layers",
                        layers,
                        "Thin regions between others, of hexahedra in columns "
                        "from one wall to the other, e.g. a ligament. Their "
                        "new cells stand on the triangles of the wall, as many "
                        "across as before.",
                        Patterns::List(Patterns::Anything(), 0));
      prm.add_parameter("Edge length factor",
                        factor,
                        "Wanted edges of the surface over the mean of the old "
                        "edges there [-].",
                        Patterns::Double(0.05, 20.));
      prm.add_parameter(
        "Edge angle",
        edge_angle,
        "Wanted edges are so short that the surface turns by no "
        "more than this along them, so that a round end stays "
        "round where `Edge length factor` is large; edges may "
        "become 4/3 times as long as wanted [degree].",
        Patterns::Double(1., 180.));
      prm.add_parameter("Smallest edge length",
                        smallest,
                        "Bound of the wanted edges, also of those that `Edge "
                        "angle` asks for [mm].",
                        Patterns::Double(0.));
      prm.add_parameter("Largest edge length",
                        largest,
                        "Bound of the wanted edges [mm].",
                        Patterns::Double(1e-9));
      prm.add_parameter("Growth",
                        growth,
                        "Largest growth of the wanted edges with the distance "
                        "[-].",
                        Patterns::Double(0.01, 10.));
      prm.add_parameter("Corner angle",
                        corner_angle,
                        "Edges where the surface turns by more than this, and "
                        "corners of lines that do, are kept [degree].",
                        Patterns::Double(1., 180.));
      prm.add_parameter("Good quality",
                        good,
                        "Corners below this scaled Jacobian, or outside layers "
                        "below this mean ratio of their edges, are improved by "
                        "moving nodes [-].",
                        Patterns::Double(0., 1.));
      prm.add_parameter("Sweeps",
                        n_sweeps,
                        "Largest number of times that nodes are moved.",
                        Patterns::Integer(0, 1000));
      prm.add_parameter("Attempts",
                        n_attempts,
                        "Meshes to make, by several algorithms and densities "
                        "of the mesher inside; the best ones are tried first.",
                        Patterns::Integer(1, 6));
      settings.gmsh.declare_parameters(prm);
    }

    void
    initialize(const NamedSets<3> &names, const std::string &path) override
    {
      where = path;
      for (const std::string &layer : layers)
        names.region(layer, where + " / Layers");
      if (smallest > largest)
        throw InputError(where + " / Smallest edge length",
                         "it is larger than 'Largest edge length'",
                         "lower it");
    }

    unsigned int
    largest_degree() const override
    {
      return 1;
    }

    bool
    can_keep_lattices() const override
    {
      return false;
    }

    std::vector<RemeshCandidate<3>>
    candidates(const Configuration<3> &old,
               const std::string      &output_directory,
               const std::string      &name) const override
    {
      const MeshDescription<3>     mesh = description_of(old);
      std::set<types::material_id> thin;
      for (const std::string &layer : layers)
        for (const types::material_id id :
             old.mesh.names.region(layer, where + " / Layers"))
          thin.insert(id);
      const BodySurface surface =
        extract_surface(mesh, thin, corner_angle * numbers::PI / 180., where);
      SmoothBody smooth(surface);
      // Triangles become quads of half the edge
      smooth.set_sizes(2. * factor,
                       2. * smallest,
                       2. * largest,
                       growth,
                       2. * edge_angle * numbers::PI / 180.);
      SurfaceMesh triangles(smooth);
      triangles.remesh(n_rounds);

      // Algorithms of gmsh and factors of the sizes inside
      const std::pair<unsigned int, double> ways[] = {
        {1, 1.}, {10, 1.}, {4, 1.}, {1, 0.85}, {10, 0.85}, {1, 1.2}};
      std::vector<RemeshCandidate<3>> result;
      std::string                     failure;
      const MeshingJob job{name, output_directory, where, old.communicator()};
      for (unsigned int k = 0; k < n_attempts; ++k)
        try
          {
            TetrahedraSettings with = settings;
            with.algorithm          = ways[k].first;
            with.size_factor        = ways[k].second;
            result.push_back(
              make(old,
                   mesh,
                   triangles,
                   with,
                   job,
                   k == 0 ? "" : "attempt-" + std::to_string(k + 1)));
          }
        catch (const RunError &error)
          {
            failure = error.what();
          }
      if (result.empty())
        throw RunError(where,
                       "no mesh is made in " + std::to_string(n_attempts) +
                         " attempts (" + failure + ")",
                       "change 'Edge length factor' a little");
      sort_best_first(result, [](const auto &mesh) { return mesh.quality; });
      return result;
    }

  private:
    static constexpr unsigned int n_rounds = 8; ///< of the surface remesher

    std::vector<std::string> layers;
    double                   factor     = 1.;
    double                   edge_angle = 180.;            ///< [degree]
    double                   smallest = 0., largest = 1e6; ///< [mm]
    double                   growth       = 0.3;
    double                   corner_angle = 40.; ///< [degree]
    double                   good         = 0.5;
    unsigned int             n_sweeps     = 40;
    unsigned int             n_attempts   = 2;
    TetrahedraSettings       settings;
    std::string              where = "Remeshing";

    MeshDescription<3>
    description_of(const Configuration<3> &old) const
    {
      try
        {
          return describe_mesh(Nodes<3>(old), old.positions(), where);
        }
      catch (const InputError &error)
        {
          // The mesh became so during the run
          throw RunError(where, error.what(), "");
        }
    }

    RemeshCandidate<3>
    make(const Configuration<3>   &old,
         const MeshDescription<3> &mesh,
         const SurfaceMesh        &triangles,
         const TetrahedraSettings &with,
         const MeshingJob         &job,
         const std::string        &attempt) const
    {
      const BodySurface           &body = triangles.body.body;
      std::vector<FilledComponent> filled;
      unsigned int                 n_tetrahedra = 0;
      FlatTetrahedra               flat;
      for (unsigned int c = 0; c < body.components.size(); ++c)
        {
          const MeshingJob body_job = job.part("body-" + std::to_string(c + 1));
          filled.push_back(
            fill(triangles,
                 c,
                 with,
                 attempt.empty() ? body_job : body_job.part(attempt),
                 flat));
          n_tetrahedra += filled.back().mesh.cells.size();
        }
      HexMesh    hexes  = divide_into_hexahedra(triangles, filled, mesh);
      const auto report = optimise_hexahedra(hexes, triangles, good, n_sweeps);
      hexes.description.source = job.name;

      RemeshCandidate<3> candidate;
      candidate.mesh    = build_mesh(hexes.description, old.communicator());
      candidate.quality = report.after.jacobian;
      std::ostringstream text;
      text << job.name << ": " << hexes.description.cells.size() << " cells, "
           << hexes.description.vertices.size() << " vertices, of "
           << triangles.triangles.size() << " triangles (quality "
           << std::setprecision(3) << triangles.smallest_quality() << ") and "
           << n_tetrahedra << " tetrahedra (algorithm " << with.algorithm
           << ", size factor " << with.size_factor << ", " << flat.n_divided
           << " flat ones divided, " << flat.n_left
           << " left), smallest scaled Jacobian " << report.before.jacobian
           << " (shape " << report.before.shape << "), after "
           << report.n_sweeps << " sweeps " << report.after.jacobian
           << " (shape " << report.after.shape << ")";
      candidate.describe(text.str());
      return candidate;
    }

    /** Tetrahedra of a component of the body. */
    FilledComponent
    fill(const SurfaceMesh        &surface,
         const unsigned int        component,
         const TetrahedraSettings &with,
         const MeshingJob         &job,
         FlatTetrahedra           &flat) const
    {
      const BodySurface &body = surface.body.body;
      const unsigned int part = body.components[component].part;
      FilledComponent    result;
      std::map<unsigned int, unsigned int>     number;
      std::vector<Point<3>>                    vertices;
      std::vector<std::array<unsigned int, 3>> triangles;
      std::vector<unsigned int>                patches;
      for (const auto &triangle : surface.triangles)
        {
          const auto &face =
            body.faces[surface.body.patch_face[triangle.patch]];
          if (face.components[0] != component &&
              face.components[1] != component)
            continue;
          std::array<unsigned int, 3> local;
          for (unsigned int i = 0; i < 3; ++i)
            {
              const unsigned int v     = triangle.vertices[i];
              const auto         entry = number.emplace(v, vertices.size());
              if (entry.second)
                {
                  vertices.push_back(surface.vertices[v].x[part]);
                  result.surface_vertices.push_back(v);
                }
              local[i] = entry.first->second;
            }
          if (face.components[0] != component)
            std::swap(local[1], local[2]);
          triangles.push_back(local);
          patches.push_back(triangle.patch);
        }
      result.mesh = fill_with_tetrahedra(vertices, triangles, with, job);
      const FlatTetrahedra found =
        divide_flat_tetrahedra(result.mesh, triangles, patches);
      flat.n_divided += found.n_divided;
      flat.n_left += found.n_left;
      return result;
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::Remesher<3>,
  alveolus::VolumeRemesher,
  "volume",
  "New hexahedra within the boundary and the interfaces of the deformed body, "
  "in 3D. Both are divided into smooth patches at edges (`Corner angle`), named "
  "lines and changes of name; named points and corners stay, nodes of lines lie "
  "on cubic splines through the old ones, those of patches on a smooth surface "
  "through the old ones (Phong tessellation). Triangles on the patches get the "
  "edges that are wanted (Botsch and Kobbelt 2004); gmsh fills each region with "
  "tetrahedra; each is divided into four hexahedra, whose nodes then move, those "
  "of patches along these, until corners have `Good quality`. `Layers` keep "
  "columns of cells: both walls get the same triangles, and between them stand "
  "columns of hexahedra. Regions, boundaries, lines and points keep names and "
  "ids. New meshes have no lattices: use the rules follow, straight, spline, "
  "surface, Giuliani or barrier, not transfinite. Degree 1.")
