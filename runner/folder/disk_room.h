// Room on the file systems of a campaign: whether something fits, and what to wait for when it did not.
#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace peclet::runner {

// Whether `bytes` could be written in `folder` now. It is tried, not asked for: quotas do not show in
// statvfs. True also when it cannot be tried for another reason than want of room.
bool has_room(const std::filesystem::path& folder, std::uint64_t bytes);

// "/data/friction.peclet/spool is full: 0.0 MB are free there, 1.1 MB are needed"
std::string shortage_text(const std::filesystem::path& folder, std::uint64_t bytes);

// Why waiting for `bytes` in `folder` is in vain: its file system, without all that is not of the campaign in
// `root`, would still be too small. "" where somebody could make room, and where quotas hide the truth.
std::string why_in_vain(const std::filesystem::path& root, const std::filesystem::path& folder,
                        std::uint64_t bytes);

// What could not be written last, until there is room for it.
class DiskShortage {
 public:
  using Time = std::chrono::steady_clock::time_point;

  // Something of `bytes` did not fit into `folder`.
  void begin(const std::filesystem::path& folder, std::uint64_t bytes, Time now);
  // Whether is_over() would look now.
  bool is_looked_at(Time now) const;
  // Looks whether there is room, every few seconds at most. True when there just turned out to be.
  bool is_over(Time now);

  // Why waiting in the campaign's folder `root` is in vain; "" unless that has been so for twenty seconds,
  // in which workers may have ended and freed what they had.
  std::string in_vain(const std::filesystem::path& root, Time now);

  bool lasts() const { return folder_.has_value(); }
  std::string text() const { return lasts() ? shortage_text(*folder_, bytes_) : ""; }

 private:
  std::optional<std::filesystem::path> folder_;
  std::uint64_t bytes_ = 0;
  Time looked_{};
  std::optional<Time> vain_since_;
};

}  // namespace peclet::runner
