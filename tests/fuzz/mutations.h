// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_tests_fuzz_mutations_h
#define alveolus_tests_fuzz_mutations_h

#include <cstdint>
#include <string>
#include <vector>

namespace alveolus::fuzz
{
  /** A generator whose numbers are the same on every machine (splitmix64). */
  class Random
  {
  public:
    explicit Random(const std::uint64_t seed)
      : state(seed)
    {}

    std::uint64_t
    number()
    {
      std::uint64_t z = (state += 0x9e3779b97f4a7c15ull);
      z               = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
      z               = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
      return z ^ (z >> 31);
    }

    /** One of 0 ... n - 1; 0 for n = 0. */
    std::size_t
    below(const std::size_t n)
    {
      return n == 0 ? 0 : number() % n;
    }

  private:
    std::uint64_t state;
  };

  /**
   * The text after one to six changes: bytes, numbers, words, lines; cut off;
   * mixed with @p other, a file of the same kind.
   */
  std::string
  mutated_text(std::string text, const std::string &other, Random &random);

  /**
   * A checkpoint after some changes: of its bytes, which the checksums tell, or
   * of the blocks with checksums made anew, as a faulty program would write.
   */
  std::string
  mutated_blocks(const std::string &bytes, Random &random);
} // namespace alveolus::fuzz

#endif
