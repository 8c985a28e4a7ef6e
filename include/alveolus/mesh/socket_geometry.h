// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_mesh_socket_geometry_h
#define alveolus_mesh_socket_geometry_h

#include <alveolus/geometry/outline.h>
#include <alveolus/mesh/planar_geometry.h>

namespace alveolus
{
  /** Lengths [mm] and numbers that turn two outlines into a socket. */
  struct SocketSettings
  {
    double       thickness = 0.2; ///< of the ligament
    unsigned int n_across  = 4;   ///< elements through the ligament
    /** Layers of the caps at the labial and the lingual rim, see Strip. */
    std::array<unsigned int, 2> caps{{0, 0}};
    unsigned int n_along      = 250;  ///< elements along the root, even
    double       tooth_size   = 0.32; ///< largest edge
    double       bone_size    = 0.9;  ///< largest edge [mm]
    double       tooth_growth = 0.19; ///< of the edge with the distance [-]
    double       bone_growth  = 0.25; ///< the same in bone [-]
    double       corner_angle = 0.7;  ///< [rad]
    double       least_bone   = 0.3;  ///< thinnest plate that is accepted

    // Pieces of outlines without labels
    double crown_height = 2.; ///< crown pieces begin so far above margins
    double incisal_height =
      0.4;                     ///< of the incisal edge below the highest point
    double crest_length = 1.2; ///< of the crest pieces along the surface
    double base_height  = 1.;  ///< of the base above the lowest point
  };

  /**
   * Plane section of a tooth in its socket: regions `tooth`, `ligament` and
   * `bone`.
   *
   * The socket is the curve at the distance `thickness` from the tooth's
   * outline, r + t n; where it crosses the bone's outline are the margins. The
   * part of the tooth's outline below them is the `root`, divided into n_along
   * segments of equal arc length; node i of the `socket` is that of the root
   * plus t times its unit normal, so that the ligament's area is that of a
   * parallel strip, t L + t^2/2 (turn of the tangent along the root). The bone
   * is what is inside its outline and beyond the socket; its outline over the
   * tooth is dropped. The ligament is structured, tooth and bone are not; their
   * edges grow from those of the root.
   *
   * Curves: root, socket, rim labial, rim lingual (free ends of the ligament),
   * neck and crown labial and lingual, incisal edge, crest labial and lingual,
   * bone surface, bone base. A label of an outline is the name of the curve,
   * except `root` (above the margins: `neck labial` or `neck lingual`) and
   * `crest`
   * (`crest labial` or `crest lingual`). Labial is the side where, seen along
   * the anticlockwise outline of the tooth, the root begins: -x for a tooth
   * with its crown upwards, +x for one of the upper jaw with its crown below;
   * heights count towards the crown. Points: tip (middle of the incisal edge
   * or, without one, the highest point), apex (lowest node of the root), margin
   * root labial, margin root lingual, margin socket labial, margin socket
   * lingual.
   *
   * @throws InputError: outlines that do not cross twice, a socket that leaves
   * the bone or crosses itself, plates of bone thinner than `least_bone`
   */
  PlanarGeometry
  socket_geometry(const Outline        &tooth,
                  const Outline        &bone,
                  const SocketSettings &settings,
                  const std::string    &where);
} // namespace alveolus

#endif
