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
    const std::string section = "Mesh / tooth in block";
  } // namespace



  /**
   * The academic case in three dimensions: a root in the form of a quarter of
   * an ellipsoid (half of the root, z >= 0) in a box of bone; the tooth itself
   * is not meshed. The plane z = 0 is a plane of symmetry and looks like the
   * two-dimensional case:
   *
   *     A------B----C       D----E------F    y = 0
   *     |      |     \     /     |      |
   *     | left |  cen-\   /-tre  |right |
   *     |      |       '-'       |      |
   *     G------H-----------------K------L    y = -height
   *
   * A2 to L2 are the points behind it on the back plane (there is no C2, D2).
   * The centre consists of four blocks between the root and the box around it:
   * below the apex, left, right and behind, as on a sphere that is a cube.
   */
  class ToothInBlock3D : public MeshSource<3>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      const dealii::Patterns::Double length(1e-3, 1e6);
      prm.add_parameter("Root half width",
                        half_width,
                        "Half the width of the root at the alveolar margin in "
                        "the direction x, semi-axis of the ellipsoid [mm].",
                        length);
      prm.add_parameter("Root half thickness",
                        half_thickness,
                        "The same in the direction z (3D) [mm].",
                        length);
      prm.add_parameter("Root depth",
                        depth,
                        "Height of the root within the bone, vertical "
                        "semi-axis of the ellipsoid [mm].",
                        length);
      prm.add_parameter("Bone width",
                        bone_width,
                        "Width of the bone on each side of the root at the "
                        "margin, from A to C [mm].",
                        length);
      prm.add_parameter("Bone height",
                        bone_height,
                        "Height of the bone, from A to G [mm].",
                        length);
      prm.add_parameter("Bone half thickness",
                        bone_half_thickness,
                        "From the plane of symmetry to the back plane, from A "
                        "to A2 (3D) [mm].",
                        length);
      prm.add_parameter("Centre margin",
                        centre_margin,
                        "Width of the centre on each side of the root at the "
                        "margin, from B to C [mm].",
                        length);
      prm.add_parameter("Mesh density",
                        density,
                        "Number of cells relative to the default mesh of "
                        "about 32000 cells; cell sizes go with its inverse "
                        "cubic root [-].",
                        dealii::Patterns::Double(1e-3, 1000.));
    }

    Mesh<3>
    create(const MPI_Comm &communicator,
           const std::string &,
           const std::string &) const override
    {
      check_lengths();
      BlockMesh mesh("tooth in block", bone_width);
      add_blocks(mesh);
      add_names(mesh);
      return build_mesh(mesh.description(section), communicator);
    }

  private:
    using Place = BlockMesh::Place;

    double half_width          = 3.5;
    double half_thickness      = 3.5;
    double depth               = 16.;
    double bone_width          = 49.;
    double bone_height         = 40.;
    double bone_half_thickness = 24.5;
    double centre_margin       = 10.;
    double density             = 1.;

    /** Size of the block below the apex on the cube around the unit sphere:
     * the smaller, the nearer its edges are to the apex. */
    static constexpr double apex_part = 0.5;

    void
    check_lengths() const
    {
      const auto refuse = [](const std::string &name,
                             const double       value,
                             const std::string &other,
                             const double       bound) {
        throw InputError(section + " / " + name,
                         std::to_string(value) + " mm is not less than '" +
                           other + "' (" + std::to_string(bound) + " mm)",
                         "lower it or raise '" + other + "'");
      };
      if (depth >= bone_height)
        refuse("Root depth", depth, "Bone height", bone_height);
      if (centre_margin >= bone_width)
        refuse("Centre margin", centre_margin, "Bone width", bone_width);
      if (half_thickness >= bone_half_thickness)
        refuse("Root half thickness",
               half_thickness,
               "Bone half thickness",
               bone_half_thickness);
    }

    unsigned int
    divisions(const unsigned int by_default, const unsigned int least) const
    {
      return std::max<unsigned int>(least,
                                    std::lround(by_default *
                                                std::cbrt(density)));
    }

    /** Point of the root in the direction of @p x on the cube. */
    Place
    root(const Place &x) const
    {
      const double r = x.norm();
      return {half_width * x[0] / r,
              depth * x[1] / r,
              half_thickness * x[2] / r};
    }

    /** Part @p u in [0, 1] of an edge of the cube that is @p length long, at
     * equal angles seen from the middle. */
    static double
    equiangular(const double u, const double length)
    {
      return std::tan(u * std::atan(length));
    }

    /** Part of the way from the root to the box: finer at the root. */
    static double
    outwards(const double w)
    {
      constexpr double growth = 2.2;
      return (std::exp(growth * w) - 1.) / (std::exp(growth) - 1.);
    }

    void
    add_blocks(BlockMesh &mesh) const
    {
      const unsigned int n_across = divisions(10, 2); // margin, 45 degrees
      const unsigned int n_down   = divisions(24, 4);
      const unsigned int n_out    = divisions(22, 4);
      const unsigned int n_far    = divisions(14, 2);
      const double       X = half_width + centre_margin, Y = bone_height;
      const double       Z    = bone_half_thickness;
      const double       deep = 1. / apex_part;

      const auto between = [](const Place &a, const Place &b, const double w) {
        const double part = outwards(w);
        return Place((1. - part) * a + part * b);
      };
      // Unit coordinates: around (t, r), up (s) or across, and outwards (w)
      for (const double side : {-1., 1.})
        {
          const auto map =
            [&, side](const double t, const double s, const double w) {
              return between(
                root(Place(side, -equiangular(s, deep), equiangular(t, 1.))),
                Place(side * X, -s * Y, t * Z),
                w);
            };
          const auto far =
            [&, side](const double t, const double s, const double w) {
              return Place(side * (X + w * (half_width + bone_width - X)),
                           -s * Y,
                           t * Z);
            };
          const BlockMesh::Divisions n{{n_out, n_down, n_across}};
          const BlockMesh::Divisions n_lateral{{n_far, n_down, n_across}};
          const std::string          name = side < 0. ? "left" : "right";
          // Right-handed: (x, y, z) upwards in y
          mesh.add("centre", n, [&](const Place &u) {
            return map(u[2], 1. - u[1], side < 0. ? 1. - u[0] : u[0]);
          });
          mesh.add(name, n_lateral, [&](const Place &u) {
            return far(u[2], 1. - u[1], side < 0. ? 1. - u[0] : u[0]);
          });
        }
      mesh.add("centre", {{2 * n_across, n_down, n_out}}, [&](const Place &u) {
        const double r = 2. * u[0] - 1., s = 1. - u[1];
        return between(root(
                         Place(std::copysign(equiangular(std::abs(r), 1.), r),
                               -equiangular(s, deep),
                               1.)),
                       Place(r * X, -s * Y, Z),
                       u[2]);
      });
      mesh.add("centre",
               {{2 * n_across, n_out, n_across}},
               [&](const Place &u) {
                 const double r = 2. * u[0] - 1.;
                 return between(
                   root(Place(apex_part *
                                std::copysign(equiangular(std::abs(r), 1.), r),
                              -1.,
                              apex_part * equiangular(u[2], 1.))),
                   Place(r * X, -Y, u[2] * Z),
                   1. - u[1]);
               });
    }

    void
    add_names(BlockMesh &mesh) const
    {
      const double X = half_width + centre_margin, Y = bone_height;
      const double Z   = bone_half_thickness;
      const double end = half_width + bone_width;
      const double eps = 1e-9 * bone_width;

      std::map<std::string, Place> points;
      for (const bool back : {false, true})
        {
          const double      z    = back ? Z : 0.;
          const std::string also = back ? "2" : "";
          points["A" + also]     = Place(-end, 0., z);
          points["B" + also]     = Place(-X, 0., z);
          points["E" + also]     = Place(X, 0., z);
          points["F" + also]     = Place(end, 0., z);
          points["G" + also]     = Place(-end, -Y, z);
          points["H" + also]     = Place(-X, -Y, z);
          points["K" + also]     = Place(X, -Y, z);
          points["L" + also]     = Place(end, -Y, z);
        }
      points["C"] = Place(-half_width, 0., 0.);
      points["D"] = Place(half_width, 0., 0.);
      for (const auto &point : points)
        mesh.name_point(point.first, point.second);

      const auto segment = [&](const std::string &a, const std::string &b) {
        mesh.name_segment(a + b, points.at(a), points.at(b));
      };
      for (const std::string line : {"BC", "DE"})
        segment(line.substr(0, 1), line.substr(1));
      for (const std::string line :
           {"AB", "EF", "AG", "BH", "EK", "FL", "GH", "HK", "KL"})
        for (const std::string also : {"", "2"})
          segment(line.substr(0, 1) + also, line.substr(1) + also);
      segment("B2", "E2");
      for (const std::string point : {"A", "B", "E", "F", "G", "H", "K", "L"})
        segment(point, point + "2");

      const auto on_root = [=](const Place &x) {
        return std::abs(std::hypot(x[0] / half_width,
                                   x[1] / depth,
                                   x[2] / half_thickness) -
                        1.) < 1e-9;
      };
      mesh.name_curve("margin", [=](const Place &x) {
        return on_root(x) && std::abs(x[1]) < eps;
      });
      mesh.name_curve("profile", [=](const Place &x) {
        return on_root(x) && std::abs(x[2]) < eps;
      });

      mesh.name_boundary("root", on_root);
      const auto plane =
        [&](const std::string &name, const unsigned int d, const double value) {
          mesh.name_boundary(name, [=](const Place &x) {
            return std::abs(x[d] - value) < eps;
          });
        };
      plane("top", 1, 0.);
      plane("base", 1, -Y);
      plane("left end", 0, -end);
      plane("right end", 0, end);
      plane("symmetry", 2, 0.);
      plane("back", 2, Z);
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::MeshSource<3>,
  alveolus::ToothInBlock3D,
  "tooth in block",
  "The academic case in three dimensions: a box of bone around half a root (z "
  ">= 0) in the form of a quarter of an ellipsoid with its axis at x = z = 0, "
  "the alveolar margin at y = 0, of hexahedra. In the plane of symmetry z = 0 "
  "points A to H, K and L as in two dimensions, A2, B2, E2, F2, G2, H2, K2, L2 "
  "behind them; curves AB, BC, DE, EF, AG, BH, EK, FL, GH, HK, KL, A2B2, B2E2, "
  "E2F2, A2G2, B2H2, E2K2, F2L2, G2H2, H2K2, K2L2, from front to back AA2, BB2 "
  "and so on, and on the root margin and profile; boundaries root, top, base, "
  "left end, right end, symmetry and back; regions left, centre and right.")
