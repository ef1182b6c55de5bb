// One realisation from its scene to its result, with checkpoints on the way.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "contract/durable_file.h"
#include "engine/realisation/result.h"

namespace peclet::engine {

struct JobSpecification {
  ResultHeader header;
  Json scene;
  std::string scene_name;            // in messages
  int threads = 1;                   // at most; a small system uses fewer
  std::filesystem::path checkpoint;  // resumed from when it exists; empty: none is written
  double checkpoint_seconds = 300;
  // A checkpoint, of a scene that differs in durations, observables and files at most, from which the job
  // goes on if it has none of its own; empty: it begins at the start. Windows begin where the checkpoint is,
  // if the scene's begins before it.
  std::filesystem::path extended;
  std::filesystem::path failures;  // folder for the state of a realisation that broke off; empty: not saved
  std::string files;  // what the names of files beside the result begin with; empty: none are taken
  bool restart_on_bad_checkpoint =
      false;  // an unusable checkpoint is set aside (.rejected) instead of ending the job
};

struct Progress {
  const char* phase;  // "packing", "equilibration", "production"
  // Steps made and in all; while packing those of its minimisation, whose number nobody knows: 0.
  std::uint64_t step, steps;
  double strain;
};

// What the surroundings of a job may ask and hear, several times a second.
struct JobEvents {
  std::function<bool()> drain_requested = [] { return false; };
  std::function<void(const Progress&)> progress = [](const Progress&) {};
  std::function<void(const std::string&)> remark = [](const std::string&) {};  // for a log
  // A checkpoint on the way did not fit onto the disk; the job goes on, and tries again some seconds later.
  std::function<void(const NoRoomError&)> skipped = [](const NoRoomError&) {};
  // A file that the job cannot end without did not fit. True: try again now; false: end all the same.
  std::function<bool(const NoRoomError&)> wait_for_room = [](const NoRoomError&) { return false; };
};

// The result, or nothing when the job was drained: its checkpoint is then on disk, or the one before it when
// there was no room. Throws InputError, CheckpointError, std::system_error.
std::optional<Json> run_job(const JobSpecification& job, const JobEvents& events);

// Speaks frames on `descriptor` until the peer closes it or says stop; schema/README.md lists the messages.
// Returns the exit code.
int serve(int descriptor);

}  // namespace peclet::engine
