// SPDX-License-Identifier: LGPL-2.1-or-later
#include "seeds.h"

#include <alveolus/base/errors.h>
#include <alveolus/driver/program.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/scene/scene.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <sstream>

namespace alveolus::fuzz
{
  namespace fs = std::filesystem;

  namespace
  {
    std::string
    content_of(const std::string &file)
    {
      std::ifstream      in(file, std::ios::binary);
      std::ostringstream text;
      text << in.rdbuf();
      if (!in)
        throw RunError(file, "cannot be read", "");
      return text.str();
    }

    void
    write(const std::string &file, const std::string &content)
    {
      std::ofstream out(file, std::ios::binary);
      out << content;
      if (!out.flush())
        throw RunError(file, "cannot be written", "");
    }

    /** The statements of a scene in one file, with absolute paths. */
    std::string
    flat(const ParameterText &text)
    {
      std::ostringstream out;
      // Later statements override: only the last one of each may stay.
      std::vector<std::string> seen;
      std::vector<std::string> lines;
      for (auto entry = text.entries.rbegin(); entry != text.entries.rend();
           ++entry)
        {
          std::string path, line, end;
          for (const auto &section : entry->section)
            {
              path += section + "/";
              line += "subsection " + section + "\n";
              end += "end\n";
            }
          path += entry->name;
          if (std::find(seen.begin(), seen.end(), path) != seen.end())
            continue;
          seen.push_back(path);
          std::string value = entry->value;
          if (ParameterText::is_path(entry->name) && !value.empty() &&
              value.front() != '/')
            value = fs::absolute(fs::path(entry->directory) / value)
                      .lexically_normal()
                      .string();
          lines.push_back(line + "  set " + entry->name + " = " + value + "\n" +
                          end);
        }
      for (auto line = lines.rbegin(); line != lines.rend(); ++line)
        out << *line;
      return out.str();
    }

    std::string
    resolved(const ParameterText &text)
    {
      std::ostringstream out;
      if (text.value("Dimension", "2") == "3")
        Scene<3>(text).write_resolved(out);
      else
        Scene<2>(text).write_resolved(out);
      return out.str();
    }

    std::vector<std::string>
    files(const std::string &folder, const std::string &ending)
    {
      std::vector<std::string> list;
      for (const auto &entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ending)
          list.push_back(entry.path().string());
      std::sort(list.begin(), list.end());
      return list;
    }

    /**
     * A scene; those in three dimensions on the coarsest mesh, since the checks
     * of 32 240 good cells take 13 s with sanitizers.
     */
    ParameterText
    coarse(const std::string &scene)
    {
      const ParameterText text = ParameterText::read(scene, {});
      const std::string   mesh = text.value("Mesh/Type", "");
      if (text.value("Dimension", "2") != "3" ||
          (mesh != "tooth in block" && mesh != "incisor"))
        return text;
      return ParameterText::read(scene,
                                 {"Mesh/" + mesh + "/Mesh density=0.02"});
    }

    /** All parameter files, as their statements and with all defaults. */
    void
    add_scenes(const std::string &source, std::vector<Seed> &seeds)
    {
      std::vector<std::string> scenes = files(source + "/prm", ".prm");
      for (const std::string folder : {"/tests/scene", "/tests/fuzz/seeds"})
        {
          const auto more = files(source + folder, ".prm");
          scenes.insert(scenes.end(), more.begin(), more.end());
        }
      for (const std::string &scene : scenes)
        try
          {
            // As seen from the top folder
            const std::string   name = scene.substr(source.size() + 1);
            const ParameterText text = coarse(scene);
            seeds.push_back(
              {Kind::parameters, name, "scene.prm", flat(text), "", ""});
            std::ostringstream flat_text(flat(text));
            seeds.push_back(
              {Kind::parameters,
               name + " (all)",
               "scene.prm",
               resolved(ParameterText::parse(flat_text.str(), scene)),
               "",
               ""});
          }
        catch (const InputError &)
          {
            // A file that shows what is refused
          }
    }

    void
    add_checkpoint(const std::string              &source,
                   const std::string              &work,
                   const std::string              &scene,
                   const std::vector<std::string> &sets,
                   std::vector<Seed>              &seeds)
    {
      const std::string name = fs::path(scene).stem().string();
      ProgramOptions    options;
      options.scene  = source + "/" + scene;
      options.output = work + "/" + name;
      options.sets   = sets;
      options.sets.push_back("Output/Fields=false");
      options.quiet  = true;
      const int code = run_program(options, MPI_COMM_WORLD, std::cerr);
      if (code != 0)
        throw RunError(scene, "ended with " + std::to_string(code), "");
      seeds.push_back({Kind::checkpoint,
                       scene,
                       "000001.alv",
                       content_of(CheckpointFolder::find(options.output)),
                       "",
                       ""});
    }

    /** Let gmsh make the meshes of a scene, and keep them for its double. */
    void
    keep_meshes(const std::string &source,
                const std::string &work,
                const std::string &scene)
    {
      ProgramOptions options;
      options.scene    = source + "/" + scene;
      options.output   = work + "/meshes";
      options.validate = options.quiet = true;
      if (run_program(options, MPI_COMM_WORLD, std::cerr) != 0)
        throw RunError(scene, "is not accepted", "");
    }
  } // namespace



  std::string
  name_of(const Kind kind)
  {
    switch (kind)
      {
        case Kind::parameters:
          return "parameters";
        case Kind::mesh:
          return "mesh";
        case Kind::outline:
          return "outline";
        case Kind::table:
          return "table";
        default:
          return "checkpoint";
      }
  }



  std::vector<Seed>
  make_seeds(const std::string &source, const std::string &work)
  {
    keep_meshes(source, work, "prm/academic.prm");
    keep_meshes(source, work, "prm/incisor.prm");
    fs::create_directories(work + "/bin");
    const std::string gmsh = work + "/bin/gmsh";
    // The last argument is the file asked for.
    write(gmsh,
          "#!/bin/sh\nfor out; do :; done\n"
          "exec /bin/cp '" +
            work + "/meshes/'\"${out##*/}\" \"$out\"\n");
    fs::permissions(gmsh, fs::perms::owner_all);

    std::vector<Seed> seeds;
    add_scenes(source, seeds);

    const auto add = [&](const Kind         kind,
                         const std::string &file,
                         const std::string &scene,
                         const std::string &parameter) {
      seeds.push_back({kind,
                       file,
                       fs::path(file).filename().string(),
                       content_of(source + "/" + file),
                       source + "/" + scene,
                       parameter});
    };
    const std::string small = "tests/fuzz/seeds/", file = "Mesh/file/File name";
    for (const std::string version : {"22", "41"})
      for (const std::string shape : {"square", "cube"})
        add(Kind::mesh,
            small + shape + "-" + version + ".msh",
            small + shape + ".prm",
            file);
    add(Kind::mesh,
        "meshes/two-blocks.msh",
        "prm/verification/contact-patch.prm",
        file);
    add(Kind::mesh,
        "meshes/academic-coarse.msh",
        "tests/scene/academic-tied.prm",
        file);
    for (const std::string part : {"tooth", "bone"})
      add(Kind::outline,
          "meshes/incisor-" + part + ".csv",
          "prm/incisor.prm",
          "Mesh/tooth in socket/" +
            std::string(part == "tooth" ? "Tooth" : "Bone") + " outline file");
    add(Kind::table,
        "prm/tables/ligament-table-2.csv",
        "prm/verification/ligament-uniaxial.prm",
        "Materials/ligament/Table file");
    add(Kind::table,
        "prm/tables/ligament-table-2.csv",
        "tests/scene/ligament-confined.prm",
        "Materials/ligament/Table file");

    // Interface, remodelling, rezoning; contact; a mesh made again by its
    // source; 3D.
    add_checkpoint(source,
                   work,
                   "tests/scene/base/academic-interrupted.prm",
                   {"Time/End=1"},
                   seeds);
    add_checkpoint(
      source, work, "prm/verification/contact-patch.prm", {}, seeds);
    add_checkpoint(source,
                   work,
                   "tests/scene/thick-cylinder-rezoned.prm",
                   {"Mesh/grid generator/Refinements=2", "Time/End=0.1"},
                   seeds);
    add_checkpoint(source, work, small + "cube.prm", {}, seeds);
    return seeds;
  }
} // namespace alveolus::fuzz
