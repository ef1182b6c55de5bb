// RunListener hears what a run tells about itself. Only progress.cpp puts it into words on a terminal.
#pragma once

#include <optional>
#include <string>
#include <variant>

#include "runner/campaign/paths.h"
#include "runner/statistics/cohorts.h"
#include "runner/statistics/forecast.h"
#include "runner/store/blame.h"

namespace peclet::runner {

// Events of a run, for programs that follow it; schema/events.schema.json describes each as JSON.
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
  std::optional<double> value;  // value of the target's observable
  std::optional<double> cpu_seconds;
};

// An attempt that gave no result. The seed is tried again, or is given up and has then ended, too.
struct AttemptFailed {
  PointName point;
  int seed = 0;
  AttemptOutcome outcome = AttemptOutcome::crashed;
  std::string message;
  bool given_up = false;
  bool blamed = true;  // it counts against the seed
};

struct StopTestMade {
  PointName point;
  StopTest stop_test;
};

// The point needs no more seeds: its last stop test is within the tolerance, or all allowed seeds have ended.
struct Decided {
  PointName point;
  StopTest stop_test;
};

// The campaign has one more value of the axis of its curves.
struct ValueChosen {
  std::string axis;  // pointer
  double value = 0;
  std::string observable;  // whose band was widest
  double width = 0;        // of the band there, relative
};

// The run pauses because something is in its way. Sent once for each kind of hindrance until ShortageEnded.
struct ShortageBegan {
  std::string message;
};
struct ShortageEnded {};

struct RunEnded {
  int exit_code = 0;
  std::string message;  // error that ended the run, or ""
};

using RunEvent = std::variant<RunBegan, SeedEnded, AttemptFailed, StopTestMade, Decided, ValueChosen,
                              ShortageBegan, ShortageEnded, RunEnded>;

struct RunReport {
  int points = 0, decided = 0, converged = 0;  // converged or complete, also with losses
  bool has_target = true;
  int cancelled = 0;                      // points cancelled before they were decided
  int seeds_ended = 0, seeds_wanted = 0;  // seeds of the next or the deciding stop tests
  int workers = 0, busy = 0;
  int running = 0;     // realisations that workers have begun
  int results = 0;     // results in this run
  double elapsed = 0;  // time of this run [s]
  std::optional<TimeToGo> to_go;
  double spent_seconds = 0;  // processor time of this run [s]
  std::optional<double> budget_seconds;
};

class RunListener {
 public:
  virtual ~RunListener() = default;
  // Tells a person what happened: note() what is good to know, warn() what may need action.
  virtual void note(const std::string& message) = 0;
  virtual void warn(const std::string& message) = 0;
  // Tells programs about an event, once and after it is durable.
  virtual void happened(const RunEvent&) {}
  // Tells how far the run is, about once a second.
  virtual void report(const RunReport& report) = 0;
};

}  // namespace peclet::runner
