// How a run looks to the person who started it: one line that keeps itself up to date on a terminal, log
// lines elsewhere; always on stderr.
#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>

#include "runner/campaign/paths.h"
#include "runner/owner/run_listener.h"
#include "runner/store/rotating_file.h"

namespace peclet::runner {

// "points 2/6 converged, 1 otherwise decided | seeds 143/210 | 12.3/min | 12 min to go (10 to 18 min)"
std::string progress_line(const RunReport& report);

class Progress : public RunListener {
 public:
  enum class Style { terminal, lines, quiet };
  // Style for stderr as it is: quiet when asked for, else by what it is connected to.
  static Style style_of_stderr(bool quiet);

  explicit Progress(Style style);
  ~Progress() override;
  Progress& operator=(Progress&&) = delete;

  void note(const std::string& message) override;
  void warn(const std::string& message) override;  // also when quiet
  void report(const RunReport& report) override;

 private:
  void erase_line();
  void draw_line();

  Style style_;
  std::shared_ptr<spdlog::logger> log_;
  std::string line_;      // what the terminal's last line shows
  double next_line_ = 0;  // seconds of the run at which a log line is due
};

// The run's own log, logs/peclet.log: one line an event, times in UTC, bounded in size. Writes down what a
// run tells, and passes it on.
class RunLog : public RunListener {
 public:
  // `audience` must outlive the log.
  RunLog(const fs::path& file, RunListener& audience);

  void note(const std::string& message) override;
  void warn(const std::string& message) override;
  void happened(const RunEvent& event) override { audience_.happened(event); }
  void report(const RunReport& report) override;  // into the file once in ten minutes

  // For the file alone: how the run began and ended.
  void record(const std::string& message) { write("info", message); }

 private:
  void write(const char* level, const std::string& message);

  RunListener& audience_;
  RotatingFile file_;
  double next_report_ = 0;  // seconds of the run
};

}  // namespace peclet::runner
