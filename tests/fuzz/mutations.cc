// SPDX-License-Identifier: LGPL-2.1-or-later
#include "mutations.h"

#include <boost/crc.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace alveolus::fuzz
{
  namespace
  {
    const std::vector<std::string> numbers = {"0",
                                              "-1",
                                              "1",
                                              "2",
                                              "3",
                                              "0.5",
                                              "-0.0",
                                              "1e-320",
                                              "1e-30",
                                              "1e10",
                                              "1e30",
                                              "1e308",
                                              "-1e308",
                                              "1e400",
                                              "nan",
                                              "inf",
                                              "-inf",
                                              "255",
                                              "65536",
                                              "2147483647",
                                              "2147483648",
                                              "-2147483648",
                                              "4294967295",
                                              "18446744073709551615",
                                              "99999999999999999999999",
                                              "0x10",
                                              "1,5",
                                              "1e",
                                              "+",
                                              ""};

    const std::string ends = " \t\r\n,;:=\"|";

    struct Part
    {
      std::size_t begin, length;
    };

    /** The words of a text. */
    std::vector<Part>
    words(const std::string &text)
    {
      std::vector<Part> list;
      std::size_t       begin = 0;
      while ((begin = text.find_first_not_of(ends, begin)) != std::string::npos)
        {
          const std::size_t end =
            std::min(text.find_first_of(ends, begin), text.size());
          list.push_back({begin, end - begin});
          begin = end;
        }
      return list;
    }

    /** Its lines with their ends. */
    std::vector<Part>
    lines(const std::string &text)
    {
      std::vector<Part> list;
      for (std::size_t begin = 0; begin < text.size();)
        {
          const std::size_t end =
            std::min(text.find('\n', begin), text.size() - 1) + 1;
          list.push_back({begin, end - begin});
          begin = end;
        }
      return list;
    }

    bool
    begins_like_a_number(const std::string &text, const Part &word)
    {
      return std::strchr("+-.0123456789", text[word.begin]) != nullptr;
    }

    void
    change_bytes(std::string &text, Random &random)
    {
      const std::size_t at = random.below(text.size());
      switch (random.below(4))
        {
          case 0:
            text[at] = static_cast<char>(random.below(256));
            break;
          case 1:
            text[at] ^= static_cast<char>(1 << random.below(8));
            break;
          case 2:
            text.erase(at, 1 + random.below(8));
            break;
          default:
            text.insert(at,
                        1 + random.below(4),
                        "\0\n #$=/\\\xff"[random.below(9)]);
        }
    }

    void
    change_a_word(std::string &text, Random &random, const bool only_numbers)
    {
      auto list = words(text);
      if (only_numbers)
        list.erase(std::remove_if(list.begin(),
                                  list.end(),
                                  [&](const Part &word) {
                                    return !begins_like_a_number(text, word);
                                  }),
                   list.end());
      if (list.empty())
        return;
      const Part  word  = list[random.below(list.size())];
      const Part  other = list[random.below(list.size())];
      std::string value = text.substr(other.begin, other.length);
      if (only_numbers && random.below(3) > 0)
        value = numbers[random.below(numbers.size())];
      text.replace(word.begin, word.length, value);
    }

    void
    change_lines(std::string &text, const std::string &other, Random &random)
    {
      const auto  list = lines(text), others = lines(other);
      const Part  line  = list[random.below(list.size())];
      const Part  from  = list[random.below(list.size())];
      std::string moved = text.substr(from.begin, from.length);
      switch (random.below(5))
        {
          case 0:
            text.erase(line.begin, line.length);
            break;
          case 1:
            text.insert(line.begin, moved);
            break;
          case 2:
            text.replace(line.begin, line.length, moved);
            break;
            case 3: {
              // A part of some lines of another file
              if (others.empty())
                return;
              const Part        strange = others[random.below(others.size())];
              const std::size_t n       = random.below(400);
              text.insert(line.begin,
                          other.substr(strange.begin,
                                       std::max(strange.length, n)));
              break;
            }
          default:
            // Several lines at once
            text.erase(line.begin, random.below(2000));
        }
    }
  } // namespace



  std::string
  mutated_text(std::string text, const std::string &other, Random &random)
  {
    const std::size_t n = 1 + random.below(random.below(2) == 0 ? 2 : 6);
    for (std::size_t i = 0; i < n && !text.empty(); ++i)
      switch (random.below(12))
        {
          case 0:
          case 1:
            change_bytes(text, random);
            break;
          case 2:
          case 3:
          case 4:
          case 5:
          case 6:
            change_a_word(text, random, true);
            break;
          case 7:
          case 8:
            change_a_word(text, random, false);
            break;
          case 9:
          case 10:
            change_lines(text, other, random);
            break;
          default:
            if (random.below(4) == 0)
              text.resize(random.below(text.size() + 1));
            else
              change_a_word(text, random, true);
        }
    return text;
  }



  namespace
  {
    struct Block
    {
      std::string   name, data;
      std::uint32_t kind;
    };

    template <class Number>
    Number
    read(const std::string &bytes, const std::size_t at)
    {
      Number number;
      std::memcpy(&number, bytes.data() + at, sizeof(Number));
      return number;
    }

    template <class Number>
    void
    append(std::string &bytes, const Number number)
    {
      bytes.append(reinterpret_cast<const char *>(&number), sizeof(Number));
    }

    void
    append_checksum(std::string &bytes, const std::string &of)
    {
      boost::crc_32_type crc;
      crc.process_bytes(of.data(), of.size());
      append(bytes, static_cast<std::uint32_t>(crc.checksum()));
    }

    constexpr std::size_t head_size = 24; // without its checksum

    /** The blocks of a valid file (base/block_file.h describes it). */
    std::vector<Block>
    blocks_of(const std::string &bytes)
    {
      std::vector<Block>  blocks;
      std::size_t         at = head_size + 4;
      const std::uint64_t n  = read<std::uint64_t>(bytes, 16);
      for (std::uint64_t b = 0; b < n; ++b)
        {
          const auto length = read<std::uint32_t>(bytes, at);
          const auto kind   = read<std::uint32_t>(bytes, at + 4);
          const auto size   = read<std::uint64_t>(bytes, at + 8);
          at += 16;
          blocks.push_back({bytes.substr(at, length),
                            bytes.substr(at + length + 4, size),
                            kind});
          at += length + 4 + size + 4;
        }
      return blocks;
    }

    std::string
    file_of(const std::vector<Block> &blocks, const std::string &original)
    {
      std::string bytes = original.substr(0, 16);
      append(bytes, static_cast<std::uint64_t>(blocks.size()));
      append_checksum(bytes, std::string(bytes));
      for (const Block &block : blocks)
        {
          std::string head;
          append(head, static_cast<std::uint32_t>(block.name.size()));
          append(head, block.kind);
          append(head, static_cast<std::uint64_t>(block.data.size()));
          head += block.name;
          bytes += head;
          append_checksum(bytes, head);
          bytes += block.data;
          append_checksum(bytes, block.data);
        }
      return bytes;
    }

    void
    change_a_number(Block &block, Random &random)
    {
      if (block.data.size() < 8)
        return;
      static const std::uint64_t integers[] = {0,
                                               1,
                                               2,
                                               7,
                                               1000,
                                               65535,
                                               0xffffffffull,
                                               0x100000000ull,
                                               1ull << 62,
                                               ~0ull};
      static const double        reals[]    = {0.,
                                               -1.,
                                               1e300,
                                               -1e300,
                                               1e-320,
                                               std::numeric_limits<double>::quiet_NaN(),
                                               std::numeric_limits<double>::infinity()};
      const std::size_t          at = 8 * random.below(block.data.size() / 8);
      if (block.kind == 1)
        {
          const double value = reals[random.below(std::size(reals))];
          std::memcpy(&block.data[at], &value, 8);
          return;
        }
      std::uint64_t value = read<std::uint64_t>(block.data, at);
      switch (random.below(3))
        {
          case 0:
            ++value;
            break;
          case 1:
            --value;
            break;
          default:
            value = integers[random.below(std::size(integers))];
        }
      std::memcpy(&block.data[at], &value, 8);
    }

    void
    change_a_block(std::vector<Block> &blocks, Random &random)
    {
      if (blocks.empty())
        return;
      const std::size_t at    = random.below(blocks.size());
      Block            &block = blocks[at];
      const Block      &other = blocks[random.below(blocks.size())];
      switch (random.below(9))
        {
          case 0:
            blocks.erase(blocks.begin() + at);
            return;
          case 1:
            block.kind = random.below(4);
            return;
          case 2:
            block.data.resize(8 * random.below(block.data.size() / 8 + 2));
            return;
          case 3:
            block.data = other.data;
            return;
          case 4:
            block.name = other.name;
            return;
          default:
            if (block.kind == 0)
              block.data = mutated_text(block.data, other.data, random);
            else
              change_a_number(block, random);
        }
    }
  } // namespace



  std::string
  mutated_blocks(const std::string &bytes, Random &random)
  {
    if (random.below(4) == 0)
      {
        std::string result = bytes;
        const auto  n      = 1 + random.below(3);
        for (std::size_t i = 0; i < n && !result.empty(); ++i)
          if (random.below(6) == 0)
            result.resize(random.below(result.size()));
          else
            change_bytes(result, random);
        return result;
      }
    std::vector<Block> blocks = blocks_of(bytes);
    const auto         n      = 1 + random.below(3);
    for (std::size_t i = 0; i < n; ++i)
      change_a_block(blocks, random);
    return file_of(blocks, bytes);
  }
} // namespace alveolus::fuzz
