// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/text_file.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/io/checkpoint.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

namespace alveolus
{
  using namespace dealii;
  namespace fs = std::filesystem;

  namespace
  {
    const std::string ending = ".alv";

    /** Checkpoints in a folder by their numbers. */
    std::map<unsigned int, std::string>
    list(const std::string &folder)
    {
      std::map<unsigned int, std::string> files;
      std::error_code                     ignored;
      for (const auto &entry : fs::directory_iterator(folder, ignored))
        {
          const std::string digits = entry.path().stem().string();
          if (entry.path().extension() == ending && !digits.empty() &&
              digits.size() < 10 &&
              digits.find_first_not_of("0123456789") == std::string::npos)
            files[std::stoul(digits)] = entry.path().string();
        }
      return files;
    }



    std::string
    folder_of(const std::string &directory)
    {
      return directory + "/checkpoint";
    }



    /** The whole content of a file. @throws InputError */
    std::string
    content(const std::string &file)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream bytes;
      bytes << in.rdbuf();
      if (!in || in.bad())
        throw InputError(file, "cannot be read", "check its permissions");
      return bytes.str();
    }



    /** Advice for a run whose checkpoint @p damaged cannot be read. */
    std::string
    other_than(const std::string &damaged)
    {
      const auto files =
        list(fs::path(damaged).parent_path().string()); // ascending
      for (auto file = files.rbegin(); file != files.rend(); ++file)
        if (file->second != damaged)
          try
            {
              const BlockFile blocks =
                BlockFile::parse(content(file->second), file->second);
              std::ostringstream text;
              text << "an older one is whole, of t = "
                   << blocks.number("state/time") << " T: --resume "
                   << file->second;
              return text.str();
            }
          catch (const InputError &)
            {}
      return "there is no other one that is whole: run the scene anew";
    }
  } // namespace



  void
  CheckpointFolder::Parameters::declare(ParameterHandler &prm)
  {
    prm.add_parameter("Write",
                      write,
                      "Write checkpoints, from which a run can go on: at the "
                      "intervals below, before each remesh, when the run is "
                      "interrupted or fails, and at its end.",
                      Patterns::Bool());
    prm.add_parameter("Wall time interval",
                      wall_interval,
                      "Wall time between two checkpoints [s]; 0: not by time.",
                      Patterns::Double(0.));
    prm.add_parameter("Step interval",
                      step_interval,
                      "Accepted steps between two checkpoints; 0: not by "
                      "steps.",
                      Patterns::Integer(0));
  }



  CheckpointFolder::CheckpointFolder(const std::string &directory)
    : folder(folder_of(directory))
  {}



  void
  CheckpointFolder::clear()
  {
    require_plain(folder, true);
    std::error_code ignored;
    for (const auto &file : list(folder))
      fs::remove(file.second, ignored);
    remove_unfinished(folder);
  }



  void
  CheckpointFolder::go_on_from(const std::string &file)
  {
    require_plain(folder, true);
    remove_unfinished(folder);
    const auto files = list(folder);
    if (!files.empty())
      last_number = files.rbegin()->first;
    std::error_code ignored;
    if (fs::equivalent(fs::path(file).parent_path(), folder, ignored))
      last = file;
  }



  std::string
  CheckpointFolder::write(const BlockFile &blocks)
  {
    std::error_code ignored; // the file cannot be opened then
    fs::create_directory(folder, ignored);
    char number[16];
    std::snprintf(number, sizeof(number), "%06u", last_number + 1);
    const std::string name = folder + "/" + number + ending;
    WholeFile         file(name);
    blocks.write(file.stream());
    file.commit();
    for (const auto &other : list(folder))
      if (other.second != name &&
          !(last != "" && fs::equivalent(other.second, last, ignored)))
        fs::remove(other.second, ignored);
    ++last_number;
    last = name;
    return name;
  }



  std::string
  CheckpointFolder::find(const std::string &name)
  {
    std::error_code ignored;
    if (fs::is_regular_file(name, ignored))
      return name;
    const auto files = list(folder_of(name));
    if (files.empty())
      throw InputError("--resume",
                       fs::exists(name, ignored)
                         ? "there is no checkpoint in '" + name + "'"
                         : "there is no folder '" + name + "'",
                       "name the output folder of a run that wrote one");
    return files.rbegin()->second;
  }



  BlockFile
  read_checkpoint(const std::string &name, const MPI_Comm &communicator)
  {
    const bool  is_first = Utilities::MPI::this_mpi_process(communicator) == 0;
    BlockFile   blocks;
    std::string bytes;
    const std::string file = text_from_root(communicator, [&]() {
      const std::string found = CheckpointFolder::find(name);
      try
        {
          bytes  = content(found);
          blocks = BlockFile::parse(bytes, found);
          blocks.number("state/time");
        }
      catch (const InputError &error)
        {
          throw InputError("--resume", error.what(), other_than(found));
        }
      return found;
    });
    // The others parse the same bytes, which are good.
    const std::uint64_t size =
      Utilities::MPI::broadcast(communicator,
                                static_cast<std::uint64_t>(bytes.size()));
    if (!is_first)
      bytes.resize(size);
    Utilities::MPI::broadcast(bytes.data(), bytes.size(), 0, communicator);
    return is_first ? blocks : BlockFile::parse(bytes, file);
  }
} // namespace alveolus
