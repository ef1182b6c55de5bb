#include "runner/owner/progress.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <spdlog/sinks/ansicolor_sink.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "runner/campaign/number_text.h"

namespace peclet::runner {

namespace {

// Interval of log lines if stderr is not a terminal.
constexpr double seconds_between_lines = 30;

bool colour_wanted() {
  const char* const no_colour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) != 0 && (no_colour == nullptr || *no_colour == '\0');
}

spdlog::sink_ptr stderr_sink() {
  if (colour_wanted()) return std::make_shared<spdlog::sinks::ansicolor_stderr_sink_st>();
  return std::make_shared<spdlog::sinks::stderr_sink_st>();
}

std::size_t terminal_width() {
  winsize size{};
  if (ioctl(STDERR_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_col == 0) return 80;
  return size.ws_col;
}

constexpr std::uint64_t largest_log = 4 << 20;
constexpr int older_logs = 4;
constexpr double seconds_between_entries = 600;

}  // namespace

std::string progress_line(const RunReport& report) {
  std::string line = fmt::format("points {}/{} {}", report.converged, report.points,
                                 report.has_target ? "converged" : "complete");
  if (report.decided > report.converged) line += fmt::format(", {} not", report.decided - report.converged);
  if (report.cancelled > 0) line += fmt::format(", {} cancelled", report.cancelled);
  line += fmt::format(" | seeds {}/{}", report.seeds_ended, report.seeds_wanted);
  if (report.results > 0) line += fmt::format(" | {:.3g}/min", 60 * report.results / report.elapsed);
  if (const std::string to_go = report.to_go ? to_string(*report.to_go) : ""; !to_go.empty()) {
    line += " | " + to_go;
  }
  if (report.budget_seconds) {
    line += fmt::format(" | budget {} of {} h", rough(report.spent_seconds / seconds_per_hour),
                        rough(*report.budget_seconds / seconds_per_hour));
  }
  if (report.workers > 0) line += fmt::format(" | workers {}/{}", report.busy, report.workers);
  if (report.running > report.busy) line += fmt::format(": {} realisations", report.running);
  return line;
}

Progress::Style Progress::style_of_stderr(bool quiet) {
  if (quiet) return Style::quiet;
  return isatty(STDERR_FILENO) != 0 ? Style::terminal : Style::lines;
}

Progress::Progress(Style style)
    : style_(style), log_(std::make_shared<spdlog::logger>("run", stderr_sink())) {
  log_->set_pattern("%H:%M:%S %^%l%$ %v");
}

Progress::~Progress() { erase_line(); }

void Progress::erase_line() {
  if (line_.empty()) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
}

void Progress::draw_line() {
  if (line_.empty()) return;
  std::fputs(line_.substr(0, terminal_width() - 1).c_str(), stderr);
  std::fflush(stderr);
}

void Progress::note(const std::string& message) {
  if (style_ == Style::quiet) return;
  erase_line();
  log_->info(message);
  draw_line();
}

void Progress::warn(const std::string& message) {
  erase_line();
  log_->warn(message);
  draw_line();
}

void Progress::report(const RunReport& report) {
  if (style_ == Style::terminal) {
    erase_line();
    line_ = progress_line(report);
    draw_line();
  } else if (style_ == Style::lines && report.elapsed >= next_line_) {
    log_->info(progress_line(report));
    next_line_ = report.elapsed + seconds_between_lines;
  }
}

RunLog::RunLog(const fs::path& file, RunListener& audience)
    : audience_(audience), file_(file, largest_log, older_logs) {}

void RunLog::write(const char* level, const std::string& message) {
  using namespace std::chrono;
  const auto now = system_clock::now();
  const auto millisecond = duration_cast<milliseconds>(now.time_since_epoch()).count() % 1000;
  file_.append(fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z {} {}\n", fmt::gmtime(system_clock::to_time_t(now)),
                           millisecond, level, message));
}

void RunLog::note(const std::string& message) {
  write("info", message);
  audience_.note(message);
}

void RunLog::warn(const std::string& message) {
  write("warning", message);
  audience_.warn(message);
}

void RunLog::report(const RunReport& report) {
  if (report.elapsed >= next_report_) {
    write("info", progress_line(report));
    next_report_ = report.elapsed + seconds_between_entries;
  }
  audience_.report(report);
}

}  // namespace peclet::runner
