// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/io/history_file.h>

#include <deal.II/base/exceptions.h>

#include <iomanip>
#include <sstream>

namespace alveolus
{
  HistoryFile::HistoryFile(const std::string &file_name)
    : file_name(file_name)
    , file(file_name)
  {
    if (!file)
      throw InputError(file_name,
                       "cannot be written",
                       "choose another `Output / Directory` or `--output`");
  }



  void
  HistoryFile::write(const Row &row)
  {
    std::ostringstream text;
    if (n_columns == 0)
      {
        n_columns = row.size();
        for (std::size_t i = 0; i < row.size(); ++i)
          text << (i > 0 ? "," : "") << row[i].first;
        text << '\n';
      }
    AssertThrow(row.size() == n_columns,
                dealii::ExcDimensionMismatch(row.size(), n_columns));
    text << std::setprecision(12);
    for (std::size_t i = 0; i < row.size(); ++i)
      text << (i > 0 ? "," : "") << row[i].second;
    text << '\n';
    file << text.str() << std::flush;
    if (!file)
      throw RunError(file_name,
                     "a row could not be written",
                     "is the disk full, or has the folder vanished?");
  }
} // namespace alveolus
