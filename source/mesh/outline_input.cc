// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/text_file.h>
#include <alveolus/mesh/outline_input.h>

#include <deal.II/base/patterns.h>
#include <deal.II/base/utilities.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    /** Whether the name ends with .stl, in capitals or not. */
    bool
    is_surface(const std::string &file)
    {
      const std::string ending = ".stl";
      return file.size() > ending.size() &&
             std::equal(ending.rbegin(),
                        ending.rend(),
                        file.rbegin(),
                        [](const char a, const char b) {
                          return a ==
                                 std::tolower(static_cast<unsigned char>(b));
                        });
    }

    double
    millimetres(const std::string &unit)
    {
      return unit == "m" ? 1e3 : unit == "cm" ? 10. : unit == "um" ? 1e-3 : 1.;
    }

    /** Three numbers with commas between them. */
    Tensor<1, 3>
    vector_of(const std::string &text, const std::string &where)
    {
      Tensor<1, 3> vector;
      const auto   parts = Utilities::split_string_list(text, ',');
      bool         good  = parts.size() == 3;
      for (unsigned int d = 0; good && d < 3; ++d)
        {
          std::istringstream stream(parts[d]);
          good = static_cast<bool>(stream >> vector[d]) &&
                 stream.peek() == std::char_traits<char>::eof();
        }
      if (!good)
        throw InputError(where,
                         "'" + text + "' are not three numbers",
                         "write them with commas between, e.g. 0, 0, 1");
      return vector;
    }
  } // namespace



  void
  OutlineInput::declare_parameters(ParameterHandler &prm)
  {
    prm.add_parameter("Tooth outline file",
                      tooth_file,
                      "File with the closed outline of the tooth: a point a "
                      "line, x, y and, if wanted, the label of the piece to "
                      "the next point; or a closed surface (.stl, text or "
                      "binary), which `Section normal` cuts. Relative to the "
                      "folder of the parameter file.");
    prm.add_parameter("Bone outline file",
                      bone_file,
                      "The same for the bone as it would be without a "
                      "socket; it has to cross the tooth at the margins.");
    prm.add_parameter("Outline unit",
                      unit,
                      "Unit of the lengths in both files.",
                      Patterns::Selection("um|mm|cm|m"));
    prm.add_parameter("Section origin",
                      origin,
                      "Surfaces: a point of the plane that cuts them, x, y, z "
                      "[mm]. It becomes the origin of the outlines.");
    prm.add_parameter("Section normal",
                      normal,
                      "Surfaces: normal of the plane, of any length; it "
                      "points to the viewer.");
    prm.add_parameter("Section up",
                      up,
                      "Surfaces: direction that becomes +y of the outlines "
                      "when seen along the plane, from the apex to the crown "
                      "for a lower tooth; +x is to the right of it.");
    prm.add_parameter("Tooth loop",
                      tooth_loop,
                      "Surfaces: where the plane cuts the tooth in several "
                      "loops, the number of the one to take, 1 for that of "
                      "the largest area; 0: there must be one only.",
                      Patterns::Integer(0, 1000));
    prm.add_parameter("Bone loop",
                      bone_loop,
                      "The same for the bone.",
                      Patterns::Integer(0, 1000));
  }



  SectionPlane
  OutlineInput::plane(const std::string &section) const
  {
    SectionPlane plane;
    plane.origin =
      Point<3>() + vector_of(origin, section + " / Section origin");
    plane.normal = vector_of(normal, section + " / Section normal");
    plane.up     = vector_of(up, section + " / Section up");
    if (plane.normal.norm() == 0.)
      throw InputError(section + " / Section normal",
                       "the vector is zero",
                       "give the normal of the plane, e.g. 1, 0, 0");
    plane.normal /= plane.normal.norm();
    const double length = plane.up.norm();
    plane.up -= (plane.up * plane.normal) * plane.normal;
    if (plane.up.norm() <= 1e-6 * length)
      throw InputError(section + " / Section up",
                       "the direction is zero or that of `Section normal`",
                       "give one that lies in the plane, e.g. the axis of the "
                       "tooth towards the crown");
    plane.up /= plane.up.norm();
    return plane;
  }



  Outline
  OutlineInput::read(const std::string &file,
                     const std::string &what,
                     const unsigned int loop,
                     const std::string &directory,
                     const std::string &section,
                     const MPI_Comm    &communicator) const
  {
    const std::string where = section + " / " + what + " outline file";
    if (file.empty())
      throw InputError(where,
                       "no file is given",
                       "name a file with x, y in each line, or an STL file");
    const std::string name = path_below(directory, file);
    const std::string text = read_text_file(communicator, name, where);
    if (!is_surface(file))
      return read_outline(text, name, millimetres(unit));
    return cut_surface(text,
                       name,
                       millimetres(unit),
                       plane(section),
                       loop,
                       section + " / " + what + " loop");
  }



  Outline
  OutlineInput::tooth(const std::string &directory,
                      const std::string &section,
                      const MPI_Comm    &communicator) const
  {
    return read(
      tooth_file, "Tooth", tooth_loop, directory, section, communicator);
  }



  Outline
  OutlineInput::bone(const std::string &directory,
                     const std::string &section,
                     const MPI_Comm    &communicator) const
  {
    return read(bone_file, "Bone", bone_loop, directory, section, communicator);
  }



  std::string
  summary_of(const Outline &outline, const double corner_angle)
  {
    constexpr std::size_t n_shown = 6;
    const SmoothOutline   smooth(outline, corner_angle);
    std::ostringstream    text;
    text.precision(3);
    text << outline.points.size() << " points, "
         << std::abs(signed_area(outline.points)) << " mm^2, ";
    if (smooth.corners().empty())
      text << "no corners";
    else
      text << smooth.corners().size() << " corners at";
    for (std::size_t i = 0; i < std::min(n_shown, smooth.corners().size()); ++i)
      {
        const Point<2> p = smooth.point(smooth.corners()[i]);
        text << (i == 0 ? " (" : ", (") << p[0] << ", " << p[1] << ")";
      }
    if (smooth.corners().size() > n_shown)
      text << " ...";
    for (const std::string &remark : outline.remarks)
      text << ", " << remark;
    return text.str();
  }
} // namespace alveolus
