// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_fuzz_seeds_h
#define alveolus_tests_fuzz_seeds_h

#include <string>
#include <vector>

namespace alveolus::fuzz
{
  /** The kinds of input. */
  enum class Kind
  {
    parameters,
    mesh,
    outline,
    table,
    checkpoint
  };

  constexpr Kind all_kinds[] = {Kind::parameters,
                                Kind::mesh,
                                Kind::outline,
                                Kind::table,
                                Kind::checkpoint};

  std::string
  name_of(const Kind kind);

  /** A valid file, and how the program comes to read it. */
  struct Seed
  {
    Kind        kind;
    std::string name;
    std::string file_name; ///< of the changed file, in the folder of inputs
    std::string content;
    /** Parameter file that names it; empty: it is the file itself, or a
     * checkpoint. */
    std::string scene;
    /** The parameter that names it in `scene`. */
    std::string parameter;
  };

  /**
   * The seeds: scenes, meshes, outlines and tables of the repository, and
   * checkpoints of short runs, which are made here.
   *
   * @param source the top folder of the repository
   * @param work   an existing folder for scenes, checkpoints, and meshes that
   *               gmsh has made, one folder for each scene; a program `gmsh`
   *               that copies them is put into `work`/bin, so that gmsh itself
   *               need not run for every input
   */
  std::vector<Seed>
  make_seeds(const std::string &source, const std::string &work);
} // namespace alveolus::fuzz

#endif
