// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_errors_h
#define alveolus_base_errors_h

#include <stdexcept>
#include <string>

namespace alveolus
{
  /**
   * A message for the user in three parts: where the problem is (file and line,
   * or parameter), what was found, and what would be right.
   */
  class UserError : public std::runtime_error
  {
  public:
    /**
     * @param where file, line or parameter
     * @param found what stands there or has happened
     * @param advice what to do about it; may be empty
     */
    UserError(const std::string &where,
              const std::string &found,
              const std::string &advice)
      : std::runtime_error(where + ": " + found +
                           (advice.empty() ? "" : "; " + advice))
    {}
  };

  /** Wrong input: the program ends with exit code 2 before any work. */
  class InputError : public UserError
  {
  public:
    /** An InputError of these three parts, see UserError. */
    using UserError::UserError;
  };

  /** A run that cannot go on: exit code 1, with complete results on disk. */
  class RunError : public UserError
  {
  public:
    /** A RunError of these three parts, see UserError. */
    using UserError::UserError;
  };
} // namespace alveolus

#endif
