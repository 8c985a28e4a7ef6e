// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_line_reader_h
#define alveolus_base_line_reader_h

#include <alveolus/base/errors.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

namespace alveolus
{
  /**
   * Lines of a text file, counted, with numbers taken out of them one by one.
   * Blank lines are passed over; line ends of Windows are blanks. Numbers are
   * read independently of the locale. Whatever cannot be read is an InputError
   * with the file's name and the line number.
   */
  class LineReader
  {
  public:
    /** Both must outlive this object; @p source names the file in messages. */
    LineReader(const std::string &text, const std::string &source)
      : text(text)
      , source(source)
    {}

    std::size_t number = 0; ///< of the current line, from 1

    /** Go to the next line that is not blank; false at the end. */
    bool
    advance()
    {
      while (position < text.size())
        {
          const std::size_t end =
            std::min(text.find('\n', position), text.size());
          current  = std::string_view(text).substr(position, end - position);
          position = end + 1;
          ++number;
          while (!current.empty() && is_blank(current.back()))
            current.remove_suffix(1);
          rest = current;
          skip_blanks();
          if (!rest.empty())
            {
              current = rest;
              return true;
            }
        }
      return false;
    }

    /** The current line without blanks at its ends. */
    std::string_view
    all() const
    {
      return current;
    }

    /** The next number of the line; @p what describes it in the message. */
    template <class Number>
    Number
    take(const char *what)
    {
      skip_blanks();
      Number      value{};
      const char *begin = rest.data();
      const char *end   = begin + rest.size();
      if (begin != end && *begin == '+')
        ++begin;
      const auto [stop, error] = std::from_chars(begin, end, value);
      if (rest.empty() || error != std::errc() ||
          (stop != end && !is_blank(*stop)))
        fail(rest.empty() ? std::string("the line ends before ") + what
                          : "'" + first_word() + "' is not " + what,
             "");
      rest.remove_prefix(stop - rest.data());
      return value;
    }

    /** A number of things, never negative. */
    std::size_t
    take_count(const char *what)
    {
      const long long value = take<long long>(what);
      if (value < 0)
        fail(std::string(what) + " is negative", "");
      return value;
    }

    /** An integer, of either sign. */
    int
    take_id(const char *what)
    {
      const int value = take<int>(what);
      // Signs are dropped here and there: keep to numbers where that works.
      if (value == std::numeric_limits<int>::min())
        fail(std::string(what) + " is too large", "");
      return value;
    }

    /** A finite number. */
    double
    take_coordinate()
    {
      const double value = take<double>("a coordinate");
      if (!std::isfinite(value) || std::abs(value) > 1e100)
        fail("a coordinate is not a finite number", "");
      return value;
    }

    /** Make sure that the line holds nothing more. */
    void
    end_of_line()
    {
      skip_blanks();
      if (!rest.empty())
        fail("'" + first_word() + "' is more than this line should hold", "");
    }

    /** What is left of the line. */
    std::string_view
    remainder()
    {
      skip_blanks();
      return rest;
    }

    /** Throw the InputError of the current line. */
    [[noreturn]] void
    fail(const std::string &found, const std::string &advice) const
    {
      throw InputError(source + ", line " + std::to_string(number),
                       found,
                       advice);
    }

  private:
    static bool
    is_blank(const char c)
    {
      return c == ' ' || c == '\t' || c == '\r';
    }

    void
    skip_blanks()
    {
      while (!rest.empty() && is_blank(rest.front()))
        rest.remove_prefix(1);
    }

    std::string
    first_word() const
    {
      return std::string(
        rest.substr(0, std::min<std::size_t>(rest.find_first_of(" \t"), 40)));
    }

    const std::string &text;
    const std::string &source;
    std::size_t        position = 0;
    std::string_view   current, rest;
  };
} // namespace alveolus

#endif
