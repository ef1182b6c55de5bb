#include "runner/folder_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace peclet::runner {

FolderLock::FolderLock(const std::filesystem::path& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  while (descriptor_ >= 0 && flock(descriptor_, LOCK_EX) != 0) {
    if (errno == EINTR) continue;
    close(descriptor_);
    descriptor_ = -1;
  }
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), folder.string());
}

FolderLock::~FolderLock() { close(descriptor_); }

}  // namespace peclet::runner
