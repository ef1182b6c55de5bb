// One process at a time at the files of a folder.
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

}  // namespace peclet::runner
