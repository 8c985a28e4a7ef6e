// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_text_file_h
#define alveolus_base_text_file_h

#include <deal.II/base/mpi.h>

#include <functional>
#include <string>

namespace alveolus
{
  /**
   * Call @p produce on process 0 and give its text to every process of
   * @p communicator (collective). If it throws, every process throws the same
   * InputError or RunError, so that none waits for another.
   */
  std::string
  text_from_root(const MPI_Comm                     &communicator,
                 const std::function<std::string()> &produce);

  /**
   * The whole content of the file @p name; read by process 0 (collective).
   * @param where the parameter that holds the name, for messages
   * @throws InputError if it cannot be read
   */
  std::string
  read_text_file(const MPI_Comm    &communicator,
                 const std::string &name,
                 const std::string &where);

  /**
   * Write @p text to the file @p name as a whole or not at all (WholeFile), by
   * the calling process only.
   * @throws RunError if that fails, e.g. on a full disk
   */
  void
  write_text_file(const std::string &name, const std::string &text);

  /** @p name itself if absolute, else below the folder @p directory. */
  std::string
  path_below(const std::string &directory, const std::string &name);
} // namespace alveolus

#endif
