// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/scene/parameter_text.h>

#include <deal.II/base/utilities.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

namespace alveolus
{
  using namespace dealii;

  namespace
  {
    std::string
    joined(const std::vector<std::string> &parts, const std::string &separator)
    {
      std::string result;
      for (const auto &part : parts)
        result += (result.empty() ? "" : separator) + part;
      return result;
    }

    std::string
    path_of(const ParameterText::Entry &entry)
    {
      const std::string section = joined(entry.section, "/");
      return section.empty() ? entry.name : section + "/" + entry.name;
    }

    /** "set  a b = c" -> {"a b", "c"}; false if there is no '='. */
    bool
    split_assignment(const std::string &text,
                     std::string       &name,
                     std::string       &value)
    {
      const auto equal = text.find('=');
      if (equal == std::string::npos)
        return false;
      name  = Utilities::trim(text.substr(0, equal));
      value = Utilities::trim(text.substr(equal + 1));
      return !name.empty();
    }

    bool
    starts_with_word(const std::string &line, const std::string &word)
    {
      return line.compare(0, word.size(), word) == 0 &&
             (line.size() == word.size() || line[word.size()] == ' ' ||
              line[word.size()] == '\t');
    }
  } // namespace



  std::string
  directory_of(const std::string &file_name)
  {
    const auto slash = file_name.find_last_of('/');
    return slash == std::string::npos ? "."
           : slash == 0               ? "/"
                                      : file_name.substr(0, slash);
  }



  std::string
  ParameterText::Entry::resolved_value() const
  {
    if (!ParameterText::is_path(name) || value.empty() ||
        value.front() == '/' || directory.empty() || directory == ".")
      return value;
    return directory + "/" + value;
  }



  bool
  ParameterText::is_path(const std::string &name)
  {
    static const std::string ending = " file";
    return name == "File name" ||
           (name.size() > ending.size() &&
            name.compare(name.size() - ending.size(), ending.size(), ending) ==
              0);
  }



  ParameterText
  ParameterText::parse(const std::string &content, const std::string &name)
  {
    ParameterText text;
    text.file_name = name;
    std::vector<std::string> problems, open_files;
    std::istringstream       in(content);
    text.read_statements(in, name, open_files, problems);
    if (!problems.empty())
      throw InputError("parameters", joined(problems, "\n"), "");
    return text;
  }



  void
  ParameterText::add(const std::vector<std::string> &sets)
  {
    std::vector<std::string> problems;
    add(sets, problems);
    if (!problems.empty())
      throw InputError("parameters", joined(problems, "\n"), "");
  }



  void
  ParameterText::add(const std::vector<std::string> &sets,
                     std::vector<std::string>       &problems)
  {
    for (const auto &assignment : sets)
      {
        Entry       entry;
        std::string path;
        entry.origin = "--set '" + assignment + "'";
        if (!split_assignment(assignment, path, entry.value))
          {
            problems.push_back(entry.origin +
                               ": expected 'Section/Parameter=value'");
            continue;
          }
        entry.section = Utilities::split_string_list(path, '/');
        entry.name    = entry.section.back();
        entry.section.pop_back();
        entries.push_back(entry);
      }
  }



  ParameterText
  ParameterText::read(const std::string              &file_name,
                      const std::vector<std::string> &sets)
  {
    ParameterText text;
    text.file_name = file_name;
    std::vector<std::string> problems;
    std::vector<std::string> open_files;
    text.read_file(file_name, open_files, problems);

    text.add(sets, problems);
    if (!problems.empty())
      throw InputError("parameters", joined(problems, "\n"), "");
    return text;
  }



  void
  ParameterText::read_file(const std::string        &name,
                           std::vector<std::string> &open_files,
                           std::vector<std::string> &problems)
  {
    std::error_code ignored;
    for (const auto &open_file : open_files)
      if (open_file == name ||
          std::filesystem::equivalent(open_file, name, ignored))
        {
          problems.push_back(name + ": the file includes itself");
          return;
        }
    // Files that each include the next one twice would never end.
    if (++n_files > most_files)
      {
        if (n_files == most_files + 1)
          problems.push_back(name + ": more than " +
                             std::to_string(most_files) +
                             " files are included; include each once");
        return;
      }
    if (std::filesystem::is_character_file(name, ignored) &&
        !std::filesystem::equivalent(name, "/dev/stdin", ignored))
      {
        problems.push_back("parameter file '" + name + "' is a device");
        return;
      }
    std::ifstream file(name);
    if (!file || file.peek() == std::ifstream::traits_type::eof())
      {
        problems.push_back("parameter file '" + name +
                           "' cannot be read or is empty");
        return;
      }
    read_statements(file, name, open_files, problems);
  }



  void
  ParameterText::read_statements(std::istream             &file,
                                 const std::string        &name,
                                 std::vector<std::string> &open_files,
                                 std::vector<std::string> &problems)
  {
    open_files.push_back(name);

    std::vector<std::string>           section;
    std::vector<std::string>           section_begin;
    std::map<std::string, std::string> seen;
    std::string                        raw;
    for (unsigned int line_number = 1; std::getline(file, raw); ++line_number)
      {
        const std::string origin = name + ":" + std::to_string(line_number);
        std::string       line   = raw.substr(0, raw.find('#'));
        // A backslash at the end continues the statement on the next line.
        while (!line.empty() && Utilities::trim(line).size() > 0 &&
               Utilities::trim(line).back() == '\\' && std::getline(file, raw))
          {
            ++line_number;
            line = Utilities::trim(line);
            line.pop_back();
            line += " " + Utilities::trim(raw.substr(0, raw.find('#')));
          }
        line = Utilities::trim(line);
        if (line.empty())
          continue;

        if (starts_with_word(line, "include"))
          {
            const std::string other = Utilities::trim(line.substr(7));
            if (!section.empty())
              problems.push_back(origin + ": 'include' inside subsection '" +
                                 joined(section, "/") +
                                 "'; put it at the top level");
            else
              read_file(other.compare(0, 1, "/") == 0
                          ? other
                          : directory_of(name) + "/" + other,
                        open_files,
                        problems);
          }
        else if (starts_with_word(line, "subsection"))
          {
            section.push_back(Utilities::trim(line.substr(10)));
            section_begin.push_back(origin);
          }
        else if (line == "end")
          {
            if (section.empty())
              problems.push_back(origin + ": 'end' without 'subsection'");
            else
              {
                section.pop_back();
                section_begin.pop_back();
              }
          }
        else if (starts_with_word(line, "set"))
          {
            Entry entry;
            entry.section   = section;
            entry.origin    = origin;
            entry.directory = directory_of(name);
            if (!split_assignment(line.substr(3), entry.name, entry.value))
              {
                problems.push_back(origin +
                                   ": expected 'set NAME = VALUE', found '" +
                                   line + "'");
                continue;
              }
            const auto earlier = seen.emplace(path_of(entry), origin);
            if (!earlier.second)
              problems.push_back(origin + ": '" + path_of(entry) +
                                 "' is set twice in this file, first at " +
                                 earlier.first->second);
            entries.push_back(entry);
          }
        else
          problems.push_back(
            origin + ": '" + line +
            "' is not a statement; expected subsection, set, end or include");
      }
    for (unsigned int i = 0; i < section.size(); ++i)
      problems.push_back(section_begin[i] + ": subsection '" + section[i] +
                         "' has no 'end'");
    open_files.pop_back();
  }



  std::string
  ParameterText::value(const std::string &path,
                       const std::string &otherwise) const
  {
    for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
      if (path_of(*entry) == path)
        return entry->value;
    return otherwise;
  }



  std::string
  ParameterText::origin(const std::string &path) const
  {
    for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
      if (path_of(*entry) == path)
        return entry->origin;
    return "default";
  }



  std::vector<std::string>
  ParameterText::names(const std::string &section) const
  {
    std::vector<std::string> result;
    for (const auto &name :
         Utilities::split_string_list(value(section + "/Names", ""), ','))
      if (!name.empty())
        {
          if (std::find(result.begin(), result.end(), name) != result.end())
            throw InputError(origin(section + "/Names"),
                             "'" + name + "' stands twice in " + section +
                               " / Names",
                             "each name may stand there once");
          result.push_back(name);
        }
    return result;
  }



  void
  ParameterText::apply(ParameterHandler            &prm,
                       std::vector<std::string>     problems,
                       const std::set<std::string> &unknown) const
  {
    // A variant may shorten the Names, or change the Type of the mesh, of the
    // file it includes: what then has no place any more is no mistake.
    const auto is_left_out = [this](const std::string &section,
                                    const std::string &member) {
      for (const auto &entry : entries)
        if (path_of(entry) == section + "/Names")
          {
            const auto list = Utilities::split_string_list(entry.value, ',');
            if (std::find(list.begin(), list.end(), member) != list.end())
              return true;
          }
        else if (path_of(entry) == section + "/Type" && entry.value == member)
          return true;
      return false;
    };

    for (const auto &entry : entries)
      {
        if (entry.section.size() > 1 &&
            unknown.count(entry.section[0] + "/" + entry.section[1]) > 0)
          continue;
        std::vector<std::string> path;
        bool                     known = true;
        for (const auto &section : entry.section)
          {
            path.push_back(section);
            if (!prm.subsection_path_exists(path))
              {
                path.pop_back();
                known = false;
                if (path.size() == 1 && is_left_out(path[0], section))
                  break;
                const bool collection =
                  path.size() == 1 && !names(path[0]).empty();
                problems.push_back(
                  entry.origin + ": there is no subsection '" + section + "'" +
                  (path.empty() ? "" : " in '" + joined(path, " / ") + "'") +
                  (collection || path.size() == 1
                     ? "; add '" + section + "' to " + path[0] +
                         " / Names, or correct it"
                     : "; `--print-parameters` lists what there is"));
                break;
              }
          }
        if (!known)
          continue;

        for (const auto &section : entry.section)
          prm.enter_subsection(section);
        // Only set() tells of undeclared entries in a release build.
        try
          {
            prm.set(entry.name, entry.resolved_value());
          }
        catch (const ParameterHandler::ExcEntryUndeclared &)
          {
            problems.push_back(
              entry.origin + ": there is no parameter '" + entry.name + "'" +
              (path.empty() ? "" : " in '" + joined(path, " / ") + "'") +
              "; `--print-parameters` lists what there is");
          }
        catch (const ParameterHandler::ExcValueDoesNotMatchPattern &error)
          {
            std::ostringstream message;
            error.print_info(message);
            const std::string all = message.str();
            const auto        at  = all.find("given pattern <");
            problems.push_back(
              entry.origin + ": '" + path_of(entry) + "' is '" + entry.value +
              "', but must be " +
              (at == std::string::npos
                 ? all
                 : all.substr(at + 15, all.rfind('>') - at - 15)));
          }
        for (unsigned int i = 0; i < entry.section.size(); ++i)
          prm.leave_subsection();
      }
    if (!problems.empty())
      throw InputError("parameters", joined(problems, "\n"), "");
  }
} // namespace alveolus
