// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_problems_h
#define alveolus_base_problems_h

#include <alveolus/base/errors.h>

#include <vector>

namespace alveolus
{
  /**
   * Problems of an input, kept until all of it has been looked at, so that a
   * user is told all of them at once and not one in each run.
   */
  class Problems
  {
  public:
    /** More than these are not told. */
    static constexpr unsigned int most_told = 20;

    /** Keep a message, or that there are more. */
    void
    add(const std::string &message)
    {
      if (messages.size() < most_told)
        messages.push_back(message);
      else
        more = true;
    }

    /** Whether further ones would not be told: no need to look for them. */
    bool
    full() const
    {
      return more;
    }

    /** The same with the text of an InputError. */
    void
    add(const std::string &where,
        const std::string &found,
        const std::string &advice)
    {
      add(InputError(where, found, advice).what());
    }

    /** Do @p action; an InputError is a problem. @return whether it went well
     */
    template <typename Function>
    bool
    collect(const Function &action)
    {
      try
        {
          action();
          return true;
        }
      catch (const InputError &error)
        {
          add(error.what());
          return false;
        }
    }

    /** Whether there is no problem so far. */
    bool
    none() const
    {
      return messages.empty();
    }

    /** @throws InputError with all problems, one a line, if there are any */
    void
    throw_if_any() const
    {
      if (none())
        return;
      std::string text;
      for (const std::string &message : messages)
        text += (text.empty() ? "" : "\n") + message;
      if (more)
        text += "\nand more";
      const std::size_t colon = text.find(": ");
      if (colon == std::string::npos)
        throw InputError("input", text, "");
      throw InputError(text.substr(0, colon), text.substr(colon + 2), "");
    }

  private:
    std::vector<std::string> messages;
    bool                     more = false;
  };
} // namespace alveolus

#endif
