// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_block_file_h
#define alveolus_base_block_file_h

#include <cstdint>
#include <iosfwd>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace alveolus
{
  /**
   * Named blocks of data and the file that holds them: text, floating point
   * numbers or unsigned integers, each with its length and a checksum, so that
   * damage is found before anything is used and can be named.
   *
   * The file, all numbers in the byte order of the machine: 8 bytes `ALVBLOCK`,
   * uint32 format version, uint32 0x01020304 (tells the byte order), uint64
   * number of blocks, uint32 CRC-32 of all this; then for each block, ordered
   * by name, uint32 length of the name, uint32 kind (0 text, 1 double, 2
   * uint64), uint64 bytes of data, the name, uint32 CRC-32 of all this, the
   * data, uint32 CRC-32 of the data. Nothing follows.
   */
  class BlockFile
  {
  public:
    /** Version that is written; files of others are refused. */
    static constexpr std::uint32_t format_version = 1;

    /** Blocks of numbers. */
    using Numbers = std::vector<double>;
    /** Blocks of whole numbers. */
    using Integers = std::vector<std::uint64_t>;

    /** @param source name of the file for messages */
    explicit BlockFile(const std::string &source = "")
      : source(source)
    {}

    /** Add a block; one of the same name is replaced. */
    void
    put(const std::string &name, Numbers values)
    {
      blocks[name] = std::move(values);
    }
    /** The same for whole numbers. */
    void
    put(const std::string &name, Integers values)
    {
      blocks[name] = std::move(values);
    }
    /** The same for a text. */
    void
    put(const std::string &name, std::string text)
    {
      blocks[name] = std::move(text);
    }
    /** A block of one number. */
    void
    put_number(const std::string &name, const double value)
    {
      put(name, Numbers{value});
    }
    /** A block of one whole number. */
    void
    put_integer(const std::string &name, const std::uint64_t value)
    {
      put(name, Integers{value});
    }

    /** Whether there is a block of this name. */
    bool
    has(const std::string &name) const
    {
      return blocks.count(name) > 0;
    }

    /** @throws InputError if there is no such block, or it is of another kind
     */
    const Numbers &
    numbers(const std::string &name) const;
    /** The same for a block of whole numbers. */
    const Integers &
    integers(const std::string &name) const;
    /** The same for a block of text. */
    const std::string &
    text(const std::string &name) const;
    /** The only number of a block. @throws InputError */
    double
    number(const std::string &name) const;
    /** The only whole number of a block. @throws InputError */
    std::uint64_t
    integer(const std::string &name) const;

    /**
     * Throw the InputError that says that block @p name does not fit: @p found
     * is a sentence about it.
     */
    [[noreturn]] void
    refuse(const std::string &name, const std::string &found) const;

    /** Write the file. Failure is left in the state of the stream. */
    void
    write(std::ostream &out) const;

    /**
     * The blocks of the content @p bytes of a file.
     * @throws InputError that names @p source and the damaged block
     */
    static BlockFile
    parse(const std::string &bytes, const std::string &source);

    std::string source; ///< name of the file, in messages

  private:
    using Block = std::variant<std::string, Numbers, Integers>;

    template <class Kind>
    const Kind &
    get(const std::string &name, const std::string &kind) const;

    std::map<std::string, Block> blocks;
  };
} // namespace alveolus

#endif
