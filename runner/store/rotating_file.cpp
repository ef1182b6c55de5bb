#include "runner/store/rotating_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "contract/guarded_file.h"

namespace peclet::runner {

RotatingFile::RotatingFile(fs::path path, std::uint64_t limit, int older)
    : path_(std::move(path)), limit_(limit), older_(older) {}

RotatingFile::~RotatingFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

void RotatingFile::reopen(int flags) {
  try {
    descriptor_ = open_regular(path_, O_WRONLY | O_CREAT | O_APPEND | flags, 0644).take();
  } catch (const std::exception&) {  // append() counts the bytes as dropped
    descriptor_ = -1;
  }
}

bool RotatingFile::open() {
  if (descriptor_ >= 0) return true;
  reopen(0);
  struct stat about {};
  if (descriptor_ >= 0 && fstat(descriptor_, &about) == 0) size_ = static_cast<std::uint64_t>(about.st_size);
  return descriptor_ >= 0;
}

void RotatingFile::rotate() {
  close(std::exchange(descriptor_, -1));
  const auto name = [this](int age) {
    return age == 0 ? path_.string() : fmt::format("{}.{}", path_.string(), age);
  };
  std::error_code failed;  // on failure the present file is overwritten
  for (int age = older_; age > 0; --age) fs::rename(name(age - 1), name(age), failed);
  size_ = 0;
  reopen(O_TRUNC);
}

void RotatingFile::append(std::string_view bytes) {
  while (bytes.size() > limit_) {
    append(bytes.substr(0, limit_));
    bytes.remove_prefix(limit_);
  }
  if (!open()) {
    dropped_ += bytes.size();
    return;
  }
  if (size_ + bytes.size() > limit_ && size_ > 0) rotate();
  if (dropped_ > 0 && descriptor_ >= 0) {
    const std::uint64_t lost = std::exchange(dropped_, 0);
    write(fmt::format("({} bytes could not be written here)\n", lost));
    if (dropped_ > 0) dropped_ = lost;  // still no room
  }
  write(bytes);
}

void RotatingFile::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = descriptor_ >= 0 ? ::write(descriptor_, bytes.data(), bytes.size()) : -1;
    if (written < 0 && descriptor_ >= 0 && errno == EINTR) continue;
    if (written <= 0) {
      dropped_ += bytes.size();
      return;
    }
    size_ += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace peclet::runner
