// SPDX-License-Identifier: LGPL-2.1-or-later
#ifndef alveolus_base_whole_file_h
#define alveolus_base_whole_file_h

#include <fstream>
#include <string>

namespace alveolus
{
  /**
   * A file that is written as a whole or not at all: what goes to stream() is
   * kept beside it under the name `NAME.unfinished` until commit(), which
   * brings it to the disk and then gives it its name in one step. An earlier
   * file of the same name stays valid until then, whatever happens: a kill, a
   * crash of the machine, a full disk.
   */
  class WholeFile
  {
  public:
    /** @throws RunError if it cannot be opened */
    explicit WholeFile(const std::string &name);

    /** Removes what was not committed. */
    ~WholeFile();

    WholeFile(const WholeFile &) = delete;
    WholeFile &
    operator=(const WholeFile &) = delete;

    /** Where to write what the file is to hold. */
    std::ostream &
    stream()
    {
      return file;
    }

    /** @throws RunError if it could not be written, e.g. on a full disk */
    void
    commit();

    /** End of the names of files that were being written. */
    static constexpr char unfinished[] = ".unfinished";

  private:
    [[noreturn]] void
    fail(const int error) const;

    std::string   name, temporary;
    std::ofstream file;
    bool          committed = false;
  };

  /**
   * Refuse to write where something else than a file (or, if @p folder, than a
   * folder) has the name: through a link planted in an output folder results
   * would go elsewhere and spoil what is there, and a pipe would never answer.
   * @throws InputError if there is such a thing; not if there is nothing
   */
  void
  require_plain(const std::string &name, const bool folder = false);

  /**
   * Wait until the content of the file or folder @p name is on the disk.
   * @return 0, or the error number
   */
  int
  bring_to_disk(const std::string &name);

  /**
   * Keeps other runs out of a folder for as long as it lives; the operating
   * system lets go of it however the process ends. Not where the file system
   * cannot lock (some network ones).
   */
  class FolderLock
  {
  public:
    /**
     * @param directory existing folder
     * @throws InputError if another run has it
     */
    explicit FolderLock(const std::string &directory);
    ~FolderLock();

    FolderLock(const FolderLock &) = delete;
    FolderLock &
    operator=(const FolderLock &) = delete;

  private:
    int file;
  };

  /** Remove the unfinished files of a run that was killed from a folder. */
  void
  remove_unfinished(const std::string &directory);
} // namespace alveolus

#endif
