// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh.h>

namespace alveolus
{
  namespace
  {
    template <typename Map>
    const typename Map::mapped_type &
    find(const Map         &map,
         const std::string &kind,
         const std::string &name,
         const std::string &where)
    {
      const auto entry = map.find(name);
      if (entry != map.end())
        return entry->second;
      std::string known;
      for (const auto &e : map)
        known += (known.empty() ? "" : ", ") + e.first;
      throw InputError(where,
                       "the mesh has no " + kind + " '" + name + "'",
                       "known are: " + known);
    }
  } // namespace

  template <int dim>
  const dealii::Point<dim> &
  NamedSets<dim>::point(const std::string &name, const std::string &where) const
  {
    return find(points, "point", name, where);
  }

  template <int dim>
  const std::set<dealii::types::manifold_id> &
  NamedSets<dim>::curve(const std::string &name, const std::string &where) const
  {
    return find(curves, "curve", name, where);
  }

  template <int dim>
  const std::set<dealii::types::boundary_id> &
  NamedSets<dim>::boundary(const std::string &name,
                           const std::string &where) const
  {
    return find(boundaries, "boundary", name, where);
  }

  template <int dim>
  const std::set<dealii::types::material_id> &
  NamedSets<dim>::region(const std::string &name,
                         const std::string &where) const
  {
    return find(regions, "region", name, where);
  }

  template struct NamedSets<2>;
  template struct NamedSets<3>;
} // namespace alveolus
