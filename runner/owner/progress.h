// Progress shows a run to the person who started it, on stderr: one line that is kept up to date on a
// terminal, log lines elsewhere. RunLog writes the run's log file.
#pragma once

#include <spdlog/logger.h>

#include <memory>
#include <string>

#include "runner/campaign/paths.h"
#include "runner/owner/run_listener.h"
#include "runner/store/rotating_file.h"

namespace peclet::runner {

// Returns "points 2/6 converged, 1 not | seeds 143/210 | 12.3/min | 12 min to go (10 to 18 min)".
std::string progress_line(const RunReport& report);

class Progress : public RunListener {
 public:
  enum class Style { terminal, lines, quiet };
  // Returns the style for stderr: quiet if asked for, else by what stderr is connected to.
  static Style style_of_stderr(bool quiet);

  explicit Progress(Style style);
  ~Progress() override;
  Progress& operator=(Progress&&) = delete;

  void note(const std::string& message) override;
  void warn(const std::string& message) override;  // printed even if quiet
  void report(const RunReport& report) override;

 private:
  void erase_line();
  void draw_line();

  Style style_;
  std::shared_ptr<spdlog::logger> log_;
  std::string line_;      // text of the terminal's last line
  double next_line_ = 0;  // time of the run [s] at which a log line is due
};

// Writes what a run tells into logs/peclet.log, of bounded size, one line an event, and passes it on.
class RunLog : public RunListener {
 public:
  // `audience` must outlive the log.
  RunLog(const fs::path& file, RunListener& audience);

  void note(const std::string& message) override;
  void warn(const std::string& message) override;
  void happened(const RunEvent& event) override { audience_.happened(event); }
  void report(const RunReport& report) override;  // writes to the file once in ten minutes

  // Writes to the file only: how the run began and ended.
  void record(const std::string& message) { write("info", message); }

 private:
  void write(const char* level, const std::string& message);

  RunListener& audience_;
  RotatingFile file_;
  double next_report_ = 0;  // time of the run [s] at which a report is due
};

}  // namespace peclet::runner
