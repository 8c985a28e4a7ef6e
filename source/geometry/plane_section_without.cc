// SPDX-License-Identifier: LGPL-2.1-or-later
// Stands for plane_section.cc where there is no CGAL.
#include <alveolus/base/errors.h>
#include <alveolus/geometry/plane_section.h>

namespace alveolus
{
  bool
  can_cut_surfaces()
  {
    return false;
  }



  Outline
  cut_surface(const std::string &,
              const std::string &source,
              const double,
              const SectionPlane &,
              const unsigned int,
              const std::string &)
  {
    throw InputError(source,
                     "this program was built without CGAL, which cuts surfaces",
                     "install it (Debian: libcgal-dev) and build again, or "
                     "give the outline as a list of points");
  }
} // namespace alveolus
