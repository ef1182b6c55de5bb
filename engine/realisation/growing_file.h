// Writes the files beside a result: a growing GSD file and the last configuration.
#pragma once

#include <filesystem>
#include <string>

#include "contract/durable_file.h"
#include "engine/snapshots/gsd_file.h"
#include "engine/state/system.h"

namespace peclet::engine {

// A GSD file that grows during a realisation.
//
// The file is CHECKPOINT@growing. Without a checkpoint it has no name and vanishes with the process. Frames
// that a checkpoint knows of (gsd::Frames) are on disk before the checkpoint; a resumed run writes later
// frames again. Every byte and its place follow from scene and seed. So an old engine that lives on for some
// seconds, beside a new one with the same seed, writes the same bytes.
class GrowingFile {
 public:
  // Opens or creates the file. Throws std::system_error, UnsuitableFile.
  explicit GrowingFile(const std::filesystem::path& path, bool has_name = true);

  // Checks that the file has the written frames; bytes behind them are overwritten later. Throws
  // CheckpointError if a frame is absent or altered.
  void go_on(const gsd::Frames& frames) const;

  // Writes the pending bytes of `frames`. Throws NoRoomError, std::system_error; all bytes then stay pending.
  void take(gsd::Frames& frames) const;
  // Waits until all written bytes are on disk.
  void synchronise() const;

  // Replaces `target` by the whole file, durably. Throws NoRoomError, std::system_error, IntegrityError.
  void finish(const gsd::Frames& frames, const std::filesystem::path& target) const;

 private:
  void write_at(std::uint64_t place, std::string_view bytes) const;
  void cut(std::uint64_t length) const;
  void move_to(std::uint64_t place) const;
  // Returns a description of the first frame that is absent or altered; "" if all are sound.
  std::string fault(const gsd::Frames& frames) const;

  std::filesystem::path path_;
  Descriptor file_;
};

// Returns the spheres as extended XYZ, in the units of the scene:
//
// - the number of spheres;
// - a line with the lattice vectors of the deformed cell, the names of the columns, time, net strain, and the
//   columns of the velocity gradient;
// - for each sphere, sorted by id: id, centre, radius, velocity, angular velocity.
//
// Numbers round-trip bit by bit. A centre may lie outside of the cell; its velocity is that of this image.
std::string extended_xyz(const System& system);

}  // namespace peclet::engine
