// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/whole_file.h>
#include <alveolus/io/history_file.h>

#include <filesystem>
#include <iomanip>
#include <sstream>

namespace alveolus
{
  namespace
  {
    [[noreturn]] void
    cannot_write(const std::string &file_name)
    {
      throw InputError(file_name,
                       "cannot be written",
                       "choose another `Output / Directory` or `--output`");
    }

    std::string
    names_of(const HistoryFile::Row &row)
    {
      std::string names;
      for (const auto &value : row)
        names += (names.empty() ? "" : ",") + value.first;
      return names;
    }
  } // namespace



  HistoryFile::HistoryFile(const std::string &file_name)
    : file_name(file_name)
  {
    require_plain(file_name);
    file.open(file_name);
    if (!file)
      cannot_write(file_name);
  }



  HistoryFile::HistoryFile(const std::string &file_name,
                           const unsigned int n_rows)
    : file_name(file_name)
  {
    require_plain(file_name);
    std::uintmax_t length = 0;
    if (n_rows > 0)
      {
        std::ifstream present(file_name, std::ios::binary);
        std::string   line;
        // A line that a kill cut short has no end.
        while (n_written < n_rows && std::getline(present, line) &&
               !present.eof())
          {
            if (header.empty())
              header = line;
            else
              ++n_written;
            length += line.size() + 1;
          }
      }
    n_missing = n_rows - n_written;
    std::error_code error;
    if (std::filesystem::exists(file_name, error))
      std::filesystem::resize_file(file_name, length, error);
    if (error)
      cannot_write(file_name);
    file.open(file_name, std::ios::app);
    if (!file)
      cannot_write(file_name);
  }



  void
  HistoryFile::write(const Row &row)
  {
    std::ostringstream text;
    if (header.empty())
      {
        header = names_of(row);
        text << header << '\n';
      }
    const std::string different = difference(row);
    if (!different.empty())
      throw RunError(file_name,
                     different,
                     "choose another folder by `--output`");
    text << std::setprecision(12);
    for (std::size_t i = 0; i < row.size(); ++i)
      text << (i > 0 ? "," : "") << row[i].second;
    text << '\n';
    // A file that was removed could be written on unseen.
    std::error_code ignored;
    file << text.str() << std::flush;
    if (!file || !std::filesystem::exists(file_name, ignored))
      fail();
    ++n_written;
  }



  std::string
  HistoryFile::difference(const Row &row) const
  {
    const std::string names = names_of(row);
    if (header.empty() || names == header)
      return "";
    std::istringstream there(header), here(names);
    std::string        a, b;
    unsigned int       column = 0;
    while (a == b)
      {
        ++column;
        a = std::getline(there, a, ',') ? "'" + a + "'" : "missing";
        b = std::getline(here, b, ',') ? "'" + b + "'" : "missing";
      }
    return "its column " + std::to_string(column) + " is " + a +
           ", that of this run " + b;
  }



  void
  HistoryFile::bring_to_disk() const
  {
    if (alveolus::bring_to_disk(file_name) != 0)
      fail();
  }



  void
  HistoryFile::fail() const
  {
    throw RunError(file_name,
                   "a row could not be written",
                   "is the disk full, or has the folder vanished?");
  }
} // namespace alveolus
