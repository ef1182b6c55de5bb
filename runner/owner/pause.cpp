#include "runner/owner/pause.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <utility>

#include "contract/durable_file.h"
#include "runner/campaign/quoting.h"
#include "runner/store/disk_room.h"
#include "runner/store/sqlite.h"

namespace peclet::runner {
namespace {

constexpr std::chrono::seconds patience{3}, vain_patience{20};

}  // namespace

std::string Hindrance::kind() const {
  struct stat about {};
  if (folder.empty() || stat(folder.c_str(), &about) != 0) return end + folder.string();
  return fmt::format("{} on {}", end, about.st_dev);
}

Hindrance lack_of_room_in(const fs::path& folder, std::uint64_t bytes, int error) {
  return {shortage_text(folder, bytes, error), "when there is room", folder, bytes};
}

std::optional<Hindrance> hindrance_in(const std::exception& error, const fs::path& root,
                                      std::uint64_t bytes) {
  if (const auto* const database = dynamic_cast<const DatabaseError*>(&error)) {
    if (database->is_locked()) return Hindrance{error.what(), "when the lock is released"};
    if (!database->no_room()) return std::nullopt;
    return lack_of_room_in(root, bytes, database->system_error() == EDQUOT ? EDQUOT : ENOSPC);
  }
  const auto* const system = dynamic_cast<const std::system_error*>(&error);
  if (system == nullptr) return std::nullopt;
  const int number = system->code().value();
  if (means_no_room(error)) {
    const auto* const unwritten = dynamic_cast<const NoRoomError*>(&error);
    return unwritten == nullptr
               ? lack_of_room_in(root, bytes, number)
               : lack_of_room_in(unwritten->path().parent_path(), unwritten->bytes(), number);
  }
  if (!means_machine_fault(number)) return std::nullopt;
  return Hindrance{plain(error.what()) + ": this machine or its disk fails (`dmesg` may say more)",
                   "when that succeeds"};
}

void Pause::begin(Hindrance hindrance, Time now) {
  if (lasts() && hindrance_->folder == hindrance.folder) {
    hindrance.bytes = std::max(hindrance.bytes, hindrance_->bytes);
  } else if (!lasts()) {
    looked_ = now;
    vain_since_.reset();
  }
  hindrance_ = std::move(hindrance);
}

bool Pause::is_looked_at(Time now) const { return lasts() && now - looked_ >= patience; }

bool Pause::is_over(Time now) {
  if (!is_looked_at(now)) return false;
  looked_ = now;
  if (!hindrance_->folder.empty() && !has_room(hindrance_->folder, hindrance_->bytes)) return false;
  hindrance_.reset();
  return true;
}

std::string Pause::in_vain(const fs::path& root, Time now) {
  if (!lasts() || now != looked_) return "";
  std::string why =
      hindrance_->folder.empty() ? "" : why_in_vain(root, hindrance_->folder, hindrance_->bytes);
  if (why.empty()) {
    vain_since_.reset();
  } else if (!vain_since_) {
    vain_since_ = now;
  }
  return vain_since_ && now - *vain_since_ >= vain_patience ? why : "";
}

}  // namespace peclet::runner
