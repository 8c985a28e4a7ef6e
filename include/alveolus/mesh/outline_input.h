// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_outline_input_h
#define alveolus_mesh_outline_input_h

#include <alveolus/geometry/outline.h>
#include <alveolus/geometry/plane_section.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/parameter_handler.h>

#include <array>
#include <string>

namespace alveolus
{
  /**
   * The parameters that say where the outlines of a tooth and of its bone come
   * from: a list of points (read_outline()) or, for files that end with `.stl`,
   * the section of a closed surface by a plane (cut_surface()).
   */
  class OutlineInput
  {
  public:
    /** Add the parameters, bound to members, to the current subsection. */
    void
    declare_parameters(dealii::ParameterHandler &prm);

    /**
     * The outline of the tooth, or of the bone (collective).
     * @param directory of the parameter file
     * @param section   of the parameters, for messages
     * @throws InputError: see read_outline() and cut_surface(), a wrong plane
     */
    Outline
    tooth(const std::string &directory,
          const std::string &section,
          const MPI_Comm    &communicator) const;
    /** The same for the bone. @throws InputError */
    Outline
    bone(const std::string &directory,
         const std::string &section,
         const MPI_Comm    &communicator) const;

  private:
    Outline
    read(const std::string &file,
         const std::string &what,
         const unsigned int loop,
         const std::string &directory,
         const std::string &section,
         const MPI_Comm    &communicator) const;
    SectionPlane
    plane(const std::string &section) const;

    std::string  tooth_file, bone_file;
    std::string  unit   = "mm";
    std::string  origin = "0, 0, 0", normal = "1, 0, 0";
    std::string  up         = "0, 0, 1";
    unsigned int tooth_loop = 0, bone_loop = 0;
  };

  /**
   * Points, size, corners and remarks of an outline in a line.
   * @param corner_angle [rad], see SmoothOutline
   */
  std::string
  summary_of(const Outline &outline, const double corner_angle);
} // namespace alveolus

#endif
