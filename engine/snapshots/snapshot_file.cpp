#include "engine/snapshots/snapshot_file.h"

#include <fmt/format.h>

#include <charconv>

#include "contract/input_error.h"
#include "contract/input_file.h"
#include "engine/snapshots/gsd_snapshots.h"
#include "engine/snapshots/xyz_snapshots.h"

namespace peclet::engine {
namespace {

constexpr InputLimits text_limits{std::size_t{256} << 20, 0};

std::int64_t whole(std::string_view text, std::int64_t missing, const std::string& range,
                   const std::string& option) {
  if (text.empty()) return missing;
  std::int64_t value = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec == std::errc() && read.ptr == text.data() + text.size()) return value;
  throw InputError(option, "", range, "must be FIRST:LAST:STEP or one frame, whole numbers");
}

}  // namespace

std::string note_on_sizes(const std::string& file) {
  return file + " has no diameters (particles/diameter): its spheres are shown with the diameter 1";
}

SnapshotFile::SnapshotFile(const std::filesystem::path& path) : path_(path) {
  if (gsd::begins_as_gsd(path)) {
    gsd_.emplace(path);
  } else {
    text_ = std::make_unique<Text>();
    text_->text = read_input(path, text_limits);
    text_->frames = xyz_frames(text_->text, path.string());
  }
  if (frames() == 0) throw InputError(path.string(), "", "", "must have a frame, and has none");
}

std::uint64_t SnapshotFile::frames() const { return gsd_ ? gsd_->frames() : text_->frames.size(); }

std::uint64_t SnapshotFile::index_of(std::int64_t frame) const {
  const auto count = static_cast<std::int64_t>(frames());
  const std::int64_t index = frame < 0 ? frame + count : frame;
  if (index < 0 || index >= count) {
    throw InputError(path_.string(), "", fmt::format("frame {}", frame),
                     fmt::format("must be from 0 to {}, or from -1, the last one, to {}", count - 1, -count));
  }
  return static_cast<std::uint64_t>(index);
}

Snapshot SnapshotFile::read(std::uint64_t frame) const {
  return gsd_ ? read_gsd_frame(*gsd_, frame) : read_xyz_frame(text_->frames.at(frame), path_.string());
}

std::vector<std::uint64_t> chosen_frames(const std::string& range, const SnapshotFile& file,
                                         const std::string& option) {
  std::vector<std::string_view> parts;
  for (std::string_view rest = range;;) {
    const std::size_t end = rest.find(':');
    parts.push_back(rest.substr(0, end));
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  if (range.empty() || parts.size() > 3) whole("-", 0, range, option);
  const std::uint64_t first = file.index_of(whole(parts[0], 0, range, option));
  if (parts.size() == 1) return {first};
  const std::uint64_t last = file.index_of(whole(parts[1], -1, range, option));
  const std::int64_t step = parts.size() == 3 ? whole(parts[2], 1, range, option) : 1;
  if (step < 1 || last < first) {
    throw InputError(option, "", range,
                     "must have its first frame before its last one, and a step of 1 or more");
  }
  std::vector<std::uint64_t> frames;
  for (std::uint64_t k = first; k <= last; k += static_cast<std::uint64_t>(step)) frames.push_back(k);
  return frames;
}

}  // namespace peclet::engine
