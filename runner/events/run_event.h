// What happens in a run, for programs that follow it: schema/events.schema.json describes each as JSON.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "runner/statistics/cohorts.h"
#include "runner/store/blame.h"

namespace peclet::runner {

struct RunBegan {
  std::string campaign;
  std::filesystem::path directory;
  int process = 0, points = 0, workers = 0, threads = 0;
};

struct PointName {
  std::string label, hash;
};

struct SeedEnded {
  PointName point;
  int seed = 0;
  std::string cause;            // "completed", "overlap", ..., "crashed"
  std::optional<double> value;  // of the target's observable
  std::optional<double> cpu_seconds;
};

// An attempt that gave no result: the seed is tried again, or given up (then it has ended as well).
struct AttemptFailed {
  PointName point;
  int seed = 0;
  AttemptOutcome outcome = AttemptOutcome::crashed;
  std::string message;
  bool given_up = false;
};

struct Looked {
  PointName point;
  Look look;
};

// No more seeds are needed: the last look is within the tolerance, or all seeds that are allowed have ended.
struct Decided {
  PointName point;
  Look look;
};

// Something is in the run's way: it pauses. Told again of whatever else gets in its way before ShortageEnded.
struct ShortageBegan {
  std::string message;
};
struct ShortageEnded {};

struct RunEnded {
  int exit_code = 0;
  std::string message;  // of the error that ended it, or ""
};

using RunEvent =
    std::variant<RunBegan, SeedEnded, AttemptFailed, Looked, Decided, ShortageBegan, ShortageEnded, RunEnded>;

}  // namespace peclet::runner
