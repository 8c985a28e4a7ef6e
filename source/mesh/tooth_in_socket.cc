// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh_builder.h>
#include <alveolus/mesh/mesh_source.h>
#include <alveolus/mesh/outline_input.h>
#include <alveolus/mesh/planar_mesher.h>
#include <alveolus/mesh/socket_geometry.h>

#include <deal.II/base/numbers.h>

namespace alveolus
{
  namespace
  {
    const std::string section = "Mesh / tooth in socket";
  }

  /** A tooth, its ligament and its bone from two outlines. */
  class ToothInSocket : public MeshSource<2>
  {
  public:
    void
    declare_parameters(dealii::ParameterHandler &prm) override
    {
      const dealii::Patterns::Double length(1e-6, 1e6), any(-1e6, 1e6);
      input.declare_parameters(prm);
      prm.add_parameter("Tooth rotation",
                        rotation,
                        "Angle by which the tooth is turned about the origin "
                        "of its outline, anticlockwise [degree].",
                        dealii::Patterns::Double(-180., 180.));
      prm.add_parameter("Tooth shift x",
                        shift_x,
                        "Way by which the tooth is shifted then [mm].",
                        any);
      prm.add_parameter("Tooth shift y",
                        shift_y,
                        "Way by which the tooth is shifted then [mm].",
                        any);
      prm.add_parameter("Ligament thickness",
                        settings.thickness,
                        "Distance of the socket from the root [mm].",
                        length);
      prm.add_parameter("Least bone thickness",
                        settings.least_bone,
                        "A thinner plate of bone beside the socket is refused "
                        "(except at the margins, down to twice this length) "
                        "[mm].",
                        dealii::Patterns::Double(0., 1e6));
      prm.add_parameter("Elements across ligament",
                        settings.n_across,
                        "Number of elements from root to socket.",
                        dealii::Patterns::Integer(1, 1000));
      for (unsigned int e = 0; e < 2; ++e)
        prm.add_parameter(e == 0 ? "Cap at labial rim" : "Cap at lingual rim",
                          settings.caps[e],
                          "Layers of elements parallel to the rim of the "
                          "ligament, so that two elements share each corner of "
                          "it; 0 for one element at a corner.",
                          dealii::Patterns::Integer(0, 100));
      prm.add_parameter("Elements along ligament",
                        settings.n_along,
                        "Number of elements along the root, even.",
                        dealii::Patterns::Integer(4, 100000));
      prm.add_parameter("Largest edge in tooth",
                        settings.tooth_size,
                        "To this length the edges of the tooth grow with the "
                        "distance from the ligament [mm].",
                        length);
      prm.add_parameter("Largest edge in bone",
                        settings.bone_size,
                        "The same for the bone [mm].",
                        length);
      prm.add_parameter("Growth in tooth",
                        settings.tooth_growth,
                        "Growth of the edges of the tooth with the distance "
                        "from the ligament [-].",
                        dealii::Patterns::Double(1e-3, 10.));
      prm.add_parameter("Growth in bone",
                        settings.bone_growth,
                        "The same for the bone [-].",
                        dealii::Patterns::Double(1e-3, 10.));
      prm.add_parameter("Refinement",
                        refinement,
                        "Numbers of elements are multiplied, lengths of edges "
                        "and their growth divided by this number: 1, 2 and 4 "
                        "for meshes h, h/2 and h/4.",
                        dealii::Patterns::Integer(1, 64));
      prm.add_parameter("Corner angle",
                        corner_angle,
                        "An outline has a corner where it turns by more than "
                        "this angle from one line to the next; between corners "
                        "it is smooth [degree].",
                        dealii::Patterns::Double(1., 180.));
      prm.add_parameter("Crown height",
                        settings.crown_height,
                        "Outline of the tooth without labels: the pieces crown "
                        "labial and lingual begin so far above the higher "
                        "margin [mm].",
                        dealii::Patterns::Double(0., 1e6));
      prm.add_parameter("Incisal edge height",
                        settings.incisal_height,
                        "Outline of the tooth without labels: height of the "
                        "piece incisal edge below the highest point [mm].",
                        dealii::Patterns::Double(0., 1e6));
      prm.add_parameter("Crest length",
                        settings.crest_length,
                        "Outline of the bone without labels: length of the "
                        "pieces crest labial and lingual from the margin [mm].",
                        dealii::Patterns::Double(0., 1e6));
      prm.add_parameter("Base height",
                        settings.base_height,
                        "Outline of the bone without labels: height of the "
                        "piece bone base above the lowest point [mm].",
                        dealii::Patterns::Double(0., 1e6));
      prm.add_parameter("Least quality",
                        least_quality,
                        "A mesh whose smallest scaled Jacobian is lower is "
                        "refused [-].",
                        dealii::Patterns::Double(0., 1.));
      mesher.gmsh.declare_parameters(prm);
    }

    Mesh<2>
    create(const MPI_Comm    &communicator,
           const std::string &input_directory,
           const std::string &output_directory) const override
    {
      if (settings.n_along % 2 != 0)
        throw InputError(section + " / Elements along ligament",
                         "the number " + std::to_string(settings.n_along) +
                           " is odd",
                         "take an even one");
      for (unsigned int e = 0; e < 2; ++e)
        if (2 * settings.caps[e] >= settings.n_across)
          throw InputError(section + (e == 0 ? " / Cap at labial rim"
                                             : " / Cap at lingual rim"),
                           std::to_string(settings.caps[e]) +
                             " layers leave no room between them with " +
                             std::to_string(settings.n_across) +
                             " elements across the ligament",
                           "take fewer than half of `Elements across "
                           "ligament`");
      dealii::Tensor<1, 2> shift;
      shift[0]             = shift_x;
      shift[1]             = shift_y;
      const double  degree = dealii::numbers::PI / 180.;
      const Outline tooth  = input.tooth(input_directory, section, communicator)
                              .placed(rotation * degree, shift);
      const Outline bone = input.bone(input_directory, section, communicator);

      SocketSettings refined = settings;
      refined.corner_angle   = corner_angle * degree;
      for (auto &cap : refined.caps)
        cap *= refinement;
      refined.n_across *= refinement;
      refined.n_along *= refinement;
      refined.tooth_size /= refinement;
      refined.bone_size /= refinement;
      refined.tooth_growth /= refinement;
      refined.bone_growth /= refinement;
      PlanarMeshReport         report;
      const MeshDescription<2> description = mesh_planar_geometry(
        socket_geometry(tooth, bone, refined, section),
        mesher,
        {"tooth-in-socket", output_directory, section, communicator},
        report);
      if (report.smallest_scaled_jacobian < least_quality)
        throw InputError(section + " / Least quality",
                         "the smallest scaled Jacobian is " +
                           std::to_string(report.smallest_scaled_jacobian) +
                           " only; " + report.summary(),
                         "change the largest edges or growths a little, or "
                         "smooth the outlines near the worst cell");
      Mesh<2> mesh = build_mesh(description, communicator);
      mesh.description += "; " + report.summary();
      for (const Outline *const outline : {&tooth, &bone})
        mesh.description +=
          std::string(outline == &tooth ? "; tooth" : "; bone") +
          " outline: " + summary_of(*outline, refined.corner_angle);
      return mesh;
    }

  private:
    OutlineInput   input;
    double         rotation = 0., shift_x = 0., shift_y = 0.;
    double         corner_angle  = 40.; ///< [degree]
    double         least_quality = 0.4;
    unsigned int   refinement    = 1;
    SocketSettings settings;
    PlanarMesher   mesher;
  };
} // namespace alveolus

ALVEOLUS_REGISTER(
  alveolus::MeshSource<2>,
  alveolus::ToothInSocket,
  "tooth in socket",
  "A tooth in its socket, in 2D, from the closed outlines of tooth and bone "
  "(`Tooth outline file`, `Bone outline file`), or from closed surfaces that a "
  "plane cuts. The crown may be above or, in the upper jaw, below. The socket is the offset of the tooth's "
  "outline by `Ligament thickness` t along its normals; where it crosses the "
  "bone's outline are the margins. The root, below them, has `Elements along "
  "ligament` segments of equal arc length; the ligament between root and socket "
  "is structured with `Elements across ligament` layers, tooth and bone are "
  "unstructured quads. Regions tooth, ligament, bone. Curves root and socket "
  "(inside), rim labial and rim lingual (free ends of the ligament), neck labial "
  "and lingual, crown labial and lingual, incisal edge, crest labial and "
  "lingual, bone surface and bone base. These are labels of the outlines, where "
  "`root` above the margins becomes neck and `crest` gets its side, or for "
  "outlines without labels follow from `Crown height`, `Incisal edge height`, "
  "`Crest length` and `Base height`. Points tip, apex, margin root labial, "
  "margin root lingual, margin socket labial and margin socket lingual. Needs "
  "gmsh.")
