// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_scene_settings_h
#define alveolus_scene_settings_h

#include <alveolus/base/block_file.h>
#include <alveolus/scene/parameter_text.h>

#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Put the settings of a run into blocks "settings/...": the statements they
   * were made of, to repeat them; all parameters as resolved, to compare them;
   * and checksums of the files they name.
   * @param resolved all parameters, in the input format
   */
  void
  save_settings(const ParameterText &text,
                const std::string   &resolved,
                BlockFile           &blocks);

  /**
   * The statements in the blocks, valid also in another working folder. @p sets
   * come last, as in ParameterText::read(). @throws InputError
   */
  ParameterText
  saved_settings(const BlockFile &blocks, const std::vector<std::string> &sets);

  /** A setting that is not what it was when the blocks were written. */
  struct ChangedSetting
  {
    std::string parameter;   ///< "Section / Parameter"
    std::string description; ///< was and is
    bool        acceptable;  ///< false if a run cannot go on with it
  };

  /**
   * Compare the settings in the blocks with those of now. Title, output folder
   * and checkpoint intervals may differ. The mesh cannot be changed.
   */
  std::vector<ChangedSetting>
  changed_settings(const BlockFile &blocks, const std::string &resolved);

  /**
   * Refuse changed settings.
   * @param accept let those pass with which a run can go on
   * @return a line for each change that was let pass
   * @throws InputError that names each change that was not
   */
  std::vector<std::string>
  check_settings(const BlockFile   &blocks,
                 const std::string &resolved,
                 const bool         accept);
} // namespace alveolus

#endif
