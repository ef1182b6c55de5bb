// A realisation cut in the middle, on disk.
//
//   bytes 0-7    "PCLTCKPT"
//   bytes 8-11   version of the layout, unsigned, little-endian
//   bytes 12-19  length of the payload
//   then         the payload: identity (scene, seed, binary, motion), processor seconds so far, simulation
//   then         64 letters: SHA-256 of the payload
//
// It carries every bit that the rest of the run depends on: a run that was cut and resumed ends as one that
// was not.
#pragma once

#include <filesystem>
#include <string>

#include "contract/errors.h"
#include "engine/realisation/simulation.h"

namespace peclet::engine {

// What a checkpoint belongs to. The binary counts: another one may round differently.
struct CheckpointIdentity {
  std::string scene_sha256;  // of the canonical scene with its defaults
  std::uint64_t seed = 0;
  std::string binary_sha256;
  std::string motion_sha256 = {};  // motion_of()

  friend bool operator==(const CheckpointIdentity&, const CheckpointIdentity&) = default;
};

// SHA-256 of all that steps depend on: the scene without durations, observables and files, and the step's
// size.
std::string motion_of(const Scene& scene, const Schedule& schedule);

// The file is no checkpoint, of another version, torn, altered, or of another scene, seed or binary.
class CheckpointError : public IntegrityError {
 public:
  using IntegrityError::IntegrityError;
};

struct Spent {
  double processor_seconds = 0, wall_seconds = 0;
};

// Throws std::system_error when it cannot be written; the old file is then untouched.
void write_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      const Spent& spent, const Simulation& simulation);

// Restores a simulation of the same scene. Throws CheckpointError naming the file and the fault; `simulation`
// is then to be discarded.
Spent read_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                      Simulation& simulation);

// How far a realisation has come, and what it has cost.
struct Progressed {
  std::uint64_t step = 0;
  Spent spent;
};

// Of a checkpoint of the same motion, seed and binary: its scene may differ in durations, observables and
// files. Throws CheckpointError naming the file and the fault.
Progressed read_progress(const std::filesystem::path& path, const CheckpointIdentity& identity,
                         std::size_t particles);

// Goes on from there: what was measured until then is left behind.
void extend_checkpoint(const std::filesystem::path& path, const CheckpointIdentity& identity,
                       Simulation& simulation);

}  // namespace peclet::engine
