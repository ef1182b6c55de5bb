// A GSD file that grows beside a checkpoint.
//
// It lies beside the checkpoint as CHECKPOINT@growing; without one it has no name, and goes with the
// process. What a checkpoint knows of it (gsd::Frames) is on disk before the checkpoint is; whatever was
// written after that is written again by the run that goes on. The bytes of a realisation follow from its
// scene and seed, and each has its place: an engine that lives on for some seconds, while the next one is at
// work on the same seed, writes what is there.
#pragma once

#include <filesystem>

#include "contract/descriptor.h"
#include "engine/gsd/frames.h"

namespace peclet::engine {

class GrowingFile {
 public:
  // Throws std::system_error, UnsuitableFile.
  explicit GrowingFile(const std::filesystem::path& path, bool has_name = true);

  // What is behind the frames that were given to it does not count, and is written again. Throws
  // CheckpointError where one of them is absent or altered.
  void go_on(const gsd::Frames& frames) const;

  // Takes what is pending. Throws NoRoomError, std::system_error; everything then is still pending.
  void take(gsd::Frames& frames) const;
  // What was taken is on disk.
  void synchronise() const;

  // Replaces `target` by the whole file, durably. Throws NoRoomError, std::system_error, IntegrityError where
  // somebody has altered a frame.
  void finish(const gsd::Frames& frames, const std::filesystem::path& target) const;

 private:
  void write_at(std::uint64_t place, std::string_view bytes) const;
  void cut(std::uint64_t length) const;
  void move_to(std::uint64_t place) const;
  // The first frame that is not as it was written; empty: none.
  std::string fault(const gsd::Frames& frames) const;

  std::filesystem::path path_;
  Descriptor file_;
};

}  // namespace peclet::engine
