// The C library's calls that change files or send to sockets, and reads of files. Each asks the plan first
// and then makes the system call. The programs use no relative paths, so these are not resolved.
#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>
#include <cstdio>

#include "tests/end_to_end/shim/journal.h"
#include "tests/end_to_end/shim/plan.h"

namespace {

using namespace peclet::drill;

bool fails(Call call, const std::string& path) {
  const int error = strike(call, path);
  if (error == 0) return false;
  errno = error;
  return true;
}

int open_file(const char* path, int flags, mode_t mode) {
  const bool absent = (flags & O_CREAT) != 0 && syscall(SYS_faccessat, AT_FDCWD, path, F_OK) != 0;
  if (absent) {
    if (fails(Call::create, path)) return -1;
    note_created(path);
  }
  return static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, flags, mode));
}

// A failing write leaves the first half of its bytes.
ssize_t write_at(int descriptor, const void* bytes, size_t count, off_t offset) {
  const bool fault = fails(Call::write, path_of(descriptor));
  const int error = errno;
  note_write(descriptor, offset, count);
  const size_t written = fault ? count / 2 : count;
  const ssize_t result = syscall(SYS_pwrite64, descriptor, bytes, written, offset);
  if (!fault) return result;
  errno = error;
  return -1;
}

int truncate_file(int descriptor, off_t size) {
  if (fails(Call::truncate, path_of(descriptor))) return -1;
  note_truncation(descriptor, size);
  return static_cast<int>(syscall(SYS_ftruncate, descriptor, size));
}

int synchronise(int descriptor, long number) {
  if (fails(Call::sync, path_of(descriptor))) return -1;
  const int result = static_cast<int>(syscall(number, descriptor));
  if (result == 0) note_synchronised(descriptor);
  return result;
}

ssize_t read_at(int descriptor, void* bytes, size_t count, off_t offset) {
  if (fails(Call::read, path_of(descriptor))) return -1;
  return syscall(SYS_pread64, descriptor, bytes, count, offset);
}

int remove_file(const char* path) {
  if (fails(Call::remove, path)) return -1;
  note_removal(path);
  return static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, path, 0));
}

bool has_mode(int flags) { return (flags & (O_CREAT | O_TMPFILE)) != 0; }

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = has_mode(flags) ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return open_file(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const mode_t mode = has_mode(flags) ? va_arg(arguments, mode_t) : 0;
  va_end(arguments);
  return open_file(path, flags, mode);
}

ssize_t write(int descriptor, const void* bytes, size_t count) {
  const std::string path = path_of(descriptor);
  if (!path.starts_with('/')) return syscall(SYS_write, descriptor, bytes, count);
  const bool fault = fails(Call::write, path);
  const int error = errno;
  struct stat about {};
  const bool appends = (fcntl(descriptor, F_GETFL) & O_APPEND) != 0 && fstat(descriptor, &about) == 0;
  note_write(descriptor, appends ? about.st_size : lseek(descriptor, 0, SEEK_CUR), count);
  const ssize_t result = syscall(SYS_write, descriptor, bytes, fault ? count / 2 : count);
  if (!fault) return result;
  errno = error;
  return -1;
}

ssize_t pwrite(int descriptor, const void* bytes, size_t count, off_t offset) {
  return write_at(descriptor, bytes, count, offset);
}
ssize_t pwrite64(int descriptor, const void* bytes, size_t count, off64_t offset) {
  return write_at(descriptor, bytes, count, offset);
}

ssize_t pread(int descriptor, void* bytes, size_t count, off_t offset) {
  return read_at(descriptor, bytes, count, offset);
}
ssize_t pread64(int descriptor, void* bytes, size_t count, off64_t offset) {
  return read_at(descriptor, bytes, count, offset);
}

int ftruncate(int descriptor, off_t size) noexcept { return truncate_file(descriptor, size); }
int ftruncate64(int descriptor, off64_t size) noexcept { return truncate_file(descriptor, size); }

int fsync(int descriptor) { return synchronise(descriptor, SYS_fsync); }
int fdatasync(int descriptor) { return synchronise(descriptor, SYS_fdatasync); }

int rename(const char* from, const char* to) noexcept {
  if (fails(Call::rename, to)) return -1;
  note_rename(from, to);
  return static_cast<int>(syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

int linkat(int from_folder, const char* from, int to_folder, const char* to, int flags) noexcept {
  if (fails(Call::create, to)) return -1;
  note_created(to);
  return static_cast<int>(syscall(SYS_linkat, from_folder, from, to_folder, to, flags));
}

int unlink(const char* path) noexcept { return remove_file(path); }

int remove(const char* path) noexcept {
  if (remove_file(path) == 0) return 0;
  return errno == EISDIR ? static_cast<int>(syscall(SYS_unlinkat, AT_FDCWD, path, AT_REMOVEDIR)) : -1;
}

ssize_t send(int socket, const void* bytes, size_t count, int flags) {
  if (fails(Call::send, "socket")) return -1;
  return syscall(SYS_sendto, socket, bytes, count, flags, nullptr, 0);
}
}
