// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/block_mesh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_source.h>

#include <cmath>

namespace alveolus
{
  namespace
  {
    const std::string section = "Mesh / incisor";

    /** Part @p u in [0, 1] of an edge of the cube that is @p length long, at
     * equal angles seen from the middle. */
    double
    equiangular(const double u, const double length)
    {
      return std::copysign(std::tan(std::abs(u) * std::atan(length)), u);
    }
  } // namespace



  /**
   * One incisor in its socket, three-dimensional, half of it (z >= 0): the root
   * within the bone is half an ellipsoid, above the crest (y = 0) sections are
   * ellipses, wider in the crown, tapering in x towards the incisal edge. The
   * ligament is a layer of constant thickness around the root, the bone a box.
   * x is the labio-lingual direction (labial at negative x), y the axis of the
   * tooth, z mesio-distal. Hexahedra in structured blocks that conform: a core
   * along the axis, around it and below the apex blocks as on a cube.
   */
  class Incisor3D : public MeshSource<3>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      const dealii::Patterns::Double length(1e-3, 1e3);
      prm.add_parameter("Root half width",
                        root[0],
                        "Half the labio-lingual width of the root at the crest "
                        "of the bone [mm].",
                        length);
      prm.add_parameter("Root depth",
                        root[1],
                        "Depth of the apex below the crest [mm].",
                        length);
      prm.add_parameter("Root half thickness",
                        root[2],
                        "Half the mesio-distal width at the crest [mm].",
                        length);
      prm.add_parameter("Crown height",
                        height,
                        "Incisal edge above the crest [mm].",
                        length);
      prm.add_parameter("Crown half width",
                        crown_width,
                        "Greatest labio-lingual half width of the crown [mm].",
                        length);
      prm.add_parameter("Edge half width",
                        edge_width,
                        "Labio-lingual half width of the incisal edge [mm].",
                        length);
      prm.add_parameter("Edge half length",
                        edge_length,
                        "Mesio-distal half length of the incisal edge [mm].",
                        length);
      prm.add_parameter("Ligament thickness",
                        ligament,
                        "Between root and bone [mm].",
                        length);
      prm.add_parameter("Bone half width",
                        bone[0],
                        "Half the labio-lingual width of the bone [mm].",
                        length);
      prm.add_parameter("Bone height",
                        bone[1],
                        "From crest to base [mm].",
                        length);
      prm.add_parameter("Bone half thickness",
                        bone[2],
                        "From the plane of symmetry to the mesio-distal end of "
                        "the bone [mm].",
                        length);
      prm.add_parameter("Mesh density",
                        density,
                        "Number of cells relative to the default mesh; cell "
                        "sizes go with its inverse cubic root [-].",
                        dealii::Patterns::Double(1e-3, 1000.));
    }

    Mesh<3>
    create(const MPI_Comm &communicator,
           const std::string &,
           const std::string &) const override
    {
      BlockMesh mesh("incisor", bone[1]);
      add_blocks(mesh);
      add_names(mesh);
      return build_mesh(mesh.description(section), communicator);
    }

  private:
    using Place = BlockMesh::Place;

    // Dental anatomy textbooks: mandibular central incisor, 21.5 mm long, root
    // 12.5, of which 2 above the crest; symphysis 24 mm high, 13 mm wide.
    double root[3]     = {2.6, 10.5, 1.75};
    double height      = 11.;
    double crown_width = 3.;
    double edge_width  = 0.5;
    double edge_length = 2.5;
    double ligament    = 0.2;
    double bone[3]     = {6.5, 24., 6.};
    double density     = 1.;

    /** As in the academic case: the smaller, the nearer the block below the
     * apex ends to the apex. */
    static constexpr double apex_part = 0.5;

    unsigned int
    divisions(const unsigned int by_default, const unsigned int least) const
    {
      return std::max<unsigned int>(least,
                                    std::lround(by_default *
                                                std::cbrt(density)));
    }

    /** Half axes of the section at height @p y above the crest [mm]. */
    std::array<double, 2>
    section_at(const double y) const
    {
      // Cubic from the root to the widest place at a third, then to the edge
      const double widest = height / 3.;
      const auto smooth = [](const double u) { return u * u * (3. - 2. * u); };
      const double a =
        y < widest
          ? root[0] + (crown_width - root[0]) * smooth(y / widest)
          : crown_width + (edge_width - crown_width) *
                            std::pow((y - widest) / (height - widest), 1.5);
      return {{a, root[2] + (edge_length - root[2]) * smooth(y / height)}};
    }

    /** Surface of the root in the direction @p x on the cube. */
    Place
    on_root(const Place &x) const
    {
      const double r = x.norm();
      return {root[0] * x[0] / r, root[1] * x[1] / r, root[2] * x[2] / r};
    }

    /** The same on the side of the bone. */
    Place
    on_socket(const Place &x) const
    {
      const Place          at = on_root(x);
      dealii::Tensor<1, 3> n;
      for (unsigned int d = 0; d < 3; ++d)
        n[d] = at[d] / (root[d] * root[d]);
      return at + ligament / n.norm() * n;
    }

    /** The core of the root at r in [-1, 1], s in [0, 1] downwards, t. */
    Place
    core(const double r, const double s, const double t) const
    {
      const double q = 0.6 * (std::sqrt(0.5) * (1. - s) + 0.41 * s);
      return {root[0] * r * q, -0.62 * root[1] * s, root[2] * t * q};
    }

    static Place
    between(const Place &a, const Place &b, const double w)
    {
      return Place((1. - w) * a + w * b);
    }

    void
    add_blocks(BlockMesh &mesh) const
    {
      const unsigned int n_t     = divisions(6, 2); // 45 degrees
      const unsigned int n_s     = divisions(18, 4);
      const unsigned int n_ring  = divisions(4, 1);
      const unsigned int n_layer = divisions(3, 1);
      const unsigned int n_bone  = divisions(9, 2);
      const unsigned int n_crown = divisions(12, 4);
      const double       deep    = 1. / apex_part;
      using Divisions            = BlockMesh::Divisions;

      const auto outwards = [](const double w) {
        return (std::exp(1.5 * w) - 1.) / (std::exp(1.5) - 1.);
      };
      // The layers around the axis: where the wall is, below the crest, at a
      // direction on the cube; the box of the bone at the same parameters.
      struct Wall
      {
        std::string  region;
        unsigned int n;
      };
      const Wall walls[] = {{"tooth", n_ring},
                            {"ligament", n_layer},
                            {"bone", n_bone}};
      const auto layer   = [&](const unsigned int k,
                             const Place       &inside,
                             const Place       &direction,
                             const Place       &box,
                             const double       w) {
        if (k == 0)
          return between(inside, on_root(direction), w);
        if (k == 1)
          return between(on_root(direction), on_socket(direction), w);
        return between(on_socket(direction), box, outwards(w));
      };

      mesh.add("tooth", Divisions{{2 * n_t, n_s, n_t}}, [&](const Place &u) {
        return core(2. * u[0] - 1., 1. - u[1], u[2]);
      });
      for (unsigned int k = 0; k < 3; ++k)
        {
          const unsigned int n = walls[k].n;
          for (const double side : {-1., 1.})
            mesh.add(walls[k].region,
                     Divisions{{n, n_s, n_t}},
                     [&](const Place &u) {
                       const double s = 1. - u[1], t = u[2];
                       return layer(
                         k,
                         core(side, s, t),
                         Place(side, -equiangular(s, deep), equiangular(t, 1.)),
                         Place(side * bone[0], -s * bone[1], t * bone[2]),
                         side < 0. ? 1. - u[0] : u[0]);
                     });
          mesh.add(
            walls[k].region, Divisions{{2 * n_t, n_s, n}}, [&](const Place &u) {
              const double r = 2. * u[0] - 1., s = 1. - u[1];
              return layer(k,
                           core(r, s, 1.),
                           Place(equiangular(r, 1.), -equiangular(s, deep), 1.),
                           Place(r * bone[0], -s * bone[1], bone[2]),
                           u[2]);
            });
          mesh.add(walls[k].region,
                   Divisions{{2 * n_t, n, n_t}},
                   [&](const Place &u) {
                     const double r = 2. * u[0] - 1., t = u[2];
                     return layer(k,
                                  core(r, 1., t),
                                  Place(apex_part * equiangular(r, 1.),
                                        -1.,
                                        apex_part * equiangular(t, 1.)),
                                  Place(r * bone[0], -bone[1], t * bone[2]),
                                  1. - u[1]);
                   });
        }

      // Above the crest: the sections of the root's upper end, scaled
      const auto lifted = [&](const Place &at_crest, const double v) {
        const auto axes = section_at(v * height);
        return Place(at_crest[0] * axes[0] / root[0],
                     v * height,
                     at_crest[2] * axes[1] / root[2]);
      };
      mesh.add("tooth",
               Divisions{{2 * n_t, n_crown, n_t}},
               [&](const Place &u) {
                 return lifted(core(2. * u[0] - 1., 0., u[2]), u[1]);
               });
      for (const double side : {-1., 1.})
        mesh.add("tooth",
                 Divisions{{n_ring, n_crown, n_t}},
                 [&](const Place &u) {
                   return lifted(
                     between(core(side, 0., u[2]),
                             on_root(Place(side, 0., equiangular(u[2], 1.))),
                             side < 0. ? 1. - u[0] : u[0]),
                     u[1]);
                 });
      mesh.add(
        "tooth", Divisions{{2 * n_t, n_crown, n_ring}}, [&](const Place &u) {
          const double r = 2. * u[0] - 1.;
          return lifted(between(core(r, 0., 1.),
                                on_root(Place(equiangular(r, 1.), 0., 1.)),
                                u[2]),
                        u[1]);
        });
    }

    void
    add_names(BlockMesh &mesh) const
    {
      const double eps = 1e-9 * bone[1];
      const auto   plane =
        [&](const std::string &name, const unsigned int d, const double value) {
          mesh.name_boundary(name, [=](const Place &x) {
            return std::abs(x[d] - value) < eps;
          });
        };
      plane("symmetry", 2, 0.);
      plane("back", 2, bone[2]);
      plane("base", 1, -bone[1]);
      mesh.name_boundary("crown labial", [&](const Place &x) {
        if (x[1] < 0.3 * height || x[1] > 0.8 * height || x[0] > 0.)
          return false;
        const auto   axes = section_at(x[1]);
        const double u = x[0] / axes[0], v = x[2] / axes[1];
        return std::abs(u * u + v * v - 1.) < 1e-9 && v < -u + 1e-9;
      });
      mesh.name_point("apex", Place(0., -root[1], 0.));
      mesh.name_point("edge", Place(0., height, 0.));
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::MeshSource<3>,
  alveolus::Incisor3D,
  "incisor",
  "One incisor in its socket in three dimensions, half of it (z >= 0), of "
  "hexahedra: below the crest of the bone (y = 0) the root is half an "
  "ellipsoid, above it sections are ellipses; the ligament is a layer of "
  "constant thickness, the bone a box. x is labio-lingual (labial at negative "
  "x), y the axis of the tooth. Regions tooth, ligament and bone; boundaries "
  "symmetry, back (z greatest), base, crown labial; points apex and edge.")
