// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/scene/accuracy.h>

#include <algorithm>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    const std::string parameter = "Accuracy";
    const std::string section   = "Accuracy levels";
    const std::string as_is     = "balanced";

    std::string
    spoken_path(const ParameterText::Entry &entry)
    {
      std::string path;
      for (const auto &part : entry.section)
        path += part + " / ";
      return path + entry.name;
    }

    bool
    same_parameter(const ParameterText::Entry &a, const ParameterText::Entry &b)
    {
      return a.name == b.name && a.section == b.section;
    }

    /** Refuse what cannot be a statement of a level. */
    void
    check(const ParameterText::Entry &entry)
    {
      if (entry.section.size() < 2)
        throw InputError(entry.origin,
                         "'" + section + " / " + entry.name +
                           "' belongs to no level",
                         "put it into a subsection with the level's name");
      if (entry.section[1] == as_is)
        throw InputError(entry.origin,
                         "the level '" + as_is +
                           "' is the scene as it stands, without the "
                           "statements of any level",
                         "set '" + entry.name + "' outside of '" + section +
                           "', or choose another name for the level");
      if (entry.section.size() == 2 &&
          (entry.name == parameter || entry.name == "Dimension"))
        throw InputError(entry.origin,
                         "a level sets '" + entry.name + "'",
                         "set it outside of '" + section + "'");
      if (entry.section.size() > 2 && entry.section[2] == section)
        throw InputError(entry.origin,
                         "a level holds levels",
                         "put them side by side");
    }
  } // namespace



  AccuracyLevels::AccuracyLevels(const ParameterText &text)
    : levels({as_is})
    , level(text.value(parameter, as_is))
  {
    for (const auto &entry : text.entries)
      if (entry.section.empty() && entry.name == parameter)
        asked_for = true;
      else if (!entry.section.empty() && entry.section[0] == section)
        {
          check(entry);
          all.push_back(entry);
          if (std::find(levels.begin(), levels.end(), entry.section[1]) ==
              levels.end())
            levels.push_back(entry.section[1]);
        }
    if (std::find(levels.begin(), levels.end(), level) == levels.end())
      {
        std::string list;
        for (const auto &name : levels)
          list += (list.empty() ? "" : ", ") + name;
        throw InputError(text.origin(parameter) + ": " + parameter,
                         "there is no level '" + level + "' in " +
                           (text.file_name.empty() ? "this scene"
                                                   : text.file_name),
                         levels.size() == 1
                           ? "it has only " + as_is +
                               ", the scene as it stands; a section '" +
                               section + "' would add others"
                           : "choose one of: " + list);
      }

    effective.file_name = text.file_name;
    for (const auto &entry : text.entries)
      if (entry.section.empty() || entry.section[0] != section)
        effective.entries.push_back(entry);
      else if (entry.section[1] == level)
        {
          of_level.push_back(effective.entries.size());
          effective.entries.push_back(entry);
          auto &place = effective.entries.back();
          place.section.erase(place.section.begin(), place.section.begin() + 2);
          place.origin += " (accuracy " + level + ")";
        }
  }



  std::vector<std::string>
  AccuracyLevels::settings() const
  {
    std::vector<std::string> result;
    for (const std::size_t i : of_level)
      {
        const auto &entry = effective.entries[i];
        std::string line  = spoken_path(entry) + " = " + entry.value;
        bool        again = false; // the level itself sets it once more
        for (std::size_t j = effective.entries.size(); j-- > i + 1;)
          if (same_parameter(effective.entries[j], entry))
            {
              const auto &last = effective.entries[j];
              again = std::find(of_level.begin(), of_level.end(), j) !=
                      of_level.end();
              if (!again && last.value != entry.value)
                line +=
                  " (not taken: " + last.origin + " sets " + last.value + ")";
              break;
            }
        if (!again)
          result.push_back(line);
      }
    return result;
  }



  void
  AccuracyLevels::declare(ParameterHandler &prm) const
  {
    if (!used())
      return;
    std::string list;
    for (const auto &name : levels)
      list += (list.empty() ? "" : "|") + name;
    prm.declare_entry(parameter,
                      as_is,
                      Patterns::Selection(list),
                      "Accuracy level, a set of statements from '" + section +
                        "'; balanced is the scene without any of them.");
    for (const auto &entry : all)
      {
        for (const auto &part : entry.section)
          prm.enter_subsection(part);
        prm.declare_entry(entry.name,
                          entry.resolved_value(),
                          Patterns::Anything(),
                          "");
        for (std::size_t i = 0; i < entry.section.size(); ++i)
          prm.leave_subsection();
      }
  }
} // namespace alveolus
