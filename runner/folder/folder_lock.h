// One process at a time at the files of a folder, or at one file.
#pragma once

#include <filesystem>

namespace peclet::runner {

// Held from construction, which waits for it, to destruction or to the end of the process. Leaves no file.
class FolderLock {
 public:
  // Throws std::system_error naming the folder.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

// The same of a file, which whoever holds it may replace by another of its name.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& file);
  ~FileLock();
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace peclet::runner
