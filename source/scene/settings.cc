// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/scene/settings.h>

#include <boost/crc.hpp>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace alveolus
{
  namespace fs = std::filesystem;
  using nlohmann::json;

  namespace
  {
    constexpr char statements_block[] = "settings/statements";
    constexpr char resolved_block[]   = "settings/resolved";
    constexpr char folder_block[]     = "settings/working folder";
    constexpr char files_block[]      = "settings/files";

    std::string
    working_folder()
    {
      std::error_code ignored;
      return fs::current_path(ignored).string();
    }

    /** Parameters by "Section / Parameter"; paths absolute. */
    std::map<std::string, std::string>
    parameters(const std::string &resolved, const std::string &folder)
    {
      std::map<std::string, std::string> result;
      for (const auto &entry :
           ParameterText::parse(resolved, "parameters").entries)
        {
          std::string path;
          for (const auto &section : entry.section)
            path += section + " / ";
          path += entry.name;
          result[path] =
            ParameterText::is_path(entry.name) && !entry.value.empty()
              ? (fs::path(folder) / entry.value).lexically_normal().string()
              : entry.value;
        }
      return result;
    }

    bool
    ends_with_path_parameter(const std::string &path)
    {
      const auto begin = path.rfind(" / ");
      return ParameterText::is_path(
        begin == std::string::npos ? path : path.substr(begin + 3));
    }

    /** Checksums of the files that parameters name, as JSON. */
    json
    checksums(const std::map<std::string, std::string> &all)
    {
      json result = json::object();
      for (const auto &[path, value] : all)
        if (!value.empty() && ends_with_path_parameter(path))
          {
            std::error_code ignored;
            std::ifstream   file(value, std::ios::binary);
            if (!file || !fs::is_regular_file(value, ignored))
              continue;
            boost::crc_32_type crc;
            char               buffer[4096];
            while (file.read(buffer, sizeof(buffer)) || file.gcount() > 0)
              crc.process_bytes(buffer, file.gcount());
            result[path] = crc.checksum();
          }
      return result;
    }

    /** What may differ without a word. */
    bool
    is_free(const std::string &path)
    {
      return path == "Title" || path == "Output / Directory" ||
             path == "Mesh / Largest number of cells" ||
             path.compare(0, 16, "Accuracy levels ") == 0 ||
             path.compare(0, 11, "Checkpoint ") == 0;
    }

    /** What is fixed by the checkpoint. */
    bool
    is_fixed(const std::string &path)
    {
      return path == "Dimension" || path.compare(0, 7, "Mesh / ") == 0;
    }
  } // namespace



  void
  save_settings(const ParameterText &text,
                const std::string   &resolved,
                BlockFile           &blocks)
  {
    json list = json::array();
    for (const auto &entry : text.entries)
      list.push_back({{"section", entry.section},
                      {"name", entry.name},
                      {"value", entry.value},
                      {"origin", entry.origin},
                      {"folder", entry.directory}});
    const json statements = {{"file", text.file_name}, {"entries", list}};
    const auto quiet = json::error_handler_t::replace; // whatever a file holds
    blocks.put(statements_block, statements.dump(1, ' ', false, quiet));
    blocks.put(resolved_block, resolved);
    blocks.put(folder_block, working_folder());
    blocks.put(files_block,
               checksums(parameters(resolved, working_folder())).dump());
  }



  ParameterText
  saved_settings(const BlockFile &blocks, const std::vector<std::string> &sets)
  {
    ParameterText     text;
    const std::string folder = blocks.text(folder_block);
    try
      {
        const json statements = json::parse(blocks.text(statements_block));
        text.file_name        = statements.at("file").get<std::string>();
        for (const json &item : statements.at("entries"))
          {
            ParameterText::Entry entry;
            entry.section = item.at("section").get<std::vector<std::string>>();
            entry.name    = item.at("name").get<std::string>();
            entry.value   = item.at("value").get<std::string>();
            entry.origin  = item.at("origin").get<std::string>();
            entry.directory = item.at("folder").get<std::string>();
            if (folder != working_folder())
              entry.directory = (fs::path(folder) / entry.directory).string();
            text.entries.push_back(entry);
          }
      }
    catch (const json::exception &error)
      {
        blocks.refuse(statements_block,
                      std::string("cannot be read: ") + error.what());
      }
    text.add(sets);
    return text;
  }



  std::vector<ChangedSetting>
  changed_settings(const BlockFile &blocks, const std::string &resolved)
  {
    const auto before =
      parameters(blocks.text(resolved_block), blocks.text(folder_block));
    const auto                  now = parameters(resolved, working_folder());
    std::vector<ChangedSetting> changes;
    const auto add = [&](const std::string &path, const std::string &what) {
      if (!is_free(path))
        changes.push_back({path, what, !is_fixed(path)});
    };
    for (const auto &[path, value] : before)
      {
        const auto found = now.find(path);
        if (found == now.end())
          add(path, "was '" + value + "', is not there any more");
        else if (found->second != value)
          add(path, "was '" + value + "', is '" + found->second + "'");
      }
    for (const auto &[path, value] : now)
      if (before.count(path) == 0)
        add(path, "was not there, is '" + value + "'");

    const json sums = json::parse(blocks.text(files_block), nullptr, false);
    if (!sums.is_object())
      blocks.refuse(files_block, "cannot be read");
    const json sums_now = checksums(now);
    for (const auto &[path, sum] : sums_now.items())
      if (sums.contains(path) && sums[path] != sum && before.count(path) > 0 &&
          before.at(path) == now.at(path))
        changes.push_back(
          {path, "the content of '" + now.at(path) + "' has changed", true});
    return changes;
  }



  std::vector<std::string>
  check_settings(const BlockFile   &blocks,
                 const std::string &resolved,
                 const bool         accept)
  {
    std::vector<std::string> passed;
    std::string              refused;
    bool                     never = false;
    for (const auto &change : changed_settings(blocks, resolved))
      {
        const std::string line = change.parameter + ": " + change.description;
        if (accept && change.acceptable)
          passed.push_back(line);
        else
          refused += (refused.empty() ? "" : "\n  ") + line +
                     (change.acceptable ? "" : " (cannot be changed)");
        never = never || !change.acceptable;
      }
    if (!refused.empty())
      throw InputError("--resume",
                       "settings are not those of " + blocks.source + "\n  " +
                         refused + "\n",
                       never ? "set them back, or run the scene anew"
                             : "set them back, or go on with them by "
                               "--accept-changes");
    return passed;
  }
} // namespace alveolus
