// The run's own log, logs/peclet.log: one line an event, times in UTC, bounded in size.
#pragma once

#include <spdlog/logger.h>

#include <filesystem>
#include <memory>
#include <string>

#include "runner/owner/run_listener.h"

namespace peclet::runner {

// Writes down what a run tells, and passes it on.
class RunLog : public RunListener {
 public:
  // `audience` must outlive the log.
  RunLog(const std::filesystem::path& file, RunListener& audience);

  void note(const std::string& message) override;
  void warn(const std::string& message) override;
  void happened(const RunEvent& event) override { audience_.happened(event); }
  void report(const RunReport& report) override;  // into the file once in ten minutes

  // For the file alone: how the run began and ended.
  void record(const std::string& message);

 private:
  RunListener& audience_;
  std::shared_ptr<spdlog::logger> log_;
  double next_report_ = 0;  // seconds of the run
};

}  // namespace peclet::runner
