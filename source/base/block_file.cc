// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/block_file.h>
#include <alveolus/base/errors.h>

#include <boost/crc.hpp>

#include <array>
#include <cstring>
#include <ostream>

namespace alveolus
{
  namespace
  {
    constexpr char          magic[]    = "ALVBLOCK";
    constexpr std::size_t   n_magic    = 8;
    constexpr std::uint32_t byte_order = 0x01020304;

    std::uint32_t
    checksum(const char *data, const std::size_t n)
    {
      boost::crc_32_type crc;
      crc.process_bytes(data, n);
      return crc.checksum();
    }

    template <class Number>
    void
    append(std::string &bytes, const Number number)
    {
      std::array<char, sizeof(Number)> raw;
      std::memcpy(raw.data(), &number, sizeof(Number));
      bytes.append(raw.data(), raw.size());
    }

    /** Walks through the bytes of a file; never beyond their end. */
    class Reader
    {
    public:
      explicit Reader(const std::string &bytes)
        : bytes(bytes)
      {}

      std::size_t
      left() const
      {
        return bytes.size() - position;
      }

      const char *
      here() const
      {
        return bytes.data() + position;
      }

      void
      skip(const std::size_t n)
      {
        position += n;
      }

      template <class Number>
      Number
      take()
      {
        Number number;
        std::memcpy(&number, here(), sizeof(Number));
        skip(sizeof(Number));
        return number;
      }

    private:
      const std::string &bytes;
      std::size_t        position = 0;
    };

    template <class Number>
    std::vector<Number>
    take_all(const char *data, const std::size_t n_bytes)
    {
      std::vector<Number> values(n_bytes / sizeof(Number));
      if (!values.empty())
        std::memcpy(values.data(), data, n_bytes);
      return values;
    }

    struct Raw
    {
      const char   *data;
      std::uint64_t n_bytes;
    };

    template <class Block>
    Raw
    raw(const Block &block)
    {
      return std::visit(
        [](const auto &values) {
          return Raw{reinterpret_cast<const char *>(values.data()),
                     values.size() * sizeof(values[0])};
        },
        block);
    }
  } // namespace



  void
  BlockFile::write(std::ostream &out) const
  {
    const auto with_checksum = [&out](std::string head) {
      append(head, checksum(head.data(), head.size()));
      out.write(head.data(), head.size());
    };
    std::string head(magic, n_magic);
    append(head, format_version);
    append(head, byte_order);
    append(head, static_cast<std::uint64_t>(blocks.size()));
    with_checksum(head);
    for (const auto &[name, block] : blocks)
      {
        const auto [data, n_bytes] = raw(block);
        head.clear();
        append(head, static_cast<std::uint32_t>(name.size()));
        append(head, static_cast<std::uint32_t>(block.index()));
        append(head, n_bytes);
        head += name;
        with_checksum(head);
        out.write(data, n_bytes);
        std::string tail;
        append(tail, checksum(data, n_bytes));
        out.write(tail.data(), tail.size());
      }
  }



  BlockFile
  BlockFile::parse(const std::string &bytes, const std::string &source)
  {
    const std::string advice = "the file is damaged; use an earlier one";
    const auto        damage = [&](const std::string &found) {
      return InputError(source, found, advice);
    };

    Reader                reader(bytes);
    constexpr std::size_t head_size = n_magic + 16;
    if (reader.left() < n_magic ||
        std::memcmp(reader.here(), magic, n_magic) != 0)
      throw InputError(source,
                       "this is no checkpoint (it does not begin like one)",
                       "name a file or folder that alveolus wrote");
    if (reader.left() < head_size + 4)
      throw damage("the file ends within its head");
    const std::uint32_t sum = checksum(reader.here(), head_size);
    reader.skip(n_magic);
    const auto version  = reader.take<std::uint32_t>();
    const auto order    = reader.take<std::uint32_t>();
    const auto n_blocks = reader.take<std::uint64_t>();
    if (reader.take<std::uint32_t>() != sum)
      throw damage("the checksum of the head is wrong");
    if (order != byte_order)
      throw InputError(source,
                       "was written by a machine of another byte order",
                       "resume on a machine of the same kind");
    if (version != format_version)
      throw InputError(source,
                       "has format version " + std::to_string(version) +
                         ", this program reads version " +
                         std::to_string(format_version),
                       "resume with the program that wrote it");

    BlockFile   result(source);
    std::string last;
    for (std::uint64_t b = 0; b < n_blocks; ++b)
      {
        const std::string place =
          b == 0 ? "in the first block" : "after block '" + last + "'";
        constexpr std::size_t fixed = 16;
        if (reader.left() < fixed)
          throw damage("the file ends " + place);
        const char *const begin   = reader.here();
        const auto        length  = reader.take<std::uint32_t>();
        const auto        kind    = reader.take<std::uint32_t>();
        const auto        n_bytes = reader.take<std::uint64_t>();
        if (length > reader.left() || reader.left() - length < 4)
          throw damage("the file ends " + place);
        const std::string name(reader.here(), length);
        reader.skip(length);
        const std::uint32_t head_sum = checksum(begin, fixed + length);
        if (reader.take<std::uint32_t>() != head_sum)
          throw damage("the checksum of a block's head is wrong " + place);
        last = name;
        if (n_bytes > reader.left() || reader.left() - n_bytes < 4)
          throw damage("the file ends within block '" + name + "'");
        const char *const data = reader.here();
        reader.skip(n_bytes);
        if (reader.take<std::uint32_t>() != checksum(data, n_bytes))
          throw damage("the checksum of block '" + name + "' is wrong");
        if (kind > 2 || (kind > 0 && n_bytes % 8 != 0) || result.has(name))
          throw damage("block '" + name + "' is no block of this format");
        if (kind == 0)
          result.put(name, std::string(data, n_bytes));
        else if (kind == 1)
          result.put(name, take_all<double>(data, n_bytes));
        else
          result.put(name, take_all<std::uint64_t>(data, n_bytes));
      }
    if (reader.left() > 0)
      throw damage("something follows the last block '" + last + "'");
    return result;
  }



  void
  BlockFile::refuse(const std::string &name, const std::string &found) const
  {
    throw InputError(source.empty() ? "checkpoint" : source,
                     "block '" + name + "' " + found,
                     "resume the scene it was written for, with the same "
                     "program");
  }



  template <class Kind>
  const Kind &
  BlockFile::get(const std::string &name, const std::string &kind) const
  {
    const auto block = blocks.find(name);
    if (block == blocks.end())
      refuse(name, "is missing");
    const Kind *const values = std::get_if<Kind>(&block->second);
    if (values == nullptr)
      refuse(name, "holds no " + kind);
    return *values;
  }

  const BlockFile::Numbers &
  BlockFile::numbers(const std::string &name) const
  {
    return get<Numbers>(name, "numbers");
  }

  const BlockFile::Integers &
  BlockFile::integers(const std::string &name) const
  {
    return get<Integers>(name, "integers");
  }

  const std::string &
  BlockFile::text(const std::string &name) const
  {
    return get<std::string>(name, "text");
  }

  double
  BlockFile::number(const std::string &name) const
  {
    const Numbers &values = numbers(name);
    if (values.size() != 1)
      refuse(name, "does not hold one number");
    return values[0];
  }

  std::uint64_t
  BlockFile::integer(const std::string &name) const
  {
    const Integers &values = integers(name);
    if (values.size() != 1)
      refuse(name, "does not hold one integer");
    return values[0];
  }
} // namespace alveolus
