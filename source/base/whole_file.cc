// SPDX-License-Identifier: LGPL-2.1-or-later
#include <alveolus/base/errors.h>
#include <alveolus/base/whole_file.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <unistd.h>

namespace alveolus
{
  void
  require_plain(const std::string &name, const bool folder)
  {
    namespace fs = std::filesystem;
    std::error_code     ignored;
    const fs::file_type type = fs::symlink_status(name, ignored).type();
    if (type == fs::file_type::not_found || type == fs::file_type::none ||
        type == (folder ? fs::file_type::directory : fs::file_type::regular))
      return;
    const std::string wanted = folder ? "folder" : "file";
    throw InputError(name,
                     (type == fs::file_type::symlink     ? "is a link"
                      : type == fs::file_type::directory ? "is a folder"
                                                         : "is no " + wanted) +
                       ", where a " + wanted + " is to be written",
                     "remove it, or choose another output folder by "
                     "`--output`");
  }



  int
  bring_to_disk(const std::string &name)
  {
    const int file = open(name.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0)
      return errno;
    const int error = fsync(file) == 0 ? 0 : errno;
    close(file);
    // Some file systems cannot do it (for folders): no loss of data.
    return error == EINVAL || error == ENOTSUP ? 0 : error;
  }



  WholeFile::WholeFile(const std::string &name)
    : name(name)
    , temporary(name + unfinished)
  {
    // Never through a link of that name to some other file
    std::remove(temporary.c_str());
    errno = 0;
    file.open(temporary, std::ios::binary | std::ios::trunc);
    if (!file)
      fail(errno);
  }



  WholeFile::~WholeFile()
  {
    if (committed)
      return;
    file.close();
    std::remove(temporary.c_str());
  }



  void
  WholeFile::commit()
  {
    if (file)
      errno = 0;
    file.close();
    if (!file)
      fail(errno != 0 ? errno : ENOSPC);
    const int error = bring_to_disk(temporary);
    if (error != 0)
      fail(error);
    if (std::rename(temporary.c_str(), name.c_str()) != 0)
      fail(errno);
    committed = true;
    const std::string folder =
      std::filesystem::path(name).parent_path().string();
    const int folder_error = bring_to_disk(folder.empty() ? "." : folder);
    if (folder_error != 0)
      fail(folder_error);
  }



  void
  WholeFile::fail(const int error) const
  {
    throw RunError("writing '" + name + "'",
                   std::strerror(error),
                   "check that the folder exists, is writable and not full");
  }



  FolderLock::FolderLock(const std::string &directory)
    : file(open(directory.c_str(), O_RDONLY | O_CLOEXEC))
  {
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) != 0 &&
        errno == EWOULDBLOCK)
      {
        close(file);
        throw InputError(directory,
                         "another run is writing into this folder",
                         "wait for its end, or choose another folder by "
                         "`--output`");
      }
  }



  FolderLock::~FolderLock()
  {
    if (file >= 0)
      close(file);
  }



  void
  remove_unfinished(const std::string &directory)
  {
    const std::string ending = WholeFile::unfinished;
    std::error_code   ignored;
    for (const auto &entry :
         std::filesystem::directory_iterator(directory, ignored))
      {
        const std::string file = entry.path().filename().string();
        if (file.size() > ending.size() &&
            file.compare(file.size() - ending.size(), ending.size(), ending) ==
              0 &&
            entry.is_regular_file(ignored))
          std::filesystem::remove(entry.path(), ignored);
      }
  }
} // namespace alveolus
