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
    /** Columns by name with unit, e.g. "force x [N]", and their values. */
    using Row = std::vector<std::pair<std::string, double>>;

    /** @throws InputError if the file cannot be written */
    explicit HistoryFile(const std::string &file_name);

    /**
     * Go on with a file that has at least @p n_rows complete rows: later ones
     * are cut away. If it has fewer, missing_rows() tells how many.
     * @throws InputError if the file cannot be read or written
     */
    HistoryFile(const std::string &file_name, const unsigned int n_rows);

    /** Rows that a file to go on with should have had. */
    unsigned int
    missing_rows() const
    {
      return n_missing;
    }

    /** Complete rows that the file has. */
    unsigned int
    n_rows() const
    {
      return n_written;
    }

    /**
     * Where the columns of @p row are not those of the file, in words; empty if
     * they are or the file has none yet.
     */
    std::string
    difference(const Row &row) const;

    /** Wait until all rows are on the disk. @throws RunError */
    void
    bring_to_disk() const;

    /**
     * Append a row; the first one fixes the columns.
     * @throws RunError if it cannot be written (disk full, folder vanished), or
     *         a file gone on with has other columns
     */
    void
    write(const Row &row);

  private:
    [[noreturn]] void
    fail() const;

    std::string   file_name;
    std::ofstream file;
    std::string   header; ///< first line; empty before the first row
    unsigned int  n_written = 0, n_missing = 0;
  };
} // namespace alveolus

#endif
