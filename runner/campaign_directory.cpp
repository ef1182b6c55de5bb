#include "runner/campaign_directory.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <system_error>
#include <thread>
#include <utility>

#include "contract/durable_file.h"

namespace peclet::runner {
namespace {

namespace fs = std::filesystem;

// Sixteen hexadecimal digits tell the points of a campaign apart and keep names readable.
std::string stem(const std::string& hash, int seed) {
  return fmt::format("{}-{:06}", hash.substr(0, 16), seed);
}

// statfs(2) magic numbers of file systems whose locks or fsync cannot be trusted between machines.
constexpr std::array<std::pair<unsigned long, const char*>, 9> network_kinds{{{0x6969, "NFS"},
                                                                              {0x517b, "SMB"},
                                                                              {0xff534d42, "CIFS"},
                                                                              {0xfe534d42, "SMB2"},
                                                                              {0x00c36400, "Ceph"},
                                                                              {0x0bd00bd0, "Lustre"},
                                                                              {0x47504653, "GPFS"},
                                                                              {0x19830326, "BeeGFS"},
                                                                              {0x5346414f, "AFS"}}};

std::int64_t written_owner(int descriptor) {
  std::array<char, 32> text{};
  const ssize_t count = pread(descriptor, text.data(), text.size(), 0);
  std::int64_t process = 0;
  if (count > 0) std::from_chars(text.data(), text.data() + count, process);
  return process;
}

// Readers that ask current_owner() hold the lock for an instant; an owner holds it for longer than this.
bool lock_patiently(int descriptor) {
  for (int attempt = 0; attempt < 20; ++attempt) {
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0) return true;
    if (errno != EWOULDBLOCK && errno != EINTR) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  errno = EWOULDBLOCK;
  return false;
}

}  // namespace

fs::path CampaignDirectory::checkpoint(const std::string& hash, int seed) const {
  return checkpoints() / (stem(hash, seed) + ".checkpoint");
}

fs::path CampaignDirectory::spool_file(const std::string& hash, int seed, std::int64_t attempt) const {
  return spool() / fmt::format("{}-{}.json", stem(hash, seed), attempt);
}

fs::path CampaignDirectory::worker_log(int worker) const {
  return logs() / fmt::format("worker-{}.log", worker);
}

CampaignDirectory campaign_directory(const fs::path& campaign_file, const fs::path& chosen) {
  if (!chosen.empty()) return CampaignDirectory(fs::absolute(chosen).lexically_normal());
  fs::path folder = fs::absolute(campaign_file).lexically_normal();
  folder.replace_extension(".peclet");
  return CampaignDirectory(folder);
}

void create_folders(const CampaignDirectory& directory) {
  for (const fs::path& folder : {directory.root(), directory.rejected(), directory.checkpoints(),
                                 directory.failures(), directory.logs(), directory.backup()}) {
    fs::create_directories(folder);
  }
}

std::optional<std::string> network_file_system(const fs::path& path) {
  fs::path existing = fs::absolute(path);
  while (!fs::exists(existing) && existing.has_relative_path()) existing = existing.parent_path();
  struct statfs about {};
  if (statfs(existing.c_str(), &about) != 0) {
    throw std::system_error(errno, std::generic_category(), existing.string());
  }
  // The field is signed or not, 32 or 64 bits wide, depending on the machine.
  const unsigned long magic = static_cast<unsigned long>(about.f_type) & 0xffffffffUL;
  for (const auto& [number, name] : network_kinds) {
    if (number == magic) return name;
  }
  return std::nullopt;
}

OwnerLock::OwnerLock(const CampaignDirectory& directory) {
  const std::string path = directory.lock().string();
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path);
  if (!lock_patiently(descriptor_)) {
    const int error = errno;
    const std::int64_t owner = written_owner(descriptor_);
    close(descriptor_);
    if (error != EWOULDBLOCK) throw std::system_error(error, std::generic_category(), path);
    throw OwnedByAnother(
        fmt::format("{}: process {} owns this campaign; look at it with `peclet status`, or stop "
                    "that process first",
                    directory.root().string(), owner));
  }
  const std::string process = fmt::format("{}\n", getpid());
  const bool written = ftruncate(descriptor_, 0) == 0 && pwrite(descriptor_, process.data(), process.size(),
                                                                0) == static_cast<ssize_t>(process.size());
  // On a full disk the lock is worth as much without the number.
  if (const int error = errno; !written && !means_no_room(error)) {
    close(descriptor_);
    throw std::system_error(error, std::generic_category(), path);
  }
}

OwnerLock::~OwnerLock() { close(descriptor_); }

std::optional<std::int64_t> current_owner(const CampaignDirectory& directory) {
  const int descriptor = open(directory.lock().c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  // A shared lock, held for an instant: it fails while there is an owner.
  std::optional<std::int64_t> owner;
  if (flock(descriptor, LOCK_SH | LOCK_NB) != 0) owner = written_owner(descriptor);
  close(descriptor);
  return owner;
}

}  // namespace peclet::runner
