// SPDX-License-Identifier: LGPL-2.1-or-later
// Files that must survive: blocks with checksums, whole files, checkpoints.
#include <alveolus/base/block_file.h>
#include <alveolus/base/errors.h>
#include <alveolus/base/text_file.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/io/checkpoint.h>
#include <alveolus/io/history_file.h>

#include <boost/crc.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

using namespace alveolus;
namespace fs = std::filesystem;

namespace
{
  BlockFile
  example()
  {
    BlockFile blocks;
    blocks.put("text", std::string("two\nlines\0and a zero", 20));
    blocks.put("empty", "");
    blocks.put("numbers",
               BlockFile::Numbers{0.1,
                                  -0.,
                                  std::numeric_limits<double>::denorm_min(),
                                  std::numeric_limits<double>::infinity(),
                                  std::numeric_limits<double>::quiet_NaN()});
    blocks.put("integers", BlockFile::Integers{0, 1, ~std::uint64_t(0)});
    blocks.put_number("number", 1. / 3.);
    blocks.put_integer("integer", 42);
    return blocks;
  }

  std::string
  bytes_of(const BlockFile &blocks)
  {
    std::ostringstream out;
    blocks.write(out);
    return out.str();
  }

  /** The message with which bytes are refused; empty if they are not. */
  std::string
  refusal(const std::string &bytes)
  {
    try
      {
        BlockFile::parse(bytes, "FILE");
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  }

  std::string
  content(const std::string &name)
  {
    std::ifstream      in(name, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
  }

  void
  write(const std::string &name, const std::string &text)
  {
    std::ofstream(name, std::ios::binary) << text;
  }

  /** A new empty folder. */
  std::string
  folder(const std::string &name)
  {
    const std::string path = "base_files/" + name;
    fs::remove_all(path);
    fs::create_directories(path);
    return path;
  }

  bool
  contains(const std::string &text, const std::string &part)
  {
    return text.find(part) != std::string::npos;
  }
} // namespace



TEST(BlockFile, ComeBackToTheLastBit)
{
  const BlockFile before = example();
  const BlockFile after  = BlockFile::parse(bytes_of(before), "FILE");
  EXPECT_EQ(after.text("text"), before.text("text"));
  EXPECT_EQ(after.text("text").size(), 20u);
  EXPECT_EQ(after.text("empty"), "");
  EXPECT_EQ(after.integers("integers"), before.integers("integers"));
  ASSERT_EQ(after.numbers("numbers").size(), 5u);
  EXPECT_EQ(std::memcmp(after.numbers("numbers").data(),
                        before.numbers("numbers").data(),
                        5 * sizeof(double)),
            0);
  EXPECT_EQ(after.number("number"), 1. / 3.);
  EXPECT_EQ(after.integer("integer"), 42u);
  EXPECT_TRUE(after.has("empty"));
  EXPECT_FALSE(after.has("none"));
  EXPECT_EQ(bytes_of(after), bytes_of(before));
}



TEST(BlockFile, EveryDamageIsFound)
{
  const std::string good = bytes_of(example());
  EXPECT_EQ(refusal(good), "");
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_TRUE(contains(refusal(good.substr(0, n)), "FILE: "))
      << "cut to " << n << " bytes";
  for (std::size_t n = 0; n < good.size(); ++n)
    for (unsigned int bit = 0; bit < 8; ++bit)
      {
        std::string bad = good;
        bad[n] ^= 1 << bit;
        EXPECT_TRUE(contains(refusal(bad), "FILE: "))
          << "byte " << n << ", bit " << bit;
      }
  EXPECT_TRUE(contains(refusal(good + "x"), "follows the last block"));
}



TEST(BlockFile, DamageIsNamed)
{
  const std::string good = bytes_of(example());
  // Data follow name and checksum.
  const auto data = [&](const std::string &name) {
    return good.find(name) + name.size() + 4;
  };
  std::string bad = good;
  bad[data("numbers")] ^= 1;
  EXPECT_TRUE(
    contains(refusal(bad), "FILE: the checksum of block 'numbers' is wrong"))
    << refusal(bad);
  EXPECT_TRUE(contains(refusal(good.substr(0, data("numbers") + 8)),
                       "ends within block 'numbers'"));
  bad = good;
  bad[good.find("numbers") + 1] ^= 1;
  // BlockFile are in alphabetical order.
  EXPECT_TRUE(contains(refusal(bad), "after block 'number'")) << refusal(bad);
}



TEST(BlockFile, LyingSizesAreRefused)
{
  // With a right checksum: only the comparison with the file's length is left.
  std::string       bytes = bytes_of(example());
  const std::size_t begin = 8 + 4 + 4 + 8 + 4; // head of the first block
  const std::size_t name  = std::strlen("empty");
  for (const std::uint64_t size :
       {std::uint64_t(1) << 20, std::uint64_t(1) << 40, ~std::uint64_t(0)})
    {
      std::memcpy(&bytes[begin + 8], &size, 8);
      boost::crc_32_type crc;
      crc.process_bytes(bytes.data() + begin, 16 + name);
      const std::uint32_t sum = crc.checksum();
      std::memcpy(&bytes[begin + 16 + name], &sum, 4);
      EXPECT_TRUE(contains(refusal(bytes), "ends within block 'empty'"))
        << refusal(bytes);
    }
}



TEST(BlockFile, OtherFiles)
{
  EXPECT_TRUE(contains(refusal(""), "no checkpoint"));
  EXPECT_TRUE(
    contains(refusal("time [T],force x [N]\n1,2\n"), "no checkpoint"));
  std::string later = bytes_of(example());
  ++later[8];
  boost::crc_32_type crc;
  crc.process_bytes(later.data(), 24);
  const std::uint32_t sum = crc.checksum();
  std::memcpy(&later[24], &sum, 4);
  EXPECT_TRUE(contains(refusal(later), "format version 2")) << refusal(later);
}



TEST(BlockFile, MissingAndOtherKinds)
{
  const BlockFile blocks  = BlockFile::parse(bytes_of(example()), "FILE");
  const auto      message = [](const auto &action) -> std::string {
    try
      {
        action();
      }
    catch (const InputError &error)
      {
        return error.what();
      }
    return "";
  };
  EXPECT_TRUE(contains(message([&] { blocks.numbers("none"); }),
                       "FILE: block 'none' is missing"));
  EXPECT_TRUE(contains(message([&] { blocks.numbers("text"); }),
                       "block 'text' holds no numbers"));
  EXPECT_TRUE(contains(message([&] { blocks.number("numbers"); }),
                       "does not hold one number"));
}



TEST(WholeFile, AllOrNothing)
{
  const std::string name = folder("whole") + "/file";
  write(name, "earlier");
  {
    WholeFile file(name);
    file.stream() << "half of";
    file.stream().flush();
    EXPECT_EQ(content(name), "earlier");
  } // an exception, say
  EXPECT_EQ(content(name), "earlier");
  EXPECT_FALSE(fs::exists(name + WholeFile::unfinished));
  {
    WholeFile file(name);
    file.stream() << "later";
    file.commit();
  }
  EXPECT_EQ(content(name), "later");
  EXPECT_FALSE(fs::exists(name + WholeFile::unfinished));
  EXPECT_THROW(WholeFile("base_files/none/file"), RunError);

  write(name + WholeFile::unfinished, "left by a kill");
  write("base_files/whole/other.unfinished.txt", "not ours");
  remove_unfinished("base_files/whole");
  EXPECT_FALSE(fs::exists(name + WholeFile::unfinished));
  EXPECT_TRUE(fs::exists("base_files/whole/other.unfinished.txt"));
}



// A limit of the file size acts like a full disk.
TEST(WholeFile, FullDisk)
{
  const std::string name = folder("full") + "/file";
  write(name, "earlier");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  rlimit small   = before;
  small.rlim_cur = 10000;
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  EXPECT_THROW(write_text_file(name, std::string(1000000, 'x')), RunError);
  // The buffer of the stream is written by commit() only
  EXPECT_THROW(write_text_file(name, std::string(10001, 'x')), RunError);
  CheckpointFolder checkpoints("base_files/full");
  BlockFile        blocks;
  blocks.put_number("state/time", 1.);
  const std::string first = checkpoints.write(blocks);
  blocks.put("much", BlockFile::Numbers(10000, 1.));
  EXPECT_THROW(checkpoints.write(blocks), RunError);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_EQ(content(name), "earlier");
  EXPECT_EQ(CheckpointFolder::find("base_files/full"), first);
  EXPECT_EQ(
    read_checkpoint("base_files/full", MPI_COMM_SELF).number("state/time"), 1.);
}



namespace
{
  BlockFile
  at_time(const double t)
  {
    BlockFile blocks;
    blocks.put_number("state/time", t);
    return blocks;
  }

  double
  time_in(const std::string &name)
  {
    return read_checkpoint(name, MPI_COMM_SELF).number("state/time");
  }

  std::size_t
  n_files(const std::string &path)
  {
    std::size_t n = 0;
    for (const auto &entry : fs::directory_iterator(path))
      n += entry.is_regular_file();
    return n;
  }
} // namespace



TEST(CheckpointFolder, TheLastTwoAreKept)
{
  const std::string run = folder("two");
  CheckpointFolder  checkpoints(run);
  EXPECT_THROW(CheckpointFolder::find(run), InputError);
  for (unsigned int t = 1; t <= 5; ++t)
    {
      checkpoints.write(at_time(t));
      EXPECT_EQ(n_files(run + "/checkpoint"), std::min(t, 2u));
      EXPECT_EQ(time_in(run), t);
    }
  EXPECT_EQ(time_in(run + "/checkpoint/000004.alv"), 4.);
  checkpoints.clear();
  EXPECT_EQ(n_files(run + "/checkpoint"), 0u);
}



TEST(CheckpointFolder, DamagedNewestNamesTheOlder)
{
  const std::string run = folder("damaged");
  CheckpointFolder  first(run);
  first.write(at_time(1.));
  const std::string older = first.write(at_time(2.));
  const std::string newer = first.write(at_time(3.));
  fs::resize_file(newer, fs::file_size(newer) - 1);
  std::string message;
  try
    {
      read_checkpoint(run, MPI_COMM_SELF);
    }
  catch (const InputError &error)
    {
      message = error.what();
    }
  EXPECT_TRUE(contains(message, newer)) << message;
  EXPECT_TRUE(contains(message, "block 'state/time'")) << message;
  EXPECT_TRUE(contains(message, "of t = 2 T: --resume " + older)) << message;

  // Going on from the older one: it stays until there are two good ones.
  EXPECT_EQ(time_in(older), 2.);
  CheckpointFolder second(run);
  second.go_on_from(older);
  const std::string next = second.write(at_time(2.5));
  EXPECT_GT(next, newer);
  EXPECT_TRUE(fs::exists(older));
  EXPECT_FALSE(fs::exists(newer));
  EXPECT_EQ(time_in(run), 2.5);
  second.write(at_time(2.75));
  EXPECT_FALSE(fs::exists(older));

  for (const auto &file : {next, CheckpointFolder::find(run)})
    fs::resize_file(file, 20);
  try
    {
      read_checkpoint(run, MPI_COMM_SELF);
      ADD_FAILURE() << "nothing is whole";
    }
  catch (const InputError &error)
    {
      EXPECT_TRUE(contains(error.what(), "no other one that is whole"))
        << error.what();
    }
}



TEST(HistoryFile, LaterRowsAreCutAway)
{
  const std::string name = folder("rows") + "/history.csv";
  const auto        row  = [](const double t) {
    return HistoryFile::Row{{"time [T]", t}, {"force x [N]", t / 3.}};
  };
  {
    HistoryFile file(name);
    for (const double t : {1., 2., 3., 3.})
      file.write(row(t));
    EXPECT_EQ(file.n_rows(), 4u);
  }
  const std::string all = content(name);
  write(name, all + "4,1.33"); // cut short by a kill

  {
    HistoryFile file(name, 2);
    EXPECT_EQ(file.missing_rows(), 0u);
    EXPECT_EQ(file.difference(row(0.)), "");
    file.write(row(3.));
    file.write(row(3.));
    EXPECT_EQ(file.n_rows(), 4u);
  }
  EXPECT_EQ(content(name), all);

  // A row cut short counts for none.
  write(name, all + "4,1.33");
  {
    HistoryFile file(name, 5);
    EXPECT_EQ(file.missing_rows(), 1u);
    EXPECT_EQ(file.n_rows(), 4u);
  }
  EXPECT_EQ(content(name), all);

  HistoryFile            file(name, 4);
  const HistoryFile::Row other = {{"time [T]", 5.}, {"force y [N]", 0.}};
  EXPECT_TRUE(contains(file.difference(other), "column 2"))
    << file.difference(other);
  EXPECT_THROW(file.write(other), RunError);
  file.write(row(5.));
  fs::remove(name);
  EXPECT_THROW(file.write(row(6.)), RunError); // vanished
}
