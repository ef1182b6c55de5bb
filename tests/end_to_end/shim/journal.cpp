#include "tests/end_to_end/shim/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "tests/end_to_end/shim/plan.h"

namespace peclet::drill {
namespace {

const char* folder() {
  static const char* const path = std::getenv("PECLET_FAULT_JOURNAL");
  return path;
}

// SQLite rebuilds the write-ahead log's index, and the lock is empty.
bool is_recorded(const std::string& path) {
  return folder() != nullptr && path.find(".peclet/") != std::string::npos && !path.ends_with("-shm") &&
         !path.ends_with("campaign.lock");
}

bool is_recorded_folder(const std::string& path) {
  return folder() != nullptr && path.find(".peclet") != std::string::npos;
}

void append(const std::string& record) {
  const std::string path = std::string(folder()) + "/" + std::to_string(getpid());
  const long file =
      syscall(SYS_openat, AT_FDCWD, path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  // A missing record would make the drill's power cut too mild.
  if (file < 0 || syscall(SYS_write, file, record.data(), record.size()) != static_cast<long>(record.size()))
    std::abort();
  syscall(SYS_close, file);
}

void record(std::int64_t sequence, const char* kind, ino_t inode, off_t offset, off_t size,
            const std::string& bytes, const std::string& paths) {
  append(std::to_string(sequence) + " " + kind + " " + std::to_string(inode) + " " + std::to_string(offset) +
         " " + std::to_string(size) + " " + std::to_string(bytes.size()) + " " + paths + "\n" + bytes);
}

std::string bytes_at(const std::string& path, off_t offset, off_t end) {
  std::string bytes(static_cast<std::size_t>(std::max<off_t>(0, end - offset)), '\0');
  const long file = syscall(SYS_openat, AT_FDCWD, path.c_str(), O_RDONLY | O_CLOEXEC, 0);
  const long count = syscall(SYS_pread64, file, bytes.data(), bytes.size(), offset);
  if (count != static_cast<long>(bytes.size())) std::abort();
  syscall(SYS_close, file);
  return bytes;
}

// Gives a file a second name before it loses its own.
void keep(std::int64_t sequence, const std::string& path) {
  const std::string name = std::string(folder()) + "/kept/" + std::to_string(sequence);
  syscall(SYS_linkat, AT_FDCWD, path.c_str(), AT_FDCWD, name.c_str(), 0);
}

}  // namespace

void note_created(const std::string& path) {
  if (!is_recorded(path)) return;
  record(next_record(), "create", 0, 0, 0, "", path);
}

void note_write(int descriptor, off_t offset, std::size_t count) {
  struct stat about {};
  const std::string path = path_of(descriptor);
  if (!is_recorded(path) || fstat(descriptor, &about) != 0) return;
  const off_t end = std::min(about.st_size, offset + static_cast<off_t>(count));
  record(next_record(), "write", about.st_ino, offset, about.st_size, bytes_at(path, offset, end), path);
}

void note_truncation(int descriptor, off_t size) {
  struct stat about {};
  const std::string path = path_of(descriptor);
  if (!is_recorded(path) || fstat(descriptor, &about) != 0) return;
  record(next_record(), "truncate", about.st_ino, size, about.st_size, bytes_at(path, size, about.st_size),
         path);
}

void note_synchronised(int descriptor) {
  struct stat about {};
  const std::string path = path_of(descriptor);
  if (!is_recorded_folder(path) || fstat(descriptor, &about) != 0) return;
  record(next_record(), S_ISDIR(about.st_mode) ? "sync-folder" : "sync", about.st_ino, 0, 0, "", path);
}

void note_rename(const std::string& from, const std::string& to) {
  if (!is_recorded(to)) return;
  const std::int64_t sequence = next_record();
  keep(sequence, to);
  record(sequence, "rename", 0, 0, 0, "", from + " -> " + to);
}

void note_removal(const std::string& path) {
  if (!is_recorded(path)) return;
  const std::int64_t sequence = next_record();
  keep(sequence, path);
  record(sequence, "remove", 0, 0, 0, "", path);
}

}  // namespace peclet::drill
