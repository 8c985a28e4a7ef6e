// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_assembly_contact_forces_h
#define alveolus_assembly_contact_forces_h

#include <alveolus/assembly/contact_gap.h>

namespace alveolus
{
  /**
   * What a point of the slave and the nodes of a master patch resist with, per
   * length of the slave line [MPa]: minus the forces on them, and their
   * derivatives by the coordinates of the patch [MPa/mm].
   */
  struct ContactForces
  {
    /** Coordinates that forces and matrix go with. */
    ContactPatch patch;
    /** Residual by coordinate [N/mm]. */
    ContactPatch::Row value{};
    /** Its derivatives [N/mm^2]. */
    std::array<ContactPatch::Row, ContactPatch::max_size> matrix{};
  };

  /** Pressure p with dp = -e dg along the normal: p n and -p N_b n. */
  ContactForces
  pressing_forces(const ContactGap &gap, const double pressure, const double e);

  /**
   * The same and a shear t with dt = e ds, as derivatives of -p dg and t ds.
   */
  ContactForces
  sticking_forces(const ContactOffset &offset,
                  const double         pressure,
                  const double         shear,
                  const double         e);
} // namespace alveolus

#endif
