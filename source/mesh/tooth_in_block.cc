// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/gmsh.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_checks.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/msh_reader.h>

#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

namespace alveolus
{
  namespace
  {
    const std::string section = "Mesh / tooth in block";

    /** A combination of gmsh's options to try. */
    struct Attempt
    {
      unsigned int algorithm; ///< 6: frontal Delaunay, 5: Delaunay
      unsigned int smoothing; ///< steps
    };

    /**
     * In the order of their success on this geometry. Algorithm 8 (for quads)
     * crashes in gmsh 4.8.
     */
    constexpr Attempt attempts[] = {{6, 10}, {6, 5}, {5, 10}};

    /** With this smallest scaled Jacobian no further attempt is made; the
     * 135 degrees of a regular node with three cells give 0.71. */
    constexpr double good_quality = 0.6;

    /** Straight lines by the names of their ends; tags follow from 1 on. */
    constexpr const char *straight_lines[] = {"AB",
                                              "BC",
                                              "DE",
                                              "EF",
                                              "AG",
                                              "BH",
                                              "GH",
                                              "HI",
                                              "IJ",
                                              "JK",
                                              "KL",
                                              "EK",
                                              "FL"};

    int
    point_tag(const char name)
    {
      return name - 'A' + 1;
    }

    int
    line_tag(const std::string &name)
    {
      int tag = 1;
      for (const char *line : straight_lines)
        {
          if (name == line)
            return tag;
          ++tag;
        }
      throw std::logic_error("no line " + name);
    }

    /** Tags of several lines, negative where the name is turned round. */
    std::string
    tags_of(const std::vector<std::string> &names)
    {
      std::string result;
      for (const std::string &name : names)
        result += (result.empty() ? "" : ", ") + std::to_string(line_tag(name));
      return result;
    }

    constexpr int centre_tag = 13, apex_tag = 14; // points
    constexpr int left_root = 14, right_root = 15;
  } // namespace



  /**
   * The academic case of the paper (model 1, Figure 1): a root in the form of a
   * half-ellipse in a rectangular block of bone; the tooth itself is not
   * meshed.
   *
   *     A------B----C       D----E------F    y = 0
   *     |      |     \     /     |      |
   *     | left |  cen-\   /-tre  |right |
   *     |      |       '-'       |      |
   *     G------H----I-------J----K------L    y = -height
   *
   * The axis of the root is x = 0. Lateral blocks are structured, the centre is
   * not and gets finer towards the apex.
   */
  class ToothInBlock : public MeshSource<2>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      const dealii::Patterns::Double length(1e-3, 1e6);
      prm.add_parameter("Root half width",
                        half_width,
                        "Half the width of the root at the alveolar margin, "
                        "horizontal semi-axis of the half-ellipse [mm].",
                        length);
      prm.add_parameter("Root depth",
                        depth,
                        "Height of the root within the bone, vertical "
                        "semi-axis of the half-ellipse [mm].",
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
      prm.add_parameter("Centre margin",
                        centre_margin,
                        "Width of the unstructured part on each side of the "
                        "root at the margin, from B to C [mm].",
                        length);
      prm.add_parameter("Mesh density",
                        density,
                        "Number of cells relative to the default mesh of about "
                        "1000 cells; cell sizes go with its inverse square "
                        "root [-].",
                        dealii::Patterns::Double(0.01, 1000.));
      gmsh.declare_parameters(prm);
    }

    Mesh<2>
    create(const MPI_Comm &communicator,
           const std::string &,
           const std::string &output_directory) const override
    {
      check_lengths();
      std::optional<MeshDescription<2>> best;
      std::string                       failure;
      unsigned int                      number = 0;
      for (const Attempt &attempt : attempts)
        {
          const std::string name =
            "tooth-in-block" +
            (++number == 1 ? "" : "-" + std::to_string(number));
          const std::string text =
            run_gmsh(geometry(attempt),
                     2,
                     gmsh,
                     {name, output_directory, section, communicator});
          try
            {
              MeshDescription<2> candidate = read_msh<2>(text, name + ".msh");
              check_description(candidate);
              if (!best || smallest_scaled_jacobian(candidate) >
                             smallest_scaled_jacobian(*best))
                best = std::move(candidate);
            }
          catch (const InputError &error)
            {
              failure = error.what(); // e.g. a triangle: the next may have none
            }
          if (best && smallest_scaled_jacobian(*best) >= good_quality)
            break;
        }
      if (!best)
        throw InputError(section,
                         "gmsh makes no mesh of quads of this geometry (" +
                           failure + ")",
                         "change 'Mesh density' or 'Centre margin'");
      return build_mesh(*best, communicator);
    }

  private:
    double       half_width    = 3.5;
    double       depth         = 16.;
    double       bone_width    = 49.;
    double       bone_height   = 40.;
    double       centre_margin = 10.;
    double       density       = 1.;
    GmshSettings gmsh;

    void
    check_lengths() const
    {
      if (depth >= bone_height)
        throw InputError(section + " / Root depth",
                         "the root of " + std::to_string(depth) +
                           " mm is deeper than the bone of " +
                           std::to_string(bone_height) + " mm",
                         "lower it or raise 'Bone height'");
      if (centre_margin >= bone_width)
        throw InputError(section + " / Centre margin",
                         "the centre of " + std::to_string(centre_margin) +
                           " mm is wider than the bone of " +
                           std::to_string(bone_width) + " mm",
                         "lower it or raise 'Bone width'");
    }

    /** Length of the root's outline from the margin to the apex [mm]. */
    double
    arc_length() const
    {
      constexpr unsigned int n      = 2000;
      double                 length = 0.;
      for (unsigned int i = 0; i < n; ++i)
        {
          const double a = 0.5 * dealii::numbers::PI * i / n;
          const double b = 0.5 * dealii::numbers::PI * (i + 1) / n;
          length += std::hypot(half_width * (std::cos(a) - std::cos(b)),
                               depth * (std::sin(a) - std::sin(b)));
        }
      return length;
    }

    /** Edges along a line, of size @p size [mm] at density 1. */
    unsigned int
    n_edges(const double length, const double size) const
    {
      return std::max(1L, std::lround(length / size * std::sqrt(density)));
    }

    /** Gmsh's script of the block. */
    std::string
    geometry(const Attempt &attempt) const
    {
      std::ostringstream geo;
      geo.precision(16);
      write_outline(geo);
      write_divisions(geo);

      // Anticlockwise loops, so that no cell has to be turned.
      geo << "Curve Loop(1) = {5, 7, -6, -1};\n"
          << "Curve Loop(2) = {6, 8, 9, 10, -12, -3, -" << right_root << ", -"
          << left_root << ", -2};\n"
          << "Curve Loop(3) = {12, 11, -13, -4};\n"
          << "Plane Surface(1) = {1};\nPlane Surface(2) = {2};\n"
          << "Plane Surface(3) = {3};\n"
          << "Transfinite Surface {1};\nTransfinite Surface {3};\n"
          << "Recombine Surface {1, 2, 3};\n";
      write_names(geo);
      geo << "Mesh.Algorithm = " << attempt.algorithm << ";\n"
          << "Mesh.Smoothing = " << attempt.smoothing << ";\n"
          << "Mesh.RecombinationAlgorithm = 1;\n"
          << "Mesh.RandomSeed = 1;\n"
          << "Mesh.RandomFactor = 1e-9;\n"
          << "Mesh.ElementOrder = 1;\n"
          << "Mesh.SaveAll = 0;\n"
          << "Mesh.Binary = 0;\n";
      return geo.str();
    }

    void
    write_outline(std::ostream &geo) const
    {
      const double x_c = -half_width, x_b = x_c - centre_margin;
      const double x_a  = x_c - bone_width;
      const double x[6] = {x_a, x_b, x_c, -x_c, -x_b, -x_a};
      geo << "// Bone block around a root, lengths in mm.\n";
      for (unsigned int i = 0; i < 12; ++i)
        geo << "Point(" << i + 1 << ") = {" << x[i % 6] << ", "
            << (i < 6 ? 0. : -bone_height) << ", 0};\n";
      geo << "Point(" << centre_tag << ") = {0, 0, 0};\n"
          << "Point(" << apex_tag << ") = {0, " << -depth << ", 0};\n";
      for (const std::string line : straight_lines)
        geo << "Line(" << line_tag(line) << ") = {" << point_tag(line[0])
            << ", " << point_tag(line[1]) << "};\n";
      // Gmsh wants a point on the major axis.
      const int major = depth > half_width ? apex_tag : point_tag('C');
      geo << "Ellipse(" << left_root << ") = {" << point_tag('C') << ", "
          << centre_tag << ", " << major << ", " << apex_tag << "};\n"
          << "Ellipse(" << right_root << ") = {" << apex_tag << ", "
          << centre_tag << ", " << major << ", " << point_tag('D') << "};\n";
    }

    /**
     * Numbers of edges along the lines. At the default parameters: 12 x 18
     * cells in each lateral block and 21 edges along each half of the root. The
     * number of edges around the centre is even (a condition for quads only),
     * since all lines but IJ come in pairs and IJ gets an even number.
     */
    void
    write_divisions(std::ostream &geo) const
    {
      const auto divide = [&geo](const std::string &lines,
                                 const unsigned int n,
                                 const double       ratio = 1.) {
        geo << "Transfinite Curve {" << lines << "} = " << n + 1
            << " Using Progression " << ratio << ";\n";
      };
      divide(tags_of({"AB", "GH", "EF", "KL"}),
             n_edges(bone_width - centre_margin, 39. / 12.));
      divide(tags_of({"AG", "BH", "EK", "FL"}),
             n_edges(bone_height, 40. / 18.));
      divide(tags_of({"HI", "JK"}), n_edges(centre_margin, 10. / 6.));
      divide(tags_of({"IJ"}), 2 * n_edges(half_width, 3.5 / 2.));

      // At the default parameters 5 and 6 % longer from edge to edge; the same
      // ratio of the last to the first edge for other numbers of them.
      const unsigned int n_margin     = n_edges(centre_margin, 10. / 8.);
      const double       margin_ratio = std::pow(1.05, 8. / n_margin);
      divide(tags_of({"BC"}), n_margin, 1. / margin_ratio);
      divide(tags_of({"DE"}), n_margin, margin_ratio);
      const unsigned int n_root     = n_edges(arc_length(), 17.27 / 21.);
      const double       root_ratio = std::pow(1.06, 21. / n_root);
      divide(std::to_string(left_root), n_root, 1. / root_ratio);
      divide(std::to_string(right_root), n_root, root_ratio);
    }

    void
    write_names(std::ostream &geo) const
    {
      for (char name = 'A'; name <= 'L'; ++name)
        geo << "Physical Point(\"" << name << "\") = {" << point_tag(name)
            << "};\n";
      for (const std::string line : straight_lines)
        geo << "Physical Curve(\"" << line << "\") = {" << line_tag(line)
            << "};\n";
      const auto group = [&geo](const std::string &name,
                                const std::string &tags) {
        geo << "Physical Curve(\"" << name << "\") = {" << tags << "};\n";
      };
      group("root",
            std::to_string(left_root) + ", " + std::to_string(right_root));
      group("top", tags_of({"AB", "BC", "DE", "EF"}));
      group("base", tags_of({"GH", "HI", "IJ", "JK", "KL"}));
      group("left end", tags_of({"AG"}));
      group("right end", tags_of({"FL"}));
      geo << "Physical Surface(\"left\") = {1};\n"
          << "Physical Surface(\"centre\") = {2};\n"
          << "Physical Surface(\"right\") = {3};\n";
    }
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::MeshSource<2>,
  alveolus::ToothInBlock,
  "tooth in block",
  "The academic case of Mengoni, Ponthot and Boman (2016), Figure 1: a block of "
  "bone around a root in the form of a half-ellipse with its axis at x = 0, the "
  "alveolar margin at y = 0. Points A to F on the margin line (C and D where it "
  "meets the root), G to L below them on the bottom line; curves AB, BC, DE, "
  "EF, AG, BH, GH, HI, IJ, JK, KL, EK, FL and root; boundaries top, base, "
  "left end, right end and root; regions left, centre and right. Needs gmsh.")
