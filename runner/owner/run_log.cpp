#include "runner/owner/run_log.h"

#include <spdlog/details/null_mutex.h>
#include <spdlog/pattern_formatter.h>
#include <spdlog/sinks/base_sink.h>

#include "runner/owner/progress.h"
#include "runner/store/rotating_file.h"

namespace peclet::runner {
namespace {

constexpr std::uint64_t largest_file = 4 << 20;
constexpr int older_files = 4;
constexpr double seconds_between_entries = 600;

class FileSink : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  explicit FileSink(const std::filesystem::path& path) : file_(path, largest_file, older_files) {}

 protected:
  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    file_.append({line.data(), line.size()});
  }
  void flush_() override {}

 private:
  RotatingFile file_;
};

}  // namespace

RunLog::RunLog(const std::filesystem::path& file, RunListener& audience)
    : audience_(audience), log_(std::make_shared<spdlog::logger>("log", std::make_shared<FileSink>(file))) {
  log_->set_formatter(std::make_unique<spdlog::pattern_formatter>("%Y-%m-%dT%H:%M:%S.%eZ %l %v",
                                                                  spdlog::pattern_time_type::utc));
}

void RunLog::note(const std::string& message) {
  log_->info(message);
  audience_.note(message);
}

void RunLog::warn(const std::string& message) {
  log_->warn(message);
  audience_.warn(message);
}

void RunLog::report(const RunReport& report) {
  if (report.elapsed >= next_report_) {
    log_->info(progress_line(report));
    next_report_ = report.elapsed + seconds_between_entries;
  }
  audience_.report(report);
}

void RunLog::record(const std::string& message) { log_->info(message); }

}  // namespace peclet::runner
