// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_io_history_file_h
#define alveolus_io_history_file_h

#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace alveolus
{
  /**
   * A comma separated file with one row for each accepted step; the first line
   * holds the column names with their units. Every row is flushed, so the file
   * is complete whenever the program ends.
   */
  class HistoryFile
  {
  public:
    using Row = std::vector<std::pair<std::string, double>>;

    /** @throws InputError if the file cannot be written */
    explicit HistoryFile(const std::string &file_name);

    /**
     * Append a row; the first one fixes the columns.
     * @throws RunError if it cannot be written (disk full)
     */
    void
    write(const Row &row);

  private:
    std::string   file_name;
    std::ofstream file;
    std::size_t   n_columns = 0;
  };
} // namespace alveolus

#endif
