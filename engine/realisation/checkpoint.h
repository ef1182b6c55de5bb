// Writes and reads checkpoints of a realisation.
//
//   bytes 0-7    "PCLTCKPT"
//   bytes 8-11   version of the layout, unsigned, little-endian
//   bytes 12-19  length of the payload
//   then         the payload: identity (scene, seed, binary, motion), time spent, simulation
//   then         64 characters: SHA-256 of the payload in hexadecimal
//
// A checkpoint holds the whole state of the run: a resumed run gives the same bits as an uninterrupted one.
#pragma once

#include <filesystem>
#include <string>

#include "contract/errors.h"
#include "engine/realisation/simulation.h"

namespace peclet::engine {

// Identity of the run that a checkpoint belongs to. Another binary may round differently.
struct CheckpointIdentity {
  std::string scene_sha256;  // of the canonical scene with its defaults
  std::uint64_t seed = 0;
  std::string binary_sha256;       // if an ensemble made the steps, its name follows after a space
  std::string motion_sha256 = {};  // motion_of()

  friend bool operator==(const CheckpointIdentity&, const CheckpointIdentity&) = default;
};

// The file is not a checkpoint, truncated, altered, or of another version, scene, seed, binary or device.
class CheckpointError : public IntegrityError {
 public:
  using IntegrityError::IntegrityError;
};

struct Spent {
  double processor_seconds = 0, wall_seconds = 0;
};

// Writes a checkpoint durably. Throws std::system_error if this fails; the old file then stays.
void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const Spent& spent, const Simulation& simulation);

// Restores a simulation of the same scene and returns the time spent on it. Throws CheckpointError naming the
// file and the fault; `simulation` is then unusable.
Spent read_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      Simulation& simulation);

// Progress of a realisation, and the time spent on it.
struct Progressed {
  std::uint64_t step = 0;
  Spent spent;
};

// Returns the progress of a checkpoint of the same motion, seed and binary. Its scene may differ in
// durations, observables and files. Throws CheckpointError naming the file and the fault.
Progressed read_progress(const std::filesystem::path& path, const CheckpointIdentity& identity,
                         std::size_t particles);

// Restores the motion from such a checkpoint, without its measurements. Throws as read_progress().
void extend_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                       Simulation& simulation);

}  // namespace peclet::engine
