// What a run tells about itself. The dispatcher reports; progress.cpp alone puts it into words on a terminal.
#pragma once

#include <optional>
#include <string>

#include "runner/events/run_event.h"
#include "runner/statistics/forecast.h"

namespace peclet::runner {

struct RunReport {
  int points = 0, decided = 0, converged = 0;  // converged, or complete: also with losses
  bool has_target = true;
  int cancelled = 0;                      // before they were decided
  int seeds_ended = 0, seeds_wanted = 0;  // of the looks that are next or have decided
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
