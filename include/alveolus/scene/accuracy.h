// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_scene_accuracy_h
#define alveolus_scene_accuracy_h

#include <alveolus/scene/parameter_text.h>

#include <string>
#include <vector>

namespace alveolus
{
  /**
   * Accuracy levels of a scene: sets of statements of which one is chosen by
   * the top-level parameter `Accuracy`. They stand in subsections
   *
   *     subsection Accuracy levels
   *       subsection fast
   *         subsection Time
   *           set Maximum step = 4
   *         end
   *       end
   *     end
   *
   * A statement of the chosen level counts as if it stood, without the two
   * outer subsections, at its own place among the statements of the scene:
   * it overrides what was set before (the scene, whose levels stand at its
   * end), and is overridden by what is set later (variants that include the
   * scene, `--set`). The level `balanced` is the scene as it stands, without
   * the statements of any level; it is the default.
   */
  class AccuracyLevels
  {
  public:
    /**
     * Choose the level that @p text asks for.
     * @throws InputError for a level that the scene does not have, and for
     *         statements that no level can hold
     */
    explicit AccuracyLevels(const ParameterText &text);

    /** Whether the scene has levels or asks for one. */
    bool
    used() const
    {
      return levels.size() > 1 || asked_for;
    }

    /** The chosen level. */
    const std::string &
    chosen() const
    {
      return level;
    }

    /** All levels, balanced first. */
    const std::vector<std::string> &
    names() const
    {
      return levels;
    }

    /** The statements with those of the chosen level in their places and
     * without those of the others. */
    const ParameterText &
    statements() const
    {
      return effective;
    }

    /** What the chosen level sets: "Section / Parameter = value", with a remark
     * where a later statement wins. */
    std::vector<std::string>
    settings() const;

    /**
     * Declare `Accuracy` and the statements of all levels in @p prm, so that
     * the resolved parameters hold them and can be run with any of the levels.
     * Nothing is declared if levels are not used().
     */
    void
    declare(dealii::ParameterHandler &prm) const;

  private:
    std::vector<std::string>          levels;
    std::string                       level;
    bool                              asked_for = false;
    std::vector<ParameterText::Entry> all; ///< statements of all levels
    ParameterText                     effective;
    std::vector<std::size_t>          of_level; ///< indices in effective
  };
} // namespace alveolus

#endif
