// Files that a realisation writes beside its result: a growing GSD file and the last configuration.
#pragma once

#include <filesystem>
#include <string>

#include "contract/durable_file.h"
#include "engine/snapshots/gsd_file.h"
#include "engine/state/system.h"

namespace peclet::engine {

// A GSD file that grows beside a checkpoint.
//
// It lies beside the checkpoint as CHECKPOINT@growing; without one it has no name, and goes with the
// process. What a checkpoint knows of it (gsd::Frames) is on disk before the checkpoint is; whatever was
// written after that is written again by the run that goes on. The bytes of a realisation follow from its
// scene and seed, and each has its place: an engine that lives on for some seconds, while the next one is at
// work on the same seed, writes what is there.
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

// Returns the spheres as extended XYZ: the number of spheres; a line with the three lattice vectors of the
// deformed cell, the columns, time, strain and the columns of the velocity gradient; then of each sphere its
// number for life, by which they are sorted, the centre, the radius, the velocity and the angular velocity,
// in the units of the scene. Numbers are read back as they were, bit by bit. A centre may lie outside of the
// cell; its velocity is that of the image there.
std::string extended_xyz(const System& system);

}  // namespace peclet::engine
