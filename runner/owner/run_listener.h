// What a run tells about itself. The dispatcher reports; progress.cpp alone puts it into words on a terminal.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "runner/campaign/paths.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/forecast.h"
#include "runner/store/blame.h"

namespace peclet::runner {

// What happens in a run, for programs that follow it: schema/events.schema.json describes each as JSON.
struct RunBegan {
  std::string campaign;
  fs::path directory;
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

struct StopTestMade {
  PointName point;
  StopTest stop_test;
};

// No more seeds are needed: the last stop test is within the tolerance, or all seeds that are allowed have
// ended.
struct Decided {
  PointName point;
  StopTest stop_test;
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

using RunEvent = std::variant<RunBegan, SeedEnded, AttemptFailed, StopTestMade, Decided, ShortageBegan,
                              ShortageEnded, RunEnded>;

struct RunReport {
  int points = 0, decided = 0, converged = 0;  // converged, or complete: also with losses
  bool has_target = true;
  int cancelled = 0;                      // before they were decided
  int seeds_ended = 0, seeds_wanted = 0;  // of the stop tests that are next or have decided
  int workers = 0, busy = 0;
  int results = 0;     // of this run
  double elapsed = 0;  // seconds of this run
  std::optional<TimeToGo> to_go;
  double spent_seconds = 0;  // processor time of this run
  std::optional<double> budget_seconds;
};

class RunListener {
 public:
  virtual ~RunListener() = default;
  // Something happened that a person may want to know (may have to know).
  virtual void note(const std::string& message) = 0;
  virtual void warn(const std::string& message) = 0;
  // The same for programs, once each and after it is durable.
  virtual void happened(const RunEvent&) {}
  // How far the run is; comes about once a second.
  virtual void report(const RunReport& report) = 0;
};

}  // namespace peclet::runner
