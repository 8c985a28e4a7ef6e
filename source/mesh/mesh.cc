// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/mesh/mesh.h>

namespace alveolus
{
  namespace
  {
    template <class Value>
    const Value &
    look_up(const std::map<std::string, Value> &sets,
            const std::string                  &kind,
            const std::string                  &name,
            const std::string                  &where)
    {
      const auto set = sets.find(name);
      if (set != sets.end())
        return set->second;

      std::string known;
      for (const auto &entry : sets)
        known += (known.empty() ? "" : ", ") + entry.first;
      throw InputError(where,
                       "the mesh has no " + kind + " '" + name + "'",
                       sets.empty() ? "it has no named " + kind + " at all"
                                    : "known are: " + known);
    }
  } // namespace



  template <int dim>
  const dealii::Point<dim> &
  NamedSets<dim>::point(const std::string &name, const std::string &where) const
  {
    return look_up(points, "point", name, where);
  }



  template <int dim>
  const std::set<dealii::types::manifold_id> &
  NamedSets<dim>::curve(const std::string &name, const std::string &where) const
  {
    return look_up(curves, "curve", name, where);
  }



  template <int dim>
  const std::set<dealii::types::boundary_id> &
  NamedSets<dim>::boundary(const std::string &name,
                           const std::string &where) const
  {
    return look_up(boundaries, "boundary", name, where);
  }



  template <int dim>
  const std::set<dealii::types::material_id> &
  NamedSets<dim>::region(const std::string &name,
                         const std::string &where) const
  {
    return look_up(regions, "region", name, where);
  }



  template struct NamedSets<2>;
  template struct NamedSets<3>;
} // namespace alveolus
