// A file of frames, whichever kind it is of.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/gsd/reader.h"
#include "engine/snapshots/snapshot.h"

namespace peclet::engine {

// A GSD file, or extended XYZ of up to 256 MiB: what it is shows in its first bytes, not in its name.
class SnapshotFile {
 public:
  // Throws InputError.
  explicit SnapshotFile(const std::filesystem::path& path);

  std::uint64_t frames() const;
  // Counted from 0, or from the last one, -1. Throws InputError where there is no such frame.
  std::uint64_t index_of(std::int64_t frame) const;
  // Throws InputError.
  Snapshot read(std::uint64_t frame) const;

 private:
  struct Text {
    std::string text;
    std::vector<std::string_view> frames;  // of the text
  };

  std::filesystem::path path_;
  std::optional<gsd::Reader> gsd_;
  std::unique_ptr<Text> text_;
};

// What a person should know of a file without sizes.
std::string note_on_sizes(const std::string& file);

// "first:last:step", of which each may be left out, or one number: the frames, at most `count`, that it
// names. Both ends are included, and count from the last frame where they are negative. Throws InputError for
// what is no such text (in `option`) and for frames that are not there.
std::vector<std::uint64_t> chosen_frames(const std::string& range, const SnapshotFile& file,
                                         const std::string& option);

}  // namespace peclet::engine
