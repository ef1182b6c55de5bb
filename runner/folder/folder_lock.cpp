#include "runner/folder/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace peclet::runner {
namespace {

// A descriptor that holds the lock.
int locked(const std::filesystem::path& path, int flags) {
  int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC | flags);
  while (descriptor >= 0 && flock(descriptor, LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    const int error = errno;
    close(descriptor);
    descriptor = -1;
    errno = error;
  }
  if (descriptor < 0) throw std::system_error(errno, std::generic_category(), path.string());
  return descriptor;
}

// False: it was replaced while we waited, and there is nothing to hold any more.
bool is_there(int descriptor, const std::filesystem::path& file) {
  struct stat held {
  }, named{};
  return fstat(descriptor, &held) == 0 && stat(file.c_str(), &named) == 0 && held.st_dev == named.st_dev &&
         held.st_ino == named.st_ino;
}

}  // namespace

FolderLock::FolderLock(const std::filesystem::path& folder) : descriptor_(locked(folder, O_DIRECTORY)) {}

FolderLock::~FolderLock() { close(descriptor_); }

FileLock::FileLock(const std::filesystem::path& file) : descriptor_(locked(file, 0)) {
  while (!is_there(descriptor_, file)) {
    close(descriptor_);
    descriptor_ = locked(file, 0);
  }
}

FileLock::~FileLock() { close(descriptor_); }

}  // namespace peclet::runner
