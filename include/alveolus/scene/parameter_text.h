// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_scene_parameter_text_h
#define alveolus_scene_parameter_text_h

#include <deal.II/base/parameter_handler.h>

#include <iosfwd>
#include <set>
#include <string>
#include <vector>

namespace alveolus
{
  /**
   * The statements of a parameter file, in deal.II's syntax, with every
   * `include` (relative to the including file) resolved and every statement's
   * file and line remembered. Later statements override earlier ones, so a
   * variant is a file that includes its base and sets a few values; setting an
   * entry twice in one file is refused. A parameter called "File name" or "...
   * file" is a path, relative to the file that sets it. apply() hands the
   * values to a ParameterHandler, which owns names, patterns and documentation.
   */
  class ParameterText
  {
  public:
    struct Entry
    {
      std::vector<std::string> section;   ///< path of subsections
      std::string              name;      ///< of the parameter
      std::string              value;     ///< as it stands there
      std::string              origin;    ///< "file:line" or "--set"
      std::string              directory; ///< of that file, "" for "--set"

      /** The value, or for paths (is_path()) the path from here: in a file
       * they are relative to the folder of that file. */
      std::string
      resolved_value() const;
    };

    /**
     * Read @p file_name and then @p sets, statements of the form
     * `Section/Subsection/Parameter=value` from the command line.
     * @throws InputError for files that cannot be read and broken statements,
     *         all problems in one message
     */
    static ParameterText
    read(const std::string &file_name, const std::vector<std::string> &sets);

    /**
     * The statements of @p text, which is called @p name in messages.
     * @throws InputError as read()
     */
    static ParameterText
    parse(const std::string &text, const std::string &name);

    /**
     * Add statements `Section/Subsection/Parameter=value`.
     * @throws InputError for broken ones
     */
    void
    add(const std::vector<std::string> &sets);

    /** Whether a parameter of this name holds a path. */
    static bool
    is_path(const std::string &name);

    /** The last value set for "Section/Subsection/Name", or @p otherwise. */
    std::string
    value(const std::string &path, const std::string &otherwise) const;

    /** Where the last value of @p path was set; "default" if nowhere. */
    std::string
    origin(const std::string &path) const;

    /** The comma separated list at "<section>/Names"; empty if not set. */
    std::vector<std::string>
    names(const std::string &section) const;

    /**
     * Set every entry in @p prm, whose declarations must be complete.
     * @param problems found before, told together with those found here
     * @param unknown sections "Section/member" whose entries are passed over,
     *        since their Type is among these problems
     * @throws InputError with one line for each undeclared entry or section
     *         and each value that does not match its pattern
     */
    void
    apply(dealii::ParameterHandler    &prm,
          std::vector<std::string>     problems = {},
          const std::set<std::string> &unknown  = {}) const;

    std::string file_name; ///< of the scene, in messages
    /** All of them, later ones override earlier ones. */
    std::vector<Entry> entries;

  private:
    /** The same; appends to @p problems instead of throwing. */
    void
    add(const std::vector<std::string> &sets,
        std::vector<std::string>       &problems);
    void
    read_file(const std::string        &file_name,
              std::vector<std::string> &open_files,
              std::vector<std::string> &problems);
    void
    read_statements(std::istream             &in,
                    const std::string        &name,
                    std::vector<std::string> &open_files,
                    std::vector<std::string> &problems);

    /** More included files than this are a mistake. */
    static constexpr unsigned int most_files = 1000;

    unsigned int n_files = 0;
  };

  /** Folder part of a file name, "." if there is none. */
  std::string
  directory_of(const std::string &file_name);
} // namespace alveolus

#endif
